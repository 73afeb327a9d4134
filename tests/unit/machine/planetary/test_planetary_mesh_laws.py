"""Computed teeth in the plane model: directions of all meshes, and the lag of the ring meshes."""

import math
from itertools import product

import numpy as np
import pytest

from known_planetary import LIN_PARKER
from plain.planet_meshes import PlanetMesh, with_computed_teeth
from tribodyn.dynamics import Contact
from tribodyn.gear import cylindrical_pair, gear_outline
from tribodyn.machine import Gear, Mesh, mesh_phases, planetary_plane_model
from tribodyn.machine.planetary.mesh_laws import sun_to_ring_lag

MODULE, ALPHA = 4e-3, math.radians(20.0)


def planet_mesh(member, teeth, planet_first, sun_drives):
    """Mesh whose contact is that of a pair: y towards the driven gear, theta as it runs."""
    radii = [abs(count) * MODULE / 2 * math.cos(ALPHA) for count in teeth]
    first_drives = (sun_drives == (member == "sun")) != planet_first
    along = np.array([0.0, 1.0, radii[0], 0.0, -1.0, -radii[1]])
    contact = Contact(along if first_drives else -along, 1.0)
    mesh = Mesh(("a", "b"), MODULE, center_distance=78e-3, contacts=(contact,))
    gears = tuple(Gear("x", None, count, 1.0) for count in teeth)
    return PlanetMesh(member, mesh, gears, planet_first)


@pytest.mark.parametrize(("drives", "planet_first"), list(product([True, False], repeat=2)))
def test_pairs_in_the_plane_model_act_along_its_lines_of_action(drives, planet_first):
    phases = mesh_phases(
        sun_teeth=17, ring_teeth=61, planets=3, angles=np.array([0, 26, 53]) * 2 * np.pi / 78
    )
    data = LIN_PARKER | {"sun_pressure_angle": ALPHA, "ring_pressure_angle": ALPHA}
    plane = planetary_plane_model(planets=3, phases=phases, **data)
    sun = planet_mesh("sun", (22, 17) if planet_first else (17, 22), planet_first, drives)
    ring = planet_mesh("ring", (22, -61), True, drives)
    stage = with_computed_teeth(
        plane, phases, (sun, ring), sun_drives=drives, thickness_errors=[0.0, 2e-6, 0.0]
    )
    for contact, expected in zip(stage.contacts, plane.contacts, strict=True):
        np.testing.assert_allclose(contact.direction, expected.direction, atol=1e-12)
        # Backwards the meshes of the planets lead by as much.
        shift = contact.offset + (-1 if drives else 1) * expected.offset
        assert abs(shift - round(shift)) < 1e-12
    assert [contact.error for contact in stage.contacts] == [0.0, -1e-6, 0.0] * 2


def crossings(outline, normal, foot):
    """Distances from the foot along a line of action at which an outline is normal to it."""
    points = (outline - foot) / normal
    side = np.flatnonzero(np.diff(np.sign(points.imag)))
    first, second = points[side], points[side + 1]
    across = np.abs((second - first).real) < 0.1 * np.abs((second - first).imag)
    first, second = first[across], second[across]
    part = first.imag / (first.imag - second.imag)
    return first.real + part * (second.real - first.real)


@pytest.mark.parametrize(
    ("teeth", "shifts", "drives"),
    [
        ((17, 22, -61), (0.0, 0.0, 0.0), True),
        ((17, 22, -61), (0.3, 0.1, -0.52), False),
        ((34, 19, -72), (-0.2, 0.3, -0.42), True),
    ],
)
def test_lag_of_the_ring_mesh_is_that_of_a_turned_outline(teeth, shifts, drives):
    common = {"normal_module": MODULE, "normal_pressure_angle": ALPHA, "helix_angle": 0.0}
    order = sorted(range(2), key=lambda i: teeth[i])
    sun_pair = cylindrical_pair(
        pinion_teeth=teeth[order[0]], wheel_teeth=teeth[order[1]], pinion_face_width=0.05,
        pinion_profile_shift_coefficient=shifts[order[0]],
        wheel_profile_shift_coefficient=shifts[order[1]], **common,
    )  # fmt: skip
    ring_pair = cylindrical_pair(
        pinion_teeth=teeth[1], wheel_teeth=teeth[2], pinion_face_width=0.05,
        pinion_profile_shift_coefficient=shifts[1], wheel_profile_shift_coefficient=shifts[2],
        center_distance=sun_pair.center_distance, **common,
    )  # fmt: skip
    planet = ring_pair.pinion
    x, y = gear_outline(planet, 400)
    # Lines of action on both sides of a planet that the sun turns clockwise: feet on the base
    # circle and directions towards the contact, in which radii of curvature grow.
    alphas = sun_pair.operating_pressure_angle, ring_pair.operating_pressure_angle
    sun_foot = -planet.base_radius * np.exp(-1j * alphas[0])
    ring_foot = planet.base_radius * np.exp(1j * alphas[1])
    sun_line, ring_line = -1j * np.exp(-1j * alphas[0]), -1j * np.exp(1j * alphas[1])
    lags = []
    pitch = planet.base_pitch
    reach = sun_pair.path_limits
    if sun_pair.pinion.teeth != planet.teeth:
        reach = [sun_pair.line_of_action_length - path for path in sun_pair.path_limits[::-1]]
    for turn in (0.1, 0.13):
        outline = (x + 1j * y) * np.exp(1j * turn)
        sun_radius = max(r for r in crossings(outline, sun_line, sun_foot) if r <= reach[1])
        inside = crossings(outline, ring_line, ring_foot)
        ring_radius = min(r for r in inside if r >= ring_pair.path_limits[0])
        # Radii fall in the sun mesh and grow in the ring mesh while the sun drives.
        begin = reach[1 if drives else 0], ring_pair.path_limits[0 if drives else 1]
        sign = 1 if drives else -1
        sun_phase = sign * (begin[0] - sun_radius) / pitch
        ring_phase = sign * (ring_radius - begin[1]) / pitch
        lags.append(sign * (sun_phase - ring_phase) % 1.0)
    lag = sun_to_ring_lag(sun_pair, ring_pair, sun_drives=drives)
    np.testing.assert_allclose(lags, lag, atol=2e-3)
