"""Mesh table of a hypoid pair and its force law; transmission error over phase and torque."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.friction import LAWS
from tribodyn.mesh.force_law import MeshForceLaw
from tribodyn.mesh.gears import NoGears
from tribodyn.mesh.hypoid.cells import wrench
from tribodyn.mesh.hypoid.loaded_contact import HypoidLoadedContact, wheel_torque_at
from tribodyn.mesh.table import MeshTable
from tribodyn.nomenclature import one_or_more
from tribodyn.stiffness import HarrisMap
from tribodyn.stiffness.loaded.result import harmonic_amplitudes
from tribodyn.types import Array, Mask, Tree

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


def _contact_columns(rubbed: HypoidFriction) -> Tree:
    """Columns of each pair from its cells: means weighted by force, and least films."""
    loaded, touch = rubbed.loaded, rubbed.loaded.cells.in_contact
    force, carries = loaded.cell_force, loaded.cell_force > 0.0
    rubs = force * rubbed.friction_coefficient
    columns: Tree = {
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


def _friction_columns(rubbed: HypoidFriction) -> Tree:
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


#: Mesh harmonics of a map.
_HARMONICS = 10


def hypoid_transmission_error_over_torque(
    loaded: HypoidLoadedContact, torque: ArrayLike
) -> HarrisMap:
    """Compute the static transmission error of a hypoid pair over phase and torque (Harris map).

    Parameters
    ----------
    loaded : HypoidLoadedContact
        The contact under any torque: its contact lines are those of all.
    torque : float or array (t,)
        Torques on the smaller gear in its running sense, in any order [N*m].

    Returns
    -------
    HarrisMap
        The lag of the larger gear on the line of action, without load and under each torque; its
        ``gear_pair`` is None.

    Raises
    ------
    InputError
        If a torque is not positive.

    Notes
    -----
    :meth:`HypoidLoadedContact.under` at every torque. The lever of the mesh force depends on the
    load; that of the curve without load is the lever under the least torque.

    Examples
    --------
    >>> import math
    >>> from tribodyn.gear import EaseOff, hypoid_blank, hypoid_flanks
    >>> from tribodyn.mesh import hypoid_loaded_contact
    >>> blank = hypoid_blank(10, 43, 31.7e-3, 0.336, 47.7e-3, math.radians(46.0), 0.1143)
    >>> ease_off = EaseOff(lengthwise_crowning=30e-6, profile_crowning=6e-6)
    >>> loaded = hypoid_loaded_contact(hypoid_flanks(blank, ease_off=ease_off), 500.0, steps=32)
    >>> study = hypoid_transmission_error_over_torque(loaded, [100.0, 500.0, 2000.0])
    >>> study.quietest_torque
    500.0
    """
    torques = np.unique(one_or_more(torque=torque)[0])
    contacts = [loaded.under(float(each)) for each in torques]
    phase = loaded.phase[:-1]  # the last is the first of the next cycle
    error = np.stack([each.loaded_transmission_error[:-1] for each in contacts])
    orders = max(1, min(_HARMONICS, (phase.size - 1) // 2))
    grid = loaded.grid
    return HarrisMap(
        gear_pair=None,
        provider="contact lines",
        reference="finite elements of the teeth"
        if loaded.compliance
        else f"{loaded.line_stiffness * 1e-9:g} N/(mm um) of contact line",
        torque=torques,
        phase=phase,
        mesh_cycles=1,
        transmission_error=error,
        unloaded_transmission_error=contacts[0].unloaded_transmission_error[:-1],
        harmonics=harmonic_amplitudes(phase, error, 1, orders),
        mean_mesh_stiffness_secant=np.array([each.mean_mesh_stiffness for each in contacts]),
        mean_mesh_stiffness_tangent=np.array(
            [float(grid.mean(each.mesh_stiffness_tangent)) for each in contacts]
        ),
    )
