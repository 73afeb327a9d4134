"""The plane model of a stage with its computed teeth: data, loads and equations of motion."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribodyn.errors import ModelWarning
from tribodyn.machine import LoadShares, Mesh, load_shares, planetary_plane_model
from tribodyn.machine.planetary.mesh_laws import PlanetMesh, with_computed_teeth
from tribodyn.machine.planetary.plane_model import modal_damping, without_free_rotation
from tribodyn.progress import SILENT, Progress
from tribodyn.study.machine.run import MeshWarning, teeth_of_meshes
from tribodyn.study.mesh_inputs import mesh_inputs
from tribodyn.study.pipeline.assembly import geometry
from tribodyn.study.planetary.machine_stages import carrier_body

if TYPE_CHECKING:
    from tribodyn.dynamics import System
    from tribodyn.machine import MeshPhases
    from tribodyn.mesh import MeshTable
    from tribodyn.study.case.case import Case
    from tribodyn.study.machine.load_cases import LoadCase
    from tribodyn.study.planetary.case import PlanetaryCase

MESHES = ("sun", "ring")


class StageTeeth(NamedTuple):
    """Computed teeth of a sun mesh and a ring mesh under one load."""

    pairs: dict[str, Case]
    tables: dict[str, MeshTable]
    laws: dict[str, dict[str, Any]]
    warnings: list[MeshWarning]


def stage_teeth(
    case: PlanetaryCase, load: LoadCase, progress: Progress = SILENT, *, rehearsal: bool = False
) -> StageTeeth:
    """Compute the teeth of one sun mesh and one ring mesh; those of all planets are equal."""
    pairs = case.pairs_under(load)
    inputs = [mesh_inputs(pair) for pair in pairs.values()]
    teeth = teeth_of_meshes(inputs, load, progress, rehearsal=rehearsal)
    results = dict(zip(MESHES, teeth, strict=True))
    warnings: list[ModelWarning]
    listed = []
    for mesh, (_, _, warnings) in results.items():
        listed += [MeshWarning(mesh, load.name, warning) for warning in warnings]
    tables = {mesh: table for mesh, (table, _, _) in results.items()}
    return StageTeeth(pairs, tables, {mesh: law for mesh, (_, law, _) in results.items()}, listed)


def members_of(case: PlanetaryCase) -> dict[str, float]:
    """Masses, and moments of inertia over the square of the radius of u, of all members [kg]."""
    bodies = {mesh: geometry(pair) for mesh, pair in case.pairs.items()}
    values = {}
    for role, mesh in (("sun", "sun"), ("planet", "ring"), ("ring", "ring")):
        gear = getattr(case.table, role)
        side = ("pinion", "wheel")[case.gears_of(mesh).index(gear)]
        body = bodies[mesh]
        values[f"{role}_mass"] = body[f"mass_{side}"]
        inertia = body[f"moment_of_inertia_{side}"]
        values[f"{role}_inertia"] = inertia / body[f"base_radius_{side}"] ** 2
    density, radius = case.pairs["sun"].material.density, case.center_distance
    width = case.gears[case.table.planet].face_width
    mass, inertia = carrier_body(case.table, density, radius, width)
    values |= {"carrier_mass": mass, "carrier_inertia": inertia / radius**2}
    return values


def stage_data(
    case: PlanetaryCase, load: LoadCase, tables: Mapping[str, MeshTable], phases: MeshPhases
) -> dict[str, Any]:
    """Arguments of :func:`planetary_plane_model`, in the direction of the torque on the sun."""
    table, turn, stage = case.table, case.turn(load), case.kinematics(load)
    fixed = case.roles[2]
    pairs = {mesh: case.pairs[mesh].gear_pair for mesh in MESHES}
    sun_radius = geometry(case.pairs["ring"])["base_radius_pinion"]
    sun_radius *= case.gears[table.sun].teeth / case.gears[table.planet].teeth
    return {
        "planets": table.count,
        "phases": phases,
        **members_of(case),
        **{f"{mesh}_mesh_stiffness": _mean_stiffness(tables[mesh]) for mesh in MESHES},
        **{f"{mesh}_pressure_angle": pairs[mesh].operating_pressure_angle for mesh in MESHES},
        "pin_stiffness": table.pin_stiffness,
        **{f"{role}_support": getattr(table, f"{role}_support") for role in case.members},
        f"{fixed}_torsional_support": table.torsional_support,
        "force_per_planet": abs(stage.torques["sun"]) / sun_radius / table.count,
        "carrier_speed": turn * stage.speeds["carrier"],
        "pin_errors": turn * np.array(table.pin_errors or 0.0),
        "thickness_errors": np.array(table.thickness_errors or 0.0),
        "pin_clearance": table.pin_clearance,
        "pin_radius": case.center_distance,
    }


def _mean_stiffness(table: MeshTable) -> float:
    """Mean stiffness about the load, with which modes and load shares are computed [N/m]."""
    functions = table.functions()
    entry = functions.tangent_stiffness or functions.stiffness
    return float(np.mean(entry(table.phase)))


def stage_shares(data: Mapping[str, Any]) -> LoadShares:
    """Static load sharing of the stage, with the carrier at rest."""
    return load_shares(**{**data, "carrier_speed": 0.0})


def stage_system(
    case: PlanetaryCase, load: LoadCase, teeth: StageTeeth, data: Mapping[str, Any]
) -> System:
    """Equations of motion with the force laws and the friction of all meshes."""
    plane = planetary_plane_model(**data)
    at_rest = planetary_plane_model(**{**data, "carrier_speed": 0.0})
    damping = modal_damping(replace(at_rest, contacts=()), case.motion.modal_damping_ratio)
    driven = {"carrier": 2, "ring": 5, "sun": 8}[case.roles[1]]
    balance = np.zeros(plane.size)
    balance[driven] = 1.0  # friction takes part of the torque that the output puts out
    table = case.table
    meshes = []
    for mesh in MESHES:
        names, law = case.gears_of(mesh), teeth.laws[mesh]
        body = Mesh(
            names,
            table.normal_module,
            helix_angle=table.helix_angle,
            hand=case.hand_of(names[0]),
            center_distance=case.center_distance,
            pressure_angle=table.normal_pressure_angle,
            contacts=law["contacts"],
            frictions=law["frictions"],
        )
        gears = case.gears[names[0]], case.gears[names[1]]
        meshes.append(PlanetMesh(mesh, body, gears, names[0] == table.planet))
    return with_computed_teeth(
        replace(without_free_rotation(plane), damping=damping, balance=balance),
        data["phases"],
        meshes,
        sun_drives=case.sun_drives(load),
        thickness_errors=data["thickness_errors"],
    )
