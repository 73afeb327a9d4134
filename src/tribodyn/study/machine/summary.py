"""Figures of a machine, each defined once for a mesh, a shaft, a bearing or a housing node."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.nomenclature import QUANTITIES
from tribodyn.study.pipeline.summary import SummaryFigure

if TYPE_CHECKING:
    from tribodyn.study.machine.result import LoadResult

#: Figures of each kind of part: key, quantity that gives the unit (empty: a pure number), meaning.
_KINDS: dict[str, dict[str, tuple[str, str]]] = {
    "machine": {
        "clock_frequency": ("frequency", "periods of the whole motion per second"),
        "input_power": ("power", "power that enters by the input shaft"),
        "friction_power": ("power", "power lost to the friction of all computed teeth"),
        "efficiency": ("", "power that leaves over power that enters; losses of the teeth only"),
        "output_torque": ("torque", "torque that the output delivers"),
    },
    "meshes": {
        "mesh_frequency": ("mesh_frequency", "tooth engagements per second"),
        "static_mesh_force": ("mesh_force", "force along the line of action at rest"),
        "mean_mesh_force": ("mesh_force", "mean of the dynamic force"),
        "rms_mesh_force": ("mesh_force", "root mean square of its alternating part"),
        "peak_mesh_force": ("mesh_force", "greatest dynamic force"),
        "minimum_mesh_force": ("mesh_force", "least dynamic force; zero where the flanks part"),
        "dynamic_factor_peak": ("", "greatest dynamic force over its mean"),
        "contact_loss_share": ("", "part of the time without contact on the driving flanks"),
        "transmission_error_peak_to_peak": (
            "dynamic_transmission_error",
            "rotation of one gear against the other on the line of action, greatest less least",
        ),
        "static_transmission_error_peak_to_peak": (
            "static_transmission_error",
            "of the computed teeth at rest under the load",
        ),
        "mean_mesh_stiffness": ("mesh_stiffness", "mean over a mesh cycle"),
        "misalignment": ("deflection", "of the flanks over the face, by deflected shafts"),
        "face_load_factor": (
            "",
            "greatest over mean load along the face, of independent slices under this misalignment",
        ),
        "contact_ratio": ("", "transverse contact ratio under load"),
        "mean_friction_coefficient": ("", "mean over the mesh cycle, weighted by load"),
        "friction_power": ("power", "power lost to the friction of the teeth"),
        "maximum_hertz_pressure": ("hertz_pressure", "greatest contact pressure of the teeth"),
        "minimum_film_thickness": ("film_thickness", "least film of the computed teeth"),
    },
    "shafts": {
        "speed": ("speed", "speed of the shaft, negative where it turns against x"),
        "torque": ("torque", "torque that it transmits"),
        "power": ("power", "power that it transmits"),
        "largest_deflection": ("deflection", "greatest radial displacement at rest"),
    },
    "bearings": {
        "mean_radial_force": ("bearing_force", "size of the mean radial force"),
        "mean_axial_force": ("bearing_force", "mean force along the shaft"),
        "rms_radial_force": ("bearing_force", "root mean square of the alternating radial force"),
        "peak_radial_force": ("bearing_force", "greatest radial force"),
        "radial_stiffness": ("bearing_stiffness", "mean of y and z at the working load"),
        "maximum_pressure": ("hertz_pressure", "greatest pressure on a raceway"),
    },
    "housing": {
        "rms_acceleration": (
            "acceleration",
            "root mean square of the acceleration, all directions",
        ),
        "peak_acceleration": ("acceleration", "greatest acceleration"),
    },
}
_TOPICS = {
    "machine": "Machine",
    "meshes": "Mesh {0}",
    "shafts": "Shaft {0}",
    "bearings": "Bearing {0}",
    "housing": "Housing at {0}",
}


def figure_of(key: str) -> SummaryFigure:
    """Unit, meaning and topic of a key of the summary, such as ``meshes.first.mesh_frequency``."""
    kind, _, part_key = key.partition(".")
    prefix = ""
    if kind == "load_cases":
        case, _, key = part_key.partition(".")
        prefix, (kind, _, part_key) = f"{case}: ", key.partition(".")
    name, _, last = part_key.rpartition(".")
    quantity, meaning = _KINDS[kind][last]
    entry = QUANTITIES[quantity] if quantity else None
    units = (entry.unit, entry.display_unit) if entry else ("", "")
    return SummaryFigure(key, *units, meaning, prefix + _TOPICS[kind].format(name))


def summary_of(result: LoadResult) -> dict[str, float]:
    """All figures of a machine under one load, in SI, by dotted key."""
    values: dict[str, float | None] = {}
    for group, parts in (
        ("machine", {"": _of_machine(result)}),
        ("meshes", {name: _of_mesh(result, name) for name in result.motion.mesh}),
        ("shafts", {name: _of_shaft(result, name) for name in result.machine.shafts}),
        ("bearings", {name: _of_bearing(result, name) for name in result.motion.bearing}),
        ("housing", {name: _of_node(result, name) for name in result.motion.node}),
    ):
        for name, figures in parts.items():
            prefix = f"{group}.{name}" if name else group
            values |= {f"{prefix}.{key}": value for key, value in figures.items()}
    return {key: float(v) for key, v in values.items() if v is not None and np.isfinite(v)}


def _of_machine(result: LoadResult) -> Mapping[str, float | None]:
    run, motion = result.machine.operation, result.motion
    power = abs(run.speed * run.torque)
    lost = sum(table.mean_friction_power for table in result.tables.values())
    return {
        "clock_frequency": motion.frequency,
        "input_power": power,
        "friction_power": lost if result.tables else None,
        "efficiency": (power - lost) / power if result.tables and power else None,
        "output_torque": abs(result.static.output_torque),
    }


def _of_mesh(result: LoadResult, name: str) -> Mapping[str, float | None]:
    motion, load = result.motion, result.machine.kinematics.meshes[name]
    column = motion.mesh.index(name)
    force, error = motion.mesh_force[:, column], motion.transmission_error[:, column]
    table, balance = result.tables.get(name), result.static.meshes[name]
    mean = float(motion.mean(force))
    return {
        "mesh_frequency": load.mesh_frequency,
        "static_mesh_force": balance.force,
        "mean_mesh_force": mean,
        "rms_mesh_force": float(motion.rms(force)),
        "peak_mesh_force": float(force.max()),
        "minimum_mesh_force": float(force.min()),
        "dynamic_factor_peak": float(force.max()) / mean if mean else None,
        "contact_loss_share": float(motion.mean(motion.open[:, column])),
        "transmission_error_peak_to_peak": float(np.ptp(error)),
        "misalignment": balance.misalignment,
        "face_load_factor": balance.face_load_factor,
        **_of_table(result, name, table),
    }


def _of_table(result: LoadResult, name: str, table: Any) -> dict[str, float | None]:
    """Figures of computed teeth; of a constant stiffness there is only that."""
    if table is None:
        return {"mean_mesh_stiffness": float(result.static.meshes[name].stiffness[0, 0])}
    film = getattr(table, "film_thickness", None)
    pressure = getattr(table, "hertz_pressure", None)
    return {
        "mean_mesh_stiffness": table.mean_mesh_stiffness,
        "static_transmission_error_peak_to_peak": float(np.ptp(table.transmission_error_at_rest)),
        "contact_ratio": table.contact_ratio_under_load,
        "mean_friction_coefficient": table.mean_friction_coefficient,
        "friction_power": table.mean_friction_power,
        "maximum_hertz_pressure": None if pressure is None else float(np.nanmax(pressure)),
        "minimum_film_thickness": None if film is None else float(np.nanmin(film)),
    }


def _of_shaft(result: LoadResult, name: str) -> Mapping[str, float | None]:
    load, bent = result.machine.kinematics.shafts[name], result.static.shafts[name]
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


def summary_rows(values: Mapping[str, float]) -> list[tuple[str, str, str, str]]:
    """Topic, key, value with unit and meaning of each figure, by the part it is about."""
    topics: dict[str, list[tuple[str, str, str, str]]] = {}
    for key, value in values.items():
        figure = figure_of(key)
        row = figure.topic, key, figure.show(value), figure.meaning
        topics.setdefault(figure.topic, []).append(row)
    return [row for rows in topics.values() for row in rows]
