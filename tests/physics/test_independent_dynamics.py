"""Motions with impacts, their bifurcations and chaos against computations with nothing of ours.

The references below are written from the equations alone: SciPy's DOP853 with located events, and
jumps of the disturbance where the damping force of a contact sets in or out.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tribodyn.analysis import lyapunov_exponents, mesh_harmonics, rms
from tribodyn.dynamics import Contact, System, continuation, simulate

TURN = 2.0 * np.pi

MASS, LOSS, SPRING = np.array([0.5, 0.8]), np.array([150.0, 90.0]), np.array([1e7, 2e7])
LOAD, SENSE = np.array([180.0, -140.0]), np.array([1.0, -1.2])
BEAT, CYCLES, START = 1500.0, 6, np.array([3e-5, -1e-5, 0.2, 0.1])
DAMPER, HALF_GAP, JUMP = 1600.0, 24e-6, 0.4


def _stiffness(phase):
    return np.where(phase < JUMP, 2.1e8, 1.4e8)


def _rub(phase):
    return np.stack((np.where(phase < JUMP, 0.1, -0.1), np.full_like(phase, -0.06)), axis=-1)


def _error(phase):
    return 0.9e-6 * np.cos(TURN * phase)


def rattling_system():
    teeth = Contact(
        SENSE, _stiffness, DAMPER, _error, HALF_GAP, friction=_rub, events=(0.0, JUMP)
    )  # fmt: skip
    return System(np.diag(MASS), np.diag(LOSS), np.diag(SPRING), LOAD, [teeth])


def located_impacts():
    """Figures of the rattling system: compression, force and accelerations over all cycles."""
    y = np.concatenate((START, np.zeros(9)))
    crossings = 0
    for segment in range(2 * CYCLES):
        cycle, half = divmod(segment, 2)
        phase, end = (cycle + JUMP, cycle + 1.0) if half else (float(cycle), cycle + JUMP)
        inside = np.array(0.5 * (phase + end) % 1.0)
        stiffness, rub = float(_stiffness(inside)), _rub(inside)

        def compression(at, y):
            return SENSE @ y[:2] - _error(at)

        def rate(at, y, side, stiffness=stiffness, rub=rub):
            d, moving = compression(at, y), -TURN * 0.9e-6 * np.sin(TURN * at) * BEAT
            force = stiffness * (d - side * HALF_GAP) + DAMPER * (SENSE @ y[2:4] - moving)
            force *= abs(side)
            pull = (LOAD - LOSS * y[2:4] - SPRING * y[:2] - (SENSE + rub) * force) / MASS
            wave = np.exp(-1j * TURN * at)
            pieces = [d * 1e5, (d * 1e5) ** 2, force / 1e3, (force / 1e3) ** 2]
            pieces += [*(pull / 1e3) ** 2, force / 1e3 * wave.real, force / 1e3 * wave.imag, 1.0]
            return np.concatenate((y[2:4] / BEAT, pull / BEAT, pieces))

        while phase < end:
            d = compression(phase, y)
            if abs(abs(d) - HALF_GAP) > 1e-15:
                side = float(d > HALF_GAP) - float(d < -HALF_GAP)
            events = []
            for bound in (1.0, -1.0) if side == 0.0 else (side,):

                def border(at, y, side, bound=bound):
                    return compression(at, y) - bound * HALF_GAP

                border.terminal, border.direction = True, bound if side == 0.0 else -bound
                events.append(border)
            solution = solve_ivp(
                rate, (phase, end), y, "DOP853", events=events, args=(side,), rtol=1e-10,
                atol=[1e-16] * 2 + [1e-12] * 2 + [1e-10] * 9,
            )  # fmt: skip
            phase, y = solution.t[-1], solution.y[:, -1]
            if solution.status == 1:
                crossings += 1
                side = 0.0 if side else float(np.sign(SENSE @ y[:2]))
    return crossings, y[:4], y[4:] / y[-1]


@pytest.mark.parametrize("steps", [512, 1024])
def test_forces_and_accelerations_with_impacts(steps):
    crossings, end, mean = located_impacts()
    motion = simulate(rattling_system(), BEAT, CYCLES, (START[:2], START[2:]), steps=steps)
    fine = motion.fine
    d, force = fine.deflection[:, 0] * 1e5, fine.contact_force[:, 0] / 1e3
    assert crossings > 9
    assert np.concatenate((fine.position[-1], fine.velocity[-1])) == pytest.approx(end, rel=1e-5)
    assert (fine.mean(d), rms(fine, d) ** 2) == pytest.approx(mean[:2], rel=1e-6)
    assert (fine.mean(force), rms(fine, force) ** 2) == pytest.approx(mean[2:4], rel=1e-6)
    assert rms(fine, fine.acceleration / 1e3) ** 2 == pytest.approx(mean[4:6], rel=2e-6)
    wave = mesh_harmonics(motion, force, 1)[0]
    assert abs(wave - 2.0 * (mean[6] + 1j * mean[7])) < 1e-6 * abs(wave)


def cycle_of_the_oscillator(turn, start):
    """State and disturbances after one cycle of a damped dead-zone oscillator; see below."""
    y, side = np.concatenate((start, np.eye(2).ravel())), float(start[0] > 1.0)
    time, end = 0.0, TURN / turn
    while time < end:

        def rate(t, y, side=side):
            stiffness, loss = side * (1.0 + 0.3 * np.cos(turn * t)), 0.04 + 0.02 * side
            pull = 0.3 - stiffness * (y[0] - 1.0) - loss * y[1]
            return np.concatenate(([y[1], pull], y[4:], -stiffness * y[2:4] - loss * y[4:]))

        def border(t, y):
            return y[0] - 1.0

        border.terminal, border.direction = True, -1.0 if side else 1.0
        solution = solve_ivp(rate, (time, end), y, "DOP853", events=border, rtol=1e-12, atol=1e-13)
        time, y = solution.t[-1], solution.y[:, -1]
        if solution.status == 1:
            # The damping sets in or out: the disturbance of the speed jumps.
            y[4:] += (0.02 if side else -0.02) * y[2:4]
            side = 1.0 - side
    return y[:2], y[2:].reshape(2, 2)


def test_period_doubling_has_the_multiplier_minus_one():
    pair = Contact([1.0], lambda p: 1.0 + 0.3 * np.cos(TURN * p), damping=0.02, gap=1.0)
    system = System([[1.0]], [[0.04]], [[0.0]], [0.3], [pair])
    branch = continuation(system, between=(2.1 / TURN, 1.5 / TURN), steps=256)
    (point,) = branch.special("period-doubling")
    start = np.concatenate((point.position, point.velocity))
    end, disturbed = cycle_of_the_oscillator(TURN * point.parameter, start)
    assert end == pytest.approx(start, abs=1e-6)
    assert np.linalg.eigvals(disturbed).real.min() == pytest.approx(-1.0, abs=1e-6)
    doubled = continuation(system, between=(2.1 / TURN, 1.5 / TURN), steps=256, start=point)
    number = doubled.parameter.size // 2
    state = np.concatenate(doubled.start(number))
    turn = TURN * doubled.parameter[number]
    middle, first = cycle_of_the_oscillator(turn, state)
    end, second = cycle_of_the_oscillator(turn, middle)
    assert end == pytest.approx(state, abs=1e-6)
    assert np.abs(middle - state).max() > 0.1
    eigenvalues = np.linalg.eigvals(second @ first)
    multiplier = doubled.floquet_multipliers[number]
    assert np.sort(multiplier.real) == pytest.approx(np.sort(eigenvalues.real), abs=1e-5)
    assert multiplier.real.max() > 1.0


def test_friction_sets_off_a_growing_swing_where_a_multiplier_leaves_the_circle():
    spring, loss = np.diag([1.0, 1.1]), np.diag([0.06, 0.05])
    sense = np.array([1.0, 0.3])

    def make(friction):
        pair = Contact(sense, lambda p: 0.5 + 0.1 * np.cos(TURN * p), friction=[0.0, -friction])
        return System(np.eye(2), loss, spring, [0.4, 0.2], [pair])

    branch = continuation(make, 0.37, parameter="friction", between=(0.0, 3.0), steps=256)
    (point,) = branch.special("neimark-sacker")

    def rate(t, y):
        x, v = y.reshape(2, 2, 4)
        push = np.outer(sense - [0.0, point.parameter], sense @ x)
        pull = -spring @ x - loss @ v - (0.5 + 0.1 * np.cos(TURN * 0.37 * t)) * push
        return np.concatenate((v, pull)).ravel()

    fundamental = solve_ivp(
        rate, (0.0, 1.0 / 0.37), np.eye(4).ravel(), "DOP853", rtol=1e-12, atol=1e-13
    )  # fmt: skip
    eigenvalues = np.linalg.eigvals(fundamental.y[:, -1].reshape(4, 4))
    assert np.abs(eigenvalues).max() == pytest.approx(1.0, abs=1e-7)
    assert np.abs(eigenvalues[np.abs(eigenvalues).argmax()].imag) > 0.1


def test_chaos_of_an_oscillator_whose_stiffness_and_damping_change():
    """Reference: 800 motions of 180 mesh cycles after 80, disturbances with jumps, in NumPy."""
    value, error = 0.102382, 0.000192
    pair = Contact([1.0], lambda p: 1.0 + 0.2 * np.cos(TURN * p), damping=0.04, gap=1.0)
    system = System(
        [[1.0]], [[0.02]], [[0.0]],
        lambda p: (0.05 + 0.2 * np.cos(TURN * p + 0.3))[:, None], [pair],
    )  # fmt: skip
    result = lyapunov_exponents(
        system, 0.8 / TURN, start=([1.3], [0.2]), cycles=8000, transient=300, steps=96
    )
    error_sum = np.hypot(error, result.standard_error[0])
    assert result.chaotic
    assert abs(result.largest - value) < 3.5 * error_sum
    assert result.standard_error[0] < 0.02 * value
    assert result.exponents.sum() == pytest.approx(result.divergence, rel=1e-9)
    # The reference adds up to -0.033302, counted over its own motions.
    assert result.exponents.sum() == pytest.approx(-0.033302, rel=0.01)
