"""Measured topographies of several teeth of a gear."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from tribodyn.checks import require_whole
from tribodyn.errors import Argument, InputError, Problem, require_one_of
from tribodyn.faults.fault import Fault
from tribodyn.gear import ProfileMap, SpurPair
from tribodyn.gear.mesh_geometry import flank_ranges
from tribodyn.gear.pair_checks import map_problems
from tribodyn.nomenclature import GEARS
from tribodyn.stiffness.loaded.problem import ContactPlaces
from tribodyn.types import Array, Index

#: What the teeth have that were not measured.
OTHER_TEETH = ("nominal", "nearest")


@dataclass(frozen=True, kw_only=True)
class FlankTopographies(Fault):
    """Measured deviations of the flanks, or profiles, of several teeth.

    Parameters
    ----------
    gear : "pinion" or "wheel"
        Gear that has them.
    teeth : tuple of int
        Measured teeth, numbered in the order of contact from 1.
    maps : tuple of ProfileMap
        Deviation of the flank of each of them; a map of one place along the face is a profile.
    other_teeth : str
        Other teeth have no deviation (``"nominal"``), or that of the nearest measured tooth
        (``"nearest"``; of two, the lower number).
    first_tooth : int
        Tooth of this list that comes into contact first.

    Raises
    ------
    InputError
        If no tooth is measured, a tooth is listed twice, or teeth and maps are not as many.

    Notes
    -----
    Deviations add to the modification of the gear, and to its own profile map if it has one.

    Examples
    --------
    >>> chart = ProfileMap((10e-3, 20e-3), (0.0,), ((0.0,), (2e-6,)))
    >>> FlankTopographies(gear="wheel", teeth=(1, 7), maps=(chart, chart)).teeth
    (1, 7)
    """

    teeth: tuple[int, ...]
    maps: tuple[ProfileMap, ...]
    other_teeth: str = "nominal"
    first_tooth: int = 1

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(self, "teeth", tuple(require_whole("teeth", n, 1) for n in self.teeth))
        object.__setattr__(self, "maps", tuple(self.maps))
        require_one_of("other_teeth", self.other_teeth, OTHER_TEETH)
        require_whole("first_tooth", self.first_tooth)
        counts = len(self.teeth), len(self.maps), len(set(self.teeth))
        if not self.teeth or len(set(counts)) > 1:
            what = f"{counts[0]} teeth, {counts[2]} of them different, and {counts[1]} maps"
            why, remedy = "Each measured tooth has one map", "Give as many maps as teeth"
            raise InputError(what, Argument("teeth"), why, remedy)

    @property
    def _varies_over_face(self) -> bool:  # type: ignore[override]
        """Whether a map has several places along the face."""
        return any(len(chart.face_position) > 1 for chart in self.maps)

    def _check(self, pair: SpurPair) -> None:
        """Raise InputError if a tooth does not exist or a map does not cover its flank."""
        gear = self._gear_of(pair)
        count, most = abs(gear.teeth), max(self.teeth)
        if most > count:
            what, why = f"tooth {most} is measured", f"The {self.gear} has {count} teeth"
            raise InputError(what, Argument("teeth"), why, "Count in the order of contact")
        flank = flank_ranges(pair)[GEARS.index(self.gear)]
        problems: list[Problem] = []
        for chart in self.maps:
            problems += map_problems(self.gear, chart, gear, flank, pair.common_face_width)
        if problems:
            raise InputError([replace(problem, where=Argument("maps")) for problem in problems])

    def maps_of_teeth(self, count: int) -> Index:
        """Map of every tooth of a gear.

        Parameters
        ----------
        count : int
            Number of teeth.

        Returns
        -------
        (count,) array of int
            Number of its map, from 0; -1 where a tooth has none.
        """
        away = np.abs(np.arange(1, count + 1)[:, None] - np.array(self.teeth))
        away = np.minimum(away, count - away)
        order = np.argsort(self.teeth, kind="stable")
        nearest = order[np.argmin(away[:, order], axis=1)]
        measured = away.min(axis=1) == 0
        if self.other_teeth == "nominal":
            nearest = np.where(measured, nearest, -1)
        return np.asarray(np.roll(nearest, 1 - self.first_tooth))

    def _gap(self, places: ContactPlaces, face: Array) -> Array:
        """Gap (p, s, n)."""
        pair = places.contact.pair
        gear, flank = self._gear_of(pair), flank_ranges(pair)[GEARS.index(self.gear)]
        number = self.maps_of_teeth(abs(gear.teeth))[self._tooth_numbers(places) - 1]
        radius = np.abs(np.clip(self._radius_of(places), *flank))
        across = np.broadcast_to(face, (face.shape[0], number.shape[1]))
        gap = np.zeros((len(number), *across.shape))
        for i, chart in enumerate(self.maps):
            phase, contact = np.nonzero(number == i)
            at = radius[phase, contact][:, None], across[:, contact].T
            gap[phase, :, contact] = -chart.at(*at, base_radius=gear.base_radius)
        return gap
