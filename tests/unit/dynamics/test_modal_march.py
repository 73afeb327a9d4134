"""Time integration in modal coordinates: against plain Python, its order, other engines."""

import sys

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from known_machines import CLOCK, two_mesh_system
from known_random_machines import random_machine
from plain.modal import PlainMarch
from tribodyn.dynamics import (
    ENGINES,
    Contact,
    LaneParameters,
    System,
    harmonic_balance,
    simulate,
    simulate_ensemble,
    steady_state,
)
from tribodyn.dynamics.equations.compiled import sample_system
from tribodyn.dynamics.harmonic.newton import Solution, newton
from tribodyn.dynamics.modal.modal_march import ModalEngine
from tribodyn.errors import ComputationError, InputError

module = sys.modules["tribodyn.dynamics.harmonic.harmonic_balance"]


def start(machine: System) -> tuple[np.ndarray, np.ndarray]:
    generator = np.random.default_rng(7)
    return tuple(0.1 * generator.normal(size=(2, machine.size)))


def chain(size: int, error: float = 0.05) -> System:
    """A chain of masses with two meshes."""
    links = np.diff(np.eye(size), axis=0)
    stiffness = 0.1 * np.eye(size) + 3.0 * links.T @ links
    ends = [np.eye(size)[i] - np.eye(size)[i + 1] for i in (4, size // 2)]
    shake = lambda x: error * np.cos(2.0 * np.pi * x)  # noqa: E731
    meshes = [
        Contact(end, 9.0, damping=0.05, error=shake, gap=0.02, cycles=n)
        for end, n in zip(ends, (3, 2), strict=True)
    ]
    damping = 0.02 * stiffness + 0.02 * np.eye(size)
    return System(np.eye(size), damping, stiffness, ends[0] + ends[1], meshes)


@pytest.mark.parametrize(("gap", "changes"), [(0.0, 0), (0.25, 2)])
def test_kernel_is_the_plain_integration(gap, changes):
    wave = lambda x: np.cos(2.0 * np.pi * x)  # noqa: E731
    meshes = [
        Contact([1.0, -1.0], lambda x: 5.0 + wave(x), 0.2, lambda x: 0.2 * wave(x), gap, events=()),
        Contact([0.0, 1.0], lambda x: 4.0 + wave(x), 0.1, lambda x: 0.1 * wave(x), events=()),
    ]
    meshes[1] = Contact(**{**vars(meshes[1]), "cycles": 2})
    machine = System(np.diag([1.0, 2.0]), 0.1 * np.eye(2), 0.2 * np.eye(2), [0.5, 0.1], meshes)
    q, v = np.array([0.6, 0.1]), np.array([0.1, -0.3])
    plain, count = PlainMarch(machine, 0.1, 12).period(np.concatenate((q, v)))
    motion = simulate(machine, 0.1, 2, (q, v), steps=12, method="modal")
    row = motion.time.size // 2
    state = np.concatenate((motion.position[row], motion.velocity[row]))
    assert count == changes
    assert state == pytest.approx(plain, abs=1e-9)


def test_order_is_fourth_and_the_step_has_no_limit():
    machine = random_machine(2, turning=True, friction=True, load_friction=True, gyroscopic=True)
    frequency, begin = 0.4 / machine.cycles, start(machine)
    exact = simulate(machine, frequency, 3, begin, steps=512, method="rk4")
    errors = []
    for steps in (24, 48, 96):
        motion = simulate(machine, frequency, 3, begin, steps=steps, method="modal")
        ends = motion.position[:: motion.time.size // 3] - exact.position[:: exact.time.size // 3]
        errors.append(np.abs(ends).max())
    orders = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert np.all(orders > 3.5)
    stiff = System([[1.0, 0.0], [0.0, 1.0]], 0.1 * np.eye(2), [[1e10, 0.0], [0.0, 1.0]], [1.0, 1.0],
                   [Contact([0.0, 1.0], 2.0)])  # fmt: skip
    with pytest.raises(InputError, match="omega_max"):
        simulate(stiff, 1.0, 1, ([0.0, 0.0], [0.0, 0.0]), steps=64, method="rk4")
    motion = simulate(stiff, 1.0, 1, ([0.0, 0.0], [0.0, 0.0]), steps=64, method="modal")
    assert np.abs(motion.position[:, 0]).max() < 2.1e-10


def test_order_stays_above_two_where_contacts_open():
    machine = random_machine(8, gap=0.2, depth=0.35)
    frequency, begin = 0.4 / machine.cycles, start(machine)
    exact = simulate(machine, frequency, 3, begin, steps=1024, method="rk4")
    assert np.any(exact.contact_force == 0.0)
    errors = []
    for steps in (32, 64, 128):
        motion = simulate(machine, frequency, 3, begin, steps=steps, method="modal")
        ends = motion.position[:: motion.time.size // 3] - exact.position[:: exact.time.size // 3]
        errors.append(np.abs(ends).max())
    assert np.log2(errors[0] / errors[2]) > 2 * 2.3
    assert errors[2] < 1e-7


def test_motion_with_gap_and_ramps_is_that_of_an_adaptive_method_of_eighth_order():
    turn, stiffness, ramps, gaps = 2.0 * np.pi, 40.0, (25.0, 15.0), (0.05, 0.4, 0.7)
    error = lambda x: 0.3 * np.cos(turn * x)  # noqa: E731
    contact = Contact([1.0], stiffness, 0.3, error, gaps[0], ramp_stiffness=ramps,
                      ramp_gap=gaps[1:], events=())  # fmt: skip
    machine = System([[1.0]], [[0.2]], [[1.0]], [6.0], [contact])

    def rate(time, y):
        d, speed = y[0] - error(time), y[1] + 0.3 * turn * np.sin(turn * time)
        beyond = np.sign(d) * np.maximum(np.abs(d) - np.array(gaps), 0.0)
        force = np.dot((stiffness, *ramps), beyond) + 0.3 * speed * (beyond[0] != 0.0)
        return [y[1], 6.0 - 0.2 * y[1] - y[0] - force]

    exact = solve_ivp(rate, (0.0, 4.0), [0.2, 1.0], "DOP853", rtol=1e-12, atol=1e-13, max_step=2e-3)
    errors, changes = [], []
    for steps in (32, 64, 128):
        motion = ModalEngine(sample_system(machine, steps), np.zeros((0, 1))).motion
        state, free = motion.state(np.array([0.2]), np.array([1.0]))
        ends, sums, trace = motion.advance(state, 1.0, 4, np.zeros(1))
        q, v = motion.motion(ends, free, np.array([4.0]), state, sums)
        errors.append(np.abs(np.hstack((q, v))[0] - exact.y[:, -1]).max())
        changes.append(int(trace.report[3]))
    assert min(changes) >= 12
    assert np.log2(errors[0] / errors[2]) > 2 * 3.5
    assert errors[2] < 1e-6


def test_free_rotation_of_the_drive_is_that_of_runge_kutta():
    machine = two_mesh_system()
    begin = np.zeros(8), np.linspace(0.01, 0.02, 8)
    extra = np.zeros(8)
    extra[6] = -11000.0  # not quite the balance: the drive speeds up
    runs = [
        simulate(machine, CLOCK, 1, begin, steps=256, extra_force=extra, method=method)
        for method in ("rk4", "modal")
    ]
    assert [run.engine for run in runs] == ["runge-kutta-4", "modal"]
    for name in ("position", "velocity"):
        exact, values = (getattr(run, name)[-1] for run in runs)
        assert values == pytest.approx(exact, rel=1e-7, abs=1e-7 * np.abs(exact).max())


def test_large_structures_choose_modal_coordinates_and_harmonic_balance():
    machine, small = chain(30), chain(24)
    begin = np.zeros(30), np.zeros(30)
    assert simulate(machine, 0.1, 1, begin, steps=64).engine == "modal"
    assert simulate(small, 0.1, 1, (begin[0][:24], begin[0][:24]), steps=64).engine != "modal"
    motion = steady_state(machine, 0.1)
    assert motion.engine == "harmonic-balance"
    assert motion.converged
    assert motion.stable
    assert steady_state(small, 0.1, steps=64).engine == "runge-kutta-4"


def test_motion_of_harmonic_balance_repeats():
    machine = chain(30, 0.3)
    motion = harmonic_balance(machine, 0.12)
    assert np.any(motion.contact_force == 0.0)
    begin = motion.position[0], motion.velocity[0]
    again = simulate(machine, 0.12, 2, begin, steps=256, method="modal")
    half = again.time.size // 2
    for name in ("position", "velocity"):
        values = getattr(again, name)
        scale = np.abs(values).max()
        assert values[half] == pytest.approx(values[0], abs=1e-6 * scale)


def test_a_march_leads_to_the_motion_that_the_first_attempts_miss(monkeypatch):
    machine, attempts = chain(8, 0.3), []
    direct = harmonic_balance(machine, 0.12, steps=64)

    def weak(residual, y, *options):
        attempts.append(1)
        state = residual.at(y)
        return Solution(state, 1.0, 0, 0) if len(attempts) < 9 else newton(residual, y, *options)

    monkeypatch.setattr(module, "newton", weak)
    motion = harmonic_balance(machine, 0.12, steps=64)
    assert len(attempts) >= 9
    assert motion.converged
    assert motion.deflection == pytest.approx(direct.deflection, abs=1e-8)


def test_multipliers_are_those_of_the_orbit():
    machine = random_machine(3, gyroscopic=True)
    frequency = 0.8
    orbit = steady_state(machine, frequency, steps=256)
    motion = harmonic_balance(machine, frequency, stability=True)
    exact = np.sort(np.abs(orbit.floquet_multipliers))
    assert np.sort(np.abs(motion.floquet_multipliers)) == pytest.approx(exact, abs=1e-6)
    assert motion.stable


def test_ensembles_are_refused():
    machine, begin = chain(6), (np.zeros(6), np.zeros(6))
    with pytest.raises(InputError, match="ensemble"):
        simulate_ensemble(machine, [0.1, 0.2], 2, begin, steps=64, method="modal")
    factors = LaneParameters(stiffness_scale=np.array([1.0, 1.1]))
    with pytest.raises(InputError, match="several systems"):
        simulate_ensemble(machine, 0.1, 2, begin, steps=64, method="modal", parameters=factors)
    assert ENGINES["modal"].arguments({}) == {"method": "modal"}


def test_a_growing_motion_is_reported():
    fed = System([[1.0]], [[-400.0]], [[1.0]], [1.0], [Contact([1.0], 2.0)])
    with pytest.raises(ComputationError, match="grows without bounds"):
        simulate(fed, 1.0, 4, ([1.0], [0.0]), steps=64, method="modal")
