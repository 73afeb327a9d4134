"""Methods of fixed steps: a method is a tuple of its parameters, chosen by its type.

So kernels are compiled for each method and cached on disk, which functions as arguments prevent.
The file of a method overloads the functions below for its type. ``law`` is what
:mod:`~tribodyn.dynamics._engine.contact_forces` reads, ``w`` the work buffer; the slots of a method
begin where those of the law end.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, TypeVar

import numpy as np

from tribodyn.compiled import source_digest
from tribodyn.dynamics.equations.grid import Grid
from tribodyn.types import Array, Index

if TYPE_CHECKING:
    from tribodyn.dynamics._engine.lanes import Lanes

F = TypeVar("F", bound=Callable[..., object])


def kernel_digest() -> str:
    """Digest of every file whose code may end up in a compiled kernel."""
    folder = Path(__file__).parent
    law = (f"../equations/{name}" for name in ("program", "motion", "divergence"))
    return source_digest(folder, [*sorted(path.stem for path in folder.glob("*.py")), *law])


class Law(NamedTuple):
    """Addresses of the arrays that the compiled law reads."""

    code: Index
    reads: Index
    rows: Array | tuple[Array]  #: a tuple where every lane has its own


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


Method = RungeKutta4 | Newmark


def for_method(method: type, function: Callable[..., object]) -> Callable[[F], F]:
    """Register the decorated function as overload of a function below for one type of method."""
    from numba.extending import overload

    from tribodyn.compiled.jit import INNER

    place = list(inspect.signature(function).parameters).index("method")

    def register(implementation: F) -> F:
        def choose(*arguments: object) -> F | None:
            kind = getattr(arguments[place], "instance_class", None)
            return implementation if kind is method else None

        choose.__signature__ = inspect.signature(implementation)  # type: ignore[attr-defined]
        overload(function, jit_options=INNER)(choose)
        return implementation

    return register


def own_slots(method: Method, law: Law) -> tuple[int, int, int]:
    """Count of slots of the method, of those that persist after a step, and of kinds of steps."""
    raise TypeError("chosen by type where it is compiled")


def prepare(method: Method, law: Law, base: int, duration: float, kind: int, w: Array) -> None:
    """Set up the slots of one lane for a kind of steps; kind -1: for a part of a step."""
    raise TypeError("chosen by type where it is compiled")


def restart(lanes: Lanes, method: Method, law: Law, base: int, w: Array) -> None:
    """Restart at an event or a change of side; ``base`` is the row there."""
    raise TypeError("chosen by type where it is compiled")


def step(
    lanes: Lanes,
    method: Method,
    law: Law,
    number: int,
    base: int,
    w: Array,
    statistics_slot: int | None,
) -> bool:
    """Integrate every lane over step ``number`` (-1: a part of one); False without convergence.

    Unless ``statistics_slot`` is None, the accelerations at the left end are stored from slot
    ``first`` on, those in the middle from slot ``second`` on, the state in the middle in buffer 1,
    and the rest as in :func:`~tribodyn.dynamics._engine.midpoint.statistics_slots`.
    """
    raise TypeError("chosen by type where it is compiled")


def accept(lanes: Lanes, method: Method, law: Law, w: Array) -> None:
    """Copy the end of the step to the start of the next."""
    raise TypeError("chosen by type where it is compiled")
