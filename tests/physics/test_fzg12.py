"""The rig with twelve coordinates: benchmark R1 against solutions of its own."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from known_systems import friction_vector
from tribodyn.analysis import mesh_harmonics
from tribodyn.dynamics import (
    FZG12_LIGHT,
    FZG12_MESH_FREQUENCY,
    FZG12_NAMES,
    energy_audit,
    fzg12,
    natural_modes,
    steady_state,
)
from tribodyn.dynamics.structure.fzg12 import BASE_RADIUS, RectangularMesh

PERIOD, HARMONICS = 1.0 / FZG12_MESH_FREQUENCY, 6


def rates(system, stiffness, push):
    """Matrix and constant of the first-order form with a stiffness and a friction direction."""
    (contact,) = system.contacts
    along = np.asarray(contact.direction, dtype=float)
    inverse = np.linalg.inv(system.mass)
    spring = system.stiffness + stiffness * np.outer(along + push, along)
    damper = system.damping + contact.damping * np.outer(along + push, along)
    size = system.size
    matrix = np.zeros((2 * size, 2 * size))
    matrix[:size, size:] = np.eye(size)
    matrix[size:, :size] = -inverse @ spring
    matrix[size:, size:] = -inverse @ damper
    constant = np.concatenate((np.zeros(size), inverse @ system.force))
    return matrix, constant


def exact_harmonics(system):
    """Harmonics of the compression without friction: two linear pieces, solved by exponentials."""
    size = system.size
    pieces = []
    for stiffness, begin, end in ((1.92e8, 0.0, 1 / 3), (1.2e8, 1 / 3, 1.0)):
        matrix, constant = rates(system, stiffness, np.zeros(size))
        span = (end - begin) * PERIOD
        system_matrix = np.zeros((2 * size + 1, 2 * size + 1))
        system_matrix[:-1, :-1], system_matrix[:-1, -1] = matrix, constant
        pieces.append((matrix, constant, begin * PERIOD, end * PERIOD, expm(system_matrix * span)))
    monodromy = pieces[1][-1] @ pieces[0][-1]
    # units of displacement like those of velocity; the rotation of the whole drive is free
    scale = np.concatenate((np.full(size, 1e-4), np.ones(size)))
    step = (np.eye(2 * size) - monodromy[:-1, :-1]) * scale / scale[:, None]
    state = scale * np.linalg.lstsq(step, monodromy[:-1, -1] / scale, rcond=1e-12)[0]
    along = np.asarray(system.contacts[0].direction)
    sums = np.zeros(HARMONICS, dtype=complex)
    for matrix, constant, begin, end, map_ in pieces:
        after = (map_ @ np.append(state, 1.0))[:-1]
        for k in range(HARMONICS):
            turn = 2j * np.pi * (k + 1) / PERIOD
            wave = (np.exp(-turn * end) - np.exp(-turn * begin)) / -turn
            right = after * np.exp(-turn * end) - state * np.exp(-turn * begin) - constant * wave
            part = np.linalg.solve(matrix - turn * np.eye(2 * size), right)
            sums[k] += 2.0 / PERIOD * (along @ part[:size])
        state = after
    return sums


@pytest.fixture(scope="module")
def orbit():
    return steady_state(fzg12(), FZG12_MESH_FREQUENCY, steps=1024)


def compression_harmonics(response):
    return mesh_harmonics(response, response.fine.deflection[:, 0], HARMONICS)


def test_first_elastic_mode_lies_at_492_hertz():
    modes = natural_modes(fzg12())
    assert modes.rigid == 1
    assert modes.frequency[1] == pytest.approx(492.0, abs=1e-6)
    assert modes.linear.spring[0] == pytest.approx(1.44e8, rel=1e-12)
    # it turns the gears against both shaft discs: mostly strain of the shafts
    kinds = modes.strain_by_kind()
    assert kinds["shaft"][1] > 0.8
    assert sum(kind[1] for kind in kinds.values()) == pytest.approx(1.0, rel=1e-9)
    assert natural_modes(fzg12(shaft_stiffness=75398.0)).frequency[1] > 492.0005


def test_static_loads_of_the_benchmark(orbit):
    assert pytest.approx(266.667, abs=5e-4) == FZG12_MESH_FREQUENCY
    force = orbit.fine.mean(orbit.fine.contact_force)[0]
    assert force == pytest.approx(172.0 / BASE_RADIUS[0], rel=1e-6)
    twist = orbit.fine.mean(orbit.fine.position)
    by_name = dict(zip(FZG12_NAMES, twist, strict=True))
    # the motor on shaft 1 drives: its disc runs ahead of the wheel by torque over stiffness
    ahead = by_name["shaft1_theta"] - by_name["wheel_theta"]
    assert ahead == pytest.approx(258.0 / 75397.3113, rel=1e-6)
    assert by_name["pinion_theta"] - by_name["shaft2_theta"] == pytest.approx(
        172.0 / 75397.3113, rel=1e-6
    )


def test_harmonics_against_the_exact_solution_by_exponentials(orbit):
    exact = exact_harmonics(fzg12())
    harmonics = compression_harmonics(orbit)
    np.testing.assert_allclose(harmonics, exact, rtol=1e-5, atol=1e-6 * np.abs(exact[0]))
    # the third harmonic is the dip of a rectangle with a duty of one third
    assert np.abs(exact[2]) < 0.2 * np.abs(exact[3])


def test_harmonics_are_converged_against_doubled_steps(orbit):
    system = fzg12()
    fine = steady_state(system, FZG12_MESH_FREQUENCY, steps=2048)
    np.testing.assert_allclose(
        compression_harmonics(orbit), compression_harmonics(fine), rtol=1e-6, atol=1e-12
    )
    coarse = energy_audit(system, orbit).imbalance
    assert coarse < 5e-6
    assert energy_audit(system, fine).imbalance < 0.3 * coarse


def test_harmonics_with_friction_against_an_adaptive_integrator():
    system = fzg12(friction_coefficient=0.035, torque_balance="both")
    orbit_ = steady_state(fzg12(friction_coefficient=0.035), FZG12_MESH_FREQUENCY, steps=1024)
    (contact,) = system.contacts
    size, edges = system.size, [*contact.events, 1.0]
    along = np.asarray(contact.direction)
    balance = np.linalg.inv(system.mass) @ np.asarray(fzg12().balance)

    def piece(begin, end, start):
        # the levers of friction, and with them the matrix, change in a straight line
        inside = np.array([begin + 1e-9, end - 1e-9])
        (first, constant), (last, _) = (
            rates(system, stiffness, push)
            for stiffness, push in zip(
                contact.stiffness(inside), contact.friction(inside), strict=True
            )
        )
        rise = (last - first) / np.ptp(inside)

        def slope(t, flat):
            z = flat.reshape(2 * size, -1)
            dz = (first + (t / PERIOD - inside[0]) * rise) @ z
            dz[:, -1] += constant
            dz[size:, -2] += balance
            return dz.reshape(-1)

        times = np.linspace(begin, end, 2 * round(300 * (end - begin)) + 1) * PERIOD
        done = solve_ivp(
            slope, times[[0, -1]], start.reshape(-1), "DOP853", times, rtol=1e-9, atol=1e-13
        )
        return times, done.y.reshape(2 * size, -1, times.size)

    state = np.hstack((np.eye(2 * size), np.zeros((2 * size, 2))))
    record = []
    for begin, end in pairwise(edges):
        times, values = piece(begin, end, state)
        record.append((times, values))
        state = values[:, :, -1]
    scale = np.concatenate((np.full(size, 1e-4), np.ones(size)))
    step = np.eye(2 * size) - state[:, : 2 * size]
    step = np.column_stack((step * scale / scale[:, None], -state[:, -2] / scale))
    solved = np.linalg.lstsq(step, state[:, -1] / scale, rcond=1e-10)[0]
    column = np.concatenate((scale * solved[:-1], solved[-1:], [1.0]))
    sums = np.zeros(HARMONICS, dtype=complex)
    for times, values in record:
        signal = along @ np.einsum("ict,c->it", values, column)[:size]
        weight = np.full(times.size, 2.0)
        weight[1::2], weight[[0, -1]] = 4.0, 1.0
        weight *= (times[1] - times[0]) / 3.0
        for k in range(HARMONICS):
            turns = np.exp(-2j * np.pi * (k + 1) * times / PERIOD)
            sums[k] += 2.0 / PERIOD * np.sum(weight * signal * turns)
    torque = orbit_.extra_force @ np.abs(np.asarray(fzg12().balance))
    assert np.abs(solved[-1]) == pytest.approx(np.abs(torque), rel=1e-4)
    np.testing.assert_allclose(
        compression_harmonics(orbit_), sums, rtol=2e-4, atol=1e-5 * np.abs(sums[0])
    )


@pytest.mark.parametrize("driver", ["pinion", "wheel"])
def test_friction_of_the_rectangular_mesh(driver):
    mesh = RectangularMesh(1.2e8, 1.92e8, friction_coefficient=0.1, driver=driver)
    assert len(mesh.event_phases) == 3
    phase = np.linspace(0.0, 1.0, 4000, endpoint=False)
    total = mesh.friction_sum(phase)
    # both pairs slide in the same direction, or against each other and cancel
    assert set(np.round(total, 12)) <= {-0.1, 0.0, 0.1}
    # the pitch point lies near the root of the pinion: it slides mostly one way
    assert total.mean() == pytest.approx(0.1 * (1.0 - 0.226), abs=0.01)
    assert mesh.stiffness(phase).mean() == pytest.approx(1.44e8, rel=1e-3)
    other = "pinion" if driver == "wheel" else "wheel"
    mirrored = RectangularMesh(1.2e8, 1.92e8, friction_coefficient=0.1, driver=other)
    np.testing.assert_allclose(
        np.sort(mesh.friction_moment_pinion(phase)).mean(),
        np.sort(mirrored.friction_moment_pinion(phase)).mean(),
        rtol=1e-3,
    )


def test_friction_is_that_of_the_reference_pair():
    mesh = RectangularMesh(1.2e8, 1.92e8, friction_coefficient=0.1)
    phase = np.array([0.0, 0.1, 0.22, 0.24, 0.32, 0.34, 0.6, 0.99])
    expected = friction_vector(phase, 0.1)
    np.testing.assert_allclose(mesh.friction_sum(phase), expected[:, 0], atol=1e-12)
    np.testing.assert_allclose(mesh.friction_moment_pinion(phase), expected[:, 2], atol=2e-8)
    np.testing.assert_allclose(-mesh.friction_moment_wheel(phase), expected[:, 5], atol=2e-8)
    # driven by the wheel, a pair runs along the same path the other way
    back = RectangularMesh(1.2e8, 1.92e8, friction_coefficient=0.1, driver="wheel")
    moment = back.friction_moment_pinion((4.0 / 3.0 - phase) % 1.0)
    np.testing.assert_allclose(moment[1:], mesh.friction_moment_pinion(phase)[1:], atol=1e-12)


def test_wheel_that_drives_turns_the_effect_of_friction_over():
    # what friction adds to the mean force has the sign of the driver
    means = {}
    for driver in ("pinion", "wheel"):
        system = fzg12(friction_coefficient=0.035, driver=driver)
        response = steady_state(system, FZG12_MESH_FREQUENCY, steps=512)
        means[driver] = response.fine.mean(response.fine.contact_force)[0] * BASE_RADIUS[0] / 172.0
    assert means["pinion"] < 1.0 < means["wheel"]


def ratios_with_friction(**options):
    """Harmonics of the compression with a friction coefficient of 0.035 over those without."""
    sizes = [
        np.abs(
            compression_harmonics(
                steady_state(fzg12(friction_coefficient=friction, **options), FZG12_MESH_FREQUENCY)
            )
        )
        for friction in (0.0, 0.035)
    ]
    return sizes[0], sizes[1] / sizes[0]


def test_strong_fifth_harmonic_is_a_resonance_coincidence():
    modes = natural_modes(fzg12(**FZG12_LIGHT))
    assert modes.frequency[1] == pytest.approx(492.0, abs=1e-3)
    detuned = modes.frequency[2] / (5.0 * FZG12_MESH_FREQUENCY) - 1.0
    assert -0.0035 < detuned < 0.0
    assert modes.damping_ratio[2] < 0.0016
    plain, light = ratios_with_friction(**FZG12_LIGHT)
    # printed: the fifth is the largest and grows by 62 %, and the others by 2, -27, 16 and 27 %
    assert plain[4] == plain.max()
    assert light[4] == pytest.approx(1.62, abs=0.02)
    assert light[3] == pytest.approx(1.25, abs=0.02)
    np.testing.assert_array_equal(np.sign(light[:5] - 1.0), [1, -1, 1, 1, 1])
    assert abs(light[0] - 1.0) < 0.05
    # the pinion drives: the fifth falls; usual damping: it hardly changes
    assert ratios_with_friction(**FZG12_LIGHT, driver="pinion")[1][4] < 0.8
    plain, usual = ratios_with_friction()
    assert plain[4] < 0.2 * plain[0]
    assert abs(usual[4] - 1.0) < 0.02
