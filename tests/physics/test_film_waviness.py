"""Waves that move through the contact keep the amplitude of the published curve."""

import numpy as np
import pytest

from tribodyn.ehl import AmplitudeReduction, amplitude_reduction, solve_amplitude_reduction
from tribodyn.lubricant import Lubricant

OIL, MODULUS, RADIUS = Lubricant(0.08, 880.0, 2.2e-8), 2.2e11, 8e-3


def contact(M: float, L: float) -> tuple[float, float, float]:
    """Load, entrainment speed and half width of a contact with these numbers of Moes."""
    speeds = (L / (OIL.pressure_viscosity_coefficient * MODULUS)) ** 4
    load = M * np.sqrt(speeds) * MODULUS * RADIUS
    speed = 0.5 * speeds * MODULUS * RADIUS / OIL.dynamic_viscosity
    return load, speed, np.sqrt(8.0 * load * RADIUS / (np.pi * MODULUS))


def solve(M: float, L: float, numbers: list[float], **options: float) -> AmplitudeReduction:
    load, speed, half_width = contact(M, L)
    lengths = np.array(numbers) * half_width * np.sqrt(L) / M**0.75
    return solve_amplitude_reduction(load, RADIUS, speed, OIL, MODULUS, lengths, **options)


def test_amplitudes_follow_the_curve_of_pure_rolling() -> None:
    waves = solve(50.0, 10.0, [4.0, 8.0, 16.0])
    assert waves.wave_number == pytest.approx([4.0, 8.0, 16.0], rel=1e-9)
    # 1/(1 + 0.125 N + 0.04 N^2); the constants of circular contacts are 0.08 off at 8
    by_hand = 1.0 / np.array([1.0 + 0.5 + 0.64, 1.0 + 1.0 + 2.56, 1.0 + 2.0 + 10.24])
    assert waves.fitted_ratio == pytest.approx(by_hand, rel=1e-9)
    assert waves.amplitude_ratio == pytest.approx(by_hand, abs=0.025)


def test_one_number_decides_and_the_amplitude_does_not() -> None:
    heavy, light = solve(50.0, 10.0, [8.0]), solve(20.0, 10.0, [8.0])
    assert light.wavelength[0] > 1.2 * heavy.wavelength[0]
    assert light.amplitude_ratio == pytest.approx(heavy.amplitude_ratio, abs=0.01)
    higher = solve(20.0, 10.0, [8.0], amplitude=0.3 * light.central_film)
    assert higher.amplitude_ratio == pytest.approx(light.amplitude_ratio, rel=0.02)


def test_waves_of_the_slower_surface_are_flattened_more() -> None:
    slow, rolling, fast = (
        float(solve(20.0, 10.0, [8.0], slide_to_roll_ratio=ratio).amplitude_ratio[0])
        for ratio in (-0.5, 0.0, 0.5)
    )
    assert slow < 0.95 * rolling < 0.95 * fast


def test_the_curve_runs_from_short_to_long_waves() -> None:
    ratio = amplitude_reduction(np.array([1e-9, 1e-4, 1.0]), 1e-4, 20.0, 10.0)
    assert ratio == pytest.approx([1.0, 0.5773, 0.0], abs=1e-3)
