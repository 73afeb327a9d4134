"""Damage of one tooth: a spall of its flank, a piece that has broken off, a crack at its root."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tribodyn.contact.face_contacts import entry_delay
from tribodyn.errors import Argument, InputError, require_between
from tribodyn.faults.cracked_face import crack_influence
from tribodyn.faults.cracked_tooth import SQUARE, CrackLine, crack_compliance
from tribodyn.faults.fault import ToothFault
from tribodyn.gear import Material, SpurGear, SpurPair
from tribodyn.stiffness.loaded.problem import FAR, ContactPlaces, ContactProblem
from tribodyn.stiffness.model import MODELS
from tribodyn.types import Array, Mask


@dataclass(frozen=True, kw_only=True)
class Spall(ToothFault):
    """Flank material that is missing on a part of one tooth.

    Parameters
    ----------
    gear, tooth
        Gear, and number of its tooth in the order of contact, from 1.
    depth : float
        Depth [m]; deeper than the deflection of the teeth, nothing touches in the spall.
    start, end : float
        Part of the used flank, 0 at its lowest point and 1 at the tip [1].
    face_share : float
        Part of the face width, in its middle [1].

    Raises
    ------
    InputError
        If a value is out of range or the spall has no length.

    Examples
    --------
    >>> Spall(tooth=3, depth=50e-6, start=0.4, end=0.6, face_share=0.5).face_share
    0.5
    """

    depth: float
    start: float
    end: float
    face_share: float = 1.0

    def __post_init__(self) -> None:
        super().__post_init__()
        require_between("depth", self.depth, 0.0, 0.01, "m")
        for name in ("start", "end", "face_share"):
            require_between(name, getattr(self, name), 0.0, 1.0, "")
        if self.end < self.start:
            what = f"end = {self.end:g}, start = {self.start:g}"
            why = "A spall ends above its start"
            raise InputError(what, "end", why, "Count from the lowest point of the flank")

    @property
    def _varies_over_face(self) -> bool:  # type: ignore[override]
        """Whether it is narrower than the face."""
        return 0.0 < self.face_share < 1.0

    def _gap(self, places: ContactPlaces, face: Array) -> Array:
        """Gap (p, s, n)."""
        share = self._flank_share(places)
        inside = self._has_tooth(places) & (share > self.start) & (share < self.end)
        half = 0.5 * self.face_share * places.contact.pair.common_face_width
        across = np.abs(face) < half
        return np.asarray(self.depth * (inside[:, None, :] & across))


@dataclass(frozen=True, kw_only=True)
class BrokenTooth(ToothFault):
    """A tooth whose upper part has broken off over the whole face.

    Parameters
    ----------
    gear, tooth
        Gear, and number of its tooth in the order of contact, from 1.
    remaining : float
        Part of the used flank that is left, from its lowest point; 0 if all of it is gone [1].

    Raises
    ------
    InputError
        If a value is out of range.

    Examples
    --------
    >>> BrokenTooth(gear="wheel", tooth=5, remaining=0.3).remaining
    0.3
    """

    remaining: float = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        require_between("remaining", self.remaining, 0.0, 1.0, "")

    def _gap(self, places: ContactPlaces, face: Array) -> Array:
        """Gap (p, 1, n)."""
        missing = self._has_tooth(places)
        if self.remaining:
            missing = missing & (self._flank_share(places) > self.remaining)
        return np.asarray(FAR * missing[:, None, :])


@dataclass(frozen=True, kw_only=True)
class Crack(ToothFault):
    """A crack at the root of the loaded flank of one tooth.

    Parameters
    ----------
    gear, tooth
        Gear, and number of its tooth in the order of contact, from 1.
    depth : float
        Length of the crack from the surface into the tooth, in the transverse section [m].
    angle : float
        Angle of the crack to the centre line of the tooth [rad], from pi/4, into the body, to pi/2,
        square to the tooth.
    root_tangent : float, optional
        Angle of the tangent of the fillet to the centre line where the crack begins [rad], between
        that of the involute and of the foot.
    face_share : float
        Part of the face width that is cracked, in its middle [1].
    face_length : float, optional
        Length of the crack along the face in its place [m]; for the stiffness model ``fe3d``.
    face_position : float
        Middle of this length, from the middle of the face [m].

    Raises
    ------
    InputError
        If a value is out of range, or, where a mesh is built, the crack crosses most of the tooth,
        leaves the face, or the stiffness model of the pair does not know the face.

    Notes
    -----
    By default the crack begins at the foot of the tooth, where the root fillet is 45 deg steep over
    the circle. It is open under load. With ``fe3d`` the compliance is that of solid finite elements
    over path and face, of spur and helical teeth. Of plane models the cracked and the sound part of
    the face carry in parallel.

    Examples
    --------
    >>> Crack(tooth=1, depth=1e-3).face_share
    1.0
    """

    depth: float
    angle: float = SQUARE
    root_tangent: float | None = None
    face_share: float = 1.0
    face_length: float | None = None
    face_position: float = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        require_between("depth", self.depth, 0.0, 1.0, "m")
        require_between("face_share", self.face_share, 0.0, 1.0, "")
        require_between("face_position", self.face_position, -10.0, 10.0, "m")
        if self.face_length is None:
            return
        require_between("face_length", self.face_length, 0.0, 10.0, "m")
        if self.face_share != 1.0:
            what = f"face_length = {1e3 * self.face_length:g} mm, face_share = {self.face_share:g}"
            why, remedy = "Each of them is the length of the crack along the face", "Give one"
            raise InputError(what, Argument("face_length"), why, remedy)

    def _face_length(self, gear: SpurGear) -> float:
        """Length along the face [m]."""
        return self.face_share * gear.face_width if self.face_length is None else self.face_length

    def _check(self, pair: SpurPair) -> None:
        """Raise InputError if there is no such tooth, or the gear is a ring."""
        super()._check(pair)
        gear = self._gear_of(pair)
        if gear.is_ring:
            why = "The crack runs through a tooth of an external gear"
            raise InputError("the cracked gear is a ring", "gear", why, "Crack the other gear")
        CrackLine(self.depth, self.angle, self.root_tangent).check(gear)
        reach = abs(self.face_position) + 0.5 * self._face_length(gear)
        if reach > 0.5 * gear.face_width * (1.0 + 1e-9):
            name = "face_length" if self.face_length is not None else "face_position"
            what = f"the crack reaches {1e3 * reach:.6g} mm from the middle of the face"
            why = f"The face of the {self.gear} ends {500.0 * gear.face_width:.6g} mm from there"
            raise InputError(what, Argument(name), why, "Give a shorter length or another position")

    def _check_model(self, pair: SpurPair, provider: str) -> None:
        """Raise InputError if the crack ends within the face of a plane model."""
        if MODELS[provider].over_face:
            return
        remedy = 'Choose the stiffness model "fe3d"'
        why = f'"{provider}" is a plane model, in which a tooth is the same over its face'
        if pair.helix_angle:
            what = "the cracked tooth is helical"
            raise InputError(what, Argument("kind"), why, f"{remedy}, or give another damage")
        for name in ("face_length", "face_position"):
            if getattr(self, name) != type(self).__dataclass_fields__[name].default:
                remedy = f"{remedy}, or give face_share instead"
                raise InputError(f"{name} is given", Argument(name), why, remedy)

    def _softened(self, places: ContactPlaces) -> Mask | None:
        """Contacts of the cracked tooth."""
        length = self._face_length(self._gear_of(places.contact.pair))
        return self._has_tooth(places) if self.depth and length else None

    def _soften(self, problem: ContactProblem, material: Material) -> None:
        """Add the compliance of the crack where its tooth carries."""
        places, structure = problem.places, problem.compliance.structure
        cracked = self._softened(places)
        if cracked is None:
            return
        gear, contacts = self._gear_of(places.contact.pair), np.arange(structure.shape[1])
        if places.is_sliced:
            self._soften_slices(problem, material, cracked)
            return
        radius, added = crack_compliance(
            gear, material, self.depth, angle=self.angle, root_tangent=self.root_tangent
        )
        sound = structure[:, contacts, contacts]
        softer = sound + np.interp(self._radius_of(places), radius, added)
        share = self.face_share
        combined = 1.0 / (share / softer + (1.0 - share) / sound)
        structure[:, contacts, contacts] = np.where(cracked, combined, sound)

    def _soften_slices(self, problem: ContactProblem, material: Material, cracked: Mask) -> None:
        """Add the compliance between the slices of the cracked tooth."""
        places, structure = problem.places, problem.compliance.structure
        pair = places.contact.pair
        gear, length = self._gear_of(pair), self._face_length(self._gear_of(pair))
        sense = 1 if self.gear == "pinion" else -1
        slices = places.number.size // np.unique(places.number).size
        delay = entry_delay(places.contact, slices)
        rising = sense * places.direction * float(delay[-1] - delay[0]) < 0.0
        middle = 0.5 * gear.face_width + (-1 if rising else 1) * self.face_position
        ends = middle - 0.5 * length, middle + 0.5 * length
        influence = crack_influence(
            gear, material, self.depth, ends, angle=self.angle, root_tangent=self.root_tangent
        )
        edges = np.linspace(-0.5, 0.5, slices + 1) * pair.common_face_width
        rows = np.flatnonzero(cracked.any(axis=1))
        added = np.zeros((rows.size, *structure.shape[1:]))
        radius = self._radius_of(places)[rows].reshape(rows.size, -1, slices)
        influence.sliced(edges, rising=rising).fill(added, radius, sense * places.direction)
        widths = np.broadcast_to(problem.widths, problem.gaps.shape)[rows, 0]
        added *= (widths * (slices / pair.common_face_width) * cracked[rows])[:, None, :]
        structure[rows] += added * cracked[rows][:, :, None]
