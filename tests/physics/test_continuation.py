"""Branches of periodic orbits: folds, instability and period doubling against other methods."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from known_systems import MESH_FREQUENCY, hysteresis_system, reference_system
from references.backlash_orbits import HIGH, LOW
from tribodyn.analysis import peak_to_peak
from tribodyn.dynamics import Contact, System, continuation, steady_state
from tribodyn.errors import ComputationError, InputError, ModelWarning

TURN = 2.0 * np.pi


@pytest.fixture(scope="module")
def hysteresis():
    return continuation(hysteresis_system(), between=(0.8 / TURN, 1.0 / TURN), at=[0.88 / TURN])


def orbits_at(branch, value):
    return np.flatnonzero(np.abs(branch.parameter - value) < 1e-12)


def one_cycle(rate, state):
    """Case H1 over one cycle by an adaptive method that knows nothing of steps or contacts."""

    def slope(time, y):
        force = np.sign(y[0]) * max(abs(y[0]) - 1.0, 0.0)
        return [y[1], 0.5 - 0.1 * y[1] - (1.0 + 0.2 * np.cos(rate * time)) * force]

    period = TURN / rate
    solution = solve_ivp(
        slope, (0.0, period), state, method="DOP853", rtol=1e-11, atol=1e-12, max_step=period / 64
    )
    return solution.y[:, -1]


def multipliers_of(rate, state):
    step = 1e-5
    columns = [
        (one_cycle(rate, state + step * unit) - one_cycle(rate, state - step * unit)) / (2 * step)
        for unit in np.eye(2)
    ]
    return np.sort(np.linalg.eigvals(np.array(columns).T).real)


def test_backlash_branch_turns_back_at_the_ends_of_the_hysteresis(hysteresis):
    folds = [TURN * fold.parameter for fold in hysteresis.special("fold")]
    assert folds == pytest.approx([0.9069, 0.8344], abs=5e-5)
    for fold in hysteresis.special("fold"):
        assert np.abs(fold.floquet_multipliers - 1.0).min() < 1e-6
    (grazing,) = hysteresis.special("grazing")
    assert TURN * grazing.parameter == pytest.approx(0.90411, abs=5e-6)
    assert [point.kind for point in hysteresis.special_points] == ["grazing", "fold", "fold"]
    assert hysteresis.complete
    assert hysteresis.parameter[[0, -1]] == pytest.approx([0.8 / TURN, 1.0 / TURN])
    assert hysteresis.error.max() < 2e-9


def test_three_orbits_at_one_speed(hysteresis):
    three = orbits_at(hysteresis, 0.88 / TURN)
    assert hysteresis.stable[three].tolist() == [True, False, True]
    low, middle, high = three
    assert hysteresis.rms[[low, high], 0] == pytest.approx([LOW, HIGH], rel=3e-6)
    outer = np.abs(hysteresis.floquet_multipliers[[low, high]])
    np.testing.assert_allclose(outer, 0.699773, rtol=2e-6)
    assert hysteresis.floquet_multipliers[middle, 0].real > 1.4
    # Only the damping sets the product of the multipliers, stable or not.
    product = np.prod(hysteresis.floquet_multipliers, axis=1).real
    np.testing.assert_allclose(product, np.exp(-0.1 / hysteresis.mesh_frequency), rtol=1e-5)
    assert hysteresis.contact_loss[low, 0] == 0.0 < hysteresis.contact_loss[middle, 0]
    assert hysteresis.clearance[low, 0] > 0.0 > hysteresis.clearance[middle, 0]


def test_unstable_orbit_and_fold_by_another_method(hysteresis):
    middle = orbits_at(hysteresis, 0.88 / TURN)[1]
    state = np.concatenate(hysteresis.start(middle))
    assert one_cycle(0.88, state) == pytest.approx(state, abs=1e-7)
    expected = np.sort(hysteresis.floquet_multipliers[middle].real)
    assert multipliers_of(0.88, state) == pytest.approx(expected, rel=1e-5)
    fold = hysteresis.special("fold")[1]
    state = np.concatenate((fold.position, fold.velocity))
    assert one_cycle(TURN * fold.parameter, state) == pytest.approx(state, abs=1e-7)
    assert multipliers_of(TURN * fold.parameter, state)[1] == pytest.approx(1.0, abs=1e-4)


def test_branch_starts_from_a_supplied_unstable_orbit(hysteresis):
    middle = orbits_at(hysteresis, 0.88 / TURN)[1]
    branch = continuation(
        lambda rate: (hysteresis_system(), rate / TURN),
        parameter="rate",
        between=(0.88, 0.83),
        start=hysteresis.start(middle),
        steps=128,
        longest_step=0.1,
    )
    assert not branch.stable[0]
    assert branch.rms[0] == pytest.approx(hysteresis.rms[middle], rel=1e-4)
    (fold,) = branch.special("fold")
    assert fold.parameter == pytest.approx(TURN * hysteresis.special("fold")[1].parameter, rel=1e-6)
    assert branch.parameter[-1] == pytest.approx(0.88)


def oscillator(swing, damping, gap=0.0, load=1.0):
    contact = Contact([1.0], lambda phase: 1.0 + swing * np.cos(TURN * phase), gap=gap)
    return System([[1.0]], [[damping]], [[0.0]], [load], [contact])


def test_multipliers_of_a_linear_oscillator():
    branch = continuation(oscillator(0.0, 0.1), between=(0.05, 0.3), steps=2048, longest_step=0.2)
    rate = complex(-0.05, np.sqrt(1.0 - 0.05**2))
    exact = np.exp(rate / branch.mesh_frequency)
    exact = np.sort_complex(np.stack((exact, exact.conj()), axis=1))
    np.testing.assert_allclose(np.sort_complex(branch.floquet_multipliers), exact, atol=1e-10)
    assert branch.stable.all()
    assert branch.special_points == ()
    assert branch.mean[:, 0] == pytest.approx(1.0, rel=1e-12)


def test_meissner_multipliers():
    high, low, rate, duty = 1.4, 0.6, 1.3, 0.3
    contact = Contact([1.0], lambda p: np.where(p < duty, high, low), events=(0.0, duty))
    motion = steady_state(
        System([[1.0]], [[0.0]], [[0.0]], [0.0], [contact]), rate / TURN, steps=4096
    )

    def part(stiffness, time):
        w = np.sqrt(stiffness)
        c, s = np.cos(w * time), np.sin(w * time)
        return np.array([[c, s / w], [-w * s, c]])

    period = TURN / rate
    exact = np.linalg.eigvals(part(low, (1 - duty) * period) @ part(high, duty * period))
    multipliers = np.sort_complex(motion.floquet_multipliers)
    np.testing.assert_allclose(multipliers, np.sort_complex(exact), atol=1e-10)


def hill(rate, swing, damping, terms=8):
    """Determinant whose zeros are the speeds at which a motion of twice the period is neutral."""
    order = (np.arange(-terms, terms) + 0.5) * rate
    matrix = np.diag(1.0 - order**2 + 1j * damping * order)
    matrix = matrix + 0.5 * swing * (np.eye(2 * terms, k=1) + np.eye(2 * terms, k=-1))
    return np.linalg.det(matrix / np.maximum(1.0, order**2)[:, None]).real


def test_period_doubling_at_the_edges_of_the_mathieu_tongue():
    swing, damping = 0.2, 0.04
    branch = continuation(oscillator(swing, damping), between=(1.7 / TURN, 2.3 / TURN))
    speeds = [TURN * point.parameter for point in branch.special("period-doubling")]
    exact = [brentq(hill, a, a + 0.15, args=(swing, damping)) for a in (1.85, 2.0)]
    assert speeds == pytest.approx(exact, rel=1e-8)
    inside = (branch.parameter > speeds[0] / TURN) & (branch.parameter < speeds[1] / TURN)
    np.testing.assert_array_equal(branch.stable, ~inside)


def test_twice_the_period_from_a_period_doubling():
    system = oscillator(0.5, 0.1, gap=1.0, load=0.5)
    first = continuation(system, between=(2.4 / TURN, 1.9 / TURN), steps=256)
    doubling = first.special("period-doubling")[0]
    second = continuation(
        system, between=(2.4 / TURN, 1.9 / TURN), start=doubling, steps=256, points=60
    )
    assert second.period == 2
    away = np.flatnonzero(second.stable & (second.contact_loss[:, 0] > 0.1))
    assert away.size
    motion = steady_state(
        system, second.mesh_frequency[away[-1]], periods=2, start=second.start(away[-1]), steps=256
    )
    assert motion.period == 2
    assert motion.stable
    assert np.ptp(motion.fine.deflection) == pytest.approx(
        second.peak_to_peak[away[-1], 0], rel=1e-4
    )
    # At its beginning the branch has the motion of the single period.
    assert second.rms[0] == pytest.approx(doubling.rms, rel=0.05)


def test_pair_through_the_unit_circle_where_damping_vanishes():
    branch = continuation(
        lambda damping: oscillator(0.0, damping), 0.29, parameter="damping", between=(0.1, -0.13)
    )
    (point,) = branch.special_points
    assert point.kind == "neimark-sacker"
    assert point.parameter == pytest.approx(0.0, abs=1e-9)
    np.testing.assert_array_equal(branch.stable, branch.parameter > 0.0)


def test_branch_of_the_gear_pair_is_the_steady_state_at_every_speed():
    system = reference_system(0.1)
    branch = continuation(
        system, between=(MESH_FREQUENCY, 2.0 * MESH_FREQUENCY), at=[1.37 * MESH_FREQUENCY],
        longest_step=0.2, signals=("pinion_y", "deflection"),
    )  # fmt: skip
    (index,) = orbits_at(branch, 1.37 * MESH_FREQUENCY)
    motion = steady_state(system, 1.37 * MESH_FREQUENCY)
    swing = peak_to_peak(motion.fine.deflection[:, 0])
    assert branch.peak_to_peak[index, 1] == pytest.approx(float(swing), rel=1e-6)
    assert branch.rms[index, 0] == pytest.approx(
        np.sqrt(motion.fine.mean((motion.fine.position[:, 1] - branch.mean[index, 0]) ** 2)),
        rel=1e-6,
    )
    np.testing.assert_allclose(
        np.abs(branch.floquet_multipliers[index]), np.abs(motion.floquet_multipliers), atol=1e-8
    )


def test_free_rotation_and_balancing_torque_have_no_multiplier():
    loaded = reference_system(0.1)
    free = replace(loaded, balance=[0.0, 0.0, 0.0, 0.0, 0.0, 1.0])
    first, other = (steady_state(system, 2000.0) for system in (loaded, free))
    assert first.floquet_multipliers.size == 10
    assert first.stable
    assert other.stable
    # The system is linear: no torque changes what becomes of a disturbance.
    np.testing.assert_allclose(
        np.sort(np.abs(other.floquet_multipliers)), np.sort(np.abs(first.floquet_multipliers)),
        atol=1e-9,
    )  # fmt: skip
    assert steady_state(loaded, 2000.0, periods=2).period == 1


@pytest.mark.slow
def test_where_and_why_a_branch_stops():
    def jump(parameter):
        return oscillator(0.1, 0.1, load=1.0 if parameter < 0.5 else 300.0)

    with pytest.warns(ModelWarning, match=r"stopped at 0\.4.*largest multiplier.*however short"):
        branch = continuation(
            jump, 0.2, parameter="p", between=(0.0, 1.0), steps=16, longest_step=0.1
        )
    assert not branch.complete
    assert "ended early" in repr(branch)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"between": (0.1, 0.1)}, "between"),
        ({"between": (0.1, 0.2), "periods": 0}, "periods"),
        ({"between": (0.1, 0.2), "longest_step": 0.0}, "longest_step"),
        ({"between": (0.1, 0.2), "signals": ["speed"]}, "speed"),
    ],
)
def test_bad_arguments_are_named(options, message):
    with pytest.raises(InputError, match=message):
        continuation(oscillator(0.1, 0.1), **options)


def test_function_has_to_return_a_system():
    with pytest.raises(InputError, match="mesh frequency"):
        continuation(lambda p: oscillator(p, 0.1), parameter="p", between=(0.1, 0.2))
    fold = continuation(
        hysteresis_system(), between=(0.138, 0.145), steps=128, longest_step=0.1
    ).special("fold")[0]
    with pytest.raises(InputError, match="range"):
        continuation(hysteresis_system(), between=(0.138, 0.14), start=fold, steps=128)
    with pytest.raises(ComputationError, match="no branch"):
        continuation(hysteresis_system(), between=(0.138, 0.145), start=fold, steps=128)


def test_twice_the_period_does_not_depend_on_the_sign_of_an_eigenvector(monkeypatch):
    system = oscillator(0.5, 0.1, gap=1.0, load=0.5)
    first = continuation(system, between=(2.4 / TURN, 1.9 / TURN), steps=128)
    doubling = first.special("period-doubling")[0]
    eig, signs, starts = np.linalg.eig, (1.0, -1.0), []
    for sign in signs:
        monkeypatch.setattr(np.linalg, "eig", lambda a, s=sign: (eig(a)[0], s * eig(a)[1]))
        branch = continuation(
            system, between=(2.4 / TURN, 1.9 / TURN), start=doubling, steps=128, points=4
        )
        starts.append(np.concatenate(branch.start(1)))
    np.testing.assert_array_equal(*starts)
