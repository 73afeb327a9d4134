"""The crowning and the slope over the face that spread the load most evenly over torques."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.contact import path_of_contact
from tribodyn.contact.face_contacts import SLICES, face_positions
from tribodyn.errors import Argument, InputError, quiet, require_one_of
from tribodyn.gear import FlankModification, Material, SpurPair
from tribodyn.gear.modification import LARGEST_AMOUNT
from tribodyn.model import NO_OPTIONS
from tribodyn.progress import SILENT, Progress
from tribodyn.record import Labels, Record, fact, figure_method, quantity, record
from tribodyn.stiffness.loaded.contact import contact_problem, contact_settings
from tribodyn.stiffness.loaded.problem import ContactProblem
from tribodyn.stiffness.model import MODELS
from tribodyn.stiffness.tip_relief.search import torques_and_weights
from tribodyn.types import Array, ByName

#: Mesh phases of a search.
_PHASES = 8
#: Steps of the search over the ranges at which it ends.
_ENOUGH = 1e-3


@record
class LeadOptimum(Record):
    """Crowning and slope over the face; made by :func:`tribodyn.stiffness.optimize_lead`.

    Parameters
    ----------
    gear_pair, modified_pair : SpurPair
        As it was given, and with the modification that was found.
    gear : str
        Which gear is modified.
    crowning, lead_slope : float [m]
        The modification that was found.
    torque : array (t,) [N*m]
        Torques on the pinion.
    misalignment : array (t,) [m]
        Misalignment under each torque, besides that of the pair.
    objective_kind : str
        ``"largest"`` or ``"mean"`` face load factor over the torques.
    face_position : array (s,) [m]
        Middles of the slices.
    face_load_before, face_load_after : array (t, s)
        Load of each slice over the mesh cycle, over the mean of all: pure numbers.
    """

    DERIVED: ClassVar[Mapping[str, Labels]] = {
        "face_load_factor_before": Labels(("torque",), "1"),
        "face_load_factor_after": Labels(("torque",), "1"),
    }

    gear_pair: SpurPair
    modified_pair: SpurPair
    gear: str = fact()
    crowning: float = fact("best_crowning")
    lead_slope: float = fact("best_lead_slope")
    torque: Array = quantity("torque", unit="N*m", axis=True)
    misalignment: Array = quantity("torque")
    objective_kind: str = fact()
    face_position: Array = quantity("slice", axis=True)
    face_load_before: Array = quantity("torque", "slice", unit="1")
    face_load_after: Array = quantity("torque", "slice", unit="1")

    @property
    def face_load_factor_before(self) -> Array:
        """Greatest over mean load of a slice for the pair as it was given (t,)."""
        return np.asarray(self.face_load_before.max(axis=1))

    @property
    def face_load_factor_after(self) -> Array:
        """Greatest over mean load of a slice with the modification that was found (t,)."""
        return np.asarray(self.face_load_after.max(axis=1))

    plot_face_load = figure_method(
        "lead_optimum", "Draw the load over the face before and after the modification."
    )

    def __repr__(self) -> str:
        """One line with the figures that matter."""
        before, after = self.face_load_factor_before.max(), self.face_load_factor_after.max()
        return (
            f"LeadOptimum({self.gear}: crowning {self.crowning * 1e6:.4g} um, lead slope "
            f"{self.lead_slope * 1e6:.4g} um, greatest face load factor {before:.4g} -> "
            f"{after:.4g} from {self.torque[0]:g} to {self.torque[-1]:g} N*m)"
        )


def optimize_lead(
    pair: SpurPair,
    torque: ArrayLike,
    *,
    gear: str = "pinion",
    crowning: tuple[float, float] = (0.0, 30e-6),
    lead_slope: tuple[float, float] = (-30e-6, 30e-6),
    misalignment: ArrayLike = 0.0,
    objective: str = "largest",
    weight: ArrayLike | None = None,
    provider: str = "fe3d",
    phases: int = _PHASES,
    reference: str | None = None,
    material: Material | None = None,
    slices: int = SLICES,
    options: ByName = NO_OPTIONS,
    progress: Progress = SILENT,
) -> LeadOptimum:
    """Find the crowning and the slope that spread the load most evenly over torques.

    Parameters
    ----------
    pair : SpurPair
        Both gears in their working position. Their other modifications are retained; crowning and
        lead slope of the gear that is searched are replaced.
    torque : float or array (t,) [N*m]
        Torques on the pinion; two are the ends of a range, in which three more are taken.
    gear : str
        ``"pinion"`` or ``"wheel"``.
    crowning, lead_slope : tuple of float [m]
        Least and greatest values.
    misalignment : float or array [m]
        Misalignment under each of the given torques, besides that of the pair: that of deflected
        shafts, for example; a single value belongs to the greatest torque and grows with it.
    objective : str
        ``"largest"`` or ``"mean"`` face load factor over the torques.
    weight : array (t,), optional
        How much each torque counts in the mean: pure numbers; even by default.
    provider : str
        As ``reference``, ``material`` and ``options`` for
        :func:`tribodyn.stiffness.loaded_contact`.
    phases : int
        Evenly spaced phases of the mesh cycle.
    reference, material
        As there.
    slices : int
        Slices of the face.
    options
        As there.
    progress : Progress
        Receiver of the progress: a step for every form of the face that is examined.

    Returns
    -------
    LeadOptimum

    Raises
    ------
    InputError
        If a value is out of range.
    ComputationError
        If a load is beyond what the formula of the local compression covers.

    Notes
    -----
    The best point of a grid, from which a simplex goes on within the ranges; compliances are found
    once, only the gaps change. Source of the face load factor: ISO 6336-1, K_H_beta, by its
    definition; of the simplex: Nelder and Mead (1965), Comput. J. 7, 308-313.

    Examples
    --------
    >>> from tribodyn.gear import cylindrical_pair
    >>> pair = cylindrical_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...     normal_pressure_angle=0.349, helix_angle=0.2, pinion_face_width=0.03)
    >>> best = optimize_lead(pair, 200.0, provider="iso6336", misalignment=10e-6, slices=8)
    >>> bool(abs(best.lead_slope + 10e-6) < 1e-6)
    True
    """
    require_one_of("gear", gear, ("pinion", "wheel"))
    require_one_of("objective", objective, ("largest", "mean"))
    bounds = [_range("crowning", crowning), _range("lead_slope", lead_slope)]
    torques, weights = torques_and_weights(torque, weight)
    lean = _misalignments(torques, np.atleast_1d(np.asarray(torque, float)), misalignment)
    settings = contact_settings(
        provider, np.arange(phases) / phases, False, reference, material, slices, options
    )
    plain = _with_lead(pair, gear, 0.0, 0.0)
    progress.start("compliance of the teeth")
    search, before = (_FaceLoads(each, torques, lean, settings) for each in (plain, pair))
    progress.start("crowning and slope over the face")
    along = search.face_position / getattr(pair, gear).face_width

    def loads(place: Array) -> Array:
        return search.over_face(place[0] * (2.0 * along) ** 2 + place[1] * along)

    def value(place: Array) -> float:
        factors = loads(place).max(axis=1)
        progress.advance()
        return float(factors.max() if objective == "largest" else weights @ factors)

    best = _least(value, bounds)
    progress.finish()
    return LeadOptimum(
        gear_pair=pair,
        modified_pair=_with_lead(pair, gear, *best.tolist()),
        gear=gear,
        crowning=float(best[0]),
        lead_slope=float(best[1]),
        torque=torques,
        misalignment=lean,
        objective_kind=objective,
        face_position=search.face_position,
        face_load_before=before.over_face(np.zeros(1)),
        face_load_after=loads(best),
    )


def _least(value: Callable[[Array], float], bounds: list[tuple[float, float]]) -> Array:
    """Least point within bounds: the best of a grid, from which a simplex goes on."""
    from scipy.optimize import minimize

    low = np.array([bound[0] for bound in bounds])
    span = np.array([bound[1] - bound[0] for bound in bounds])
    grid = [np.array([a, b]) for a in (0.0, 0.3, 0.6) for b in np.linspace(0.0, 1.0, 7)]
    start = min(grid, key=lambda place: value(place * span + low))
    steps = np.array([[0.0, 0.0], [0.2, 0.0], [0.0, -0.1]])
    optimum = minimize(
        lambda place: value(place * span + low), start, method="Nelder-Mead",
        bounds=[(0.0, 1.0)] * 2,
        options={
            "initial_simplex": np.clip(start + steps, 0.0, 1.0),
            "xatol": _ENOUGH, "fatol": 1e-5, "maxfev": 200,
        },
    )  # fmt: skip
    return np.asarray(optimum.x * span + low)


class _FaceLoads:
    """Loads of the slices of a pair under torques, for gaps that are added over the face."""

    def __init__(
        self, pair: SpurPair, torques: Array, lean: Array, settings: dict[str, Any]
    ) -> None:
        totals = torques / pair.pinion.base_radius
        # One problem for each torque: each has its own misalignment.
        self.totals, self.lean, self.width = totals, lean, pair.common_face_width
        forces = totals[:1] if MODELS[settings["provider"]].influence else totals
        problems = [contact_problem(pair, total_force=f, **settings) for f in forces]
        # Influences of teeth are the same under every torque.
        self.problems = problems if len(problems) > 1 else problems * len(totals)
        count = settings["slices"]
        self.face_position = face_positions(path_of_contact(pair), count)

    def over_face(self, gap: Array) -> Array:
        """Load of each slice over the mean (t, s) with a gap over the face (s,) added [m]."""
        rows = []
        for problem, total, lean in zip(self.problems, self.totals, self.lean, strict=True):
            added = gap + lean * self.face_position / self.width
            rows.append(_slice_loads(problem, float(total), added))
        return np.stack(rows)


def _slice_loads(problem: ContactProblem, total: float, added: Array) -> Array:
    """Load of each slice over the mean of all (s,), with a gap over the face added."""
    sliced = problem.places.is_sliced
    gap = np.tile(added, problem.gaps.shape[2] // added.size)[None] if sliced else added[:, None]
    moved = replace(problem, gaps=problem.gaps + gap)
    return moved.face_load(moved.at_loads(np.array([total])).load[0])


def _with_lead(pair: SpurPair, gear: str, crowning: float, slope: float) -> SpurPair:
    old = getattr(pair, gear)
    shape: FlankModification = replace(old.modification, crowning=crowning, lead_slope=slope)
    with quiet():
        return replace(pair, **{gear: replace(old, modification=shape)})


def _range(name: str, limits: tuple[float, float]) -> tuple[float, float]:
    low, high = limits
    if -LARGEST_AMOUNT <= low < high <= LARGEST_AMOUNT:
        return low, high
    text = " to ".join(f"{value * 1e6:.6g}" for value in limits)
    why = f"Values increase, within -{LARGEST_AMOUNT * 1e6:g} to {LARGEST_AMOUNT * 1e6:g} um"
    raise InputError(f"{name} = {text} um", Argument(name), why, "Check values and unit")


def _misalignments(torques: Array, listed: Array, misalignment: ArrayLike) -> Array:
    """Misalignment under every torque: a single one grows with the torque."""
    lean = np.asarray(misalignment, dtype=float)
    if lean.ndim == 0:
        return np.asarray(float(lean) * torques / torques.max())
    if lean.shape != listed.shape:
        what, why = f"{lean.size} misalignments", f"There are {listed.size} torques"
        raise InputError(what, Argument("misalignment"), why, "Give one for each, or a single one")
    order = np.argsort(listed)
    return np.asarray(np.interp(torques, listed[order], lean[order]))
