"""Matrices of one shaft: beam elements between its nodes."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from tribodyn.errors import InputError
from tribodyn.machine.beam import BeamElement, carried_along, part_of
from tribodyn.machine.shaft import SAME_PLACE, Shaft
from tribodyn.types import Array

#: Longest element over its greatest diameter, or over the length of a slender shaft.
_SLENDERNESS, _PART = 0.25, 1.0 / 60.0


@dataclass(frozen=True)
class ShaftMatrices:
    """Mass, stiffness and gyroscopic matrix of a shaft.

    Parameters
    ----------
    shaft : Shaft
        A shaft without sections is rigid: one node at position 0, without mass.
    positions : tuple of float
        Positions from its beginning at which nodes are needed, of gears and bearings [m].
    element_length : float, optional
        Longest element [m]; by default a quarter of each section's diameter, or a sixtieth of
        the shaft if that is more.

    Raises
    ------
    InputError
        If a position lies off the shaft.

    Notes
    -----
    Nodes lie at the ends of sections and at the positions; each part in between is divided into
    elements of equal length. Six coordinates a node: ``(x, y, z, theta_x, theta_y, theta_z)``.

    Examples
    --------
    >>> from tribodyn.machine import Section, Shaft
    >>> ShaftMatrices(Shaft([Section(0.1, 0.04)]), (0.035,), element_length=0.04).nodes.round(3)
    array([0.   , 0.035, 0.068, 0.1  ])
    """

    shaft: Shaft
    positions: tuple[float, ...] = ()
    element_length: float | None = None

    @cached_property
    def nodes(self) -> Array:
        """Positions of the nodes, rising [m]."""
        ends = [0.0, *np.cumsum([element.section.length for element in self._elements])]
        return np.asarray(ends)

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return 6 * self.nodes.size

    @cached_property
    def mass(self) -> Array:
        """Mass matrix, (n, n) [kg, kg*m, kg*m^2]."""
        return self._summed("mass")

    @cached_property
    def stiffness(self) -> Array:
        """Stiffness matrix of the free shaft, (n, n) [N/m, N, N*m]."""
        return self._summed("stiffness")

    @cached_property
    def gyroscopic(self) -> Array:
        """Gyroscopic matrix per unit of speed, skew, (n, n) [kg*m^2, kg*m, kg]."""
        return self._summed("gyroscopic")

    def at(self, position: float) -> Array:
        """Return the displacement at a position per coordinate of the shaft.

        Parameters
        ----------
        position : float
            From the beginning of the shaft [m].

        Returns
        -------
        (6, n) array
        """
        if position not in self._rows:
            rows = self._row(position)
            rows.flags.writeable = False
            self._rows[position] = rows
        return self._rows[position]

    @cached_property
    def _rows(self) -> dict[float, Array]:
        return {}

    def _row(self, position: float) -> Array:
        if not self._elements:
            return carried_along(position)
        self._require_on_shaft(position)
        out = np.zeros((6, self.size))
        node = int(np.abs(self.nodes - position).argmin())
        if abs(self.nodes[node] - position) <= SAME_PLACE:
            out[:, 6 * node : 6 * node + 6] = np.eye(6)
            return out
        element = int(np.searchsorted(self.nodes, position)) - 1
        inside = self._elements[element].motion(position - self.nodes[element])
        out[:, 6 * element : 6 * element + 12] = inside
        return out

    @cached_property
    def _elements(self) -> tuple[BeamElement, ...]:
        for position in self.positions if self.shaft.sections else ():
            self._require_on_shaft(position)
        elements, begin = [], 0.0
        for section in self.shaft.sections:
            end = begin + section.length
            inner = sorted(p for p in self.positions if begin + SAME_PLACE < p < end - SAME_PLACE)
            limits = _distinct([begin, *inner, end])
            thick = max(section.diameters(0.0)[0], section.diameters(1.0)[0])
            longest = self.element_length or max(_SLENDERNESS * thick, _PART * self.shaft.length)
            for left, right in pairwise(limits):
                count = max(int(np.ceil((right - left) / longest - 1e-9)), 1)
                steps = np.linspace(left, right, count + 1) - begin
                if section.is_cylindrical:  # elements of one length share their matrices
                    part = part_of(section, steps[0], steps[1])
                    elements += [BeamElement(part, self.shaft.material)] * count
                    continue
                parts = (part_of(section, start, end) for start, end in pairwise(steps))
                elements += [BeamElement(part, self.shaft.material) for part in parts]
            begin = end
        return tuple(elements)

    def _require_on_shaft(self, position: float) -> None:
        length = self.shaft.length
        if not -SAME_PLACE <= position <= length + SAME_PLACE:
            what = f"position = {1e3 * position:.6g} mm"
            why = f"The shaft extends from 0 to {1e3 * length:.6g} mm"
            raise InputError(what, "argument position", why, "Give a position on the shaft")

    def _summed(self, kind: str) -> Array:
        out = np.zeros((self.size, self.size))
        for number, element in enumerate(self._elements):
            at = slice(6 * number, 6 * number + 12)
            out[at, at] += getattr(element, kind)
        return out


def _distinct(limits: Iterable[float]) -> list[float]:
    """Rising positions without those that repeat the one before."""
    out: list[float] = []
    for limit in limits:
        if not out or limit - out[-1] > SAME_PLACE:
            out.append(limit)
    return out
