"""Maps over two parameters: period, rms and contact loss of many motions side by side."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics.equations.program import compile_system
from tribodyn.dynamics.equations.step_limit import LIMIT, largest_rate
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.time.simulate import read_start
from tribodyn.errors import InputError, Problem, require_positive
from tribodyn.nonlinear.bifurcation import signal_name
from tribodyn.nonlinear.parameter_map_march import Field, Plan, march_field
from tribodyn.nonlinear.parameter_map_result import ParameterMap
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
    rows = [slice(None)] if len(systems) == 1 else [slice(i, i + 1) for i in range(shape[0])]
    for each, row in zip(systems, rows, strict=True):
        number[row] = _rates(each, known, row, shape) / frequency[row]
    chosen = _steps(number, steps)
    number = number / chosen
    field = Field(shape, frequency, known, chosen, number)
    plan = Plan(transient, cycles, signal if systems[0].contacts else name, verdict, keep_partial)
    progress.start("Marching over two parameters", frequency.size * (1 + bool(verdict)))
    march_field(field, list(zip(systems, rows, strict=True)), begin, plan, progress)
    progress.finish()
    return ParameterMap(
        names=axes.names,
        units=units or (_unit(axes.names[0]), _unit(axes.names[1])),
        first=axes.first,
        second=axes.second,
        period=field.period,
        rms=field.rms,
        contact_loss_share=field.contact_loss_share,
        steps=chosen,
        step_number=number,
        verdict=field.verdict,
        signal=name,
        finished=field.finished,
    )


def _rates(
    system: System, known: dict[str, Array], row: slice, shape: tuple[int, int]
) -> Array | float:
    """Fastest motion [rad/s]; a stiffness factor above one can raise it by its root at most."""
    _, nodes, _ = compile_system(system, _LOOK)
    rate = largest_rate(system, nodes)
    factor = np.ones(shape)
    for name, power in (("stiffness_scale", 0.5), ("damping_scale", 1.0)):
        if name in known:
            factor = factor * np.maximum(known[name], 1.0) ** power
    return np.asarray(rate * factor[row])


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
