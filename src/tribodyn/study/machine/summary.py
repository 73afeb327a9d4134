"""Figures of a machine, each defined once for a mesh, a shaft, a bearing or a housing node."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import fields
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.machine.graph.directions import center_distance, working_pressure_angle
from tribodyn.machine.plane_law import mean_in_space
from tribodyn.study.pipeline.summary import HARMONICS, mesh_figures
from tribodyn.study.pipeline.summary_figures import MEASURES, Figures, figure_of, split_key
from tribodyn.study.planetary.machine_stages import stage_figures

if TYPE_CHECKING:
    from tribodyn.machine import Machine, MeshBalance
    from tribodyn.mesh import MeshTable
    from tribodyn.study.machine.result import LoadResult

#: Figure over the largest one of its unit that is rounding.
_ROUNDING = 1e-11


def summary_of(result: LoadResult) -> Figures:
    """All figures of a machine under one load, in SI, by dotted key."""
    values: dict[str, float | None] = {}
    measures = [(*key.rpartition("."), each) for key, each in MEASURES.all().items()]
    for group, parts in (
        ("machine", {"": _of_machine(result)}),
        ("meshes", {name: _of_mesh(result, name) for name in result.motion.mesh}),
        ("shafts", {name: _of_shaft(result, name) for name in result.machine.shafts}),
        ("bearings", {name: _of_bearing(result, name) for name in result.motion.bearing}),
        ("planets", stage_figures(result)),
        ("housing", {name: _of_node(result, name) for name in result.motion.node}),
    ):
        for name, figures in parts.items():
            prefix, of = (f"{group}.{name}", (result, name)) if name else (group, (result,))
            added = {key: each(*of) for kind, _, key, each in measures if kind == group}
            values |= {f"{prefix}.{key}": value for key, value in {**figures, **added}.items()}
    finite = {key: float(v) for key, v in values.items() if v is not None and np.isfinite(v)}
    return Figures(without_rounding(finite))


def without_rounding(figures: Mapping[str, float]) -> dict[str, float]:
    """Figures with an exact zero for those that are rounding of the largest one of their unit."""
    # Pure numbers are compared with those of their own name.
    units = {key: figure_of(key).unit or split_key(key)[3] for key in figures}
    size: dict[str, float] = {}
    for key, value in figures.items():
        size[units[key]] = max(size.get(units[key], 0.0), abs(value))
    return {k: v if abs(v) > _ROUNDING * size[units[k]] else 0.0 for k, v in figures.items()}


def _of_machine(result: LoadResult) -> Mapping[str, float | None]:
    run, flow = result.machine.operation, result.power_flow.shafts
    power, lost = abs(run.speed * run.torque), sum(result.friction_power.values())
    entering = power if run.torque >= 0.0 else power + lost
    efficiency = 1.0 - lost / entering if entering else 1.0
    ratio = float(flow[run.output].ratio)
    losses = efficiency if run.torque >= 0.0 else 1.0 / efficiency
    rubbing = any(_rubs(table) for table in result.tables.values())
    return {
        "clock_frequency": result.motion.frequency,
        "input_power": entering,
        "friction_power": lost if rubbing else None,
        "efficiency": efficiency if rubbing and power else None,
        "output_torque": abs(run.torque / ratio) * losses,
        "oil_temperature": result.load.temperature,
        "gear_temperature": result.load.gear_temperature,
        **_losses(result, power),
    }


def _losses(result: LoadResult, power: float) -> Mapping[str, float]:
    """Losses of all parts and the efficiency with them, if the case has ``[losses]``."""
    if not result.losses:
        return {}
    total = sum((*result.friction_power.values(), *result.losses.values()))
    efficiency = (
        1.0 - total / power if result.machine.operation.torque >= 0.0 else power / (power + total)
    )
    return {**result.losses, "total_power_loss": total, "total_efficiency": efficiency}


def _of_mesh(result: LoadResult, name: str) -> Mapping[str, float | None]:
    motion, load = result.motion, result.machine.kinematics.meshes[name]
    column = motion.mesh.index(name)
    force, error = motion.mesh_force[:, column], motion.transmission_error[:, column]
    table, balance = result.tables.get(name), result.static.meshes[name]
    mean, alternating = float(motion.mean(force)), float(motion.rms(force))
    return {
        "mesh_frequency": load.mesh_frequency,
        "static_mesh_force": balance.force,
        "mean_mesh_force": mean,
        "alternating_rms_mesh_force": alternating,
        "peak_mesh_force": float(force.max()),
        "minimum_mesh_force": float(force.min()),
        "dynamic_factor_peak": peak_over_mean(force, mean),
        "dynamic_factor_rms": math.hypot(mean, alternating) / mean if mean > 0.0 else None,
        "contact_loss_share": float(motion.mean(motion.open[:, column])),
        "transmission_error_peak_to_peak": float(np.ptp(error)),
        **_dynamic_error(result, name),
        **_mounting(balance),
        "face_load_factor": balance.face_load_factor,
        **geometry_figures(result.machine, name, mean, _contact_ratio(table)),
        **_of_table(result, name, table),
        "friction_power": result.friction_power[name] if _rubs(table) else None,
    }


def _rubs(table: MeshTable | None) -> bool:
    """Whether a mesh has computed teeth with friction; without a law nothing is known of it."""
    return table is not None and bool(table.friction_coefficient.any())


def _dynamic_error(result: LoadResult, name: str) -> dict[str, float]:
    """Compression of a mesh without a prescribed error, which is its dynamic transmission error."""
    motion, mesh = result.motion, result.machine.meshes[name]
    errors = [each.error for each in mesh.contacts or (mesh,)]
    if mesh.turning or any(callable(each) or each != 0.0 for each in errors):
        return {}
    column, key = motion.mesh.index(name), "dynamic_transmission_error"
    compression, cycles = motion.compression[:, column], int(motion.cycles[column])
    sizes = np.abs(motion.harmonics(compression, cycles * np.arange(1.0, HARMONICS + 1)))
    harmonics = {f"{key}_harmonic_{order}": float(s) for order, s in enumerate(sizes, 1)}
    return {f"rms_{key}": float(motion.rms(compression)), **harmonics}


def peak_over_mean(force: np.ndarray, mean: np.ndarray | float) -> float | None:
    """Greatest peak over its own mean of mesh forces [instant, mesh]; None without any load."""
    loaded = np.asarray(mean) > 0.0
    ratios = force.max(axis=0)[loaded] / np.asarray(mean)[loaded]
    return float(ratios.max()) if ratios.size else None


def _mounting(balance: MeshBalance) -> dict[str, float]:
    """Misalignment of the flanks over the face, or mounting errors of crossed axes."""
    errors = balance.mounting
    if errors is None:
        return {"misalignment": balance.misalignment}
    return {f"{each.name}_error": getattr(errors, each.name) for each in fields(errors)}


def geometry_figures(
    machine: Machine, name: str, force: float, contact_ratio: float | None
) -> dict[str, float | None]:
    """Geometry of a mesh, with the axial force of inclined teeth."""
    mesh = machine.meshes[name]
    if mesh.crossed is not None:
        return {"axial_force": -force * float(mean_in_space(machine, name)[0])}
    gears = machine.gears[mesh.gears[0]], machine.gears[mesh.gears[1]]
    figures: dict[str, float | None] = {
        "center_distance": abs(center_distance(mesh, gears)),
        "operating_pressure_angle": working_pressure_angle(mesh, gears),
        "transverse_contact_ratio": contact_ratio,
    }
    if mesh.helix_angle:
        axial_pitch = math.pi * mesh.normal_module / math.sin(mesh.helix_angle)
        figures["overlap_ratio"] = min(gear.face_width for gear in gears) / axial_pitch
        figures["axial_force"] = -force * float(machine.directions[name].normal[0])
    return figures


def _contact_ratio(table: MeshTable | None) -> float | None:
    """Transverse contact ratio of computed teeth of cylindrical gears."""
    return None if table is None or table.gears is None else table.transverse_contact_ratio


def _of_table(result: LoadResult, name: str, table: Any) -> dict[str, float | None]:
    """Figures of computed teeth; of a constant stiffness there is only that."""
    if table is None:
        return {"mean_mesh_stiffness": float(result.static.meshes[name].stiffness[0, 0])}
    return table_figures(table)


def table_figures(table: MeshTable) -> dict[str, float | None]:
    """Figures of computed teeth."""
    film = table.central_film if table.minimum_film is None else table.minimum_film
    return {
        **mesh_figures(table),
        "static_transmission_error_peak_to_peak": float(np.ptp(table.transmission_error_at_rest)),
        "contact_ratio": table.contact_ratio_under_load,
        "minimum_film_thickness": (
            None if film is None else float(np.fmin.reduce(film[table.in_contact]))
        ),
    }


def _of_shaft(result: LoadResult, name: str) -> Mapping[str, float | None]:
    load, bent = result.power_flow.shafts[name], result.static.shafts[name]
    return {
        "speed": load.speed,
        "torque": load.torque,
        "power": load.power,
        "largest_deflection": float(np.hypot(*bent.displacement[:, 1:3].T).max()),
    }


def _of_bearing(result: LoadResult, name: str) -> Mapping[str, float | None]:
    motion, balance = result.motion, result.static.bearings[name]
    column = motion.bearing.index(name)
    force = motion.bearing_force[:, column]
    mean = motion.mean(force)
    alternating = motion.rms(force)
    state = balance.state
    pressures = [] if state is None else [state.inner_pressure, state.outer_pressure]
    return {
        "mean_radial_force": float(np.hypot(mean[1], mean[2])),
        "mean_axial_force": float(mean[0]),
        "rms_radial_force": float(np.hypot(alternating[1], alternating[2])),
        "peak_radial_force": float(motion.radial_force[:, column].max()),
        "radial_stiffness": 0.5 * float(balance.stiffness[1, 1] + balance.stiffness[2, 2]),
        "maximum_pressure": float(np.max(pressures)) if pressures else None,
    }


def _of_node(result: LoadResult, name: str) -> Mapping[str, float | None]:
    motion = result.motion
    value = motion.acceleration[:, motion.node.index(name)]
    return {
        "rms_acceleration": float(np.sqrt((motion.rms(value) ** 2).sum())),
        "peak_acceleration": float(np.linalg.norm(value, axis=1).max()),
    }
