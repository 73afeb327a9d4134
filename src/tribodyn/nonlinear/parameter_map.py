"""Maps over two parameters: period, rms and contact loss of a batch of motions."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tribodyn.dynamics._engine.blocks import Backend, marching_on
from tribodyn.dynamics.equations.step_limit import LIMIT, rate_on_grid
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.time.simulate import read_start
from tribodyn.errors import InputError, require_positive
from tribodyn.nonlinear.survey import (
    Outcomes,
    Points,
    Survey,
    Surveyed,
    comes_back,
    march_points,
    signal_name,
)
from tribodyn.progress import SILENT, Progress
from tribodyn.record import Parts, fact, quantity, record
from tribodyn.types import Array, Index, Mask

#: Factors of the system that a lane can have of its own.
SCALES = (
    "stiffness_scale",
    "damping_scale",
    "friction_scale",
    "error_scale",
    "gap_scale",
    "force_scale",
)
#: ``omega_max * dt`` of the steps that are chosen, and the fewest steps per mesh cycle.
_NUMBER, _FEWEST = 0.5, 64
#: Steps of the grid on which the fastest motion is searched.
_LOOK = 64
#: Certified distance to the motion that repeats, relative to the state, and lanes of one block.
_NEAR, _WIDTH = 1e-5, 64


@dataclass(frozen=True)
class _Axes:
    """The two parameters and where they act."""

    names: tuple[str, str]
    first: Array
    second: Array


def parameter_map(
    system: System | Callable[[float], System],
    *,
    over: tuple[tuple[str, ArrayLike], tuple[str, ArrayLike]],
    mesh_frequency: float | None = None,
    units: tuple[str, str] | None = None,
    start: tuple[ArrayLike, ArrayLike] | None = None,
    transient: int = 300,
    cycles: int = 24,
    steps: int | None = None,
    signal: int | str = 0,
    verdict: bool = True,
    keep_partial: bool = False,
    progress: Progress = SILENT,
    backend: Backend | None = None,
) -> ParameterMap:
    """Map period, rms and contact loss over two parameters.

    Parameters
    ----------
    system : System or function
        The structure and its contacts. A function takes the value of the first parameter and
        returns the system; only then the first name may be any.
    over : two pairs of str and (k,) array
        Names and values of the two parameters: ``"mesh_frequency"`` [Hz], or one of
        ``"stiffness_scale"``, ``"damping_scale"``, ``"friction_scale"``, ``"error_scale"``,
        ``"gap_scale"`` and ``"force_scale"``, factors of the contacts and of the external force
        [-].
    mesh_frequency : float, optional
        Mesh frequency [Hz], if it is none of the two.
    units : two str, optional
        Units of the parameters; needed for one with a name of its own.
    start : (position, velocity), optional
        Where every motion begins [m or rad, m/s or rad/s]; the static equilibrium at mean
        stiffness by default.
    transient : int
        Mesh cycles before, fewer where the motion repeats after 1 to 8 of them.
    cycles : int
        Mesh cycles of the statistics of a motion that does not repeat by then.
    steps : int, optional
        Steps per mesh cycle; by default the power of two, at least 64, that keeps
        ``omega_max * dt`` below 0.5 at the mesh frequency and stiffness of each point.
    signal : int or str
        Number of the contact whose compression is evaluated, or name of a coordinate.
    verdict : bool
        Judge every motion by half the step.
    keep_partial : bool
        Return what is finished when interrupted (Ctrl-C), see ``finished``.
    progress : Progress
        Receives the number of finished motions; silent by default.
    backend : "cpu" or "cuda", optional
        The processor that marches, as in :func:`tribodyn.dynamics.simulate_ensemble`.

    Raises
    ------
    InputError
        If an argument is out of range or the step is too long.
    KeyboardInterrupt
        On an interruption (Ctrl-C), unless ``keep_partial``.

    Notes
    -----
    Every motion starts independently: where several exist, the map shows the one that its start
    leads to. A motion that repeats is judged without integrating it again: one period with half
    the step must come back so near that, by the rate at which disturbances die out, the motion of
    half the step lies within 0.5 % of the state. All others are integrated again, from where they
    are.

    Examples
    --------
    >>> from tribodyn.dynamics import Contact
    >>> pair = Contact([1.0], stiffness=lambda p: 1.0 + 0.2 * np.cos(2 * np.pi * p), gap=1.0)
    >>> system = System([[1.0]], [[0.1]], [[0.0]], [0.5], [pair])
    >>> over = (("mesh_frequency", [0.12, 0.14]), ("force_scale", [1.0, 1.5]))
    >>> result = parameter_map(system, over=over)
    >>> result.period.tolist(), result.verdicts()
    ([[1, 1], [1, 1]], {'physical': 4})
    """
    axes = _read_axes(system, over, mesh_frequency, units)
    if transient < 0 or cycles < 2 or (steps is not None and steps < 1):
        what = f"transient = {transient}, cycles = {cycles}, steps = {steps}"
        why = "The statistics need at least two mesh cycles"
        raise InputError(what, "argument cycles", why, "Give cycles=2 or more")
    systems = [system] if isinstance(system, System) else [system(float(v)) for v in axes.first]
    name = signal_name(systems[0], signal)
    begin = None if start is None else read_start(systems[0], start)
    shape = (axes.first.size, axes.second.size)
    points, number = _points(systems, axes, mesh_frequency, steps)
    quantity = signal if systems[0].contacts else name
    survey = map_survey(transient, cycles, quantity, keep_partial)
    progress.start("Motions", points.count * (1 + bool(verdict)))
    with marching_on(backend):
        outcomes, verdicts = surveyed(points, number, survey, begin, verdict, progress)
    progress.finish()
    return ParameterMap(
        names=axes.names,
        units=units or (_unit(axes.names[0]), _unit(axes.names[1])),
        first=axes.first,
        second=axes.second,
        period=outcomes.period.reshape(shape),
        rms=outcomes.rms.reshape(shape),
        contact_loss_share=outcomes.contact_loss_share.reshape(shape),
        steps=points.steps.reshape(shape),
        step_number=number.reshape(shape),
        verdict=verdicts.reshape(shape),
        signal=name,
        finished=outcomes.finished.reshape(shape),
    )


def map_survey(
    transient: int = 300, cycles: int = 24, signal: int | str = 0, keep_partial: bool = False
) -> Survey:
    """Settings of the time integration for the motions of a map."""
    keep = max(2, cycles)
    return Survey(transient, cycles, keep, signal, keep_partial, tolerance=_NEAR, width=_WIDTH)


def surveyed(
    points: Points,
    step_number: Array,
    survey: Survey,
    begin: object = None,
    verdict: bool = True,
    progress: Progress = SILENT,
) -> tuple[Outcomes, NDArray[np.str_]]:
    """Integrate motions from rest or from given states, and judge each of them."""
    outcomes = Outcomes(points.count, survey.keep, points.size)
    outcomes.first[:] = np.nan if begin is None else begin
    march_points(points, survey, (outcomes, None), progress=progress)
    verdicts: NDArray[np.str_] = np.full(points.count, "", dtype="<U12")
    if verdict and not survey.stop.is_set():
        verdicts = _judged(points, step_number, outcomes, survey, progress)
    return outcomes, verdicts


def _points(
    systems: list[System], axes: _Axes, mesh_frequency: float | None, steps: int | None
) -> tuple[Points, Array]:
    """All points with their steps, and ``omega_max * dt`` of each; one system, or one per row."""
    grid = np.meshgrid(axes.first, axes.second, indexing="ij")
    flat = {name: values.ravel() for name, values in zip(axes.names, grid, strict=True)}
    count = grid[0].size
    fixed = np.nan if mesh_frequency is None else mesh_frequency
    frequency = flat.pop("mesh_frequency", np.full(count, fixed))
    factors = {name: values for name, values in flat.items() if name in SCALES}
    each = [system for system in systems for _ in range(count // len(systems))]
    return stepped(each, frequency, factors, steps)


def stepped(
    systems: list[System], frequency: Array, factors: dict[str, Array], steps: int | None = None
) -> tuple[Points, Array]:
    """Motions with the steps that each of them needs, and ``omega_max * dt``."""
    number = _rates(systems, factors) / frequency
    chosen = _steps(number, steps)
    return Points(systems, frequency, chosen, factors), number / chosen


def _judged(
    points: Points, step_number: Array, outcomes: Outcomes, survey: Survey, progress: Progress
) -> NDArray[np.str_]:
    """Judge by half the step: over one period if that suffices, else by a new integration."""
    verdicts = np.full(points.count, "", dtype="<U12")
    finer = points.refined(2 * points.steps)
    same = comes_back(finer, outcomes)
    verdicts[same] = "physical"
    progress.advance(int(same.sum()))
    alive = np.all(np.isfinite(outcomes.settled), axis=1)
    verdicts[outcomes.finished & ~alive] = "undecided"
    again = Outcomes(points.count, survey.keep, points.size)
    again.first[:], again.force[:] = outcomes.settled, outcomes.force
    chosen = outcomes.finished & alive & ~same
    march_points(finer, survey, (again, chosen), progress=progress)
    for n in np.flatnonzero(again.finished):
        verdicts[n] = outcomes.verdict(int(n), step_number[n], again)
    return verdicts


def _rates(systems: list[System], factors: dict[str, Array]) -> Array:
    """Fastest motions [rad/s]; a stiffness factor above one can raise it by its root at most."""
    rates = {id(system): system for system in systems}
    fastest = {key: rate_on_grid(system, _LOOK) for key, system in rates.items()}
    rate = np.array([fastest[id(system)] for system in systems])
    for name, power in (("stiffness_scale", 0.5), ("damping_scale", 1.0)):
        if name in factors:
            rate = rate * np.maximum(factors[name], 1.0) ** power
    return rate


def _steps(number: Array, steps: int | None) -> Index:
    if steps is None:
        needed = np.maximum(number / _NUMBER, _FEWEST)
        return np.asarray(2 ** np.ceil(np.log2(needed)).astype(np.int64))
    worst = float(number.max()) / steps
    if worst > LIMIT:
        what = f"omega_max*dt = {worst:.3f} with {steps} steps per mesh cycle"
        why = f"The limit is {LIMIT}; beyond it the result is not physics"
        remedy = f"Use at least {math.ceil(float(number.max()) / LIMIT)}, or leave it out"
        raise InputError(what, "argument steps", why, remedy)
    return np.full(number.shape, int(steps))


def _read_axes(
    system: System | Callable[[float], System],
    over: tuple[tuple[str, ArrayLike], tuple[str, ArrayLike]],
    mesh_frequency: float | None,
    units: tuple[str, str] | None,
) -> _Axes:
    try:
        (first_name, first), (second_name, second) = over
        values = [np.atleast_1d(np.asarray(each, dtype=float)) for each in (first, second)]
    except (TypeError, ValueError) as error:
        remedy = 'Write over=(("mesh_frequency", values), ("force_scale", values))'
        raise InputError(
            f"over = {over!r}", where="argument over", why="Two names with values", remedy=remedy
        ) from error
    names = ("mesh_frequency", *SCALES)
    is_function = not isinstance(system, System)
    if (
        second_name not in names
        or (first_name not in names and not is_function)
        or first_name == second_name
    ):
        why = f"Two different ones of {', '.join(names)}"
        remedy = "A system that depends on another value is given as a function of the first one"
        raise InputError(
            f"over {first_name} and {second_name}", where="argument over", why=why, remedy=remedy
        )
    if is_function and first_name in names:
        what = f"{first_name} with a function"
        remedy = "Give a system and a name, or a function alone"
        raise InputError(what, "argument over", "The function takes that value", remedy)
    if is_function and units is None:
        what, why = f"{first_name} without its unit", "Axes show values with their units"
        raise InputError(what, "argument units", why, "Give one unit for each parameter")
    if any(each.ndim != 1 or not np.all(np.isfinite(each)) for each in values):
        what, why = "values that are no list of numbers", "Each axis of the map has its values"
        raise InputError(what, "argument over", why, "Give (name, values) for each of the two axes")
    if "mesh_frequency" in (first_name, second_name):
        require_positive(
            "mesh_frequency", values[(first_name, second_name).index("mesh_frequency")], "Hz"
        )
    elif mesh_frequency is None:
        why = "The time of one mesh cycle follows from it"
        remedy = "Give mesh_frequency in Hz, or return it with the system"
        raise InputError("no mesh frequency", "argument mesh_frequency", why, remedy)
    else:
        require_positive("mesh_frequency", mesh_frequency, "Hz")
    return _Axes((first_name, second_name), values[0], values[1])


def _unit(name: str) -> str:
    return "Hz" if name == "mesh_frequency" else "-"


@record
class ParameterMap(Surveyed):
    """Motions over two parameters; every array is (nx, ny) unless said otherwise.

    Parameters
    ----------
    names, units : tuple of two str
        Parameters and their units.
    first, second : (nx,), (ny,) array
        Their values [Hz or -, or as ``units`` says].
    period : int array
        Mesh cycles after which the motion repeats; 0 if it does not.
    rms : array
        Alternating rms of the signal [m or rad]; NaN for a motion that grew beyond all bounds.
    contact_loss_share : array
        Part of the time off the driving flank [-].
    steps : int array
        Steps per mesh cycle.
    step_number : array
        ``omega_max * dt`` [-].
    verdict : str array
        ``"physical"``, ``"step-limited"``, ``"undecided"``; empty if not requested.
    signal : str
        Name of what rms and contact loss are of, a contact or a coordinate.
    finished : bool array
        Which motions are there; all of them unless the work was interrupted.
    """

    names: tuple[str, str]
    units: tuple[str, str]
    first: Array = quantity("first", axis=True)
    second: Array = quantity("second", axis=True)
    period: Index = quantity("first", "second", unit="1")
    rms: Array = quantity("first", "second", unit="m or rad")
    contact_loss_share: Array = quantity("first", "second", unit="1")
    steps: Index = quantity("first", "second", unit="1")
    step_number: Array = quantity("first", "second", unit="1")
    verdict: NDArray[np.str_] = quantity("first", "second")
    signal: str = fact()
    finished: Mask = quantity("first", "second")

    def __repr__(self) -> str:
        """One line."""
        return (
            f"ParameterMap({self.first.size} values of {self.names[0]} x {self.second.size} of "
            f"{self.names[1]}{self._ending()})"
        )

    def _parts(self) -> Parts:
        return super()._parts().over(self.names, self.units)
