"""Angle of the shaft, orders and their course, on run-ups whose orders are known."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn.errors import ComputationError, InputError, ModelWarning
from tribodyn.measurement import (
    order_map,
    order_spectrum,
    shaft_angle,
    sideband_cursors,
    synthetic_run_up,
    track_orders,
)
from tribodyn.signals.uneven_transform import uneven_transform

ORDERS = {1: 1.0, 14.5: 0.3, 29: 2.0, 58: 0.5}
UP_AND_DOWN = (0.0, 3000.0 * np.pi / 30.0, 0.0)


@pytest.fixture(scope="module")
def run():
    return synthetic_run_up(ORDERS, UP_AND_DOWN, jitter=0.01, noise=0.05)


@pytest.fixture(scope="module")
def angle(run):
    return shaft_angle(run["tacho"], run.sample_rate, 60)


def test_the_uneven_transform_equals_its_sum() -> None:
    random = np.random.default_rng(0)
    strength, place = random.normal(size=400), random.uniform(0.0, 0.5, 400)
    sums = np.exp(-2j * np.pi * np.outer(np.arange(80), place)) @ strength
    np.testing.assert_allclose(uneven_transform(strength, place, 80), sums, atol=1e-10)


def test_orders_of_a_run_from_rest_to_rest_to_a_thousandth(run, angle) -> None:
    spectrum = order_spectrum(run["signal"], angle, 70, unit="m/s^2")
    for order, amplitude in ORDERS.items():
        assert spectrum.amplitude(order) == pytest.approx(amplitude, rel=1e-3)
    assert "order 29" in repr(spectrum)
    assert spectrum.to_xarray().units == "m/s^2"


def test_an_order_between_lines_and_its_phase() -> None:
    time = np.arange(60_000) / 20_000.0
    turned = 2.0 * np.pi * (4.0 * time + 9.0 * time**2 + 0.3)
    signal = 0.7 + 2.0 * np.cos(4.08 * turned + 0.5)
    between_lines = order_spectrum(signal, turned, 20)
    line = int(np.argmax(between_lines.amplitudes[1:])) + 1
    assert between_lines.amplitudes[line] == pytest.approx(2.0, rel=1e-3)
    assert between_lines.amplitudes[0] == pytest.approx(0.7, rel=1e-3)
    on_line = order_spectrum(2.0 * np.cos(7.0 * turned + 0.5), turned, 20)
    at = int(np.argmin(np.abs(on_line.orders - 7.0)))
    assert on_line.phases[at] == pytest.approx(0.5, abs=1e-4)


def test_a_resonance_in_hertz_is_not_folded_onto_low_orders() -> None:
    """Without a filter over the angle a fixed frequency would appear as an order."""
    time = np.arange(100_000) / 20_000.0
    turned = 2.0 * np.pi * (2.0 * time + time**2)
    tone = np.cos(2.0 * np.pi * 3000.0 * time)
    assert order_spectrum(tone, turned, 20).amplitudes.max() < 1e-6


def test_the_map_and_its_cut_follow_an_order_from_rest(run, angle) -> None:
    orders = order_map(run["signal"], angle, 70, run.sample_rate, unit="m/s^2")
    cut = orders.cut(29)
    np.testing.assert_allclose(cut.amplitude, 2.0, rtol=3e-3)
    # speed of the middle of each block against the known course
    expected_speed = UP_AND_DOWN[1] * (1.0 - np.abs(orders.time - 10.0) / 10.0)
    np.testing.assert_allclose(orders.speed[3:-3], expected_speed[3:-3], rtol=0.02)


@pytest.mark.parametrize("per", [1, 4, 60])
@pytest.mark.parametrize("edge", ["rising", "falling"])
def test_the_angle_of_clean_pulses(per: int, edge: str) -> None:
    run = synthetic_run_up({}, UP_AND_DOWN, pulses_per_revolution=per)
    tacho = run["tacho"] if edge == "rising" else 5.0 - run["tacho"]
    estimate = shaft_angle(tacho, run.sample_rate, per, edge=edge)
    away = estimate - run["angle"]
    inner = (run.time > 1.0) & (run.time < 19.0)
    # a sample of a pulse is 2 pi 50 / 25600 = 0.012 rad at the highest speed
    assert np.std(away[inner]) < 0.002
    assert np.all(np.diff(estimate) >= 0.0)
    assert estimate[-1] - estimate[0] == pytest.approx(run["angle"][-1], abs=0.6)


@pytest.mark.parametrize(("missing", "double"), [(20, 0), (0, 20), (15, 15)])
def test_missing_and_double_pulses_are_counted_right(missing: int, double: int) -> None:
    run = synthetic_run_up(
        {}, UP_AND_DOWN, sample_rate=51200.0, jitter=0.01, missing=missing, double=double, seed=3
    )
    with pytest.warns(ModelWarning, match="tacho-repaired") as warned:
        estimate = shaft_angle(run["tacho"], run.sample_rate, 60)
    text = str(warned[0].message)
    assert (f"{missing} missing" in text) == bool(missing)
    assert (f"{double} double" in text) == bool(double)
    away = estimate - run["angle"]
    assert np.ptp(away[(run.time > 1.0) & (run.time < 19.0)]) < 0.01  # a pulse is 0.105 rad


def test_a_standstill_is_no_missing_pulse() -> None:
    turn = np.pi / 30.0
    run = synthetic_run_up({}, np.array([0.0, 1500.0, 0.0, 0.0, 1500.0, 0.0]) * turn)
    estimate = shaft_angle(run["tacho"], run.sample_rate, 60)
    assert np.ptp(estimate - run["angle"]) < 0.2


def test_jitter_is_smoothed_and_speed_is_not() -> None:
    run = synthetic_run_up({}, (100.0, 300.0, 150.0), jitter=0.05, seed=1)
    estimate = shaft_angle(run["tacho"], run.sample_rate, 60)
    away = (estimate - run["angle"])[1000:-1000]
    assert np.std(away) < 0.25 * 0.05 * 2.0 * np.pi / 60.0


@pytest.mark.parametrize(
    ("speeds", "per"), [((1500.0, 1500.0), 60), ((0.0, 0.0, 3000.0, 3000.0, 0.0, 0.0), 60),
                        (UP_AND_DOWN, 60)]
)  # fmt: skip
def test_steep_edges_that_repeat_with_the_samples_are_no_speed(speeds, per: int) -> None:
    """Square pulses, known only to a sample, at speeds that go into the sampling rate or rest."""
    turn = 1.0 if speeds is UP_AND_DOWN else np.pi / 30.0
    run = synthetic_run_up({}, np.array(speeds) * turn, duration=10.0, sample_rate=25600.0)
    angle, orders = run["angle"], {1: 1.0, 14.5: 0.3, 40: 0.5}
    pulses = 5.0 * (np.sin(per * angle) > 0.0)
    signal = 100.0 + sum(size * np.cos(order * angle) for order, size in orders.items())
    spectrum = order_spectrum(signal, shaft_angle(pulses, run.sample_rate, per), 50)
    for order, size in orders.items():
        assert spectrum.amplitude(order) == pytest.approx(size, rel=1e-3)
    assert spectrum.amplitude(0) == pytest.approx(100.0, rel=1e-3)


def test_pulses_in_noise_are_counted_or_refused() -> None:
    """Noise at a slow speed parts gaps in every way; what parts none is left alone."""
    run = synthetic_run_up({}, UP_AND_DOWN, duration=8.0, seed=2)
    speed = np.gradient(run["angle"], run.time) / UP_AND_DOWN[1]
    noise = np.random.default_rng(0).normal(0.0, 0.01, speed.size)
    pickup = speed * np.sin(60.0 * run["angle"]) + noise
    with pytest.warns(ModelWarning, match="tacho-repaired"):
        estimate = shaft_angle(pickup, run.sample_rate, 60)
    inner = (run.time > 1.0) & (run.time < 7.0)
    assert np.ptp((estimate - run["angle"])[inner]) < 0.01


def test_the_filter_solves_its_equations() -> None:
    count, rate, width = 60, 100.0, 10.0
    signal = np.random.default_rng(0).normal(size=count)
    turned = np.linspace(0.0, 20.0, count)
    tracked = track_orders(signal, turned, [1.0, 2.5], rate, bandwidth=width)
    weight = (np.sqrt(2) - 1) / (
        6 - 8 * np.cos(np.pi * width / rate) + 2 * np.cos(2 * np.pi * width / rate)
    )
    second = np.diff(np.eye(count), 2, axis=0)
    waves = np.hstack([np.diag(np.exp(1j * order * turned)) for order in (1.0, 2.5)])
    matrix = waves.conj().T @ waves + weight * np.kron(np.eye(2), second.T @ second)
    solution = np.linalg.solve(matrix, 2.0 * waves.conj().T @ signal).reshape(2, count)
    np.testing.assert_allclose(tracked.amplitude * np.exp(1j * tracked.phase), solution, atol=1e-10)


def test_the_filter_passes_half_its_power_at_the_edge_of_its_band() -> None:
    rate, width = 1000.0, 4.0
    time = np.arange(20_000) / rate
    turned = 2.0 * np.pi * 100.0 * time
    edge_wave = np.cos(2.0 * np.pi * (100.0 + 0.5 * width) * time)
    tracked = track_orders(edge_wave, turned, [1.0], rate, bandwidth=width)
    assert np.median(tracked.amplitude) == pytest.approx(1.0 / np.sqrt(2.0), rel=1e-3)


def test_track_orders_separates_crossing_orders(run, angle) -> None:
    part = run.cut(5.0, 8.0)
    tracked = track_orders(
        part["signal"], part["angle"], [1, 29, 58], run.sample_rate, bandwidth=2.0
    )
    middle = tracked.amplitude[:, 8000:-8000]
    np.testing.assert_allclose(middle[1], 2.0, atol=0.03)
    np.testing.assert_allclose(middle[2], 0.5, atol=0.03)
    assert tracked.waveform(29).shape == part["signal"].shape
    for item in (tracked, order_spectrum(part["signal"], part["angle"], 40), run):
        assert item.plot().layout.title.text


def test_lines_of_a_synthetic_run_up() -> None:
    quiet = synthetic_run_up({2: 3.0}, (50.0,), duration=2.0, sample_rate=4000.0)
    np.testing.assert_allclose(quiet["angle"], 50.0 * quiet.time)
    np.testing.assert_allclose(quiet["signal"], 3.0 * np.cos(2.0 * quiet["angle"]))
    with pytest.raises(InputError, match="half of"):
        synthetic_run_up({5000: 1.0})
    with pytest.raises(InputError, match="samples"):
        synthetic_run_up({}, pulses_per_revolution=2000)


def test_refusals() -> None:
    time = np.arange(20_000) / 1000.0
    turned = 2.0 * np.pi * 20.0 * time
    signal = np.cos(turned)
    with pytest.raises(InputError, match="resolve orders up to 25"):
        order_spectrum(signal, turned, 30)
    with pytest.raises(InputError, match="angle falls"):
        order_spectrum(signal, -turned, 3)
    with pytest.raises(InputError, match="samples"):
        order_spectrum(signal, turned[:-1], 3)
    with pytest.raises(InputError, match=r"turns 0\.99"):
        order_spectrum(signal[:51], turned[:51] * 0.999, 3)
    with pytest.raises(InputError, match="constant"):
        shaft_angle(np.ones(100), 1000.0, 1)
    with pytest.raises(ComputationError, match="pulses found"):
        shaft_angle(np.cos(2.0 * np.pi * np.arange(1000) / 400.0), 1000.0, 1)
    with pytest.raises(InputError, match="tracked only once"):
        track_orders(signal, turned, [1, 1], 1000.0)
    with pytest.raises(InputError, match="not two"):
        track_orders(signal, turned, [40], 1000.0)
    with pytest.raises(ComputationError, match="bandwidth"):
        track_orders(signal, turned, [1], 1000.0, bandwidth=0.001)


def test_cursors_on_the_sidebands_of_amplitude_and_phase_modulation():
    """Equal indices of both kinds add at +1 and cancel at -1; the third order is of one kind."""
    turn = 2 * np.pi * 25.0 * np.arange(40_000) / 10_000.0
    size = 1.0 + 0.1 * np.cos(turn) + 0.03 * np.cos(3 * turn)
    noise = 0.3 * np.random.default_rng(5).standard_normal(turn.size)
    orders = order_spectrum(3.0 * size * np.cos(29 * turn + 0.1 * np.sin(turn)) + noise, turn, 60)
    cursors = sideband_cursors(orders, 29)
    by_number = dict(zip(cursors.number.tolist(), cursors.amplitude, strict=True))
    assert by_number[1] == pytest.approx(0.3, rel=0.03)
    assert by_number[-3] == pytest.approx(0.045, abs=0.012)
    assert cursors.number[cursors.clear].tolist() == [-3, 0, 1, 3]
    assert cursors.level[cursors.strongest] == pytest.approx(-20.0, abs=0.3)
    figure = cursors.plot()
    assert figure.layout.title.text.startswith("Order 29.00: strongest sideband +1 at 30.00, ")
    assert figure.layout.yaxis.type == "log"
    points = next(each for each in figure.data if each.name == "clear")
    assert list(points.x) == [26, 29, 30, 32]
    for options, message in (
        ({"count": 40}, "reach from order -11 to 69"),
        ({"spacing": 0.05}, "lines are separate from 0.121 on"),
    ):
        with pytest.raises(InputError, match=message):
            sideband_cursors(orders, 29, **options)
