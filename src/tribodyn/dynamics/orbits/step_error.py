"""What the step costs an orbit: its distance to the orbit of the same system at half the step.

The certified error of an orbit is the distance to that of the stepped system. The scheme is of
fourth order, so that the orbit at half the step is sixteen times as near to that of the equations.
"""

from __future__ import annotations

from copy import copy
from dataclasses import replace

import numpy as np

from tribodyn.dynamics.equations.grid import Grid
from tribodyn.dynamics.equations.program import compile_on
from tribodyn.dynamics.orbits.orbit_map import OrbitMap, newton_step
from tribodyn.dynamics.orbits.search import OrbitPoint, finish_orbit, motion_size
from tribodyn.types import Array

#: Rounds with the matrix of the coarse orbit, and the part of the way that the last may still go.
_ROUNDS, _CLOSE = 6, 0.02
#: An orbit this far away, over its size, is another one.
_OTHER = 0.5


def step_error(mapping: OrbitMap, orbit: OrbitPoint, mesh_frequency: float) -> float:
    """Greatest distance of an orbit to that at half the step over its size; infinite without one.

    The periods that it takes are few: the orbit at half the step lies beside that at the whole one.
    """
    fine = copy(mapping)
    grid = halved(mapping.compiled.grid)
    nodes, program = compile_on(mapping.compiled.system, grid)
    fine.compiled = replace(
        mapping.compiled, grid=grid, nodes=nodes, program=program, parameters=None,
        step_number=0.5 * mapping.compiled.step_number,
    )  # fmt: skip
    point, way = orbit.point, np.inf
    for _ in range(_ROUNDS):
        step = newton_step(orbit.matrix, fine.follow(point)[0] - point)[0]
        last, way = way, float(np.linalg.norm(step))
        moved = float(np.linalg.norm(point + step - orbit.point))
        if not way < 0.5 * last or moved > _OTHER * orbit.scale:
            break
        point = point + step
        if way <= _CLOSE * moved or way <= 1e-9 * orbit.scale:
            return _apart(mapping, orbit, fine.follow(point)[1])
    found = finish_orbit(fine, orbit.point, 1e-6)
    same = np.linalg.norm(found.point - orbit.point) <= _OTHER * orbit.scale
    return _apart(mapping, orbit, found.states) if found.error <= 1e-6 and same else float("inf")


def _apart(mapping: OrbitMap, orbit: OrbitPoint, states: Array) -> float:
    """Greatest distance at the ends of the whole steps; free motions of the drive do not count."""
    size = motion_size(mapping, states[::2])
    coarse, fine = (mapping.coordinates.reduce(part) for part in (orbit.states, states[::2]))
    return float(np.linalg.norm(fine - coarse, axis=1).max()) / size


def halved(grid: Grid) -> Grid:
    """The grid with every step cut in two."""
    half = np.repeat(0.5 * grid.width, 2)
    first = np.arange(half.size) % 2 == 0
    left = np.repeat(grid.left, 2) + np.where(first, 0.0, half)
    ends = (np.repeat(part, 2) for part in (grid.segment_left, grid.segment_right))
    return Grid(left, half, np.repeat(grid.after_event, 2) & first, *ends)
