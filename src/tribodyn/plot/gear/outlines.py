"""Outlines of both gears near the contact, unloaded and deformed, in the frame of the pair.

The origin of the frame is the pinion's axis. The wheel's axis lies on the horizontal axis, that
of a ring on its negative side, so that the teeth mesh at positive x. Points are complex numbers,
and outlines those of the transverse section.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.contact import path_of_contact
from tribodyn.gear import Material, gear_outline
from tribodyn.types import Array, ComplexArray

if TYPE_CHECKING:
    from tribodyn.gear import SpurGear
    from tribodyn.gear.mesh_geometry import MeshGeometry
    from tribodyn.stiffness import LoadedContact

#: Points of each tooth, enough for a smooth trochoid.
_TOOTH_POINTS = 60
#: Least fraction of the total force that is plotted; teeth on each side of the middle tooth.
_LOADED, _TEETH = 1e-3, 2


def on_line_of_action(pair: MeshGeometry, path: object) -> Array:
    """Coordinates in the plane of positions on the line of action [m]."""
    angle, radius = pair.operating_pressure_angle, pair.pinion.base_radius
    along = np.asarray(path, dtype=float)
    x = radius * math.cos(angle) + along * math.sin(angle)
    y = -radius * math.sin(angle) + along * math.cos(angle)
    return np.array([x, y])


def wheel_center(pair: MeshGeometry) -> float:
    """Position of the wheel's axis on the horizontal axis [m]."""
    return pair.wheel.sign * pair.center_distance


def tooth_angles(pair: MeshGeometry, path: float) -> tuple[float, float]:
    """Angles of the pinion tooth and the wheel tooth that touch at a position [rad]."""
    x, y = on_line_of_action(pair, path)
    places = ((pair.pinion, x, y), (pair.wheel, x - wheel_center(pair), y))
    first, second = (
        math.atan2(v, u) - gear.sign * float(gear.half_tooth_angle(math.hypot(u, v)))
        for gear, u, v in places
    )
    return first, second


def placed_outline(
    gear: SpurGear, center: float, angle: float, points: int = _TOOTH_POINTS
) -> Array:
    """Outline of an entire gear about its centre."""
    x, y = gear_outline(gear, points)
    turned = (x + 1j * y) * cmath.exp(1j * (angle - math.pi / 2.0))
    return np.array([center + turned.real, turned.imag])


def circle(center: float, radius: float) -> Array:
    """Points of a circle about a point of the horizontal axis."""
    angle = np.linspace(0.0, 2.0 * np.pi, 181)
    return np.array([center + radius * np.cos(angle), radius * np.sin(angle)])


def rotation_arc(center: float, radius: float, sense: int) -> Array:
    """Points of an arc above a gear's axis, in the sense of rotation."""
    angle = 0.5 * np.pi + sense * np.linspace(-0.25 * np.pi, 0.25 * np.pi, 25)
    return np.array([center + radius * np.cos(angle), radius * np.sin(angle)])


@dataclass(frozen=True)
class Load:
    """Load on one tooth pair."""

    path: float  #: position on the line of action where perfect involutes touch [m]
    pinion_curvature_radius: float  #: [m]
    wheel_curvature_radius: float  #: [m]
    force: float  #: normal force [N]


@dataclass(frozen=True, eq=False)
class BentMesh:
    """Outlines and displacements of both gears near the contact at a mesh phase."""

    outline: dict[str, ComplexArray]  #: of ``"pinion"`` and ``"wheel"`` without load [m]
    displacement: dict[str, ComplexArray]  #: [m]
    contact: ComplexArray  #: contact points of the loaded pairs, undeformed [m]
    shift: ComplexArray  #: displacement of these points [m]
    loads: list[Load]  #: on these pairs


def loads_at(contact: LoadedContact, phase: int, torque: int = 0) -> list[Load]:
    """Loads of the tooth pairs that carry load at a mesh phase."""
    shape = contact.normal_force.shape
    force = contact.normal_force.reshape(-1, *shape[-2:])[torque, phase]
    return [
        Load(
            float(contact.path[phase, k]),
            float(contact.pinion_curvature_radius[phase, k]),
            float(contact.wheel_curvature_radius[phase, k]),
            float(force[k]),
        )
        for k in np.flatnonzero(force > _LOADED * force.sum())
    ]


def _bent_outline(
    gear: SpurGear,
    center: float,
    angle: float,
    loads: list[tuple[int, float, float]],
    reference: str,
) -> tuple[ComplexArray, ComplexArray]:
    """Outline and displacement of a gear whose tooth 0 points in the direction ``angle``."""
    from tribodyn.stiffness.fe2d import deformed_gear

    # Models without a reference are plotted as if fixed at the bore.
    support = "rim" if reference == "rim" or gear.bore_diameter == 0.0 else "bore"
    middle = gear.base_radius * gear.roll_angle(0.5 * (gear.form_radius + gear.tip_radius))
    # Unloaded teeth are included, so that every phase shows the same teeth.
    loaded_teeth = {tooth for tooth, _, _ in loads}
    unloaded = [(k, middle, 0.0) for k in range(1 - _TEETH, _TEETH) if k not in loaded_teeth]
    outline, moved = deformed_gear(gear, Material(), [*loads, *unloaded], reference=support)
    # deformed_gear loads the right flank; this frame the left one of teeth that point outwards.
    turn, mirror = cmath.exp(1j * (angle - 0.5 * math.pi)), -gear.sign
    across, shift = mirror * outline[0], mirror * moved[0]
    return center + turn * (across + 1j * outline[1]), turn * (shift + 1j * moved[1])


def _contact_point(
    gear: SpurGear, center: float, angle: float, tooth: int, radius: float
) -> complex:
    """Point on the loaded flank of a gear with a radius of curvature."""
    distance = math.hypot(gear.base_radius, radius)
    distance = gear.sign * min(gear.sign * distance, gear.sign * gear.tip_radius)
    direction = angle + 2.0 * math.pi * tooth / abs(gear.teeth)
    half = gear.sign * float(gear.half_tooth_angle(distance))
    return center + cmath.rect(distance, direction + half)


def bent_mesh(contact: LoadedContact, phase: int, torque: int = 0) -> BentMesh:
    """Deform both gears by the loads of a mesh phase."""
    pair, loads = contact.gear_pair, loads_at(contact, phase, torque)
    path = path_of_contact(pair)
    middle = 0.5 * (path.A + path.E)
    anchor = float(contact.path[phase, np.argmin(np.abs(contact.path[phase] - middle))])
    steps = [round((load.path - anchor) / pair.base_pitch) for load in loads]
    width, centers = pair.common_face_width, {"pinion": 0.0, "wheel": wheel_center(pair)}
    outline = {}
    moved = {}
    angles = dict(zip(("pinion", "wheel"), tooth_angles(pair, anchor), strict=True))
    places: dict[str, list[complex]] = {}
    shifts: dict[str, list[complex]] = {}
    for name, sense in (("pinion", 1), ("wheel", -pair.wheel.sign)):
        radii = [abs(getattr(load, f"{name}_curvature_radius")) for load in loads]
        # Teeth are numbered towards larger radii of curvature of this gear.
        tooth_loads = [
            (sense * step, radius, load.force / width)
            for step, radius, load in zip(steps, radii, loads, strict=True)
        ]
        placement = getattr(pair, name), centers[name], angles[name]
        outline[name], moved[name] = _bent_outline(*placement, tooth_loads, contact.reference)
        places[name] = [_contact_point(*placement, *tooth_load[:2]) for tooth_load in tooth_loads]
        nearest = [int(np.argmin(np.abs(outline[name] - place))) for place in places[name]]
        shifts[name] = [complex(moved[name][at]) for at in nearest]
    normal = cmath.rect(1.0, 0.5 * math.pi - pair.operating_pressure_angle)
    forces = np.array([load.force for load in loads])
    approach = (np.array(shifts["wheel"]) - np.array(shifts["pinion"])) * normal.conjugate()
    driver, driving = pair.driver, pair.driving
    turn = float(np.average(approach.real, weights=forces)) / (driving.sign * driving.base_radius)
    moved[driver] = moved[driver] + 1j * turn * (outline[driver] - centers[driver])
    driven = "wheel" if driver == "pinion" else "pinion"
    return BentMesh(outline, moved, np.array(places[driven]), np.array(shifts[driven]), loads)
