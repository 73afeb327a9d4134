"""Flanks that differ from tooth to tooth: slopes of profile and helix, measured topographies."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from tribodyn.errors import Argument, InputError, Problem, require_between, require_one_of
from tribodyn.faults.deviations import class_sizes
from tribodyn.faults.fault import Fault
from tribodyn.gear import ProfileMap, SpurGear, SpurPair
from tribodyn.gear.mesh_geometry import flank_ranges
from tribodyn.gear.pair_checks import map_problems
from tribodyn.nomenclature import GEARS, require_whole
from tribodyn.stiffness.loaded.problem import ContactPlaces
from tribodyn.types import Array, Index

#: Largest slope that is a deviation and not a slip of the unit [m].
_MOST = 0.5e-3


def slope_tolerances(gear: SpurGear, accuracy_class: int) -> tuple[float, float]:
    """Tolerances of the slope deviations of profile and helix.

    Parameters
    ----------
    gear : SpurGear
        The gear.
    accuracy_class : int
        Class of ISO 1328-1, 1 to 11.

    Returns
    -------
    (float, float) [m]

    Raises
    ------
    InputError
        If there is no such class.

    Notes
    -----
    ISO 1328-1:2013: f_HaT = (0.4 m + 0.001 d + 4) sqrt(2)^(A - 5) and f_HbT = (0.05 sqrt(d) +
    0.35 sqrt(b) + 4) sqrt(2)^(A - 5) in um, with d, m and b in mm, without the rounding of the
    standard.

    Examples
    --------
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=50, normal_module=5e-3,
    ...     normal_pressure_angle=0.3490658504, pinion_face_width=0.025)
    >>> [round(1e6 * value, 3) for value in slope_tolerances(pair.pinion, 5)]
    [6.1, 6.25]
    """
    diameter, module, scale = class_sizes(gear, accuracy_class)
    profile = 0.4 * module + 0.001 * diameter + 4.0
    helix = 0.05 * math.sqrt(diameter) + 0.35 * math.sqrt(1e3 * gear.face_width) + 4.0
    return profile * scale, helix * scale


@dataclass(frozen=True, kw_only=True)
class FlankDeviations(Fault):
    """Slope deviations of profile and helix that differ from tooth to tooth.

    Parameters
    ----------
    gear : "pinion" or "wheel"
        Gear that has them.
    profile_slopes : tuple of float
        Material taken away at the tip, growing from the lowest used point, of each tooth in the
        order of contact [m].
    helix_slopes : tuple of float
        Material taken away at one end of the face more than at the other, of each tooth [m].
    accuracy_class : int, optional
        Class of ISO 1328-1 from which both are drawn where neither is given.
    seed : int
        Number of the draw.
    first_tooth : int
        Tooth of the lists that comes into contact first, from 1.

    Raises
    ------
    InputError
        If a value is out of range, or lists and class are both or neither given.

    Notes
    -----
    Signs are those of ``profile_slope`` and ``lead_slope`` of
    :class:`tribodyn.gear.FlankModification`. Drawn slopes are independent and normal; the largest
    is the tolerance of the class.

    Examples
    --------
    >>> FlankDeviations(gear="wheel", accuracy_class=7, seed=2).accuracy_class
    7
    """

    profile_slopes: tuple[float, ...] = ()
    helix_slopes: tuple[float, ...] = ()
    accuracy_class: int | None = None
    seed: int = 0
    first_tooth: int = 1

    def __post_init__(self) -> None:
        super().__post_init__()
        require_whole("first_tooth", self.first_tooth)
        for name in ("profile_slopes", "helix_slopes"):
            values = np.atleast_1d(np.asarray(getattr(self, name), dtype=float))
            object.__setattr__(self, name, tuple(values.tolist()))
            if values.size:
                require_between(name, values, -_MOST, _MOST, "m")
        object.__setattr__(self, "seed", require_whole("seed", self.seed, 0))
        if self.accuracy_class is not None:
            require_between("accuracy_class", self.accuracy_class, 1, 11, "")
        if (self.accuracy_class is None) != bool(self.profile_slopes or self.helix_slopes):
            what = "slopes and accuracy_class are both given"
            if self.accuracy_class is None:
                what = "neither slopes nor an accuracy_class are given"
            why = "Each tooth has its listed slopes, or those drawn from a class"
            raise InputError(what, Argument("accuracy_class"), why, "Give one of them")

    @property
    def _varies_over_face(self) -> bool:  # type: ignore[override]
        """Whether the helix deviates."""
        return self.accuracy_class is not None or any(self.helix_slopes)

    def _check(self, pair: SpurPair) -> None:
        """Raise InputError if a list has not a value for each tooth."""
        count = abs(self._gear_of(pair).teeth)
        for name in ("profile_slopes", "helix_slopes"):
            values = getattr(self, name)
            if values and len(values) != count:
                what = f"{name} has {len(values)} values"
                why = f"The {self.gear} has {count} teeth"
                raise InputError(what, Argument(name), why, f"Give {count} values")

    def slopes(self, gear: SpurGear) -> tuple[Array, Array]:
        """Slopes of profile and helix of all teeth in the order of contact.

        Parameters
        ----------
        gear : SpurGear
            The gear.

        Returns
        -------
        two (z,) arrays [m]
        """
        count = abs(gear.teeth)
        if self.accuracy_class is None:
            listed = (self.profile_slopes, self.helix_slopes)
            profile, helix = (np.asarray(values or np.zeros(count)) for values in listed)
            return np.roll(profile, 1 - self.first_tooth), np.roll(helix, 1 - self.first_tooth)
        draw = np.random.default_rng(self.seed).standard_normal((2, count))
        tolerances = np.array(slope_tolerances(gear, self.accuracy_class))
        scaled = draw * (tolerances / np.abs(draw).max(axis=1))[:, None]
        scaled = np.roll(scaled, 1 - self.first_tooth, axis=1)
        return scaled[0], scaled[1]

    def _gap(self, places: ContactPlaces, face: Array) -> Array:
        """Gap (p, s, n)."""
        gear = self._gear_of(places.contact.pair)
        profile, helix = self.slopes(gear)
        tooth = self._tooth_numbers(places) - 1
        along = profile[tooth] * self._flank_share(places)
        return np.asarray(along[:, None, :] + helix[tooth][:, None, :] * face / gear.face_width)


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
