"""Maps over two parameters: period, rms and contact loss of many motions side by side."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics.program import compile_system
from tribodyn.dynamics.simulate import read_start
from tribodyn.dynamics.step_limit import LIMIT, largest_rate
from tribodyn.dynamics.system import System
from tribodyn.errors import InputError, Problem, require_positive
from tribodyn.nonlinear.parameter_map_result import ParameterMap
from tribodyn.nonlinear.survey import (
    Outcomes,
    Points,
    Survey,
    comes_back,
    march_points,
    signal_name,
    step_verdict,
)
from tribodyn.progress import SILENT, Progress
from tribodyn.types import Array, Index

#: Factors of the system that a lane can have of its own.
SCALES = (
    "stiffness_scale", "damping_scale", "friction_scale", "error_scale", "gap_scale",
    "force_scale",
)  # fmt: skip
#: ``omega_max * dt`` of the steps that are chosen, and the fewest steps per mesh cycle.
_NUMBER, _FEWEST = 0.5, 64
#: Steps of the grid on which the fastest motion is looked for.
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
        Contact whose compression is looked at, or name of a coordinate.
    verdict : bool
        Judge every motion by half the step.
    keep_partial : bool
        Return what is finished when interrupted (Ctrl-C), see ``finished``.
    progress : Progress
        Told about the motions.

    Returns
    -------
    ParameterMap

    Raises
    ------
    InputError
        If an argument is out of range or the step is too long.
    KeyboardInterrupt
        As it came, unless ``keep_partial``.

    Notes
    -----
    Every motion starts by itself: where several exist, the map shows the one that the start comes
    to. A motion that repeats is judged without marching it anew: one period with half the step
    must come back so near that, by the rate at which disturbances die out, the motion of half the
    step lies within 0.5 % of the state. All others are marched again, from where they are.

    Examples
    --------
    >>> from tribodyn.dynamics import Contact
    >>> pair = Contact([1.0], stiffness=lambda p: 1.0 + 0.2 * np.cos(2 * np.pi * p), gap=1.0)
    >>> system = System([[1.0]], [[0.1]], [[0.0]], [0.5], [pair])
    >>> over = (("mesh_frequency", [0.12, 0.14]), ("force_scale", [1.0, 1.5]))
    >>> found = parameter_map(system, over=over)
    >>> found.period.tolist(), found.verdicts()
    ([[1, 1], [1, 1]], {'physical': 4})
    """
    axes = _read_axes(system, over, mesh_frequency, units)
    if transient < 0 or cycles < 2 or (steps is not None and steps < 1):
        what = f"transient = {transient}, cycles = {cycles}, steps = {steps}"
        raise InputError(Problem(what, "argument cycles", "At least two mesh cycles are looked at"))
    systems = [system] if isinstance(system, System) else [system(float(v)) for v in axes.first]
    name = signal_name(systems[0], signal)
    begin = None if start is None else read_start(systems[0], start)
    shape = (axes.first.size, axes.second.size)
    grid = np.meshgrid(axes.first, axes.second, indexing="ij")
    known = {n: g for n, g in zip(axes.names, grid, strict=True) if n in SCALES}
    if "mesh_frequency" in axes.names:
        frequency = grid[axes.names.index("mesh_frequency")]
    else:
        frequency = np.full(shape, mesh_frequency, dtype=float)
    number = np.zeros(shape)
    each = [systems[0]] * frequency.size
    if len(systems) > 1 or not isinstance(system, System):
        each = [item for item in systems for _ in range(shape[1])]
    flat = {key: values.ravel() for key, values in known.items()}
    number = _rates(each, flat) / frequency.ravel()
    chosen = _steps(number, steps)
    points = Points(each, frequency.ravel(), chosen, flat)
    kept = signal if systems[0].contacts else name
    survey = Survey(
        transient, cycles, max(2, cycles), kept, keep_partial, tolerance=_NEAR, width=_WIDTH
    )
    progress.start("Marching over two parameters", frequency.size * (1 + bool(verdict)))
    outcomes = Outcomes(points.count, survey.keep, points.size)
    outcomes.first[:] = np.nan if begin is None else begin
    march_points(points, survey, outcomes, None, progress)
    words = np.full(points.count, "", dtype="<U12")
    if verdict and not survey.stop.is_set():
        words = _judged(points, number / chosen, outcomes, survey, progress)
    progress.finish()
    return ParameterMap(
        names=axes.names,
        units=units or (_unit(axes.names[0]), _unit(axes.names[1])),
        first=axes.first,
        second=axes.second,
        period=outcomes.period.reshape(shape),
        rms=outcomes.rms.reshape(shape),
        contact_loss_share=outcomes.contact_loss_share.reshape(shape),
        steps=chosen.reshape(shape),
        step_number=(number / chosen).reshape(shape),
        verdict=words.reshape(shape),
        signal=name,
        finished=outcomes.finished.reshape(shape),
    )


def _judged(
    points: Points, step_number: Array, outcomes: Outcomes, survey: Survey, progress: Progress
) -> Array:
    """Judge by half the step: by one period where that is enough, else by marching anew."""
    words = np.full(points.count, "", dtype="<U12")
    finer = points.refined(2 * points.steps)
    same = comes_back(finer, outcomes)
    words[same] = "physical"
    progress.advance(int(same.sum()))
    alive = np.all(np.isfinite(outcomes.settled), axis=1)
    words[outcomes.finished & ~alive] = "undecided"
    again = Outcomes(points.count, survey.keep, points.size)
    again.first[:], again.force[:] = outcomes.settled, outcomes.force
    march_points(finer, survey, again, outcomes.finished & alive & ~same, progress)
    for n in np.flatnonzero(again.finished):
        words[n] = step_verdict(
            float(step_number[n]), int(outcomes.period[n]), float(outcomes.rms[n]),
            int(again.period[n]), float(again.rms[n]),
        )  # fmt: skip
    return words


def _rates(systems: list[System], factors: dict[str, Array]) -> Array:
    """Fastest motions [rad/s]; a stiffness factor above one can raise it by its root at most."""
    rates = {id(system): system for system in systems}
    fastest = {
        key: largest_rate(system, compile_system(system, _LOOK)[1]) for key, system in rates.items()
    }
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
        raise InputError(
            Problem(
                what=f"omega_max*dt = {worst:.3f} with {steps} steps per mesh cycle",
                where="argument steps",
                why=f"The limit is {LIMIT}; beyond it the result is not physics",
                remedy=f"Use at least {math.ceil(float(number.max()) / LIMIT)}, or leave it out",
            )
        )
    return np.full(number.shape, int(steps))


def _read_axes(
    system: System | Callable[[float], System],
    over: tuple[tuple[str, ArrayLike], tuple[str, ArrayLike]],
    mesh_frequency: float | None,
    units: tuple[str, str] | None,
) -> _Axes:
    try:
        (one, first), (two, second) = over
        values = [np.atleast_1d(np.asarray(each, dtype=float)) for each in (first, second)]
    except (TypeError, ValueError) as error:
        remedy = 'Write over=(("mesh_frequency", values), ("force_scale", values))'
        raise InputError(Problem(f"over = {over!r}", "argument over", "", remedy)) from error
    known = ("mesh_frequency", *SCALES)
    own = not isinstance(system, System)
    if two not in known or (one not in known and not own) or one == two:
        why = f"Two different ones of {', '.join(known)}"
        remedy = "A system that depends on another value is given as a function of the first one"
        raise InputError(Problem(f"over {one} and {two}", "argument over", why, remedy))
    if own and one in known:
        raise InputError(
            Problem(f"{one} with a function", "argument over", "The function takes that value")
        )
    if own and units is None:
        raise InputError(Problem(f"{one} without its unit", "argument units"))
    if any(each.ndim != 1 or not np.all(np.isfinite(each)) for each in values):
        raise InputError(Problem("values that are no list of numbers", "argument over"))
    if "mesh_frequency" in (one, two):
        require_positive("mesh_frequency", values[(one, two).index("mesh_frequency")], "Hz")
    elif mesh_frequency is None:
        raise InputError(Problem("no mesh frequency", "argument mesh_frequency"))
    else:
        require_positive("mesh_frequency", mesh_frequency, "Hz")
    return _Axes((one, two), values[0], values[1])


def _unit(name: str) -> str:
    return "Hz" if name == "mesh_frequency" else "-"
