"""Integrate all lanes on a graphics processor, one thread per lane.

The thread runs the functions of the engine, compiled for the graphics processor, with forces and
step generated as straight-line code for the structure. Numba's simulator
(``NUMBA_ENABLE_CUDASIM=1``) runs the same functions in Python.
"""

from __future__ import annotations

import importlib.util
import warnings
from functools import lru_cache
from importlib.metadata import version
from traceback import walk_tb
from types import FunctionType

import numba
import numpy as np

from tribodyn.compiled import announce
from tribodyn.dynamics._engine import (
    contact_forces,
    crossing,
    midpoint,
    runge_kutta,
    running_statistics,
)
from tribodyn.dynamics._engine.generated.source import write_source
from tribodyn.dynamics._engine.statistics import Statistics
from tribodyn.dynamics.equations.divergence import most_splits
from tribodyn.dynamics.equations.program import Program, lay_out
from tribodyn.errors import Argument, ComputationError, InputError
from tribodyn.interrupt import STOPPED, refuse_stopped, stop_flag
from tribodyn.types import Array, Index, Tree

#: Threads of a block, which share a multiprocessor, and lanes in the memory of the processor.
_BLOCK, _LANES = 64, 1 << 16
#: Steps of one lane, and of all, between two checks for an interruption: a fraction of a second,
#: also on a processor that drives a display.
_STEPS, _ALL_STEPS = 20_000, 20_000_000


class MissingProcessorError(InputError, OSError):
    """The machine lacks a graphics processor or its software; the input is valid."""


def require_gpu() -> None:
    """Raise unless a graphics processor of NVIDIA is available."""
    where, stay = Argument("backend"), 'or leave backend = "cpu"'
    try:
        if not numba.config.ENABLE_CUDASIM and importlib.util.find_spec("numba_cuda") is None:
            raise ImportError("It compiles for NVIDIA graphics processors")
        from numba import cuda
    except ImportError as error:
        what, remedy = "numba-cuda is not installed", 'Install it: pip install "tribodyn[cuda]", '
        raise MissingProcessorError(what, where, f"{error}", remedy + stay) from None
    if not cuda.is_available():
        lines = [line.strip(" .") for line in str(cuda.cuda_error()).splitlines()]
        reason = [line for line in lines if line and not line.endswith(":")]
        what, why = "no NVIDIA graphics processor available", "; ".join(reason[:1])
        remedy = f"Install its driver, so that nvidia-smi lists the processor, {stay}"
        raise MissingProcessorError(what, where, why, remedy)


class _Kernel:
    """Compiled thread of one structure, and the sizes of its buffers."""

    def __init__(self, source: str, n: int, contacts: int, frictions: int, columns: int) -> None:
        from numba import cuda

        from tribodyn.dynamics._engine.generated import thread

        self.slots = lay_out(n, contacts, frictions).end
        parts = 1 + (most_splits(contacts) + 1) * (2 + contacts + 4 * n)
        sizes = (self.slots, 3 * columns, crossing.WIDTH * (contacts + 1), parts)
        self.ends = tuple(int(end) for end in np.cumsum(sizes))
        names: Tree = {}
        for module in (contact_forces, crossing, midpoint, running_statistics, runge_kutta, thread):
            names.update(vars(module))
        for name, value in list(names.items()):
            function = getattr(value, "py_func", None) or value
            if function is not value or getattr(value, "__module__", "") == thread.__name__:
                names[name] = FunctionType(function.__code__, names, name, function.__defaults__)
        names |= {"SLOTS": self.slots, "COLUMNS": columns, "ENDS": self.ends}
        exec(compile(source, "<straight lines of one structure>", "exec"), names)
        functions = {name: f for name, f in names.items() if getattr(f, "__globals__", 0) is names}
        self.march = cuda.jit(functions.pop("march_thread"))
        if not numba.config.ENABLE_CUDASIM:
            names |= {name: cuda.jit(device=True)(each) for name, each in functions.items()}
            announce("compiling the engine for the graphics processor, about a quarter of a minute")


_kernel = lru_cache(16)(_Kernel)


def march_on_gpu(
    programs: tuple[Program, ...],
    member: Index,
    period: Array,
    load: Array,
    state: Array,
    cycles: int,
    record: Array | None,
    statistics: Statistics | None,
) -> tuple[Array, Index]:
    """Integrate all lanes; returns their states and the code of each as from ``march_block``."""
    new, codes = np.empty_like(state), np.empty(len(state), dtype=np.int64)
    for first in range(0, len(state), _LANES):
        lanes = slice(first, first + _LANES)
        rows = 0 if record is None else record.shape[0]
        lanes_record = np.empty((rows, state.shape[1], codes[lanes].size))
        sums = None if statistics is None else np.ascontiguousarray(statistics.moments[:, lanes])
        lane_arrays = member[lanes], period[lanes], load[lanes], state[lanes]
        try:
            new[lanes], codes[lanes] = _march(
                programs, lane_arrays, cycles, lanes_record, statistics, sums
            )
        except Exception as error:
            if not any(module.startswith(("numba.cuda", "cuda")) for module in _modules(error)):
                raise
            what = f"the graphics processor failed: {str(error).strip()}"
            size = f"{len(lane_arrays[0])} lanes with a record of"
            why = f"It integrated {size} {lanes_record.nbytes / 2**20:.0f} MiB"
            remedy = 'Use fewer lanes at a time, update the driver, or set backend = "cpu"'
            if not type(error).__module__.startswith(("numba", "cuda")):
                versions = [f"{name} {version(name)}" for name in ("numba-cuda", "numba", "numpy")]
                why = f"These versions are incompatible: {', '.join(versions)}"
                remedy = 'Install compatible ones: pip install --upgrade "tribodyn[cuda]"'
            raise ComputationError(what, Argument("backend"), why, remedy) from error
        if record is not None:
            record[:, :, lanes] = lanes_record
        if statistics is not None:
            statistics.moments[:, lanes] = sums
    return new, codes


def _modules(error: Exception) -> list[str]:
    """Modules in the traceback of an error, and the module of its class."""
    frames = [frame.f_globals.get("__name__", "") for frame, _ in walk_tb(error.__traceback__)]
    return [*frames, type(error).__module__]


def _march(
    programs: tuple[Program, ...],
    lane_arrays: tuple[Array | Index, ...],
    cycles: int,
    record: Array,
    statistics: Statistics | None,
    sums: Array | None,
) -> tuple[Array, Index]:
    """Integrate lanes with the arrays ``lane_arrays``: member, period, load and state."""
    from numba import cuda

    first, lanes, double = programs[0], *lane_arrays[-1].shape
    contacts, frictions = int(first.code[1]), first.slots.end - first.slots.friction
    kernel = _kernel(write_source(first), double // 2, contacts, frictions, int(first.code[2]))
    outputs, waves = np.zeros((0, double)), np.zeros((0, 3, 0, 2))
    if statistics is not None:
        outputs, waves = statistics.outputs, statistics.waves
    harmonics = waves.shape[2]
    tables = np.stack([program.rows for program in programs])
    fixed = first.code, first.reads, tables, first.width, first.restart, *lane_arrays
    host = *fixed, outputs, waves.reshape(-1)
    *program_arrays, device_outputs, device_waves = [
        cuda.to_device(np.ascontiguousarray(part)) for part in host
    ]
    lane_slots = cuda.device_array((kernel.slots, lanes))
    scratch = cuda.device_array((lanes, kernel.ends[-1] + 6 * harmonics))
    device_moments = cuda.to_device(np.zeros((0, lanes)) if sums is None else sums)
    ended = cuda.to_device(np.full(lanes, -1, dtype=np.int64))
    steps = first.width.size
    most = max(1, min(_STEPS // steps, _ALL_STEPS // (steps * lanes)))
    threads = min(_BLOCK, lanes)
    for done in range(0, cycles, most):
        count = min(most, cycles - done)
        rows = slice(done * steps, (done + count) * steps + 1) if len(record) else slice(0, 0)
        states = cuda.device_array((rows.stop - rows.start, double, lanes))
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", ".*Grid size")  # few lanes are no fault of the caller
            kernel.march[-(-lanes // threads), threads](
                *program_arrays, count, done * steps, lane_slots, scratch, states,
                device_outputs, device_waves, harmonics, device_moments, 1.0 / cycles, ended,
            )  # fmt: skip
        cuda.synchronize()
        states.copy_to_host(record[rows])
        if stop_flag()[0] != 0:
            refuse_stopped(STOPPED)
    if sums is not None:
        device_moments.copy_to_host(sums)
    return lane_slots[:double].copy_to_host().T, ended.copy_to_host()
