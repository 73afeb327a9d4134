"""Shafts as nodes and meshes as edges: a spanning tree from the input, and the loops."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import TypeVar

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
