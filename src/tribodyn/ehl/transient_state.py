"""State of a transient contact between two instants, and why the next one failed."""

from __future__ import annotations

from dataclasses import dataclass

from tribodyn.types import Array

#: What stopped the solver, by its status.
REASONS = {
    1: "Newton's method used up its steps",
    2: "no step length kept the gap open",
    3: "the linear system is singular",
    4: "a value is not finite",
    5: "rounding keeps the mass balance above its tolerance",
}


@dataclass(frozen=True, eq=False)
class State:
    """State of the contact at one instant, dimensionless."""

    P: Array
    H: Array
    numbers: Array  #: offset, last free node and further numbers of the kernel
