"""Mesh table of a hypoid pair: its cells summed up over pairs, and its force law."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from tribodyn.friction import LAWS
from tribodyn.mesh.force_law import MeshForceLaw
from tribodyn.mesh.gears import NoGears
from tribodyn.mesh.hypoid.cells import wrench
from tribodyn.mesh.hypoid.loaded_contact import HypoidLoadedContact, wheel_torque_at
from tribodyn.mesh.table import MeshTable
from tribodyn.types import Array, Mask

if TYPE_CHECKING:
    from tribodyn.mesh.hypoid.friction import HypoidFriction

#: Deflections of the points of the force law, over that at the load of the table.
_POINTS = np.array([0.0, 0.03, 0.06, *np.geomspace(0.1, 1.0, 13), 1.2, 1.5, 1.9, 2.4, 3.0])


def mesh_table_of(rubbed: HypoidFriction) -> MeshTable:
    """Mesh table of a pair with its friction."""
    loaded, teeth, cells = rubbed.loaded, rubbed.teeth, rubbed.loaded.cells
    share, law = loaded.load_share, _force_law(loaded)
    stiffness = share * loaded.mesh_stiffness[:, None]
    in_series = loaded.film_springs is not None
    # The first film of each phase carries before the flanks touch, by this on average.
    ahead = teeth.unloaded_transmission_error - loaded.unloaded_transmission_error
    offset = float(loaded.grid.mean(ahead)) if in_series else 0.0
    pitch = 2.0 * math.pi / cells.flanks.blank.teeth_wheel * loaded.wheel_lever.mean()
    return MeshTable(
        grid=loaded.grid,
        path=pitch * (loaded.phase[:, None] + np.arange(share.shape[1])),
        in_contact=cells.in_contact,
        stiffness=stiffness,
        tooth_stiffness=teeth.load_share * teeth.mesh_stiffness[:, None],
        corner_share=np.zeros((loaded.phase.size, 2)),
        static_transmission_error=loaded.mesh_force / loaded.mesh_stiffness,
        mesh_stiffness_tangent=loaded.mesh_stiffness_tangent,
        ramp_deflection=law.knot_deflection,
        ramp_stiffness=law.knot_stiffness,
        load_share=share,
        normal_force=loaded.mesh_force[:, None] * share,
        load_per_width=loaded.load_per_width.max(axis=2),
        hertz_pressure=loaded.hertz_pressure.max(axis=2),
        maximum_single_pair_stiffness=float(stiffness.max()),
        gear_pair=cast(Any, NoGears()),
        pinion_speed=rubbed.pinion_speed,
        pinion_torque=loaded.pinion_torque,
        composite_roughness=rubbed.composite_roughness,
        stiffness_model="hypoid",
        friction_law=rubbed.friction_law,
        film_model=rubbed.film_model,
        film_stiffness_kind=rubbed.film_stiffness_kind,
        mesh_order=cells.flanks.blank.teeth_pinion,
        direction=np.hstack([loaded.pinion_direction, -loaded.wheel_direction]),
        unloaded_transmission_error=loaded.unloaded_transmission_error + offset,
        film_offset=offset,
        tooth_load_share=teeth.load_share if in_series else None,
        tooth_corner_share=np.zeros((loaded.phase.size, 2)) if in_series else None,
        tooth_transmission_error=teeth.loaded_transmission_error if in_series else None,
        **_friction_columns(rubbed),
        **_contact_columns(rubbed),
    )


def _contact_columns(rubbed: HypoidFriction) -> dict[str, Any]:
    """Columns of each pair from its cells: means weighted by force, and least films."""
    loaded, touch = rubbed.loaded, rubbed.loaded.cells.in_contact
    force, carries = loaded.cell_force, loaded.cell_force > 0.0
    rubs = force * rubbed.friction_coefficient
    columns: dict[str, Any] = {
        name: _mean(getattr(rubbed, name), weight)
        for name, weight in (
            ("sliding_speed", rubs),
            ("entrainment_speed", rubs),
            ("equivalent_radius", force),
            ("film_load_share", force),
        )
    }
    for name in ("minimum_film", "central_film", "film_ratio"):
        values = getattr(rubbed, name)
        columns[name] = None if values is None else _least(values, carries)
    pressure, stiffness = rubbed.film_pressure, rubbed.film_stiffness
    columns["film_pressure"] = None if pressure is None else -_least(-pressure, carries)
    columns["film_stiffness"] = None if stiffness is None else _in_pairs(stiffness, force)
    if rubbed.friction_law in LAWS and LAWS[rubbed.friction_law].asperities:
        columns["asperity_friction_coefficient"] = _mean(
            rubbed.asperity_friction_coefficient, force
        )
    entrained = np.where(touch, columns["entrainment_speed"], 1.0)
    columns["slide_to_roll_ratio"] = columns["sliding_speed"] / entrained
    columns["sliding_direction"] = np.where(touch, 1.0, 0.0)
    return columns


def _force_law(loaded: HypoidLoadedContact) -> MeshForceLaw:
    """Force on the line of action over the deflection from the first touch on."""
    start, lever = loaded.unloaded_rotation, loaded.wheel_lever
    turn = (loaded.loaded_rotation - start) * _POINTS[:, None]
    torque = wheel_torque_at(loaded, start + turn)
    torque[0] = 0.0
    return MeshForceLaw.through(loaded.grid, (lever * turn).T, (torque / lever).T)


def _friction_columns(rubbed: HypoidFriction) -> dict[str, Any]:
    """Coefficient of each pair, the wrench of a unit friction force, and its levers.

    Without any friction the direction is that of one coefficient in all cells.
    """
    loaded, cells = rubbed.loaded, rubbed.loaded.cells
    touch = cells.in_contact
    forces = loaded.line_force * rubbed.friction_coefficient[touch]
    normal, rubs = loaded.line_force.sum(axis=1), forces.sum(axis=1)
    carries = normal > 0.0
    coefficient = np.where(carries, rubs, 0.0) / np.where(carries, normal, 1.0)
    weights = np.where((rubs > 0.0)[:, None], forces, loaded.line_force)
    along = weights[..., None] * -rubbed.friction_direction[touch]
    sums = [
        sign * wrench(cells, along, g).sum(axis=1) for g, sign in (("pinion", 1), ("wheel", -1))
    ]
    share = (loaded.mesh_force[:, None] * loaded.load_share)[touch]
    over = np.where(rubs > 0.0, coefficient, 1.0) * share
    direction = np.concatenate(sums, axis=-1) / np.where(carries, over, 1.0)[:, None]
    return {
        "friction_coefficient": cells.spread(coefficient),
        "friction_direction": cells.spread(direction),
        "pinion_curvature_radius": cells.spread(np.abs(direction[:, 4])),
        "wheel_curvature_radius": cells.spread(np.abs(direction[:, 10])),
    }


def _mean(values: Array, weight: Array) -> Array:
    """Weighted mean over the cells of each pair; the plain mean where all weights are zero."""
    weight = np.where(np.any(weight > 0.0, axis=2, keepdims=True), weight, 1.0)
    return np.asarray((weight * values).sum(axis=2) / weight.sum(axis=2))


def _least(values: Array, carries: Mask) -> Array:
    """Least certain value in the loaded cells of each pair; NaN where there is none."""
    least = np.where(carries & np.isfinite(values), values, np.inf).min(axis=2)
    return np.where(np.isfinite(least), least, np.nan)


def _in_pairs(stiffness: Array, force: Array) -> Array:
    """Stiffness of the films of each pair: ``F^2/K = sum f^2/k`` over its cells."""
    certain = (force > 0.0) & (np.nan_to_num(stiffness) > 0.0)
    forces = np.where(certain, force, 0.0)
    compliance = (forces**2 / np.where(certain, stiffness, 1.0)).sum(axis=2)
    some = compliance > 0.0
    return np.where(some, forces.sum(axis=2) ** 2 / np.where(some, compliance, 1.0), np.nan)
