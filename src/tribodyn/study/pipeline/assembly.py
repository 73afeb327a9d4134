"""Geometry of a case, and the structure that vibrates, with the damping in force."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.study.case.hypoid import bodies, contact_ratio, levers
from tribodyn.study.case.provenance import effective
from tribodyn.study.case.to_models import chosen_options, mesh_law_of
from tribodyn.study.mesh_inputs import MeshInputs, mesh_inputs
from tribodyn.study.pipeline.tooth_contact import load_friction_of
from tribodyn.types import Array, Tree

if TYPE_CHECKING:
    from tribodyn.dynamics import Campbell, Contact, MeshForce, System
    from tribodyn.gear import HypoidFlanks, SpurGear, SpurPair
    from tribodyn.mesh import MeshFriction, MeshFunctions, MeshTable
    from tribodyn.mesh.table_file import TableFile
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.case.sections import Dynamics


#: Modifications that are one figure each.
_AMOUNTS = (
    "tip_relief",
    "root_relief",
    "profile_crowning",
    "profile_slope",
    "crowning",
    "lead_slope",
    "end_relief",
    "flank_twist",
    "run_out",
)

#: Figures of the geometry of helical and internal pairs alone.
_OF_HELIX = (
    "helix_angle",
    "base_helix_angle",
    "working_helix_angle",
    "transverse_pressure_angle",
    "working_transverse_pressure_angle",
    "overlap_ratio",
    "total_contact_ratio",
    "least_contact_line_length",
    "mean_contact_line_length",
    "greatest_contact_line_length",
)
#: Mesh harmonics whose critical speeds are reported.
ORDERS = (1, 2, 3, 4, 5)
#: Number of speeds of a diagram, and its top speed over the operating speed or last resonance.
_SPEEDS, _BEYOND = 201, 1.15


def geometry(case: PairCase) -> dict[str, float]:
    """Geometry, masses and inertias that follow from a case."""
    if case.mesh_table is not None:
        return _of_mesh_table(case, case.mesh_table)
    if case.hypoid_flanks is not None:
        return _of_hypoid(case, case.hypoid_flanks)

    def of_spur() -> dict[str, float]:
        densities = case.density("pinion"), case.density("wheel")
        return _of_spur(case.gear_pair, *densities, case.backlash)

    return dict(case._once("geometry", ("gears", "dynamics", "material"), of_spur))


@lru_cache(maxsize=8)
def _of_spur(
    pair: SpurPair, density_pinion: float, density_wheel: float, backlash: float
) -> dict[str, float]:
    """Geometry of a cylindrical pair; a study uses it under many loads."""
    from tribodyn.contact import gear_loss_factor, path_of_contact

    values = {
        "transverse_contact_ratio": pair.transverse_contact_ratio,
        "gear_ratio": pair.ratio,
        "operating_pressure_angle": pair.operating_pressure_angle,
        "center_distance": pair.center_distance,
        "tip_shortening_coefficient": pair.tip_shortening_coefficient,
        "base_pitch": pair.base_pitch,
        "line_of_action_length": pair.line_of_action_length,
        "common_face_width": pair.common_face_width,
        "backlash": backlash,
        "gear_loss_factor": gear_loss_factor(pair),
    }
    if pair.helix_angle:
        values["axial_pitch"] = pair.axial_pitch
    if pair.helix_angle or pair.is_internal:
        values |= {name: getattr(pair, name) for name in _OF_HELIX}
    for place, angle in path_of_contact(pair).roll_angles.items():
        values[f"roll_angle_{place}"] = angle
    bodies = {
        "pinion": _body(pair.pinion, density_pinion),
        "wheel": _body(pair.wheel, density_wheel),
    }
    for key in bodies["pinion"]:
        for name, body in bodies.items():
            values[f"{key}_{name}"] = body[key]
    values |= _modifications(pair)
    return {name: float(value) for name, value in values.items()}


def _of_mesh_table(case: PairCase, table: TableFile) -> dict[str, float]:
    """What is known of gears behind a mesh table: levers, and the bodies that the case gives."""
    values = {"gear_ratio": case.gear_ratio, "backlash": case.backlash}
    for name, gear in (("pinion", case.gears.pinion), ("wheel", case.gears.wheel)):
        values[f"base_radius_{name}"] = table.lever(f"{name}_theta")
        for key in ("mass", "moment_of_inertia"):
            if getattr(gear, key) is not None:
                values[f"{key}_{name}"] = getattr(gear, key)
    return {name: float(value) for name, value in values.items()}


#: Dimensions of a blank in the summary, of the pair and of each gear.
_BLANK = (
    "mean_normal_module",
    "limit_pressure_angle",
    "normal_pressure_angle_drive",
    "normal_pressure_angle_coast",
    "offset_angle_pitch",
)
_CONES = (
    "pitch_angle",
    "mean_spiral_angle",
    "mean_cone_distance",
    "mean_pitch_diameter",
    "outer_tip_diameter",
    "face_angle",
    "root_angle",
)


def _of_hypoid(case: PairCase, flanks: HypoidFlanks) -> dict[str, float]:
    """Blank of a hypoid pair, its levers and its bodies."""
    blank, body = flanks.blank, bodies(flanks, case.material.density, case.gears)
    values: Tree = {
        "gear_ratio": case.gear_ratio,
        "backlash": case.backlash,
        "transverse_contact_ratio": contact_ratio(case.gears),
        **{name: getattr(blank, name) for name in _BLANK},
    }
    for key in _CONES:
        values |= {f"{key}_{gear}": getattr(blank, f"{key}_{gear}") for gear in body}
    for (name, solid), lever in zip(body.items(), levers(flanks), strict=True):
        values[f"base_radius_{name}"] = lever
        values[f"face_width_{name}"] = getattr(blank, f"face_width_{name}")
        values[f"mass_{name}"] = solid.mass
        values[f"moment_of_inertia_{name}"] = solid.moment_of_inertia
    return {name: float(value) for name, value in values.items()}


def _body(gear: SpurGear, density: float) -> dict[str, float]:
    from tribodyn.gear import mass_properties

    solid = mass_properties(gear, density)
    return {
        "reference_diameter": 2.0 * gear.reference_radius,
        "base_radius": gear.base_radius,
        "tip_diameter": 2.0 * gear.tip_radius,
        "root_diameter": 2.0 * gear.root_radius,
        "tip_thickness": gear.tip_thickness,
        "tooth_thinning": gear.tooth_thinning,
        "face_width": gear.face_width,
        "mass": solid.mass,
        "moment_of_inertia": solid.moment_of_inertia,
    }


def _modifications(pair: SpurPair) -> dict[str, float]:
    """Amounts that are not zero, with the lengths of the reliefs in force."""
    from tribodyn.gear import default_relief_length, hunting_period
    from tribodyn.gear.flank_gap import END_RELIEF_LENGTH

    lengths = dict.fromkeys(("tip_relief", "root_relief"), default_relief_length(pair))
    values = {"misalignment": pair.misalignment} if pair.misalignment else {}
    for name, gear in (("pinion", pair.pinion), ("wheel", pair.wheel)):
        modification = gear.modification
        lengths["end_relief"] = END_RELIEF_LENGTH * gear.face_width
        for key in _AMOUNTS:
            if getattr(modification, key) != 0.0:
                values[f"{key}_{name}"] = getattr(modification, key)
                if key in lengths:
                    length = getattr(modification, f"{key}_length")
                    values[f"{key}_length_{name}"] = lengths[key] if length is None else length
    if pair.has_pitch_deviation:
        values["hunting_period"] = hunting_period(pair)
    return values


@dataclass(frozen=True)
class Damping:
    """Damping coefficients of a case."""

    mesh: float  #: of the tooth contact along the line of action [N*s/m]
    bearing_pinion: float  #: [N*s/m]
    bearing_wheel: float  #: [N*s/m]


def equivalent_mass(
    inertia_pinion: float, inertia_wheel: float, radius_pinion: float, radius_wheel: float
) -> float:
    """Mass that vibrates along the line of action when both gears turn freely."""
    weighted = inertia_pinion * radius_wheel**2 + inertia_wheel * radius_pinion**2
    return inertia_pinion * inertia_wheel / weighted


def damping_of(case: PairCase, mesh: MeshTable) -> Damping:
    """Damping of a case."""
    body = geometry(case)
    supports = _supports(case, (body.get("mass_pinion", 0.0), body.get("mass_wheel", 0.0)))
    return Damping(mesh_damping(mesh_inputs(case), mesh), *supports)


def mesh_damping(inputs: MeshInputs, mesh: MeshTable) -> float:
    """Damping of the teeth of a mesh along the line of action [N*s/m]."""
    data = inputs.dynamics
    if data.mesh_damping is not None:
        return float(data.mesh_damping)
    mass = equivalent_mass(*inputs.inertias, *inputs.base_radii)
    return float(2.0 * data.mesh_damping_ratio * math.sqrt(mesh.mean_mesh_stiffness * mass))


def _supports(case: PairCase, masses: tuple[float, float]) -> tuple[float, float]:
    from tribodyn.dynamics.structure.structures import support_damping

    names = ("bearing_stiffness", "bearing_damping", "bearing_damping_ratio")
    values = [effective(case).get(f"dynamics.{name}") for name in names]
    return support_damping(values[0], masses, values[1], values[2])


def static_error(data: Dynamics, phase: Array | float) -> Array:
    """Static transmission error of a mesh: a cosine at mesh frequency."""
    amplitude = data.transmission_error_amplitude
    if amplitude == 0.0:
        return np.zeros(np.shape(phase))
    angle = 2.0 * np.pi * np.asarray(phase) + data.transmission_error_phase
    return np.asarray(amplitude * np.cos(angle))


def contact_values(inputs: MeshInputs, damping: float) -> Tree:
    """Damping, backlash and error of the contact of a mesh."""
    data, error = inputs.dynamics, {}
    if data.transmission_error_amplitude > 0.0:
        error = {"error": lambda phase: static_error(data, phase)}
    in_gap = data.damping_in_gap
    values = {"mesh_damping": damping, "backlash": inputs.backlash, "damping_in_gap": in_gap}
    return {**values, **error}


def mesh_contacts(
    inputs: MeshInputs, mesh: MeshFunctions, damping: float, mesh_force: MeshForce
) -> tuple[tuple[str, ...], tuple[Contact, ...]]:
    """Coordinates of the gears of a mesh, and the contacts of its teeth over them."""
    from tribodyn.dynamics.structure.structures import pair_contacts

    values = {"error": 0.0, **contact_values(inputs, damping)}
    of_gears: Any = {"base_radius": inputs.base_radii, "driver": inputs.driver}
    return pair_contacts(mesh, inputs.axes, **of_gears, mesh_force=mesh_force, **values)


def system_of(
    case: PairCase,
    mesh: MeshTable,
    damping: Damping,
    friction: MeshFriction | None = None,
    mesh_force: str | None = None,
) -> System:
    """Build the structure of a case with its tooth contact; ``mesh_force`` overrides its law."""
    from tribodyn.dynamics import follow_load

    law = mesh_law_of(case) if mesh_force is None else mesh_force
    system = structure_of(case, mesh.functions(), damping, law)
    return system if friction is None else follow_load(system, friction)


def whole_system(
    case: PairCase, mesh: MeshTable, mesh_force: str | None = None, *, rehearsal: bool = False
) -> System:
    """Build the structure of a case with its tooth contact, its damping and its friction."""
    friction = load_friction_of(mesh_inputs(case), mesh, rehearsal)
    return system_of(case, mesh, damping_of(case, mesh), friction, mesh_force)


def structure_of(case: PairCase, mesh: MeshFunctions, damping: Damping, mesh_force: str) -> System:
    """Build the structure of a case with a mesh, whose force law is named."""
    from tribodyn.dynamics import STRUCTURES, Gearing
    from tribodyn.dynamics.structure.force_law import refuse_clamped_teeth
    from tribodyn.gear.flank_gap import least_gap

    if mesh_force == "force-law" and case.spur_pair is not None:
        # Not by the law alone, which knows the gap at its phases only.
        refuse_clamped_teeth(least_gap(case.spur_pair), 0.5 * case.backlash)
    body, torque = geometry(case), case.pinion_torque
    contact = {
        **contact_values(mesh_inputs(case), damping.mesh),
        "driver": case.gears.driver,
        "torque_balance": case.operation.torque_balance,
        "mesh_force": mesh_force,
    }
    gearing = Gearing(
        mesh,
        mass=(body.get("mass_pinion", 0.0), body.get("mass_wheel", 0.0)),
        moment_of_inertia=(body["moment_of_inertia_pinion"], body["moment_of_inertia_wheel"]),
        base_radius=(body["base_radius_pinion"], body["base_radius_wheel"]),
        torque=(torque, torque * case.gear_ratio),
        contact=contact,
    )
    return STRUCTURES[case.dynamics.model](gearing, **chosen_options(case, "dynamics"))


def rotation_of(case: PairCase, names: Sequence[str]) -> Array | None:
    """Change of the coordinates in a mesh cycle of the drive [rad]; None where one is unknown."""
    from tribodyn.dynamics import STRUCTURES

    gears = {name: 2.0 * np.pi / abs(gear.teeth) for name, gear in case.gears.by_name.items()}
    turns = {f"{gear}_theta": angle for gear, angle in gears.items()}
    turns_with = STRUCTURES[case.dynamics.model].turns_with
    turns |= {name: gears[gear] for name, gear in turns_with.items()}
    turning = [name for name in names if name.endswith("theta")]
    if any(name not in turns for name in turning):
        return None
    return np.array([turns[name] if name in turning else 0.0 for name in names])


def shaft_coordinates(case: PairCase, system: System) -> dict[str, int]:
    """Number of the coordinate on which the torque of the shaft of each gear acts."""
    from tribodyn.dynamics import STRUCTURES

    turns_with = STRUCTURES[case.dynamics.model].turns_with
    names, force = list(system.names), np.asarray(system.force)
    places = {}
    for gear in case.gears.by_name:
        ends = [name for name, of in turns_with.items() if of == gear and force[names.index(name)]]
        places[gear] = names.index((ends or [f"{gear}_theta"])[0])
    return places


def diagram_of(
    system: System,
    case: PairCase,
    mesh_frequency: float,
    ends: Sequence[float] | None = None,
    orders: Iterable[int] = ORDERS,
) -> Campbell:
    """Campbell diagram of the structure of a case, with its operating speed marked."""
    from tribodyn.dynamics import campbell as compute
    from tribodyn.dynamics import natural_modes as modes_of

    now = case.operation.speed
    if ends is None:
        modes = modes_of(system)
        mesh_mode = modes.frequency[int(np.argmax(modes.contact_share))] if modes.contacts else 0.0
        top = _BEYOND * max(now, now * float(mesh_mode) / mesh_frequency)
        ends = [top / _SPEEDS, top]
    gear = getattr(case.gears, case.operation.speed_of)
    diagram = compute(
        system, np.linspace(ends[0], ends[1], _SPEEDS), teeth=gear.teeth, orders=orders
    )
    return replace(diagram, operating_speed=now)
