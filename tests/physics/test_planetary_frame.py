"""Coriolis and centripetal terms in the frame of the carrier, against other equations."""

import numpy as np
import pytest

from known_planetary import ALPHA, LIN_PARKER
from tribodyn.machine import planetary_modes, planetary_plane_model
from tribodyn.machine.planetary.plane_model import without_free_rotation

FREE = {"carrier_support": 0.0, "ring_support": 0.0, "sun_support": 0.0}


def matrices(system):
    """Mass, gyroscopic and stiffness matrix with closed contacts."""
    stiffness = np.array(system.stiffness)
    for contact in system.contacts:
        along = np.asarray(contact.direction)
        stiffness += contact.stiffness * np.outer(along, along)
    return np.asarray(system.mass), np.asarray(system.gyroscopic), stiffness


def roots(mass, gyroscopic, stiffness):
    """Eigenvalues of ``M q'' + G q' + K q = 0``, time in ms."""
    inverse, size = np.linalg.inv(mass), len(mass)
    state = np.block([
        [np.zeros((size, size)), np.eye(size)],
        [-1e-6 * inverse @ stiffness, -1e-3 * inverse @ gyroscopic],
    ])  # fmt: skip
    return 1e3 * np.linalg.eigvals(state)


def lin_parker(planets, speed, turning):
    """The same matrices by springs, with radial and tangential coordinates of the planets."""
    size, data = 9 + 3 * planets, LIN_PARKER
    members = [(5.43, 6.29), (2.35, 3.00), (0.40, 0.39)] + [(0.66, 0.61)] * planets
    mass = np.diag([value for m, i in members for value in (m, m, i)])
    gyroscopic, stiffness = np.zeros((size, size)), np.zeros((size, size))
    stiffness[range(9), range(9)] = [1e8, 1e8, turning, 1e8, 1e8, 1e9, 1e8, 1e8, 0.0]
    for number, (m, _) in enumerate(members):
        x = 3 * number
        gyroscopic[x, x + 1], gyroscopic[x + 1, x] = -2 * m * speed, 2 * m * speed
        stiffness[[x, x + 1], [x, x + 1]] -= m * speed**2
    for planet in range(planets):
        psi, p = 2 * np.pi * planet / planets, 9 + 3 * planet
        along = np.zeros((4, size))
        at = psi - ALPHA, psi + ALPHA
        along[0, 6:9] = -np.sin(at[0]), np.cos(at[0]), 1.0
        along[0, p : p + 3] = -np.sin(ALPHA), -np.cos(ALPHA), 1.0
        along[1, 3:6] = -np.sin(at[1]), np.cos(at[1]), 1.0
        along[1, p : p + 3] = np.sin(ALPHA), -np.cos(ALPHA), -1.0
        along[2, :2], along[2, p] = (np.cos(psi), np.sin(psi)), -1.0
        along[3, :3], along[3, p + 1] = (-np.sin(psi), np.cos(psi), 1.0), -1.0
        springs = data["sun_mesh_stiffness"], data["ring_mesh_stiffness"], 1e8, 1e8
        stiffness += (along.T * springs) @ along
    return mass, gyroscopic, stiffness


@pytest.mark.parametrize("planets", [3, 4])
def test_frequencies_over_the_carrier_speed_are_those_of_lin_and_parker(planets):
    # The carrier hardly turns, where the equations differ by the pull of the planets on it.
    speed, turning = 900.0, 1e14
    stage = planetary_plane_model(
        planets=planets, carrier_speed=speed, **LIN_PARKER, carrier_torsional_support=turning
    )
    values = roots(*lin_parker(planets, speed, turning))
    assert np.abs(values.real).max() < 1e-9 * np.abs(values).max()
    expected = np.sort(values.imag[values.imag > 0.0]) / (2 * np.pi)
    # The plane model leaves out none of them; the carrier's stiff mode is far above.
    modes = planetary_modes(stage)
    np.testing.assert_allclose(modes.frequency[:-1], expected[:-1], rtol=1e-7)
    # Pairs of translational modes split: at rest they are equal to rounding.
    translational = modes.of_type("translational")[:2]
    assert translational[1] / translational[0] > 1.1


def test_a_free_stage_moves_straight_on():
    """Seen from its turning frame, a body that moves straight on turns at the speed of it."""
    speed = 400.0
    data = {**LIN_PARKER, **FREE, "ring_torsional_support": 0.0}
    size = np.abs(roots(*matrices(planetary_plane_model(planets=3, carrier_speed=speed, **data))))
    # Straight on along x and y: i W and -i W, each double. The two free rotations: four zeros.
    assert np.count_nonzero(np.abs(size - speed) < 1e-5 * speed) == 4
    assert np.count_nonzero(size < 1e-5 * speed) == 4


def test_a_rotation_of_the_whole_stage_is_free_of_force():
    stage = planetary_plane_model(planets=3, carrier_speed=300.0, **LIN_PARKER)
    modes = planetary_modes(stage)
    assert modes.frequency[0] == 0.0 < modes.frequency[1]
    rigid = np.real(modes.shape[0])
    reduced = without_free_rotation(stage)
    gyroscopic = np.asarray(reduced.gyroscopic)
    np.testing.assert_allclose(gyroscopic, -gyroscopic.T, atol=1e-9)
    scale = np.abs(np.asarray(stage.gyroscopic)).max()
    assert np.abs(gyroscopic @ rigid).max() < 1e-10 * scale < np.abs(stage.gyroscopic @ rigid).max()
