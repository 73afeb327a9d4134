"""Amount and length of the tip relief that leave least transmission error over a torque range."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.gear import Material, SpurPair
from tribodyn.stiffness.loaded.gaps import mesh_period, slice_widths
from tribodyn.stiffness.loaded.prepare import NO_OPTIONS, phases_of
from tribodyn.stiffness.model import MODELS
from tribodyn.stiffness.tip_relief_bounds import (
    check_choices,
    relief_axes,
    torques_and_weights,
)
from tribodyn.stiffness.tip_relief_mesh import relief_mesh, with_tip_relief
from tribodyn.stiffness.tip_relief_result import TipReliefOptimum
from tribodyn.types import Array

#: Phases of a mesh cycle where nothing multiplies the work, and where something does.
_MOST, _LEAST = 512, 64
#: Points of the map from which the search goes on: the best one, and others that lie apart.
_STARTS = 3
#: Steps of a simplex; it ends when neither place nor value move by more than these parts.
_STEPS = 200
_PLACE, _VALUE = 1e-4, 1e-5


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
    grid: tuple[int, int] = (17, 11),
    provider: str = "fe2d",
    phases: int | None = None,
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
        Torques on the pinion; two are the ends of a range, in which three more are taken.
    amount : tuple of float, optional
        Least and greatest material taken away at the tip [m]; by default from zero to twice the
        mean deflection under the greatest torque.
    length : tuple of float, optional
        Least and greatest roll length of the relief [m]; by default from a fifth to twice the
        length on which more than the least number of pairs is in contact, up to the whole flank.
    gears : str
        ``"both"``, with the same relief, ``"pinion"`` or ``"wheel"``.
    shape : str
        ``"linear"`` or ``"parabolic"``.
    objective : str
        ``"largest"`` or ``"mean"`` peak-to-peak transmission error over the torques.
    weight : array (t,), optional
        How much each torque counts: pure numbers in their order; even by default.
    grid : tuple of int
        Amounts and lengths of the map with which the search begins.
    provider : str
        Where the tooth compliances come from.
    phases : int, optional
        Evenly spaced phases of a mesh cycle; by default 512, and fewer where slices of the face
        width or the hunting tooth period multiply the work, but 64 at least.
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
    The objective has kinks and several minima: it is mapped on a grid, and from the best points of
    the map a simplex goes on within the bounds. Nothing is left to chance. Compliances are found
    once; only the gaps change. The best relief puts its peaks between the phases: with 64 of them
    the error of FZG type A is 15 % greater than it seems there, with 512 it is 2 %. Source of the
    simplex: Nelder and Mead (1965), Comput. J. 7, 308-313.

    Examples
    --------
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...     normal_pressure_angle=0.3490658504, pinion_face_width=0.02,
    ...     pinion_bore_diameter=0.03, wheel_bore_diameter=0.03)
    >>> best = optimize_tip_relief(pair, (60.0, 120.0), provider="analytic", phases=16)
    >>> bool(best.objective < 0.7 * best.objective_before)
    True
    """
    check_choices(grid, gears=gears, shape=shape, objective=objective)
    torques, weights = torques_and_weights(torque, weight)
    settings = {
        "provider": provider, "phase": _phases(pair, phases, slices), "slices": slices,
        "extended_contact": extended_contact, "material": material or Material(),
        "options": _options(provider, reference, options),
    }  # fmt: skip
    bare = with_tip_relief(pair, 0.0, 0.0, gears=gears)
    mesh = relief_mesh(bare, gears, shape, torques, settings)
    deflection = float(mesh.error(0.0, 0.0)[-1].mean())
    axes = relief_axes(pair, amount, length, deflection, grid)
    before = relief_mesh(pair, gears, shape, torques, settings).error(0.0, 0.0)

    def measure(error: Array) -> float:
        peak = np.ptp(error, axis=1)
        return float(peak.max() if objective == "largest" else weights @ peak)

    def value(place: Array) -> float:
        return measure(mesh.error(float(place[0]), float(place[1])))

    mapped = np.array([[value(np.array([a, b])) for b in axes[1]] for a in axes[0]])
    best, least = _search(value, axes, mapped)
    return TipReliefOptimum(
        gear_pair=pair,
        modified_pair=with_tip_relief(pair, *best, gears=gears, shape=shape),
        gears=gears,
        shape=shape,
        amount=best[0],
        length=best[1],
        torque=torques,
        weight=weights,
        objective_kind=objective,
        objective=least,
        objective_before=measure(before),
        phase=mesh.problems[0].places.phase,
        transmission_error_before=before,
        transmission_error_after=mesh.error(*best),
        map_amount=axes[0],
        map_length=axes[1],
        map_objective=mapped,
    )


def _phases(pair: SpurPair, phases: int | None, slices: int | None) -> Array:
    """Mesh phases, as many as asked for or as there is time for."""
    cycles = mesh_period(pair)
    work = cycles * slice_widths(pair, slices).size
    return phases_of(max(_LEAST, _MOST // work) if phases is None else phases, cycles)


def _options(provider: str, reference: str | None, options: Mapping[str, Any]) -> dict[str, Any]:
    """Options of a provider with the reference among them, where it has one."""
    known = reference is not None and "reference" in MODELS[provider].options
    return {**options, "reference": reference} if known else dict(options)


def _search(
    value: Callable[[Array], float], axes: list[Array], mapped: Array
) -> tuple[tuple[float, float], float]:
    """Go on from the best points of the map; amount and length, and the objective there."""
    from scipy.optimize import minimize

    low = np.array([axis[0] for axis in axes])
    span = np.array([axis[-1] - axis[0] for axis in axes])
    starts = _starts(mapped)
    first = starts[0]
    best, least = np.array([axes[k][first[k]] for k in (0, 1)]), float(mapped[first])
    step = [0.5 / (axis.size - 1) for axis in axes]
    for row, column in starts:
        start = (np.array([axes[0][row], axes[1][column]]) - low) / span
        toward = np.where(start + step > 1.0, -1.0, 1.0) * step
        simplex = start + np.array([[0.0, 0.0], [toward[0], 0.0], [0.0, toward[1]]])
        found = minimize(
            lambda unit: value(low + span * unit) / mapped.max(),
            start,
            method="Nelder-Mead",
            bounds=[(0.0, 1.0), (0.0, 1.0)],
            options={
                "initial_simplex": simplex, "maxfev": _STEPS, "xatol": _PLACE, "fatol": _VALUE,
            },
        )  # fmt: skip
        place = low + span * np.clip(found.x, 0.0, 1.0)
        reached = value(place)
        if reached < least:
            best, least = place, reached
    return (float(best[0]), float(best[1])), least


def _starts(mapped: Array) -> list[tuple[int, int]]:
    """Rows and columns of the least local minima of the map, the least of all first."""
    padded = np.pad(mapped, 1, constant_values=np.inf)
    rows, columns = mapped.shape
    around = [
        padded[1 + i : 1 + i + rows, 1 + j : 1 + j + columns]
        for i in (-1, 0, 1)
        for j in (-1, 0, 1)
        if (i, j) != (0, 0)
    ]
    valleys = np.argwhere(mapped <= np.min(around, axis=0))
    order = np.argsort([mapped[row, column] for row, column in valleys], kind="stable")
    return [(int(row), int(column)) for row, column in valleys[order[:_STARTS]]]
