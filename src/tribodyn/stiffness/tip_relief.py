"""Amount and length of the tip relief that leave least transmission error over a torque range."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tribodyn.errors import ModelWarning, require_positive
from tribodyn.gear import (
    FlankModification,
    Material,
    SpurGear,
    SpurPair,
    default_relief_length,
    flank_ranges,
    profile_gap,
)
from tribodyn.stiffness.harris import increasing_torques
from tribodyn.stiffness.loaded.gaps import mesh_period
from tribodyn.stiffness.loaded.prepare import NO_OPTIONS, contact_problem, phases_of
from tribodyn.stiffness.loaded.problem import ContactProblem
from tribodyn.stiffness.model import MODELS
from tribodyn.stiffness.tip_relief_bounds import ReliefRange, relief_range
from tribodyn.stiffness.tip_relief_result import TipReliefOptimum

__all__ = ["optimize_tip_relief", "with_tip_relief"]

FloatArray = NDArray[np.float64]

#: Best points of the map from which the search goes on.
_STARTS = 3
#: Torques between the two ends of a range.
_TORQUES = 5


def with_tip_relief(
    pair: SpurPair, amount: float, length: float, *, gears: str = "both", shape: str = "linear"
) -> SpurPair:
    """Give a pair a tip relief; what else its flanks have stays.

    Parameters
    ----------
    pair : SpurPair
        Both gears in their working position.
    amount : float [m]
        Material taken away at the tip; zero for no relief.
    length : float [m]
        Roll length of the relief.
    gears : str
        ``"both"``, ``"pinion"`` or ``"wheel"``.
    shape : str
        ``"linear"`` or ``"parabolic"``.

    Returns
    -------
    SpurPair

    Raises
    ------
    InputError
        If a value is out of range, or the relief longer than the flank.

    Examples
    --------
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...     normal_pressure_angle=0.3490658504, pinion_face_width=0.02)
    >>> with_tip_relief(pair, 10e-6, 2e-3, gears="wheel").wheel.modification
    FlankModification(tip_relief 10 um, tip_relief_length 2 mm)
    """
    changed = {
        name: _relieved(getattr(pair, name), amount, length, shape) for name in _named(gears)
    }
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)  # of the shape of the gears: told before
        return replace(pair, **changed)


def _named(gears: str) -> tuple[str, ...]:
    return ("pinion", "wheel") if gears == "both" else (gears,)


def _relieved(gear: SpurGear, amount: float, length: float, shape: str) -> SpurGear:
    given = replace(
        gear.modification,
        tip_relief=amount,
        tip_relief_length=length if amount > 0.0 else None,
        tip_relief_shape=shape,
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        return replace(gear, modification=given)


@dataclass(frozen=True, eq=False)
class _Mesh:
    """The loaded tooth contact of a pair, to be asked for many reliefs.

    The structure of the teeth depends on where they touch and not on what is missing there, so
    compliances are found once and gaps alone change.
    """

    pair: SpurPair
    gears: str
    shape: str
    problems: list[ContactProblem]
    totals: list[FloatArray]

    def error(self, amount: float, length: float) -> FloatArray:
        """Transmission error (t, p) [m] with a relief."""
        gap = self._gap(amount, length)
        rows = [
            replace(problem, gaps=problem.gaps + gap).at_loads(totals).approach
            for problem, totals in zip(self.problems, self.totals, strict=True)
        ]
        return np.concatenate(rows)

    def _gap(self, amount: float, length: float) -> FloatArray:
        """What a relief alone adds to the gaps (p, 1, n) [m]."""
        places = self.problems[0].places
        gap = np.zeros(places.path.shape)
        alone = FlankModification(
            tip_relief=amount, tip_relief_length=length, tip_relief_shape=self.shape
        )
        for name, flank in zip(("pinion", "wheel"), flank_ranges(self.pair), strict=True):
            if name in _named(self.gears):
                gear = _shaped(getattr(self.pair, name), alone)
                radius = getattr(places, f"{name}_curvature_radius")
                gap = gap + profile_gap(gear, radius, flank, length)
        return gap[:, None, :]


def optimize_tip_relief(
    pair: SpurPair,
    torque: ArrayLike,
    *,
    amount: tuple[float, float] | None = None,
    length: tuple[float, float] | None = None,
    gears: str = "both",
    shape: str = "linear",
    objective: str = "largest",
    weight: ArrayLike | None = None,
    provider: str = "fe2d",
    phases: int = 64,
    grid: tuple[int, int] = (17, 11),
    extended_contact: bool = True,
    reference: str | None = None,
    material: Material | None = None,
    slices: int | None = None,
    options: Mapping[str, Any] = NO_OPTIONS,
) -> TipReliefOptimum:
    """Find the tip relief that leaves least transmission error over a range of torques.

    Parameters
    ----------
    pair : SpurPair
        Both gears in their working position. Everything else that their flanks have is kept; a
        tip relief of the gears that are searched is replaced.
    torque : float or array (t,) [N*m]
        Torques on the pinion; two of them are the ends of a range, in which three more are taken.
    amount : tuple of float, optional
        Least and greatest material taken away at the tip [m]; by default from zero to twice the
        mean deflection under the greatest torque.
    length : tuple of float, optional
        Least and greatest roll length of the relief [m]; by default from a fifth to one and a
        quarter of the length over which more than the least number of pairs is in contact.
    gears : str
        ``"both"`` (with the same relief), ``"pinion"`` or ``"wheel"``.
    shape : str
        ``"linear"`` or ``"parabolic"``.
    objective : str
        ``"largest"`` or ``"mean"`` peak-to-peak transmission error over the torques.
    weight : array (t,), optional
        Weights of the torques in the mean, in the order of ``torque``; even by default.
    provider : str
        Where the tooth compliances come from.
    phases : int
        Evenly spaced phases of a mesh cycle.
    grid : tuple of int
        Amounts and lengths of the map with which the search begins.
    extended_contact : bool
        Let tip corners touch before A and after E.
    reference : str, optional
        ``"bore"`` or ``"rim"``; by default that of the provider.
    material : Material, optional
        Material of both gears; steel by default.
    slices : int, optional
        Slices of the face width; by default one, or 21 where flanks vary over the width.
    options : mapping
        Further options of the provider.

    Returns
    -------
    TipReliefOptimum
        Never worse than any point of its map.

    Raises
    ------
    InputError
        If a value is out of range, or a relief longer than the flank.
    ComputationError
        If a load is beyond what the formula of the local compression covers.

    Notes
    -----
    The objective has kinks and several minima: it is mapped on a grid, and from the best points
    of the map a simplex goes on within the bounds (Nelder and Mead, Comput. J. 7, 308-313, 1965).
    Nothing is drawn by chance. Compliances are found once; only the gaps change.

    Examples
    --------
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...     normal_pressure_angle=0.3490658504, pinion_face_width=0.02,
    ...     pinion_bore_diameter=0.03, wheel_bore_diameter=0.03)
    >>> best = optimize_tip_relief(pair, (60.0, 120.0), provider="analytic", phases=16)
    >>> bool(best.objective < 0.6 * best.objective_before)
    True
    """
    torques, weights = _torques(torque, weight)
    named_problems(gears, shape, objective, grid)
    plain = with_tip_relief(pair, 0.0, 0.0, gears=gears)
    mesh = _mesh(plain, gears, shape, torques, {
        "provider": provider, "phase": phases_of(phases, mesh_period(pair)),
        "extended_contact": extended_contact, "material": material or Material(),
        "options": _options(provider, options, reference), "slices": slices,
    })  # fmt: skip
    without = mesh.error(0.0, 1.0)
    low, high = relief_bounds(pair, amount, length, float(without[-1].mean()))

    def value(place: Sequence[float] | FloatArray) -> float:
        peak = np.ptp(mesh.error(float(place[0]), float(place[1])), axis=1)
        return float(peak.max() if objective == "largest" else weights @ peak)

    amounts, lengths = (np.linspace(low[k], high[k], grid[k]) for k in (0, 1))
    mapped = np.array([[value((a, b)) for b in lengths] for a in amounts])
    best, least = _search(value, (amounts, lengths), mapped)
    given = pair.pinion.modification, pair.wheel.modification
    bare = plain.pinion.modification, plain.wheel.modification
    before = without if given == bare else _mesh_error(pair, mesh, provider)
    after = mesh.error(*best)
    ...
