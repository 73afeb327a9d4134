"""Methods of fixed steps: a method is a tuple of its parameters, chosen by its type.

So kernels are compiled for each method and kept on disk, which functions as arguments would spoil.
The file of a method overloads the functions below for its type. ``law`` is what
:mod:`~tribodyn.dynamics._engine.contact_forces` reads, ``w`` the work buffer; the slots of a method
begin where those of the law end.
"""

from __future__ import annotations

import inspect
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from tribodyn.compiled import source_digest
from tribodyn.compiled.jit import INNER_OPTIONS
from tribodyn.dynamics.equations.grid import Grid
from tribodyn.types import Array, Index


def kernel_digest() -> str:
    """Digest of every file whose code may end up in a compiled kernel."""
    folder = Path(__file__).parent
    law = (f"../equations/{name}" for name in ("program", "motion", "divergence"))
    return source_digest(folder, [*sorted(path.stem for path in folder.glob("*.py")), *law])


class RungeKutta4(NamedTuple):
    """The classical Runge-Kutta scheme."""

    stages: int = 4


class Newmark(NamedTuple):
    """Newmark's scheme."""

    gamma: float
    beta: float
    tolerance: float  #: largest last correction of the contact forces, relative to them [-]
    widths: Array  #: different phase widths of steps [-]
    kind: Index  #: which of them each step has

    @classmethod
    def on(cls, grid: Grid, gamma: float, beta: float, tolerance: float) -> Newmark:
        """Set up the method for a grid."""
        widths, kind = np.unique(grid.width, return_inverse=True)
        return cls(float(gamma), float(beta), float(tolerance), widths, kind.astype(np.int64))


#: NaN stays detectable: neither "nnan" nor "ninf". Only the outermost kernel is cached on disk.
JIT: dict[str, Any] = {"nogil": True, "fastmath": {"contract", "nsz"}, "error_model": "numpy"}

#: For what only compiled functions call.
INNER: dict[str, Any] = {**JIT, **INNER_OPTIONS}

#: For what is called in one place only: it is not compiled by itself, which would be done again
#: with its caller.
ONCE: dict[str, Any] = {**INNER, "inline": "always"}


def for_method(method: type, function: Any) -> Any:
    """Take what follows as one of the functions below, for the methods of one type."""
    from numba.extending import overload

    place = list(inspect.signature(function).parameters).index("method")

    def register(implementation: Any) -> Any:
        def choose(*arguments: Any) -> Any:
            kind = getattr(arguments[place], "instance_class", None)
            return implementation if kind is method else None

        choose.__signature__ = inspect.signature(implementation)  # type: ignore[attr-defined]
        overload(function, jit_options=INNER)(choose)
        return implementation

    return register


def own_slots(method: Any, law: Any) -> tuple[int, int, int]:
    """Slots of the method, how many of them a step changes for good, kinds of steps to prepare."""
    raise TypeError("chosen by type where it is compiled")


def prepare(method: Any, law: Any, base: int, duration: float, kind: int, w: Array) -> None:
    """Set up the slots of one lane for a kind of steps; kind -1: for a part of that duration."""
    raise TypeError("chosen by type where it is compiled")


def restart(lanes: Any, method: Any, law: Any, base: int, w: Array) -> None:
    """Begin anew at an event or a change of side; ``base`` is the row there."""
    raise TypeError("chosen by type where it is compiled")


def step(lanes: Any, method: Any, law: Any, number: int, base: int, w: Array, seen: Any) -> bool:
    """March every lane by step ``number``, -1 for a part of one; False if it was not found.

    If ``seen`` is a slot and not None, the accelerations at the left end are left in the slots from
    ``first`` and those in the middle in the slots from ``second``, the state there in buffer 1, and
    the rest as :func:`~tribodyn.dynamics._engine.middle.seen_slots` tells.
    """
    raise TypeError("chosen by type where it is compiled")


def accept(lanes: Any, method: Any, law: Any, w: Array) -> None:
    """Let the end of the step be the beginning of the next."""
    raise TypeError("chosen by type where it is compiled")
