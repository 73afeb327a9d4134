"""Methods of fixed steps: a method is a tuple of its parameters, chosen by its type.

So kernels are compiled for each method and kept on disk, which functions as arguments would spoil.
The file of a method overloads the functions below for its type. ``law`` is what
:mod:`~tribodyn.dynamics._engine.contact_forces` reads, ``w`` the work buffer; the slots of a method
begin where those of the law end.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from tribodyn.dynamics.equations.grid import Grid
from tribodyn.types import Array, Index


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


def is_method(kind: Any, method: type) -> bool:
    """Whether a Numba type is that of a method."""
    return getattr(kind, "instance_class", None) is method


def own_slots(method: Any, law: Any) -> tuple[int, int]:
    """Slots of the method, and how many of them a step changes for good."""
    raise TypeError("chosen by type where it is compiled")


def prepare(method: Any, law: Any, base: int, period: float, w: Array) -> None:
    """Set up the slots of one lane."""
    raise TypeError("chosen by type where it is compiled")


def restart(lanes: Any, method: Any, law: Any, base: int, w: Array) -> None:
    """Begin anew at an event or a change of side; ``base`` is the row there."""
    raise TypeError("chosen by type where it is compiled")


def step(lanes: Any, method: Any, law: Any, number: int, base: int, w: Array) -> bool:
    """March every lane by a whole step, from buffer 0 to buffer 2; False if it was not found."""
    raise TypeError("chosen by type where it is compiled")


def part_step(method: Any, law: Any, w: Array) -> bool:
    """March one lane by a part of a step, whose three rows are those of ``law``."""
    raise TypeError("chosen by type where it is compiled")


def accept(lanes: Any, method: Any, law: Any, w: Array) -> None:
    """Let the end of the step be the beginning of the next."""
    raise TypeError("chosen by type where it is compiled")
