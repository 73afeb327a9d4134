"""From a hypoid pair under load to the mesh table that the dynamics reads."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from tribodyn.mesh.force_law import MeshForceLaw
from tribodyn.mesh.gears import NoGears
from tribodyn.mesh.hypoid.loaded_contact import HypoidLoadedContact, wheel_torque_at, wrench
from tribodyn.mesh.table import MeshTable
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.mesh.hypoid.friction import HypoidFriction

#: Deflections of the points of the force law, over that at the load of the table.
_POINTS = np.array([0.0, 0.03, 0.06, *np.geomspace(0.1, 1.0, 13), 1.2, 1.5, 1.9, 2.4, 3.0])


def table_of(rubbed: HypoidFriction) -> MeshTable:
    """Mesh table of a pair with its friction."""
    loaded, cells = rubbed.loaded, rubbed.loaded.cells
    share, law = loaded.load_share, _force_law(loaded)
    stiffness = share * loaded.mesh_stiffness[:, None]
    pitch = 2.0 * math.pi / cells.flanks.blank.teeth_wheel * loaded.wheel_lever.mean()
    return MeshTable(
        grid=loaded.grid,
        path=pitch * (loaded.phase[:, None] + np.arange(share.shape[1])),
        in_contact=cells.in_contact,
        stiffness=stiffness,
        tooth_stiffness=stiffness,
        corner_share=np.zeros((loaded.phase.size, 2)),
        static_transmission_error=loaded.mesh_force / loaded.mesh_stiffness,
        mesh_stiffness_tangent=loaded.mesh_stiffness_tangent,
        ramp_deflection=law.knot_deflection,
        ramp_stiffness=law.knot_stiffness,
        load_share=share,
        normal_force=loaded.mesh_force[:, None] * share,
        load_per_width=loaded.load_per_width.max(axis=2),
        hertz_pressure=loaded.hertz_pressure.max(axis=2),
        central_film=None,
        film_pressure=None,
        film_stiffness=None,
        maximum_single_pair_stiffness=float(stiffness.max()),
        gear_pair=cast(Any, NoGears()),
        pinion_speed=rubbed.pinion_speed,
        pinion_torque=loaded.pinion_torque,
        composite_roughness=rubbed.composite_roughness,
        stiffness_model="hypoid",
        friction_law=rubbed.friction_law,
        film_model=rubbed.film_model,
        film_stiffness_kind="none",
        mesh_order=cells.flanks.blank.teeth_pinion,
        direction=np.hstack([loaded.pinion_direction, -loaded.wheel_direction]),
        unloaded_transmission_error=loaded.unloaded_transmission_error,
        **_friction(rubbed),
        **_contacts(rubbed),
    )


def _contacts(rubbed: HypoidFriction) -> dict[str, Array]:
    """Columns that tell of the cells of each pair: means by their force, and least films."""
    loaded, touch = rubbed.loaded, rubbed.loaded.cells.in_contact
    force, carries = loaded.cell_force, loaded.cell_force > 0.0
    rubs = force * rubbed.friction_coefficient
    found = {
        name: _mean(getattr(rubbed, name), weight)
        for name, weight in (
            ("sliding_speed", rubs),
            ("entrainment_speed", rubs),
            ("equivalent_radius", force),
            ("film_load_share", force),
        )
    }
    for name in ("minimum_film", "film_ratio"):
        least = np.where(carries, getattr(rubbed, name), np.inf).min(axis=2)
        found[name] = np.where(np.isfinite(least), least, np.nan)
    entrained = np.where(touch, found["entrainment_speed"], 1.0)
    found["slide_to_roll_ratio"] = found["sliding_speed"] / entrained
    found["sliding_direction"] = np.where(touch, 1.0, 0.0)
    return found


def _force_law(loaded: HypoidLoadedContact) -> MeshForceLaw:
    """Force on the line of action over the deflection from the first touch on."""
    start, lever = loaded.unloaded_rotation, loaded.wheel_lever
    turn = (loaded.loaded_rotation - start) * _POINTS[:, None]
    torque = wheel_torque_at(loaded, start + turn)
    torque[0] = 0.0
    return MeshForceLaw.through(loaded.grid, (lever * turn).T, (torque / lever).T)


def _friction(rubbed: HypoidFriction) -> dict[str, Array]:
    """Coefficient of each pair, what a newton of its friction does, and the levers of that.

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
    """Weighted mean over the cells of each pair; of cells alike where the weights are zero."""
    weight = np.where(np.any(weight > 0.0, axis=2, keepdims=True), weight, 1.0)
    return np.asarray((weight * values).sum(axis=2) / weight.sum(axis=2))
