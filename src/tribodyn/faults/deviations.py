"""Deviations over the turn of a gear: eccentricity, waviness, pitch deviations of a class."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from tribodyn.errors import require_between
from tribodyn.faults.fault import Fault, GearName
from tribodyn.gear import SpurPair
from tribodyn.nomenclature import require_whole
from tribodyn.stiffness.loaded.problem import ContactPlaces
from tribodyn.types import Array, Tree

#: Largest amplitude that is a deviation and not a slip of the unit [m].
_MOST = 1e-3


@dataclass(frozen=True, kw_only=True)
class Waviness(Fault):
    """Waves on the flanks that run on from tooth to tooth: the ghost order of a machine tool.

    Parameters
    ----------
    gear : "pinion" or "wheel"
        Gear that has it.
    amplitude : float
        Half the distance of crest and trough along the line of action [m].
    order : int
        Waves in a turn of the gear. One is an eccentricity, the number of teeth a deviation that
        all flanks share.
    phase : float
        Phase of the wave where tooth 1 comes into contact [rad].
    lead_angle : float
        Angle of the crests to the line of contact [rad]; the wave moves along the face with it.

    Raises
    ------
    InputError
        If a value is out of range.

    Notes
    -----
    A wave of the machine tool is a function of the rotation of the gear blank, and so is the point
    of the involute that it generates: all teeth in contact have the same deviation
    ``amplitude cos(order theta + phase)``, whatever the transverse contact ratio.

    Examples
    --------
    >>> Waviness(gear="wheel", amplitude=1e-6, order=97).order
    97
    """

    amplitude: float
    order: int
    phase: float = 0.0
    lead_angle: float = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        require_between("amplitude", self.amplitude, 0.0, _MOST, "m")
        object.__setattr__(self, "order", require_whole("order", self.order, 1))
        require_between("phase", self.phase, -2.0 * math.pi, 2.0 * math.pi, "rad")
        require_between("lead_angle", self.lead_angle, -1.5, 1.5, "rad")

    @property
    def _varies_over_face(self) -> bool:  # type: ignore[override]
        """Whether the crests are inclined."""
        return self.lead_angle != 0.0

    def _gap_after(self, turns: Array) -> Array:
        """Gap of crests along the teeth after turns of the gear, the same at all teeth [m]."""
        return np.asarray(-self.amplitude * np.cos(self.order * 2.0 * np.pi * turns + self.phase))

    def _gap(self, places: ContactPlaces, face: Array) -> Array:
        """Gap (p, s, 1): negative at a crest."""
        base = abs(self._gear_of(places.contact.pair).base_radius)
        along = face * (math.tan(self.lead_angle) / base)
        angle = self.order * (self._rotation(places)[:, None, None] + along) + self.phase
        return np.asarray(-self.amplitude * np.cos(angle))


@dataclass(frozen=True, kw_only=True)
class InclinedFlanks(Fault):
    """Inclination of the flanks of a gear in the plane of action, constant or turning with it.

    Parameters
    ----------
    gear : "pinion" or "wheel"
        Gear that has it.
    amplitude : float
        Gap at one end of the common face width less that at the other [m].
    order : int
        Changes in a turn of the gear: 0 of a shaft inclined in its bearings, 1 of a bent shaft or a
        gear that wobbles, 2 of a shaft whose stiffness or coupling has two axes.
    phase : float
        Phase where tooth 1 comes into contact [rad].

    Raises
    ------
    InputError
        If a value is out of range.

    Examples
    --------
    >>> InclinedFlanks(gear="wheel", amplitude=20e-6, order=1).order
    1
    """

    amplitude: float
    order: int = 0
    phase: float = 0.0
    _varies_over_face = True

    def __post_init__(self) -> None:
        super().__post_init__()
        require_between("amplitude", self.amplitude, 0.0, _MOST, "m")
        object.__setattr__(self, "order", require_whole("order", self.order, 0))
        require_between("phase", self.phase, -2.0 * math.pi, 2.0 * math.pi, "rad")

    def _gap(self, places: ContactPlaces, face: Array) -> Array:
        """Gap (p, s, 1), zero in the middle of the face."""
        turned = np.cos(self.order * self._rotation(places) + self.phase)
        share = face / places.contact.pair.common_face_width
        return np.asarray(self.amplitude * turned[:, None, None] * share)


def eccentricity(gear: GearName, amount: float, phase: float = 0.0) -> Waviness:
    """Distance of the axis of the toothing from the axis of rotation: a wave a turn.

    Parameters
    ----------
    gear : "pinion" or "wheel"
        Gear that has it.
    amount : float
        Eccentricity [m]; the run-out of ISO 1328-2 is twice that.
    phase : float
        Rotation after which the flanks recede from their most proud place [rad].

    Examples
    --------
    >>> eccentricity("pinion", 10e-6).amplitude
    1e-05
    """
    return Waviness(gear=gear, amplitude=amount, order=1, phase=phase)


class PitchedGear(Protocol):
    """A gear with what its pitch tolerances depend on."""

    @property
    def teeth(self) -> int:
        """Number of teeth, negative of a ring."""

    @property
    def reference_radius(self) -> float:
        """Radius of the pitch circle [m]."""

    @property
    def normal_module(self) -> float:
        """Normal module [m]."""


def class_sizes(gear: PitchedGear, accuracy_class: int) -> tuple[float, float, float]:
    """Reference diameter and module [mm], and factor of a tolerance [m] of ISO 1328-1."""
    require_between("accuracy_class", accuracy_class, 1, 11, "")
    scale = 1e-6 * math.sqrt(2.0) ** (accuracy_class - 5)
    return 2e3 * abs(gear.reference_radius), 1e3 * gear.normal_module, scale


def pitch_tolerances(gear: PitchedGear, accuracy_class: int) -> tuple[float, float]:
    """Tolerances of single and of total cumulative pitch deviation.

    Parameters
    ----------
    gear : SpurGear
        The gear, or another with teeth, reference_radius and normal_module.
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
    ISO 1328-1:2013, equations (3) and (5): f_pT = (0.001 d + 0.4 m + 5) sqrt(2)^(A - 5) and
    F_pT = (0.002 d + 0.55 sqrt(d) + 0.7 m + 12) sqrt(2)^(A - 5) in um, with d and m in mm, without
    the rounding of the standard.

    Examples
    --------
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=50, normal_module=5e-3,
    ...     normal_pressure_angle=0.3490658504, pinion_face_width=0.02)
    >>> [round(1e6 * value, 3) for value in pitch_tolerances(pair.pinion, 5)]
    [7.1, 21.2]
    """
    diameter, module, scale = class_sizes(gear, accuracy_class)
    single = 0.001 * diameter + 0.4 * module + 5.0
    total = 0.002 * diameter + 0.55 * math.sqrt(diameter) + 0.7 * module + 12.0
    return single * scale, total * scale


@dataclass(frozen=True, kw_only=True)
class PitchDeviations(Fault):
    """Pitch deviations drawn from an accuracy class.

    Parameters
    ----------
    gear : "pinion" or "wheel"
        Gear that has them.
    accuracy_class : int
        Class of ISO 1328-1, 1 to 11.
    seed : int
        Number of the draw.
    first_tooth : int
        Tooth of the draw that comes into contact first, from 1.

    Raises
    ------
    InputError
        If a value is out of range.

    Notes
    -----
    Independent normal single deviations, less their mean, so that they sum to zero over the turn.
    The largest is the tolerance of the class, unless the cumulative deviation would then exceed
    its own tolerance.

    Examples
    --------
    >>> PitchDeviations(gear="pinion", accuracy_class=6, seed=1).accuracy_class
    6
    """

    accuracy_class: int
    seed: int = 0
    first_tooth: int = 1

    def __post_init__(self) -> None:
        super().__post_init__()
        require_whole("first_tooth", self.first_tooth)
        require_between("accuracy_class", self.accuracy_class, 1, 11, "")
        object.__setattr__(self, "seed", require_whole("seed", self.seed, 0))

    def single(self, gear: PitchedGear) -> Array:
        """Single pitch deviations of a gear in the order of contact; their sum is zero.

        Parameters
        ----------
        gear : SpurGear
            The gear.

        Returns
        -------
        (z,) array [m]
        """
        single_tolerance, total_tolerance = pitch_tolerances(gear, self.accuracy_class)
        deviations = np.random.default_rng(self.seed).standard_normal(abs(gear.teeth))
        deviations -= deviations.mean()
        scale = min(
            single_tolerance / np.abs(deviations).max(),
            total_tolerance / np.ptp(np.cumsum(deviations)),
        )
        return np.asarray(scale * np.roll(deviations, 1 - self.first_tooth))

    def _on(self, pair: SpurPair) -> SpurPair:
        """The pair with these deviations in place of its own."""
        gear = self._gear_of(pair)
        places = np.cumsum(self.single(gear))
        modification = replace(
            gear.modification,
            single_pitch_deviation=(),
            cumulative_pitch_deviation=tuple((places - places[0]).tolist()),
        )
        changed: Tree = {self.gear: replace(gear, modification=modification)}
        return replace(pair, **changed)
