"""Shafts joined by meshes: the speeds that the teeth allow, and the loads that balance a torque."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from types import MappingProxyType
from typing import TypeVar

import numpy as np

from tribodyn.errors import Problem
from tribodyn.machine.gear import Gear
from tribodyn.machine.mesh import Mesh

T = TypeVar("T")


@dataclass(frozen=True)
class ShaftGraph:
    """Meshes between shafts, traversed breadth-first from the input shaft."""

    edges: Mapping[str, tuple[str, str]]  #: shafts of the first and the second gear of each mesh
    root: str
    tree: tuple[tuple[str, bool], ...] = field(init=False)  #: mesh, whether first to second gear
    loops: tuple[str, ...] = field(init=False)  #: meshes that close a loop

    def __post_init__(self) -> None:
        connected, tree, queue = {self.root}, [], [self.root]
        for shaft in queue:
            for mesh, (first, second) in self.edges.items():
                for start, end in ((first, second), (second, first)):
                    if start == shaft and end not in connected:
                        connected.add(end)
                        queue.append(end)
                        tree.append((mesh, start == first))
        used = {mesh for mesh, _ in tree}
        loops = (m for m, (first, _) in self.edges.items() if m not in used and first in connected)
        object.__setattr__(self, "tree", tuple(tree))
        object.__setattr__(self, "loops", tuple(loops))

    def propagate(self, value: T, step: Callable[[str, bool, T], T]) -> dict[str, T]:
        """Values of all connected shafts from that of the input, mesh by mesh."""
        values = {self.root: value}
        for mesh, forward in self.tree:
            start, end = self.edges[mesh] if forward else self.edges[mesh][::-1]
            values[end] = step(mesh, forward, values[start])
        return values

    def path(self, shaft: str) -> tuple[str, ...]:
        """Meshes of the tree from the input to a shaft."""
        meshes: list[str] = []
        for mesh, forward in reversed(self.tree):
            if self.edges[mesh][forward] == shaft:
                meshes.insert(0, mesh)
                shaft = self.edges[mesh][not forward]
        return tuple(meshes)

    def side(self, mesh: str, shaft: str) -> set[str]:
        """Shafts joined to one without a mesh."""
        edges = {name: ends for name, ends in self.edges.items() if name != mesh}
        tree = ShaftGraph(edges, shaft)
        return {shaft, *(edges[name][forward] for name, forward in tree.tree)}


def listed(names: Iterable[str]) -> str:
    """Names for a message: ``meshes a and b``."""
    *others, last = list(names)
    return f"meshes {', '.join(others)} and {last}" if others else f"mesh {last}"


Terms = dict[str, Fraction]
NOTHING: Mapping[str, float] = MappingProxyType({})
#: Share of the torque below which a mesh of a loop is unloaded.
_ROUNDING = 1e-9


@dataclass(frozen=True)
class Drive:
    """Input and output, speed and torque of the input, shafts that are held, and couplings."""

    input: str
    output: str
    speed: float
    torque: float
    fixed: tuple[str, ...] = ()
    couplings: Mapping[str, float] = field(default_factory=dict)  #: torsional stiffness [N*m/rad]
    sharing: Mapping[str, float] = field(
        default_factory=dict
    )  #: torques of first gears over the input's


@dataclass(frozen=True, eq=False)
class Mobility:
    """Speeds of the shafts over that of the input, and loads of the meshes."""

    # In every mesh the speeds of both gears relative to their carrier, times their numbers of
    # teeth, add up to zero (Willis); a coupling has the factors 1 and -1. By virtual power the
    # same factors times the load per tooth are the torques of a mesh on these shafts.
    graph: ShaftGraph
    gears: Mapping[str, Gear]
    meshes: Mapping[str, Mesh]
    drive: Drive

    @property
    def has_carriers(self) -> bool:
        """Whether the axes of a mesh turn with a carrier."""
        return any(mesh.carrier for mesh in self.meshes.values())

    @cached_property
    def rows(self) -> dict[str, dict[str, int]]:
        """Factors of the speeds of the shafts in each mesh."""
        rows = {}
        for name, mesh in self.meshes.items():
            first, second = (self.gears[gear] for gear in mesh.gears)
            other = int(-first.teeth / mesh.ratio((first, second)))
            rows[name] = {first.shaft: first.teeth, second.shaft: other}
            if mesh.carrier:
                rows[name][mesh.carrier] = -(first.teeth + other)
        for name in self.drive.couplings:
            rows[name] = dict(zip(self.graph.edges[name], (1, -1), strict=True))
        return rows

    @cached_property
    def _solved(self) -> tuple[dict[str, tuple[Terms, Fraction]], list[str]]:
        """Each shaft's speed by those that are free, exactly, and meshes that contradict it."""
        solved: dict[str, tuple[Terms, Fraction]] = dict.fromkeys(
            self.drive.fixed, ({}, Fraction(0))
        )
        solved[self.drive.input] = {}, Fraction(1)
        contradictions = []
        tree = [name for name, _ in self.graph.tree if name in self.rows]
        for name in dict.fromkeys((*tree, *self.rows)):
            terms, value = _substituted(self.rows[name], Fraction(0), solved)
            if not terms:
                contradictions += [name] * (value != 0)
                continue
            pivot, factor = next(iter(terms.items()))
            solution = {s: -f / factor for s, f in terms.items() if s != pivot}, -value / factor
            solved[pivot] = solution
            for shaft, (others, constant) in solved.items():
                if pivot in others:
                    solved[shaft] = _substituted(others, constant, {pivot: solution})
        return solved, contradictions

    @property
    def contradictions(self) -> list[str]:
        """Meshes that contradict the speeds by the others."""
        return self._solved[1]

    @cached_property
    def ratios(self) -> dict[str, Fraction]:
        """Speed of each shaft over that of the input."""
        return {shaft: value for shaft, (_, value) in self._solved[0].items()}

    def problems(self) -> Iterator[Problem]:
        """Shafts whose speed nothing determines, and teeth that stand."""
        solved, _ = self._solved
        if self.drive.input in self.drive.fixed:
            why, remedy = "A bearing with torsional_stiffness holds it", "Let another shaft drive"
            where = "operation.input"
            yield Problem(f'input = "{self.drive.input}" cannot turn', where, why, remedy)
        free = dict.fromkeys(name for terms, _ in solved.values() for name in terms)
        for shaft in free:
            others = [name for name, (terms, _) in solved.items() if shaft in terms]
            yield Problem(
                f"nothing determines the speed of this shaft, nor of {', '.join(others)}",
                f"shafts.{shaft}",
                "A planetary stage has one speed for each of two members; one member is held, or "
                "another part determines its speed",
                "Hold a member by a bearing with torsional_stiffness",
            )
        if free:
            return
        if self.ratios[self.drive.output] == 0:
            why, remedy = "Power leaves by a shaft that turns", "Name another output"
            where = "operation.output"
            yield Problem(f'output = "{self.drive.output}" does not turn', where, why, remedy)
        for name, mesh in self.meshes.items():
            first = self.gears[mesh.gears[0]].shaft
            if self.relative(name, first) == 0:
                why = "Its gears do not turn relative to each other"
                remedy = "Correct which shafts are held"
                yield Problem("the teeth of this mesh stand", f"meshes.{name}", why, remedy)

    def rows_with_losses(
        self,
        loads: Mapping[str, tuple[float, bool]],
        sense: float,
        efficiency: Mapping[str, float],
    ) -> dict[str, dict[str, float]]:
        """Factors of the torques in each mesh, whose driven gear receives a part of the power."""
        rows: dict[str, dict[str, float]] = {}
        for name, row in self.rows.items():
            factors: dict[str, float] = {**row}
            if name in efficiency:
                first, second, *carrier = row
                flow = -row[first] * loads[name][0] * self.relative(name, first)
                factors[second if sense * flow > 0.0 else first] *= efficiency[name]
                factors |= dict.fromkeys(carrier, -(factors[first] + factors[second]))
            rows[name] = factors
        return rows

    def loads(
        self,
        torque: float,
        weight: Mapping[str, float],
        rows: Mapping[str, Mapping[str, float]],
        first_loads: Mapping[str, float] = NOTHING,
    ) -> dict[str, tuple[float, bool]]:
        """Load per tooth [N*m] of each mesh, shared by stiffness off the first loads; if shared."""
        free = [s for s in self.ratios if s not in (*self.drive.fixed, self.drive.output)]
        balance = np.array([[row.get(s, 0) for row in self.rows.values()] for s in free], float)
        balance = balance.reshape(len(free), len(self.rows))
        torques = np.array([[row.get(s, 0) for row in rows.values()] for s in free], float)
        torques = torques.reshape(balance.shape)
        source = np.array([-torque * (s == self.drive.input) for s in free])
        weights = np.array([weight[name] for name in self.rows])
        weights = weights / weights.max()
        start = np.array([first_loads.get(name, 0.0) for name in self.rows])
        potential = np.linalg.solve((torques * weights) @ balance.T, source - torques @ start)
        loads = start + weights * (potential @ balance)
        # A load that another distribution with the same torques would change is one of a loop.
        loops = 1.0 - np.einsum("ij,ji->i", np.linalg.pinv(balance), balance)
        out = {}
        for name, load, loop in zip(self.rows, loads.tolist(), loops.tolist(), strict=True):
            shaft, factor = next(iter(self.rows[name].items()))
            referred = abs(load * factor * float(self.relative(name, shaft)))
            idle = referred < _ROUNDING * abs(torque)
            out[name] = (0.0 if idle else load), loop > _ROUNDING
        return out

    def relative(self, mesh: str, shaft: str) -> Fraction:
        """Speed of a shaft relative to the carrier of a mesh, over that of the input."""
        carrier = self.meshes[mesh].carrier if mesh in self.meshes else None
        return self.ratios[shaft] - (self.ratios[carrier] if carrier else 0)


def _substituted(
    terms: Mapping[str, Fraction | int],
    value: Fraction,
    solved: Mapping[str, tuple[Terms, Fraction]],
) -> tuple[Terms, Fraction]:
    """Terms and constant with the shafts that are solved in place of themselves."""
    total: Terms = {}
    for shaft, factor in terms.items():
        others, constant = solved.get(shaft, ({shaft: Fraction(1)}, Fraction(0)))
        value += factor * constant
        for name, share in others.items():
            total[name] = total.get(name, Fraction(0)) + factor * share
    return {name: factor for name, factor in total.items() if factor != 0}, value
