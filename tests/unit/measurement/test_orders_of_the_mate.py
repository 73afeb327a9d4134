"""Orders of the mate: amplitudes in closed form, over any number of turns and a wandering speed."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn.measurement import (
    Recording,
    analyse_signal,
    mesh_speed,
    order_spectrum,
    sideband_cursors,
)

RATE, TURN = 6_000.0, 10.0


def modulated_mesh(teeth: int, mate: int, angle: np.ndarray, noise: float = 0.05) -> np.ndarray:
    """Mesh of 10 with sidebands of the mate of 1.5 and 2, which is amplitude and phase modulation.

    Its second harmonic of 4 has sidebands of 0.5 and 0.8.
    """
    ratio = teeth / mate
    wave = 10.0 * np.cos(teeth * angle) + 4.0 * np.cos(2 * teeth * angle + 1.0)
    for order, size, phase in (
        (teeth - ratio, 1.5, -0.4),
        (teeth + ratio, 2.0, 0.3),
        (2 * teeth - ratio, 0.5, 2.0),
        (2 * teeth + ratio, 0.8, 0.0),
    ):
        wave += size * np.cos(order * angle + phase)
    return wave + noise * np.random.default_rng(1).standard_normal(angle.size)


def angle_of(turns: float, wander: float = 0.0) -> np.ndarray:
    """Angle of the shaft; its speed wanders by some rpm every 20 s."""
    time = np.arange(round(turns / TURN * RATE)) / RATE
    slow = 2.0 * np.pi * 0.05
    return 2.0 * np.pi * (TURN * time + wander / 60.0 / slow * np.sin(slow * time))


@pytest.mark.parametrize("turns", [7.3, 11.3, 15.0, 16.0, 21.4])
@pytest.mark.parametrize(("teeth", "mate"), [(24, 48), (22, 44)])
def test_half_orders_over_any_number_of_turns(teeth: int, mate: int, turns: float) -> None:
    angle = angle_of(turns)
    channels = {
        "acc": modulated_mesh(teeth, mate, angle),
        "pulse": 5.0 * ((angle / 2.0 / np.pi - 0.30012) % 1.0 < 0.1),
    }
    recording = Recording(channels, RATE, {"acc": "m/s^2", "pulse": "V"})
    orders = analyse_signal(recording, "acc", tacho="pulse", teeth=teeth, mate_teeth=mate).orders
    assert orders is not None
    sizes = [orders.amplitude(teeth + k) for k in (-0.5, 0.0, 0.5)]
    assert sizes == pytest.approx([1.5, 10.0, 2.0], rel=0.005)


@pytest.mark.parametrize("window", ["flattop", "hann", "boxcar"])
@pytest.mark.parametrize("order", [14.0, 14.125, 14.24, 14.37, 14.5])
def test_an_order_between_two_lines_has_its_amplitude(window: str, order: float) -> None:
    """One sine alone, also where no line of the spectrum is at its order."""
    angle = angle_of(41.2)
    spectrum = order_spectrum(3.0 * np.cos(order * angle), angle, 20.0, window=window)
    tolerance = 0.02 if window == "boxcar" else 1e-3
    assert spectrum.amplitude(order) == pytest.approx(3.0, rel=tolerance)


@pytest.mark.parametrize(("teeth", "mate"), [(16, 24), (24, 48), (29, 67)])
def test_period_puts_the_orders_of_the_mate_on_lines(teeth: int, mate: int) -> None:
    """Over turns of both gears the plain Fourier integral separates all of their orders."""
    period = mate // np.gcd(teeth, mate)
    angle = angle_of(2.9 * period)
    wave = modulated_mesh(teeth, mate, angle, noise=0.0)
    spectrum = order_spectrum(wave, angle, 2.5 * teeth, window="boxcar", period=int(period))
    assert spectrum.revolutions == 2 * period
    sizes = [spectrum.amplitude(teeth + k * teeth / mate) for k in (-1, 0, 1)]
    assert sizes == pytest.approx([1.5, 10.0, 2.0], rel=2e-3)


@pytest.mark.parametrize(
    ("teeth", "mate", "wander"), [(24, 48, 0.0), (24, 48, 0.1), (29, 67, 1.0), (40, 23, 10.0)]
)
def test_run_out_of_a_gear_is_not_taken_for_speed(teeth: int, mate: int, wander: float) -> None:
    """The two sidebands differ by phase modulation, which stays while the speed is followed."""
    angle = angle_of(200.0, wander)
    wave = modulated_mesh(teeth, mate, angle, noise=0.1)
    recording = Recording({"acc": wave}, RATE, {"acc": "m/s^2"})
    stated = 2.0 * np.pi * 1.002 * TURN
    analysis = analyse_signal(recording, "acc", speed=stated, teeth=teeth, mate_teeth=mate)
    assert analysis.orders is not None
    cursors = sideband_cursors(analysis.orders, teeth, teeth / mate, count=1)
    assert cursors.amplitude == pytest.approx([1.5, 10.0, 2.0], rel=0.025)
    assert analysis.figures()["mesh_harmonic_2_amplitude"] == pytest.approx(4.0, rel=0.005)


def test_what_is_followed_as_speed_is_said() -> None:
    angle = angle_of(100.0, 1.0)
    speed = mesh_speed(modulated_mesh(24, 48, angle), RATE, 24 * TURN, teeth=(24, 48))
    assert "what repeats slower than 5 Hz counts as speed" in speed.method
