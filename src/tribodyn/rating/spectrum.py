"""Load spectra of gears: linear damage by Miner, ISO 6336-6.

Each load case has its own factors. Its load cycles are counted per flank, one for each turn and
mesh, without rainflow counting: ``U = sum n_i/N_i(S sigma_i)``, and the safety S solves U = 1.
Above the static strength one cycle breaks; below the stress of 1e10 cycles there is no damage.
Cases of negative torque load the other flanks.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import Argument, InputError, require_between, require_positive
from tribodyn.gear import CylindricalPair
from tribodyn.rating.bending import record_bending
from tribodyn.rating.conditions import rating_conditions
from tribodyn.rating.factor import Factors
from tribodyn.rating.life import Curve, bending_curve, cycles_to_failure
from tribodyn.rating.mesh_load import MeshLoad
from tribodyn.rating.oil import GearOil
from tribodyn.rating.pair_rating import GEARS, PairRating, load_cycles, rate_mesh
from tribodyn.rating.pitting import pitting_strength_curve, record_pitting
from tribodyn.rating.rated_gear import RatedGear


@dataclass(frozen=True)
class SpectrumLoad:
    """One load case of a spectrum.

    Parameters
    ----------
    torque : float [N*m]
        Of the pinion; negative where the other flanks carry.
    speed : float [rad/s]
        Of the pinion.
    duration : float [s]
        Time under this load.
    name : str
        Name in the results.

    Raises
    ------
    InputError
        If a value is out of range.

    Examples
    --------
    >>> SpectrumLoad(200.0, 150.0, 3.6e6, "full load").name
    'full load'
    """

    torque: float
    speed: float
    duration: float
    name: str = ""

    def __post_init__(self) -> None:
        require_positive("speed", self.speed, "rad/s")
        require_positive("duration", self.duration, "s")
        require_between("torque", self.torque, -1e9, 1e9, "N*m")


def load_classes(
    torque: ArrayLike, speed: ArrayLike, duration: float, classes: int = 16
) -> tuple[SpectrumLoad, ...]:
    """Load duration classes of a torque history: how long which torque acts.

    Parameters
    ----------
    torque : array (n,) [N*m]
        Of the pinion at evenly spaced times, measured or computed; negative where the other flanks
        carry.
    speed : float or array (n,) [rad/s]
        Of the pinion.
    duration : float [s]
        Time that the history represents.
    classes : int
        Equal classes from no load to the greatest torque, for each sign (pure number).

    Returns
    -------
    tuple of SpectrumLoad
        Each class with the greatest torque in it, its time and the speed that keeps its turns.

    Raises
    ------
    InputError
        If a value is out of range, or the lengths of both histories differ.

    Notes
    -----
    A tooth is loaded once a turn and mesh at the torque of that moment, whatever came before: gears
    take the time under each torque, not rainflow cycles. As load cases of a machine:
    ``[{"torque": c.torque, "speed": c.speed, "share": c.duration / duration} for c in classes]``.
    Source: ISO 6336-6.

    Examples
    --------
    >>> [(c.torque, c.duration) for c in load_classes([0.0, 90.0, 100.0, -50.0], 150.0, 8.0, 4)]
    [(0.0, 2.0), (100.0, 4.0), (-50.0, 2.0)]
    """
    torques = np.asarray(torque, dtype=float).ravel()
    require_between("torque", torques, -1e9, 1e9, "N*m")
    require_positive("speed", np.asarray(speed, dtype=float), "rad/s")
    require_positive("duration", duration, "s")
    require_between("classes", classes, 1, 10000)
    speeds = np.asarray(speed, dtype=float).ravel()
    if not torques.size or speeds.size not in (1, torques.size):
        what = f"torque has {torques.size} values and speed {speeds.size}"
        why, remedy = "Each torque acts at one speed", "Give one speed, or one for each torque"
        raise InputError(what, Argument("torque"), why, remedy)
    speeds = np.broadcast_to(speeds, torques.shape)
    width = np.abs(torques).max() / classes or 1.0
    numbers = np.sign(torques) * np.ceil(np.abs(torques) / width * (1.0 - 1e-12))
    loads = []
    for place, number in enumerate(sorted(set(numbers.tolist()), key=lambda n: (n < 0.0, abs(n)))):
        inside = numbers == number
        greatest = float(torques[inside][np.abs(torques[inside]).argmax()])
        time = duration * float(inside.mean())
        name = f"class {place + 1}"
        loads.append(SpectrumLoad(greatest, float(speeds[inside].mean()), time, name))
    return tuple(loads)


@dataclass(frozen=True)
class GearDamage:
    """Damage of one gear by a spectrum.

    Parameters
    ----------
    pitting_safety, bending_safety : float
        Factors on the stresses with which the damage is 1, pure numbers; infinite without load.
    pitting_damage, bending_damage : tuple of float
        Damage n_i/N_i of each load case at its stress itself, pure numbers.
    """

    pitting_safety: float
    bending_safety: float
    pitting_damage: tuple[float, ...]
    bending_damage: tuple[float, ...]


@dataclass(frozen=True)
class SpectrumRating:
    """Rating of a gear pair under a spectrum; made by :func:`rate_spectrum`.

    Parameters
    ----------
    pinion, wheel : GearDamage
        Safeties and damage of the gears.
    cases : tuple of SpectrumLoad
        Load cases, with durations scaled to the required life.
    ratings : tuple of PairRating
        Rating of each load case alone.
    """

    pinion: GearDamage
    wheel: GearDamage
    cases: tuple[SpectrumLoad, ...]
    ratings: tuple[PairRating, ...]

    @property
    def pitting_safety(self) -> float:
        """Smaller S_H of both gears."""
        return min(self.pinion.pitting_safety, self.wheel.pitting_safety)

    @property
    def bending_safety(self) -> float:
        """Smaller S_F of both gears."""
        return min(self.pinion.bending_safety, self.wheel.bending_safety)


@dataclass(frozen=True)
class _Stress:
    """Stress of a gear in one load case, its cycles and its strength over cycles."""

    stress: float
    cycles: float
    strength: Curve

    def damage(self, safety: float) -> float:
        """n/N at the stress times a safety; the last point of the curve is the endurance limit."""
        cycles = cycles_to_failure(self.strength, safety * self.stress)
        return math.inf if cycles == 0.0 else self.cycles / cycles


def solve_safety(damage: Callable[[float], float], highest: float) -> float:
    """Safety at which a damage that grows with it passes 1, at most the static strength."""
    from scipy.optimize import bisect

    if damage(highest) < 1.0:
        return highest
    low = highest
    while damage(low) >= 1.0:
        low *= 0.5
    # The damage steps at the endurance limit; bisection needs its sign only.
    root: float = bisect(
        lambda safety: damage(safety) - 1.0, low, highest, xtol=1e-300, maxiter=200
    )
    return root


def _safety(stresses: Sequence[_Stress]) -> float:
    """Safety of one flank under its load cases."""
    loaded = [each for each in stresses if each.stress > 0.0]
    if not loaded:
        return math.inf
    static = min(each.strength[0][1] / each.stress for each in loaded)
    return solve_safety(lambda safety: sum(each.damage(safety) for each in loaded), static)


def _strength(
    curve: Curve, record: Callable[[Factors, float], float], limit: str, factors: Factors
) -> Curve:
    """Strength [Pa] at the points of a life curve, with all factors at each."""
    points = []
    for cycles, _ in curve:
        scratch = Factors(factors.replacements, factors)
        record(scratch, cycles)
        points.append((cycles, float(scratch[limit])))
    return tuple(points)


def _stresses(
    mesh: MeshLoad, index: int, oil: GearOil, rating: PairRating, case: SpectrumLoad
) -> tuple[_Stress, _Stress]:
    """Contact and root stress of a gear in a load case."""
    rated = mesh.rated[index]
    gear = rating.gears[GEARS[index]]
    speed = mesh.speed if index == 0 else mesh.speed / abs(mesh.ratio)
    count = load_cycles(rated, speed, case.duration) or 0.0
    factors = Factors({}, Factors())
    factors.update(gear.factors)
    pitting = _strength(
        pitting_strength_curve(mesh, rated),
        lambda scratch, cycles: record_pitting(mesh, index, oil, scratch, cycles),
        "sigma_HG",
        factors,
    )
    bending = _strength(
        bending_curve(rated.material, mesh.conditions.long_life_factor),
        lambda scratch, cycles: record_bending(mesh, index, scratch, cycles),
        "sigma_FG",
        factors,
    )
    return (
        _Stress(float(gear.factors["sigma_H"]), count, pitting),
        _Stress(float(gear.factors["sigma_F"]), count, bending),
    )


def _gear_damage(
    stresses: Sequence[tuple[_Stress, _Stress]], torques: Sequence[float]
) -> GearDamage:
    """Damage of a gear: each flank by the cases that load it."""
    safeties = []
    for kind in (0, 1):
        flanks = (
            [s[kind] for s, t in zip(stresses, torques, strict=True) if t * side > 0.0]
            for side in (1.0, -1.0)
        )
        safeties.append(min(_safety(flank) for flank in flanks))
    pitting, bending = (tuple(s[kind].damage(1.0) for s in stresses) for kind in (0, 1))
    return GearDamage(safeties[0], safeties[1], pitting, bending)


def rate_spectrum(
    pair: CylindricalPair,
    *,
    cases: Sequence[SpectrumLoad],
    oil: GearOil,
    pinion: RatedGear | None = None,
    wheel: RatedGear | None = None,
    factors: Mapping[str, float] | None = None,
    **conditions: Any,
) -> SpectrumRating:
    """Rate a cylindrical gear pair under a load spectrum by linear damage.

    Parameters
    ----------
    pair : CylindricalPair
        Geometry.
    cases : sequence of SpectrumLoad
        Load cases; with ``required_life`` their durations are shares of it.
    oil, pinion, wheel, factors
        As for :func:`rate_pair`, in SI units; ``load_cycles`` of the gears are not used.
    **conditions
        Fields of :class:`RatingConditions`; the application factor of a spectrum is 1.

    Returns
    -------
    SpectrumRating

    Raises
    ------
    InputError
        As :func:`rate_pair`, or if no load case has a torque.

    Warns
    -----
    ModelWarning
        As :func:`rate_pair`, for each load case.

    Notes
    -----
    Sources: ISO 6336-6 with the life curves of ISO 6336-2 and -3.

    Examples
    --------
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...     normal_pressure_angle=0.3490658504, pinion_face_width=40e-3)
    >>> cases = [SpectrumLoad(500.0, 150.0, 1.8e6), SpectrumLoad(300.0, 150.0, 3.4e7)]
    >>> rating = rate_spectrum(pair, cases=cases, oil=GearOil(kinematic_viscosity_at_40=220e-6))
    >>> print(f"{rating.pitting_safety:.2f} {rating.bending_safety:.2f}")
    1.14 2.89
    """
    loaded = [case for case in cases if case.torque != 0.0]
    if not loaded:
        why = "A spectrum has at least one load case with a torque"
        raise InputError("no load case", Argument("cases"), why, "Give torque, speed, duration")
    stated = rating_conditions(conditions)
    if stated.required_life is not None:
        scale = stated.required_life / sum(case.duration for case in cases)
        loaded = [replace(case, duration=case.duration * scale) for case in loaded]
    rated = tuple(replace(gear or RatedGear(), load_cycles=None) for gear in (pinion, wheel))
    ratings: list[PairRating] = []
    stresses: tuple[list[tuple[_Stress, _Stress]], ...] = [], []
    for case in loaded:
        timed = replace(stated, required_life=case.duration)
        mesh = MeshLoad(pair, rated[0], rated[1], timed, abs(case.torque), case.speed, Factors())
        rating = rate_mesh(mesh, oil, factors or {})
        ratings.append(rating)
        for index, gear in enumerate(stresses):
            gear.append(_stresses(mesh, index, oil, rating, case))
    torques = [case.torque for case in loaded]
    first, second = (_gear_damage(gear, torques) for gear in stresses)
    return SpectrumRating(first, second, tuple(loaded), tuple(ratings))
