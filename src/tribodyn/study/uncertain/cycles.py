"""Signals over a mesh cycle of the steady motion of every lane."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from tribodyn.dynamics._engine.blocks import marching_on
from tribodyn.dynamics.equations.motion import Forces, Scales, forces, with_middles
from tribodyn.dynamics.equations.nodes import Nodes
from tribodyn.dynamics.equations.orbit_coordinates import static_start
from tribodyn.dynamics.equations.system import System
from tribodyn.errors import ComputationError, warn
from tribodyn.mesh import MeshTable
from tribodyn.nomenclature import GEARS
from tribodyn.nonlinear.attractors import settle
from tribodyn.nonlinear.survey import Outcomes, Points
from tribodyn.progress import SILENT, Progress
from tribodyn.study.pipeline.motion import engine_arguments
from tribodyn.study.pipeline.response_series import centre_column
from tribodyn.study.uncertain.lanes import Lanes
from tribodyn.types import Array, Index

#: Most mesh cycles before a motion repeats, certified distance to the motion that does, lanes of a
#: block, and lanes whose cycle is held at a time.
_TRANSIENT, _TOLERANCE, _WIDTH, _LANES_PER_RECORD = 3000, 1e-7, 16, 32
#: Signals that every structure with two gears has, with their units.
SIGNALS = {
    "mesh_force": "N",
    "dynamic_transmission_error": "m",
    "acceleration": "m/s^2",
    "mesh_stiffness": "N/m",
    "friction_coefficient": "1",
    "backlash_function": "m",
    "transmission_error": "m",
}


class Cycles(NamedTuple):
    """Signals over one mesh cycle of every lane."""

    phase: Array  #: even mesh phases (places,)
    signals: dict[str, Array]  #: by name (lanes, places)
    #: Mean, root mean square, least and greatest value by name, each (lanes,).
    figures: dict[str, tuple[Array, ...]]


def steady_cycles(lanes: Lanes, places: int, progress: Progress = SILENT) -> Cycles:
    """Integrate every lane until it repeats, and return one mesh cycle of it."""
    with marching_on(engine_arguments(lanes.members[0].case).get("backend")):
        return _steady_cycles(lanes, places, progress)


def _steady_cycles(lanes: Lanes, places: int, progress: Progress) -> Cycles:
    systems = [member.system for member in lanes.members]
    points = Points(systems, lanes.mesh_frequency, lanes.steps, lanes.factors)
    outcomes = Outcomes(lanes.count, 1, points.size)
    phase = np.arange(places) / places
    signals = {name: np.empty((lanes.count, places)) for name in SIGNALS}
    figures = {name: tuple(np.empty(lanes.count) for _ in range(4)) for name in SIGNALS}
    scales, restless = lanes.table(), 0
    progress.start("Motions", lanes.count)
    for group in points.groups:
        compiled = points.compiled(group)
        outcomes.first[group] = static_start(compiled)
        motions = points.motions(compiled, group, outcomes)
        settle(motions, np.arange(group.size), _TRANSIENT, tolerance=_TOLERANCE, width=_WIDTH)
        if lost := int(np.sum(~np.all(np.isfinite(motions.state), axis=1))):
            what = f"{lost} of {lanes.count} variants grew beyond all bounds"
            raise ComputationError(what, "", "", "Narrow the inputs, or add damping")
        restless += int(np.sum(motions.period != 1))
        for begin in range(0, group.size, _LANES_PER_RECORD):
            part = np.arange(begin, min(begin + _LANES_PER_RECORD, group.size))
            to, member = group[part], lanes.members[int(group[0])]
            states = np.empty((compiled.grid.steps + 1, 2 * points.size, part.size))
            motions.march(part, motions.state[part], 1, motions.force[part], record=states)
            width = compiled.grid.width / lanes.mesh_frequency[to][:, None]
            q, v = with_middles(width, np.moveaxis(states, -1, 0))
            nodes, beat = compiled.nodes, lanes.mesh_frequency[to][:, None, None, None]
            lane_scales, extra = scales[to], motions.force[part][:, None, None, :]
            law = forces(
                compiled.system, nodes, beat, q, v, scales=Scales.of_lanes(lane_scales), extra=extra
            )
            for name, values in signals_at(
                member.system, member.mesh, nodes, law, lane_scales[:, None, None, :]
            ).items():
                _put(values, nodes, phase, signals[name], figures[name], to)
        progress.advance(group.size)
    progress.finish()
    if restless:
        warn(
            "ensemble-period",
            f"{restless} of {lanes.count} variants do not repeat after one "
            "mesh cycle; the result has one cycle of their motion.",
            stacklevel=4,
        )
    return Cycles(phase, signals, figures)


def _put(values: Array, nodes: Nodes, phase: Array, to: Array, figures: Any, lanes: Index) -> None:
    """Signals at even phases, and their figures by Simpson's rule."""
    values = np.broadcast_to(values, (lanes.size, *nodes.phase.shape))
    statistics = [
        np.einsum("rs,brs->b", nodes.weight, values),
        np.sqrt(np.einsum("rs,brs->b", nodes.weight, values**2)),
        values.min(axis=(1, 2)),
        values.max(axis=(1, 2)),
    ]
    for column, values_of_lanes in zip(figures, statistics, strict=True):
        column[lanes] = values_of_lanes
    # Both sides of an event have the same phase; the side after it counts.
    left = nodes.phase.reshape(-1).copy()
    left[0::3], left[2::3] = left[0::3] + 1e-13, left[2::3] - 1e-13
    for lane, row in zip(lanes, values.reshape(lanes.size, -1), strict=True):
        to[lane] = np.interp(phase + 1e-13, left, row)


def signals_at(
    system: System, mesh: MeshTable, rows: Nodes, law: Forces, scales: Array
) -> dict[str, Array]:
    """Signals of rows (lanes, ...) from what the equation of motion gives, factors last."""
    stiffness, _, friction, error, gap, _ = np.moveaxis(scales, -1, 0)
    spring = stiffness[..., None] * rows.stiffness * np.abs(law.side)
    elastic = spring * (law.deflection - law.side * gap[..., None] * rows.gap)
    total, prescribed = spring.sum(axis=-1), error * rows.error[..., 0]
    column = centre_column(tuple(system.names), GEARS[0], "y")
    coordinate = 0 if column is None else column
    return {
        "mesh_force": law.contact.sum(axis=-1),
        "dynamic_transmission_error": law.deflection[..., 0] + prescribed,
        "acceleration": law.acceleration[..., coordinate],
        "mesh_stiffness": total,
        "friction_coefficient": friction * _coefficient(mesh, rows.phase),
        "backlash_function": elastic.sum(axis=-1) / np.where(total > 0.0, total, 1.0),
        "transmission_error": prescribed,
    }


def _coefficient(mesh: MeshTable, phase: Array) -> Array:
    """Friction coefficient of the mesh: that of the pairs by their share of the load."""
    return np.asarray(np.interp(phase % 1.0, mesh.phase, mesh.by_share(mesh.friction_coefficient)))
