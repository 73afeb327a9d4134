"""Lyapunov exponents against closed forms, Floquet multipliers and an independent computation.

Run as a script, this module repeats the independent computation, which takes some ten minutes.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from known_systems import MASS, SUPPORT, hysteresis_system, reference_system
from tribodyn.analysis import lyapunov_exponents
from tribodyn.dynamics import Contact, System, simulate
from tribodyn.dynamics._engine.blocks import march
from tribodyn.dynamics.equations.compiled import compile_for
from tribodyn.dynamics.modal.modal_march import compile_modal
from tribodyn.errors import ComputationError, InputError
from tribodyn.nonlinear.lyapunov_carrier import Carrier, grouped_products
from tribodyn.nonlinear.lyapunov_tangent import TangentTables

TURN = 2.0 * np.pi
#: Damping, mean force, its amplitude and frequency of the chaotic oscillator
#: ``x'' + c x' + g(x) = f + F cos W t``, a form of Kahraman and Singh (1990).
CHAOTIC = {"c": 0.04, "f": 0.05, "F": 0.15, "W": 0.7}
#: Its largest exponent and the standard error, from `independent_exponent()`: SciPy's DOP853 on
#: the motion and its variational equation, 200 motions of 150 mesh cycles after 50.
INDEPENDENT = (0.096214, 0.00036)


def independent_exponent(motions: int = 200, transient: int = 50, cycles: int = 150):
    """Largest exponent of the chaotic oscillator with nothing of this package."""
    c, f, wave, turn = CHAOTIC.values()
    period = TURN / turn

    def rate(time, y):
        x, v, dx, dv = y.reshape(4, motions)
        touching = np.abs(x) > 1.0
        force = f + wave * np.cos(turn * time) - np.where(touching, x - np.sign(x), 0.0)
        return np.concatenate((v, force - c * v, dv, -c * dv - touching * dx))

    random = np.random.default_rng(1)
    y = np.ones((4, motions))
    y[0], y[1] = random.uniform(1.1, 1.5, motions), random.uniform(-0.1, 0.1, motions)
    y[3] = 0.0
    total = np.zeros(motions)
    options = {"method": "DOP853", "rtol": 1e-6, "atol": 1e-7, "max_step": period / 100}
    for cycle in range(transient + cycles):
        total = np.zeros(motions) if cycle == transient else total
        y = solve_ivp(rate, (0.0, period), y.reshape(-1), **options).y[:, -1].reshape(4, motions)
        size = np.hypot(y[2], y[3])
        total += np.log(size)
        y[2:] /= size
    local = total / (cycles * period)
    return local.mean(), local.std(ddof=1) / np.sqrt(motions)


def chaotic_system(**contact):
    c, f, wave, _ = CHAOTIC.values()
    pair = Contact([1.0], **{"stiffness": 1.0, "gap": 1.0} | contact)
    return System(
        [[1.0]],
        [[c]],
        [[0.0]],
        lambda phase: (f + wave * np.cos(TURN * phase))[:, None],
        [pair],
    )


@pytest.mark.parametrize("zeta", [0.0, 0.01, 0.3, 1.5])
def test_linear_oscillator_has_the_real_parts_of_its_eigenvalues(zeta):
    system = System([[2.0]], [[4.0 * zeta * 3.0]], [[2.0 * 9.0]], [0.0])
    result = lyapunov_exponents(
        system, 1.3, start=([1.0], [0.0]), cycles=40, transient=60, steps=64
    )
    expected = np.sort(np.real(np.roots([1.0, 6.0 * zeta, 9.0])))[::-1]
    assert result.exponents == pytest.approx(expected, rel=1e-9, abs=1e-9)
    assert not result.chaotic


@pytest.mark.parametrize("turn", [1.95, 2.0, 3.0])
def test_meissner_exponents_are_those_of_the_multipliers(turn):
    zeta, period = 0.02, TURN / turn
    pair = Contact([1.0], lambda p: np.where(p < 0.5, 1.4, 0.6), events=(0.0, 0.5))
    system = System([[1.0]], [[2.0 * zeta]], [[0.0]], [0.0], [pair])
    result = lyapunov_exponents(
        system, 1.0 / period, start=([1e-3], [0.0]), cycles=40, transient=160, steps=64
    )
    halves = [expm(np.array([[0.0, 1.0], [-k, -2.0 * zeta]]) * period / 2.0) for k in (1.4, 0.6)]
    expected = np.sort(np.log(np.abs(np.linalg.eigvals(halves[1] @ halves[0]))) / period)[::-1]
    assert result.exponents == pytest.approx(expected, rel=1e-9)
    # Within the tongue the equations repeat and the motion grows: unstable, and no chaos.
    assert (result.largest > 0.0) == (turn < 2.5)
    assert result.repeats == 1
    assert not result.chaotic


def test_mathieu_exponents_are_those_of_the_multipliers():
    period = TURN / 1.1
    pair = Contact([1.0], stiffness=lambda p: 1.0 + 0.5 * np.cos(TURN * p))
    system = System([[1.0]], [[0.06]], [[0.0]], [0.0], [pair])
    result = lyapunov_exponents(
        system, 1.0 / period, start=([1.0], [0.0]), cycles=40, transient=300
    )

    def rate(time, y):
        x, v = y.reshape(2, 2)
        stiffness = 1.0 + 0.5 * np.cos(TURN * time / period)
        return np.concatenate((v, -0.06 * v - stiffness * x))

    fundamental = solve_ivp(
        rate, (0.0, period), np.eye(2).ravel(), rtol=1e-12, atol=1e-13, max_step=0.1
    )
    multipliers = np.linalg.eigvals(fundamental.y[:, -1].reshape(2, 2))
    expected = np.sort(np.log(np.abs(multipliers)) / period)[::-1]
    assert result.exponents == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("start", [([1.5], [0.0]), ([3.0], [0.0])])
def test_both_motions_of_the_hysteresis_case(start):
    result = lyapunov_exponents(
        hysteresis_system(), 0.88 / TURN, start=start, cycles=40, transient=200, steps=256
    )
    assert np.exp(result.exponents * TURN / 0.88) == pytest.approx([0.699773] * 2, abs=1e-6)


def test_gear_pair_has_two_free_exponents_and_the_trace_of_its_damping():
    result = lyapunov_exponents(reference_system(), 240.0, cycles=40, transient=40)
    direction = np.asarray(reference_system().contacts[0].direction)
    rate = np.trace(4e3 * np.linalg.inv(MASS) @ SUPPORT)
    rate += 900.0 * direction @ np.linalg.inv(MASS) @ direction
    assert result.free == 2
    assert result.exponents[:2].tolist() == [0.0, 0.0]
    assert result.exponents.sum() == pytest.approx(-rate, rel=1e-9)
    assert result.divergence == pytest.approx(-rate, rel=1e-12)


def test_friction_gives_the_published_multiplier():
    result = lyapunov_exponents(reference_system(0.1), 240.0, cycles=40, transient=40)
    assert np.exp(result.vibrating[0] / 240.0) == pytest.approx(0.000949, abs=5e-7)


def test_exponents_that_differ_by_thousands_keep_their_digits():
    stiff = System(np.eye(2), np.diag([0.2, 2000.0]), np.diag([4.0, 1e4]), [0.0, 0.0])
    start = ([1.0, 1.0], [0.0, 0.0])
    result = lyapunov_exponents(stiff, 1.0, start=start, cycles=40, transient=20, steps=1024)
    fast = np.roots([1.0, 2000.0, 1e4])
    assert result.exponents == pytest.approx([-0.1, -0.1, fast.max(), fast.min()], rel=1e-9)


@pytest.mark.slow
def test_chaotic_exponent_agrees_with_the_independent_computation():
    frequency = CHAOTIC["W"] / TURN
    result = lyapunov_exponents(
        chaotic_system(), frequency, start=([1.3], [0.1]), cycles=9000, transient=200, steps=96
    )
    value, error = INDEPENDENT
    assert result.chaotic
    assert result.standard_error[0] < 0.01 * value
    assert abs(result.largest - value) < 3.5 * np.hypot(error, result.standard_error[0])
    assert result.largest == pytest.approx(value, rel=0.025)
    assert result.exponents.sum() == pytest.approx(-CHAOTIC["c"], rel=1e-9)
    assert 1.6 < result.kaplan_yorke_dimension < 1.8


@pytest.mark.parametrize(
    ("derivatives", "steps", "cycles"), [(2e9, 24, 1000), (96 * 4 * 70, 96, 70), (1.0, 96, 20)]
)
def test_motions_that_do_not_repeat_are_averaged_over_fewer_cycles(
    derivatives: float, steps: int, cycles: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A step has four derivatives of the two states; a motion that repeats has all its cycles."""
    monkeypatch.setattr("tribodyn.nonlinear.lyapunov._DERIVATIVES", derivatives)
    monkeypatch.setattr("tribodyn.nonlinear.lyapunov.compile_motion", compile_modal)
    options = {"transient": 120, "steps": steps, "verdict": False, "start": ([1.3], [0.1])}
    chaos = lyapunov_exponents(chaotic_system(), CHAOTIC["W"] / TURN, **options)
    assert chaos.cycles == cycles
    assert chaos.repeats == 0
    # the motion settles for as long whatever the number of derivatives is
    same = lyapunov_exponents(chaotic_system(), CHAOTIC["W"] / TURN, cycles=cycles, **options)
    assert np.array_equal(same.exponents, chaos.exponents)


def test_sum_is_the_damping_of_the_contact_while_it_touches():
    system, frequency = chaotic_system(damping=0.05), CHAOTIC["W"] / TURN
    start = ([1.3], [0.1])
    result = lyapunov_exponents(system, frequency, start=start, cycles=60, transient=0, steps=256)
    motion = simulate(system, frequency, 60, start, steps=256)
    touching = motion.fine.mean((np.abs(motion.fine.deflection[:, 0]) > 1.0).astype(float))
    assert result.exponents.sum() == pytest.approx(result.divergence, rel=1e-9)
    assert result.divergence == pytest.approx(-0.04 - 0.05 * touching, rel=1e-3)


GAP = {"gap": lambda p: 1.0 + 0.2 * np.cos(TURN * p)}
SYSTEMS = {
    "damping jumps": chaotic_system(damping=0.05),
    "damping in the gap": chaotic_system(damping=0.05, damping_in_gap=True),
    "gap varies": chaotic_system(damping=0.05, **GAP),
    "error varies": chaotic_system(damping=0.05, error=lambda p: 0.1 * np.sin(TURN * p)),
}


@pytest.mark.parametrize("name", SYSTEMS)
def test_disturbance_of_one_cycle_agrees_with_two_marched_motions(name):
    system, frequency = SYSTEMS[name], CHAOTIC["W"] / TURN
    compiled = compile_for(system, frequency, 512)
    tables = TangentTables(compiled, frequency)
    state, period = np.array([[1.3, 0.1]]), np.array([1.0 / frequency])
    reduce, expand = tables.coordinates.reduce, tables.coordinates.expand
    crossings = 0
    for _ in range(6):
        record = np.empty((513, 2, 1))
        new = march(compiled, period, state, 1, record=record)
        steps, _ = Carrier(tables, state[0], np.zeros(1))._matrices(record[:, :, 0])
        matrix = grouped_products(steps[None], 512)[0, 0]
        y, small = reduce(state)[0], 1e-6 * np.eye(2)
        disturbed = [
            march(compiled, np.repeat(period, 2), expand(y + d), 1) for d in (small, -small)
        ]
        expected = (reduce(disturbed[0]) - reduce(disturbed[1])).T / 2e-6
        assert np.abs(matrix - expected).max() < 1e-6 * np.abs(matrix).max()
        crossings += int(np.count_nonzero(np.diff(np.abs(record[:, 0, 0]) > 1.0)))
        state = new
    assert crossings >= 6


def test_bad_input_is_refused():
    free = System([[1.0]], [[0.0]], [[0.0]], [0.0])
    with pytest.raises(InputError, match="no coordinate is restrained"):
        lyapunov_exponents(free, 1.0)
    with pytest.raises(InputError, match="cycles = 0"):
        lyapunov_exponents(hysteresis_system(), 1.0, cycles=0)
    with pytest.raises(InputError, match="omega_max"):
        lyapunov_exponents(System([[1.0]], [[0.0]], [[1e6]], [0.0]), 1.0, steps=64)
    growing = System([[1.0]], [[-9.0]], [[1.0]], [1.0])
    with pytest.raises(ComputationError, match="beyond all bounds"):
        lyapunov_exponents(growing, 1.0, start=([2.0], [0.0]), cycles=200, steps=64)


def test_table_has_units():
    system = System([[1.0]], [[0.2]], [[4.0]], [0.0])
    result = lyapunov_exponents(system, 1.0, start=([1.0], [0.0]), cycles=4, transient=0, steps=32)
    table = result.to_xarray()
    assert table["lyapunov_exponent"].attrs["units"] == "1/s"
    assert table.attrs["cycles"] == 4
    assert "not chaotic" in repr(result)


if __name__ == "__main__":
    print(independent_exponent())
