"""Machines over one of their values: rows and matrices by polynomials through computed ones.

The values are Chebyshev points of the range, doubled until the machines at the new points are those
of the polynomials.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from tribodyn.dynamics.equations.compiled import Compiled, sample_system
from tribodyn.dynamics.equations.grid import unrepeated
from tribodyn.dynamics.equations.nodes import Nodes
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.modal.modal_march import is_modal, with_engine
from tribodyn.interrupt import in_threads, processors
from tribodyn.types import Array

#: Intervals between the points of the polynomials, and the largest difference of entries from them,
#: over the largest of each kind.
_INTERVALS, _ACCURATE = (2, 4, 8, 16), 1e-6
_MATRICES = ("mass", "damping", "stiffness", "gyroscopic")


class SystemFamily:
    """Machines on one grid, as a function of a value."""

    def __init__(
        self, ends: tuple[float, float], members: list[tuple[float, Compiled, float]]
    ) -> None:
        # members: parts of the range in order, with the machine and its frequency there
        self.ends, self.members = ends, members
        self.entries = [_entries(compiled) for _, compiled, _ in members]

    def weights(self, value: float) -> Array:
        """Weights of the members at a value."""
        at = (value - self.ends[0]) / (self.ends[1] - self.ends[0])
        parts = np.array([part for part, _, _ in self.members])
        ratio = (at - parts[None]) / (parts[:, None] - parts[None] + np.eye(parts.size))
        return np.asarray(np.prod(np.where(np.eye(parts.size, dtype=bool), 1.0, ratio), axis=1))

    def entry(self, weights: Array, name: str) -> Array:
        """Entry of a kind."""
        parts = [entries[name] for entries in self.entries]
        return np.asarray(np.tensordot(weights, np.stack(parts), 1))

    def __call__(self, value: float) -> tuple[Compiled, float]:
        """Machine and its frequency at a value."""
        weights, (_, first, _) = self.weights(value), self.members[0]
        matrices: dict[str, Any] = {
            name: self.entry(weights, f"system {name}") for name in _MATRICES
        }
        system = replace(first.system, **matrices)
        rows = {
            name: np.broadcast_to(self.entry(weights, name), part.shape)
            for name, part in zip(Nodes._fields, first.nodes, strict=True)
        }
        frequency = float(weights @ [frequency for _, _, frequency in self.members])
        return with_engine(replace(first, system=system, nodes=Nodes(**rows)), frequency), frequency

    def difference(self, value: float, entries: dict[str, Array]) -> float:
        """Largest difference of a machine from the polynomials, over the largest of each kind."""
        weights = self.weights(value)
        return max(
            float(np.abs(self.entry(weights, name) - exact).max(initial=0.0))
            / max(float(np.abs(exact).max(initial=0.0)), 1e-300)
            for name, exact in entries.items()
        )


def _entries(compiled: Compiled) -> dict[str, Array]:
    """Matrices and rows of a machine, the same ones once."""
    rows = zip(Nodes._fields, compiled.nodes, strict=True)
    return {
        **{f"system {name}": _matrix(compiled.system, name) for name in _MATRICES},
        **{name: unrepeated(part) for name, part in rows},
    }


def _matrix(system: System, name: str) -> Array:
    matrix = getattr(system, name)
    return np.zeros((system.size, system.size)) if matrix is None else np.asarray(matrix)


def family_of(
    at: Callable[[float], Any], ends: tuple[float, float], steps: int
) -> SystemFamily | None:
    """Machines of a range by polynomials; None where these do not follow them."""

    def member(part: float) -> tuple[float, Compiled, float]:
        moving = at(ends[0] + part * (ends[1] - ends[0]))
        return part, sample_system(moving.system, steps), moving.frequency

    compiled_at: dict[float, tuple[float, Compiled, float]] = {}
    family: SystemFamily | None = None
    for intervals in _INTERVALS:
        parts = [0.5 - 0.5 * float(np.cos(np.pi * k / intervals)) for k in range(intervals + 1)]
        fresh = [part for part in parts if not any(abs(part - old) < 1e-12 for old in compiled_at)]
        new = in_threads(member, fresh, processors())
        if not all(is_modal(each.system) for _, each, _ in new):
            return None
        entries = [_entries(each) for _, each, _ in new]
        shapes = {tuple(part.shape for part in each.values()) for each in entries}
        loads = {tuple(f.load for f in each.system.frictions) for _, each, _ in new}
        if family is not None:
            shapes.add(tuple(part.shape for part in family.entries[0].values()))
            loads.add(tuple(f.load for f in family.members[0][1].system.frictions))
        if len(shapes) > 1 or len(loads) > 1:
            return None
        if family is not None:
            values = [ends[0] + part * (ends[1] - ends[0]) for part in fresh]
            left = max(family.difference(v, e) for v, e in zip(values, entries, strict=True))
        compiled_at |= dict(zip(fresh, new, strict=True))
        family = SystemFamily(ends, [compiled_at[part] for part in sorted(compiled_at)])
        if intervals > _INTERVALS[0] and left <= _ACCURATE:
            return family
    return None
