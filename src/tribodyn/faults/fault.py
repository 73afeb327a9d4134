"""What every fault of a gear answers: the gap and the compliance that it adds to each contact."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from tribodyn.errors import Argument, InputError, require_one_of
from tribodyn.gear import Material, SpurGear, SpurPair
from tribodyn.nomenclature import GEARS
from tribodyn.stiffness.loaded.problem import ContactPlaces, ContactProblem
from tribodyn.types import Array, Index, Mask

GearName = Literal["pinion", "wheel"]


@dataclass(frozen=True, kw_only=True)
class Fault:
    """A deviation or a damage that repeats with the turns of one gear.

    Parameters
    ----------
    gear : "pinion" or "wheel"
        Gear that has it.
    """

    gear: GearName = "pinion"

    #: Whether the flanks differ over the face, so that slices are needed.
    _varies_over_face = False

    def __post_init__(self) -> None:
        require_one_of("gear", self.gear, GEARS)

    def _on(self, pair: SpurPair) -> SpurPair:
        """The pair with what of the fault its flank modifications can state."""
        return pair

    def _gap(self, places: ContactPlaces, face: Array) -> Array | float:
        """Material that is missing at each contact, to be broadcast to (p, s, n) [m]."""
        # Face (s, 1): place of each slice along the face, from its middle [m].
        return 0.0

    def _softened(self, places: ContactPlaces) -> Mask | None:
        """Contacts (p, n) whose tooth is softer than a sound one."""
        return None

    def _soften(self, problem: ContactProblem, material: Material) -> None:
        """Add the compliance of the fault to that of the sound teeth."""

    def _gear_of(self, pair: SpurPair) -> SpurGear:
        """The gear that has the fault."""
        return pair.pinion if self.gear == "pinion" else pair.wheel

    def _rotation(self, places: ContactPlaces) -> Array:
        """Rotation of the gear in its running sense since phase 0 (p,) [rad]."""
        return np.asarray(
            2.0 * np.pi * places.phase / abs(self._gear_of(places.contact.pair).teeth)
        )

    def _tooth_numbers(self, places: ContactPlaces) -> Index:
        """Tooth of the gear at each contact (p, n), from 1 in the order of contact."""
        cycle = np.floor(places.phase).astype(int)[:, None]
        count = abs(self._gear_of(places.contact.pair).teeth)
        return np.asarray((cycle - places.number) % count + 1)

    def _radius_of(self, places: ContactPlaces) -> Array:
        """Radius of curvature of the gear at each contact (p, n) [m]."""
        if self.gear == "pinion":
            return places.pinion_curvature_radius
        return places.wheel_curvature_radius

    def _flank_share(self, places: ContactPlaces) -> Array:
        """Place on the used flank (p, n), 0 at its lowest point and 1 at the tip."""
        from tribodyn.gear.mesh_geometry import flank_ranges

        pair = places.contact.pair
        flank = flank_ranges(pair)[GEARS.index(self.gear)]
        return np.asarray((self._radius_of(places) - flank.lowest) / flank.length)

    def _check(self, pair: SpurPair) -> None:
        """Raise InputError if the pair cannot have this fault."""

    def _check_model(self, pair: SpurPair, provider: str) -> None:
        """Raise InputError if the fault needs another stiffness model of the pair."""


@dataclass(frozen=True, kw_only=True)
class ToothFault(Fault):
    """A damage of one tooth, numbered in the order of contact from 1."""

    tooth: int = 1

    def _check(self, pair: SpurPair) -> None:
        """Raise InputError if there is no such tooth."""
        count = abs(self._gear_of(pair).teeth)
        if not 1 <= self.tooth <= count:
            what, why = f"tooth = {self.tooth}", f"The {self.gear} has {count} teeth, 1 to {count}"
            raise InputError(what, Argument("tooth"), why, "Count in the order of contact")

    def _has_tooth(self, places: ContactPlaces) -> Mask:
        """Whether the damaged tooth is at each contact (p, n)."""
        return np.asarray(self._tooth_numbers(places) == self.tooth)
