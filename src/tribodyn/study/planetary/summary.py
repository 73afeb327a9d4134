"""Figures of a planetary stage: of the stage, its members, its sun meshes and its ring meshes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.study.machine.summary import ALTERNATING, peak_over_mean, table_figures
from tribodyn.study.planetary.stage_signals import signals_along

if TYPE_CHECKING:
    from tribodyn.machine import PlanetaryKinematics
    from tribodyn.mesh import MeshTable
    from tribodyn.study.machine.load_cases import LoadCase
    from tribodyn.study.planetary.case import PlanetaryCase
    from tribodyn.study.planetary.result import PlanetaryLoadResult


def kinematic_figures(case: PlanetaryCase, stage: PlanetaryKinematics) -> dict[str, float]:
    """Speeds, torques and power of the stage and its members, in SI by dotted key."""
    driver, output = stage.input, stage.output
    power = stage.power[driver]
    values = {
        "machine.clock_frequency": stage.mesh_frequency,
        "machine.input_power": power,
        "machine.output_torque": abs(stage.torques[output]),
        f"planets.{case.name}.ratio": stage.ratio,
        f"planets.{case.name}.rolling_power": stage.rolling_power,
        f"planets.{case.name}.planet_speed": stage.relative_speeds["planet"],
    }
    for role, name in case.members.items():
        values[f"shafts.{name}.speed"] = stage.speeds[role]
        values[f"shafts.{name}.torque"] = stage.torques[role]
        values[f"shafts.{name}.power"] = stage.power[role]
    return values


def mesh_losses(
    case: PlanetaryCase, load: LoadCase, tables: Mapping[str, MeshTable]
) -> dict[str, float]:
    """Part of the power that each mesh transmits, the carrier at rest, which its teeth lose."""
    rolling = case.kinematics(load).rolling_power / case.table.count
    return {mesh: table.mean_friction_power / rolling for mesh, table in tables.items()}


def summary_of(case: PlanetaryCase, result: PlanetaryLoadResult) -> dict[str, float]:
    """All figures of a stage under one load, in SI, by dotted key."""
    stage, motion = result.kinematics, result.motion
    count, name = case.table.count, case.name
    values: dict[str, Any] = kinematic_figures(case, stage)
    lost = _friction_power(result)
    pin = np.linalg.norm(motion.mean(motion.pin_force), axis=1)
    data, errors = result.data, signals_along(result, result.response).transmission_error
    outward = data["planet_mass"] * data["pin_radius"] * data["carrier_speed"] ** 2
    sun = motion.displacement[:, motion.member.index("sun"), :2]
    values |= {
        "machine.friction_power": sum(stage.power.values()),
        "machine.efficiency": stage.efficiency,
        f"planets.{name}.load_factor": result.shares.load_factor,
        f"planets.{name}.dynamic_load_factor": motion.load_factor,
        f"planets.{name}.planets_unloaded": float(len(result.shares.unloaded)),
        f"planets.{name}.mean_pin_force": float(pin.max()),
        f"planets.{name}.peak_pin_force": float(np.linalg.norm(motion.pin_force, axis=2).max()),
        f"planets.{name}.centrifugal_force": float(outward),
        f"planets.{name}.sun_orbit": float(np.hypot(*motion.rms(sun))),
    }
    forces = {"sun": motion.sun_mesh_force, "ring": motion.ring_mesh_force}
    for number, (mesh, force) in enumerate(forces.items()):
        mean = motion.mean(force)
        figures: dict[str, float | None] = {
            "mesh_frequency": stage.mesh_frequency,
            "static_mesh_force": float(result.data["force_per_planet"]),
            "mean_mesh_force": float(mean.mean()),
            **dict.fromkeys(ALTERNATING, float(motion.rms(force).max())),
            "peak_mesh_force": float(force.max()),
            "minimum_mesh_force": float(force.min()),
            "dynamic_factor_peak": peak_over_mean(force, mean),
            "contact_loss_share": float(motion.mean((force == 0.0).astype(float)).max()),
            "transmission_error_peak_to_peak": float(
                np.ptp(errors[:, number * count : (number + 1) * count], axis=0).max()
            ),
            **table_figures(result.tables[mesh]),
            "friction_power": lost[mesh] / count,
        }
        values |= {f"meshes.{mesh}.{key}": value for key, value in figures.items()}
    return {key: float(v) for key, v in values.items() if v is not None and np.isfinite(v)}


def _friction_power(result: PlanetaryLoadResult) -> dict[str, float]:
    """Power that the teeth of all sun and all ring meshes lose of what reaches them."""
    case, load, stage = result.case, result.load, result.kinematics
    losses = mesh_losses(case, load, result.tables)
    meshes = ("sun", "ring") if case.sun_drives(load) else ("ring", "sun")
    reaching, lost = abs(stage.torques[meshes[0]] * stage.relative_speeds[meshes[0]]), {}
    for mesh in meshes:
        lost[mesh] = losses[mesh] * reaching
        reaching -= lost[mesh]
    return lost
