"""Waves that move through the contact keep the amplitude of the published curve."""

import numpy as np
import pytest

from tribodyn.ehl import (
    AmplitudeReduction,
    RoughnessProfile,
    amplitude_reduction,
    flattened_roughness,
    solve_amplitude_reduction,
    solve_line_contact,
    solve_transient_line_contact,
)
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


def test_random_roughness_of_both_surfaces_is_flattened_wave_by_wave() -> None:
    """Pure rolling: the film follows the sum of both profiles, each wave with what it keeps."""
    load, speed, half_width = contact(50.0, 10.0)
    smooth = solve_line_contact(load, RADIUS, speed, OIL, MODULUS)
    random, length = np.random.default_rng(1), 6.0 * half_width
    x = np.arange(256) * length / 256
    waves = np.arange(1, 13)[:, None]  # of 6 to 0.5 half widths
    heights = []
    for _ in range(2):
        phase, size = random.uniform(0.0, 2.0 * np.pi, (12, 1)), random.normal(size=(12, 1))
        height = (size * np.cos(2.0 * np.pi * waves * x / length + phase)).sum(axis=0)
        heights.append(0.1 * smooth.central_film / np.std(height) * height)
    profiles = [RoughnessProfile(x, height, "periodic") for height in heights]
    step = length / speed / 240
    time = step * np.arange(240 + 200)
    film = solve_transient_line_contact(
        time, load, RADIUS, speed, OIL, MODULUS, nodes=513, keep_every=0,
        roughness=(profiles[0], profiles[1]), surface_speeds=(speed, speed),
    ).central_film[-240:]  # fmt: skip
    combined = RoughnessProfile(x, heights[0] + heights[1], "periodic")
    flattened = flattened_roughness(combined, half_width, 50.0, 10.0)
    assert np.std(film) == pytest.approx(flattened.rms, rel=0.08)
    assert np.std(film) < 0.6 * combined.rms
    # The curve says nothing of phases: waves of the film lag behind those of the surface.
    assert np.corrcoef(film, flattened(-speed * time[-240:]))[0, 1] > 0.65


def test_profiles_with_ends_lose_their_long_waves_too() -> None:
    x = np.linspace(0.0, 2e-3, 2001)
    mixed = 1e-7 * np.cos(2.0 * np.pi * x / 2e-3) + 1e-7 * np.cos(2.0 * np.pi * x / 2e-5)
    flattened = flattened_roughness(RoughnessProfile(x, mixed), 1e-4, 20.0, 10.0)
    short = float(amplitude_reduction(2e-5, 1e-4, 20.0, 10.0))
    assert flattened.rms == pytest.approx(short * 1e-7 / np.sqrt(2.0), rel=0.02)


def test_the_curve_runs_from_short_to_long_waves() -> None:
    ratio = amplitude_reduction(np.array([1e-9, 1e-4, 1.0]), 1e-4, 20.0, 10.0)
    assert ratio == pytest.approx([1.0, 0.5773, 0.0], abs=1e-3)
