"""Motion over time from a given start, with the engine of one's choice."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics._engine.adaptive_engine import adaptive_engine
from tribodyn.dynamics._engine.blocks import Compiled, compile_for, march
from tribodyn.dynamics._engine.tolerance import Tolerance
from tribodyn.dynamics.equations.program import compile_system
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.time.newmark import compile_newmark, march_newmark, newmark_law
from tribodyn.dynamics.time.response import Response, build_response
from tribodyn.errors import InputError, Problem, require_positive
from tribodyn.progress import SILENT, Progress
from tribodyn.types import Array

#: Ways to march over time.
Method = Literal["rk4", "dormand-prince", "newmark"]

#: Marches a state by some mesh cycles, after others, records it, and returns the new one.
_March = Callable[[Array, int, Array, int], Array]

#: Mesh cycles marched between two reports of progress.
_CHUNK = 64


def read_start(system: System, start: tuple[ArrayLike, ArrayLike]) -> Array:
    """Check a start and return it as one state."""
    try:
        parts = [np.broadcast_to(np.asarray(part, dtype=float), (system.size,)) for part in start]
        state = np.concatenate(parts)
    except (TypeError, ValueError) as error:
        raise InputError(
            Problem(
                what="start is not a pair (position, velocity)",
                where="argument start",
                why=f"Each of the two has the shape ({system.size},)",
            )
        ) from error
    if state.size != 2 * system.size or not np.all(np.isfinite(state)):
        raise InputError(
            Problem(
                what="start holds NaN or infinity, or is not a pair (position, velocity)",
                where="argument start",
                why=f"Each of the two has the shape ({system.size},)",
            )
        )
    return state


def require_cycles(cycles: int) -> None:
    """Raise :class:`InputError` unless ``cycles`` is a whole number of at least one."""
    if int(cycles) != cycles or cycles < 1:
        raise InputError(
            Problem(what=f"cycles = {cycles}", where="argument cycles", why="A whole number >= 1")
        )


def simulate(
    system: System,
    mesh_frequency: float,
    cycles: int,
    start: tuple[ArrayLike, ArrayLike],
    *,
    steps: int = 512,
    extra_force: ArrayLike | None = None,
    progress: Progress = SILENT,
    method: Method = "rk4",
    rtol: float | None = None,
    atol: Tolerance | None = None,
    gamma: float | None = None,
    beta: float | None = None,
    preset: str | None = None,
) -> Response:
    """March a system over time, every force held as given.

    Parameters
    ----------
    system : System
    mesh_frequency : float
        Mesh frequency [Hz].
    cycles : int
        Whole mesh cycles.
    start : (position, velocity)
        Two (n,) arrays [m or rad, m/s or rad/s].
    steps : int
        Steps per mesh cycle; with "dormand-prince" rows of the response per mesh cycle.
    extra_force : (n,) array, optional
        Constant generalized force on top of the system's [N or N*m].
    progress : Progress
        Told about every 64 cycles.
    method : "rk4", "dormand-prince" or "newmark"
        Classical Runge-Kutta steps; adaptive steps of Dormand and Prince; Newmark's scheme.
    rtol : float, optional
        Of "dormand-prince": error over the largest size so far of each state, 1e-6 by default [-].
    atol : float, (position, velocity) or (2 n,) array, optional
        Of "dormand-prince": error allowed on top of that [m or rad, m/s or rad/s]; by default
        0.001 ``rtol`` times the size of the static state.
    gamma, beta : float, optional
        Of "newmark": its parameters, 1/2 and 1/4 (average acceleration) by default [-].
    preset : str, optional
        Of "newmark": "average acceleration", "linear acceleration", "central difference" or "seed"
        (1/2, 1/2) instead of the two numbers.

    Returns
    -------
    Response
        With ``cycles * steps`` rows.

    Raises
    ------
    InputError
        If an argument is out of range or belongs to another method, or the step is too long.
    ComputationError
        If the motion grows beyond all bounds.

    Notes
    -----
    All methods keep to the event-aligned grid: events are ends of steps, and a step in which a
    contact opens or closes is split there. The rows of "dormand-prince" are its dense output; means
    and harmonics of the response are as good as ``steps`` resolves the motion.

    Examples
    --------
    >>> free = System([[1.0]], [[0.0]], [[4.0]], [0.0])
    >>> motion = simulate(free, 1.0, 1, ([1.0], [0.0]), steps=256)
    >>> bool(abs(motion.position[128, 0] - np.cos(1.0)) < 1e-9)
    True
    """
    require_cycles(cycles)
    require_positive("mesh_frequency", mesh_frequency, "Hz")
    refuse_foreign(method, rtol=rtol, atol=atol, gamma=gamma, beta=beta, preset=preset)
    extra = np.zeros(system.size) if extra_force is None else np.asarray(extra_force, dtype=float)
    state = read_start(system, start)[None, :]
    period = np.array([1.0 / mesh_frequency])
    widest = [0.0]
    if method == "dormand-prince":
        compiled = _compile_samples(system, steps)
        advance, rate = _adaptive(compiled, period, cycles, extra, rtol, atol, widest)
    elif method == "newmark":
        law = newmark_law(gamma, beta, preset)
        compiled, advance = _newmark(system, mesh_frequency, steps, period, extra, law)
    else:
        compiled = compile_for(system, mesh_frequency, steps)
        advance = _runge_kutta(compiled, period, extra)
    record = np.empty((cycles * steps + 1, 2 * system.size, 1))
    progress.start("Marching over time", cycles)
    for first in range(0, cycles, _CHUNK):
        count = min(_CHUNK, cycles - first)
        part = record[first * steps : (first + count) * steps + 1]
        state = advance(state, count, part, first)
        progress.advance(count)
    progress.finish()
    if method == "dormand-prince":
        compiled = replace(compiled, step_number=rate * widest[0] / mesh_frequency)
    return build_response(compiled, mesh_frequency, record[:, :, 0], extra)


#: The method that each option belongs to.
_OWNERS = {
    "rtol": "dormand-prince",
    "atol": "dormand-prince",
    "gamma": "newmark",
    "beta": "newmark",
    "preset": "newmark",
}


def refuse_foreign(method: str, **options: object) -> None:
    """Refuse options of an engine that is not the one asked for."""
    methods = get_args(Method)
    if method not in methods:
        raise InputError(
            Problem(
                what=f'method = "{method}"',
                where="argument method",
                why="It is one of " + ", ".join(f'"{name}"' for name in methods),
            )
        )
    for name, value in options.items():
        if value is not None and _OWNERS[name] != method:
            raise InputError(
                Problem(
                    what=f'{name} = {value} with method = "{method}"',
                    where=f"argument {name}",
                    why=f'It belongs to "{_OWNERS[name]}"',
                    remedy=f'Leave it out, or give method = "{_OWNERS[name]}"',
                )
            )


def _runge_kutta(compiled: Compiled, period: Array, extra: Array) -> _March:
    def advance(state: Array, count: int, part: Array, elapsed: int) -> Array:
        return march(
            compiled, period, state, count, extra_force=extra[None, :], record=part,
            elapsed=elapsed,
        )  # fmt: skip

    return advance


def _compile_samples(system: System, steps: int) -> Compiled:
    """Compile a system on a grid that only has to resolve the response, not to march it."""
    if int(steps) != steps or steps < 1:
        raise InputError(
            Problem(what=f"steps = {steps}", where="argument steps", why="A whole number >= 1")
        )
    return Compiled(system, *compile_system(system, int(steps)), step_number=float("nan"))


def _adaptive(
    compiled: Compiled,
    period: Array,
    cycles: int,
    extra: Array,
    rtol: float | None,
    atol: Tolerance | None,
    widest: list[float],
) -> tuple[_March, float]:
    engine = adaptive_engine(
        compiled.system, 1.0 / period, cycles, rtol=1e-6 if rtol is None else rtol, atol=atol
    )
    memory: list[Array | None] = [None]

    def advance(state: Array, count: int, part: Array, elapsed: int) -> Array:
        run = engine.march(
            period, state, count, extra_force=extra[None, :], points=compiled.grid.left,
            record=part, memory=memory[0], elapsed=elapsed,
        )  # fmt: skip
        memory[0], widest[0] = run.memory, max(widest[0], run.widest)
        return run.state

    return advance, engine.rate


def _newmark(
    system: System,
    mesh_frequency: float,
    steps: int,
    period: Array,
    extra: Array,
    law: tuple[float, float],
) -> tuple[Compiled, _March]:
    gamma, beta = law
    compiled = compile_newmark(system, mesh_frequency, steps, gamma=gamma, beta=beta)

    def advance(state: Array, count: int, part: Array, elapsed: int) -> Array:
        return march_newmark(
            compiled, period, state, count, gamma=gamma, beta=beta, elapsed=elapsed,
            extra_force=extra[None, :], record=part,
        )  # fmt: skip

    return compiled, advance
