"""Run-up and run-down against independent solutions, limits and identities."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from known_systems import hysteresis_system, reference_system
from references.backlash_orbits import HIGH, LOW
from tribodyn.analysis import rms
from tribodyn.dynamics import (
    Contact,
    LoadFriction,
    SpeedProfile,
    System,
    run_up,
    speed_ramp,
    steady_state,
)

BALANCE = [0.0, 0.0, 0.0, 0.0, 0.0, -1.0]


def oscillator() -> System:
    """One degree of freedom near 0.16 Hz: error and stiffness pulsate, damping acts on the rate."""
    contact = Contact(
        [1.0],
        stiffness=lambda p: 1.0 + 0.2 * np.cos(2 * np.pi * p),
        error=lambda p: 0.1 * np.cos(2 * np.pi * p) + 0.03 * np.sin(4 * np.pi * p),
        damping=0.05,
    )
    return System([[1.0]], [[0.02]], [[0.0]], [0.0], [contact])


def exact(time: np.ndarray) -> np.ndarray:
    """Position of the oscillator: 0.05 to 0.35 Hz in 60 s and back to 0.1 Hz in 30 s."""

    def motion(rate: float, beat: float, first: float):
        def right(t: float, y: np.ndarray) -> list[float]:
            turns = 2 * np.pi * (first + beat * t + 0.5 * rate * t * t)
            speed = 2 * np.pi * (beat + rate * t)
            error = 0.1 * np.cos(turns) + 0.03 * np.sin(2 * turns)
            slope = (-0.1 * np.sin(turns) + 0.06 * np.cos(2 * turns)) * speed
            force = (1.0 + 0.2 * np.cos(turns)) * (y[0] - error) + 0.05 * (y[1] - slope)
            return [y[1], -0.02 * y[1] - force]

        return right

    options = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-12, "dense_output": True}
    up = solve_ivp(motion(0.005, 0.05, 0.0), (0.0, 60.0), [0.1, 0.0], **options)
    down = solve_ivp(motion(-0.25 / 30, 0.35, 12.0), (0.0, 30.0), up.y[:, -1], **options)
    late = down.sol(np.maximum(time - 60.0, 0.0))[0]
    return np.where(time <= 60.0, up.sol(np.minimum(time, 60.0))[0], late)


def test_a_longer_clock_is_the_same_run() -> None:
    profile = ([0.0, 60.0], [0.1, 0.3])
    options = {"samples": 16, "steps": 256, "start": ([0.1], [0.0]), "teeth": 6}
    single = run_up(oscillator(), profile, **options)
    pair = replace(oscillator().contacts[0], cycles=3)
    triple = run_up(replace(oscillator(), contacts=(pair,)), profile, cycles=3, **options)
    assert single.cycles.time.size == triple.cycles.time.size == 12
    for name in ("time", "phase", "mesh_frequency", "speed", "position", "contact_force"):
        np.testing.assert_allclose(
            getattr(triple, name), getattr(single, name), rtol=1e-9, atol=1e-9, err_msg=name
        )
    means = single.cycles.deflection.mean.reshape(4, 3, 1)
    weights = 1.0 / single.cycles.mesh_frequency.reshape(4, 3, 1)
    expected = (means * weights).sum(axis=1) / weights.sum(axis=1)
    np.testing.assert_allclose(triple.cycles.deflection.mean[::3], expected, atol=1e-3)


def test_through_resonance_it_equals_an_adaptive_integrator_at_fourth_order() -> None:
    profile = ([0.0, 60.0, 90.0], [0.05, 0.35, 0.1])
    errors = []
    for steps in (32, 64, 128):
        run = run_up(oscillator(), profile, start=([0.1], [0.0]), steps=steps, samples=8)
        inside = run.time < 90.0
        errors.append(np.abs(run.position[:, 0] - exact(run.time))[inside].max())
    assert errors[-1] < 1e-6 * 0.6 * 2
    assert np.log2(errors[0] / errors[1]) == pytest.approx(4.0, abs=0.3)
    assert np.log2(errors[1] / errors[2]) == pytest.approx(4.0, abs=0.3)


def test_samples_obey_the_equation_of_motion() -> None:
    run = run_up(oscillator(), ([0.0, 60.0], [0.05, 0.35]), start=([0.1], [0.0]), samples=16)
    turns = 2 * np.pi * run.phase
    error = 0.1 * np.cos(turns) + 0.03 * np.sin(2 * turns)
    slope = (-0.1 * np.sin(turns) + 0.06 * np.cos(2 * turns)) * 2 * np.pi * run.mesh_frequency
    d, rate = run.position[:, 0] - error, run.velocity[:, 0] - slope
    force = (1.0 + 0.2 * np.cos(turns)) * d + 0.05 * rate
    np.testing.assert_allclose(run.deflection[:, 0], d, atol=1e-9)
    np.testing.assert_allclose(run.contact_force[:, 0], force, atol=1e-8)
    force_from_motion = -0.02 * run.velocity[:, 0] - force
    np.testing.assert_allclose(run.acceleration[:, 0], force_from_motion, atol=1e-8)


def test_a_constant_speed_is_the_steady_state() -> None:
    system = replace(reference_system(0.1, gap=20e-6), balance=BALANCE)
    orbit = steady_state(system, 2000.0, steps=1024)
    run = run_up(system, ([0.0, 0.02], [2000.0, 2000.0]), samples=16, steps=1024)
    force = float(rms(orbit.fine, orbit.fine.contact_force[:, 0]))
    assert run.cycles.contact_force.rms[:, 0] == pytest.approx(force, rel=1e-6)
    assert run.cycles.extra_force[-1] == pytest.approx(orbit.extra_force, rel=1e-6)


def test_a_slow_run_comes_near_the_steady_states_and_its_distance_falls_with_the_rate() -> None:
    contact = Contact([1.0], stiffness=lambda p: 40.0 + 4.0 * np.cos(2 * np.pi * p), damping=0.6)
    system = System([[1.0]], [[0.0]], [[0.0]], [1.0], [contact])
    # Off the top of the resonance, where the distance is of first order in the rate.
    orbit = steady_state(system, 0.95, steps=512)
    level = rms(orbit.fine, orbit.fine.contact_force[:, 0] - 1.0)
    distances = []
    for duration in (400.0, 800.0):
        run = run_up(system, ([0.0, duration], [0.8, 1.2]), samples=8)
        cycles = run.cycles
        rms_force = np.sqrt(
            cycles.contact_force.rms[:, 0] ** 2 - 2 * cycles.contact_force.mean[:, 0] + 1
        )
        distances.append(abs(np.interp(0.95, cycles.mesh_frequency, rms_force) - level) / level)
    assert distances[1] < 0.02
    assert distances[0] / distances[1] == pytest.approx(2.0, rel=0.2)


def test_backlash_gives_another_motion_down_than_up() -> None:
    # Case H1: two stable motions between 0.8344 and 0.9069 rad/s
    profile = speed_ramp(0.80 / (2 * np.pi), 0.94 / (2 * np.pi), 9000.0, down=True)
    run = run_up(hysteresis_system(), profile, samples=8)
    cycles = run.cycles
    level = cycles.deflection.alternating_rms[:, 0]
    up, down = cycles.rate > 0, cycles.rate < 0
    place = 2 * np.pi * cycles.mesh_frequency
    low = np.interp(0.88, place[up], level[up])
    high = np.interp(0.88, place[down][::-1], level[down][::-1])
    assert low == pytest.approx(LOW, rel=0.02)
    assert high == pytest.approx(HIGH, rel=0.02)
    # jumps come a little late, since the speed does not wait
    jump_up = place[up][np.argmax(np.diff(level[up]))]
    jump_down = place[down][np.argmin(np.diff(level[down]))]
    assert 0.9069 < jump_up < 0.93
    assert 0.81 < jump_down < 0.8344
    assert cycles.contact_loss_share.max() > 0.1
    assert "separate" in repr(run)


def test_friction_does_not_make_the_drive_drift() -> None:
    balanced = replace(reference_system(0.1), balance=BALANCE)
    run = run_up(balanced, speed_ramp(300.0, 600.0, 1.0), samples=16)
    rigid = run.position[:, 2]  # the pinion turns back and forth with the mesh only
    # left alone, the 2 N m of friction would turn it by some hundred radians
    assert np.abs(rigid).max() < 1e-3
    assert rigid[::16] == pytest.approx(rigid[0], abs=2e-5)
    slow, quick = (steady_state(balanced, f, steps=1024).extra_force[5] for f in (330.0, 570.0))
    drive_torque = np.interp(
        [330.0, 570.0], run.cycles.mesh_frequency, run.cycles.extra_force[:, 5]
    )
    assert drive_torque == pytest.approx([slow, quick], rel=5e-3)
    assert abs(slow) > 1.0


def test_the_inertia_of_the_acceleration_loads_the_teeth() -> None:
    # wheel 1168e-6 kg m^2, driven by the pinion through 16/24: r_w N = T_w + I_w alpha_w
    system = replace(reference_system(0.0), balance=[0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
    rate = 4000.0  # Hz/s of the mesh
    turns = np.array([0.0, 0.0, 1.0, 0.0, 0.0, 16.0 / 24.0])
    profile = speed_ramp(300.0, 500.0, 200.0 / rate)
    plain = run_up(system, profile, teeth=16, samples=8)
    loaded = run_up(system, profile, teeth=16, samples=8, rotation=turns)
    alpha = 2 * np.pi * rate / 24.0
    radius = 0.0507434
    added = (loaded.cycles.contact_force.mean - plain.cycles.contact_force.mean)[5:, 0].mean()
    assert added == pytest.approx(1168e-6 * alpha / radius, rel=0.02)


def test_tables_follow_the_speed() -> None:
    def spring(stiffness: float) -> System:
        return System([[1.0]], [[4.0]], [[0.0]], [1.0], [Contact([1.0], stiffness=stiffness)])

    run = run_up({1.0: spring(50.0), 3.0: spring(100.0)}, speed_ramp(1.0, 3.0, 60.0), samples=8)
    # static compression 1/k with k in a straight line between the two; below and above level
    k = 50.0 + 25.0 * (run.cycles.mesh_frequency - 1.0)
    mean = run.cycles.deflection.mean[10:-5, 0]
    assert mean == pytest.approx(1.0 / k[10:-5], rel=2e-3)
    deflection = run.deflection.reshape(-1, 8).mean(axis=1)[10:-5]
    assert deflection == pytest.approx(mean, rel=1e-3)
    with_friction = Contact([1.0], stiffness=100.0, friction=[0.1])
    rubbing = System([[1.0]], [[4.0]], [[0.0]], [1.0], [with_friction])
    switched_run = run_up({1.0: spring(100.0), 3.0: rubbing}, speed_ramp(1.0, 3.0, 60.0), samples=8)
    share = 0.1 * (switched_run.cycles.mesh_frequency - 1.0) / 2.0
    force = switched_run.cycles.contact_force.mean[:, 0]
    assert force[10:-5] == pytest.approx(1.0 / (1.0 + share[10:-5]), rel=2e-3)


def test_time_over_phase_is_exact() -> None:
    profile = SpeedProfile([0.0, 2.0, 3.0, 7.0], [100.0, 300.0, 300.0, 1.0])
    time = np.linspace(0.0, 7.0, 1001)
    phase = profile.phase_at(time)
    # the integral of a chain of straight lines by hand
    assert profile.cycles == pytest.approx(400.0 + 300.0 + 602.0, rel=1e-14)
    assert profile.phase_at(1.0) == pytest.approx(150.0, rel=1e-14)
    np.testing.assert_allclose(profile.time_at(phase), time, rtol=1e-11, atol=1e-12)
    slope = (profile.phase_at(1.0 + 1e-5) - profile.phase_at(1.0 - 1e-5)) / 2e-5
    assert slope == pytest.approx(200.0, rel=1e-8)


def test_friction_that_follows_the_load_is_that_of_the_steady_state() -> None:
    pair = Contact([1.0, -1.0], lambda p: 9e3 + 1e3 * np.cos(2 * np.pi * p), 3.0)
    rub = LoadFriction(direction=[0.3, -0.1], coefficients=[0.1, 0.02], load=40.0)
    system = System(
        np.eye(2), np.diag([0.5, 1.0]), np.diag([3e3, 4e3]), [40.0, 0.0], [pair], frictions=[rub]
    )
    orbit = steady_state(system, 5.0, steps=512)
    run = run_up(system, ([0.0, 2.0], [5.0, 5.0]), samples=16, steps=512)
    mean = float(orbit.fine.mean(orbit.fine.contact_force)[0])
    assert run.cycles.contact_force.mean[-1, 0] == pytest.approx(mean, rel=1e-9)
    level = float(rms(orbit.fine, orbit.fine.acceleration[:, 0]))
    assert run.cycles.acceleration.rms[-1, 0] == pytest.approx(level, rel=1e-6)
    sampled = np.sqrt(np.mean(run.acceleration[-16:, 0] ** 2))
    assert sampled == pytest.approx(level, rel=1e-6)
