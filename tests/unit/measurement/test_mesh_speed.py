"""Mesh frequency from mesh lines alone: recordings are written in closed form in this file."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn.errors import InputError
from tribodyn.measurement import MeshSpeed, mesh_speed, order_spectrum

RATE, MESH = 8000.0, 400.0
SIZES = {1: 5.0, 2: 2.0, 3: 1.0, 4: 0.5, 5: 0.25}


def phase_of(ratio, wander=0.0, rate_of_wander=0.5, duration=4.0, sample_rate=RATE, mesh=MESH):
    """Angle of the mesh for ratio (1 + wander cos(w t)), and its mean frequency over that mesh."""
    time = np.arange(round(duration * sample_rate)) / sample_rate
    turn = 2.0 * np.pi * rate_of_wander
    angle = 2.0 * np.pi * mesh * ratio * (time + wander * np.sin(turn * time) / turn)
    return angle, angle[-1] / (2.0 * np.pi * mesh * time[-1])


def recording(angle, sizes, decibel=None, seed=0, shaft=None):
    """Harmonics of the mesh, amplitude modulation once per turn of a shaft, and white noise."""
    wave = sum(size * np.cos(k * angle + k) for k, size in sizes.items())
    if shaft is not None:
        teeth, depth = shaft
        wave = wave * (1.0 + depth * np.cos(angle / teeth))
    if decibel is None:
        return wave
    noise = np.random.default_rng(seed).standard_normal(angle.size)
    return wave + np.std(wave) * 10.0 ** (-decibel / 20.0) * noise


@pytest.mark.parametrize("decibel", [None, 20.0])
@pytest.mark.parametrize(
    ("ratio", "wander", "rate_of_wander"),
    [(0.97, 0.0, 1.0), (1.01, 0.0, 1.0), (1.03, 0.01, 0.5), (0.99, 0.01, 2.0)],
)
def test_ratio_and_harmonics_of_a_speed_that_is_off_and_wanders(
    ratio, wander, rate_of_wander, decibel
) -> None:
    angle, mean = phase_of(ratio, wander, rate_of_wander)
    wave = recording(angle, SIZES, decibel)
    speed = mesh_speed(wave, RATE, MESH)
    assert abs(speed.ratio - mean) < 4.0 * speed.uncertainty
    assert speed.uncertainty < 1e-4
    orders = order_spectrum(wave, speed.angle, 5.5)
    for k, size in SIZES.items():
        assert orders.amplitude(k) == pytest.approx(size, rel=0.05)
    assert speed.highest - speed.lowest == pytest.approx(2.0 * wander * ratio, abs=1e-3)
    assert speed.rivals == ()
    assert speed.mesh_frequency == pytest.approx(MESH * speed.ratio)


def test_uncertainty_of_the_angle_is_its_scatter_in_noise() -> None:
    """Where the speed wanders; a steady angle errs by its slope only."""
    for wander, least in ((0.01, 0.7), (0.0, 0.0)):
        angle, _ = phase_of(1.0, wander)
        speed = mesh_speed(recording(angle, {1: 1.0, 2: 0.5}, 0.0), RATE, MESH, harmonics=2)
        scatter = np.std(speed.angle - angle)
        assert least * speed.angle_uncertainty < scatter < 1.6 * speed.angle_uncertainty


def test_a_record_without_noise_has_no_lines_in_its_leakage() -> None:
    """Searched harmonics that are absent leave the speed alone."""
    angle, mean = phase_of(1.0, 0.01)
    speed = mesh_speed(recording(angle, {1: 4.0, 2: 1.5}), RATE, MESH, teeth=(20,))
    assert speed.harmonics == (1, 2)
    assert speed.ratio == pytest.approx(mean, abs=2e-5)


def test_one_harmonic_alone_and_a_gear_of_other_numbers() -> None:
    angle, mean = phase_of(0.985, 0.01, sample_rate=12800.0, mesh=1450.0)
    wave = recording(angle, {2: 1.0}, 20.0)
    speed = mesh_speed(wave, 12800.0, 1450.0, harmonics=3, teeth=(29, 67))
    assert abs(speed.ratio - mean) < 4.0 * speed.uncertainty
    assert speed.harmonics == (2,)
    assert order_spectrum(wave, speed.angle, 2.5).amplitude(2) == pytest.approx(1.0, rel=0.02)


@pytest.mark.parametrize("depth", [0.3, 0.8])
def test_sidebands_of_a_shaft_are_not_taken_for_the_mesh(depth) -> None:
    angle, mean = phase_of(1.0 + 1.0 / 29.0)  # a sideband lies at the assumed frequency
    speed = mesh_speed(recording(angle, SIZES, 20.0, shaft=(29, depth)), RATE, MESH)
    assert speed.ratio == pytest.approx(mean, abs=1e-5)


def test_another_channel_helps_where_one_is_buried_in_noise() -> None:
    angle, mean = phase_of(1.02, 0.01)
    buried, clear = (recording(angle, SIZES, level, seed=1) for level in (-40.0, 20.0))
    assert not mesh_speed(buried, RATE, MESH).located
    assert mesh_speed([buried, clear], RATE, MESH).ratio == pytest.approx(mean, abs=1e-5)


def test_two_combs_of_one_strength_are_both_named() -> None:
    first, second = phase_of(0.98)[0], phase_of(1.013)[0]
    pair = mesh_speed(recording(first, SIZES, 20.0) + recording(second, SIZES), RATE, MESH)
    assert {round(pair.ratio, 4), *np.round(pair.rivals, 4)} == {0.98, 1.013}


@pytest.mark.parametrize("ratio", [0.5, 1.3])
def test_lines_that_fit_by_chance_are_not_taken_where_stronger_ones_lie(ratio) -> None:
    """Lines 2 and 4 of half the speed, and line 3 of 1.3 times it at 0.975 times harmonic 4."""
    speed = mesh_speed(recording(phase_of(ratio)[0], SIZES, 20.0), RATE, MESH)
    assert not speed.located
    assert f"stronger ones lie at {ratio:.4g} times" in speed.method


@pytest.mark.parametrize("seed", range(4))
def test_noise_has_no_speed_and_neither_has_a_resonance_in_it(seed) -> None:
    from scipy.signal import lfilter

    noise = np.random.default_rng(seed).standard_normal(round(2.0 * RATE))
    damped = np.exp(-0.01 * 2.0 * np.pi * MESH / RATE)
    pole = damped * np.exp(2j * np.pi * 1.02 * MESH / RATE)
    rung = lfilter([1.0], [1.0, -2.0 * pole.real, abs(pole) ** 2], noise)
    for wave in (noise, rung):
        speed = mesh_speed(wave, RATE, MESH, harmonics=3)
        assert not speed.located
        assert "no steady mesh line" in speed.method
        assert np.isnan(speed.uncertainty)


def test_lines_beyond_the_tolerance_are_named_and_not_taken() -> None:
    speed = mesh_speed(recording(phase_of(1.08)[0], SIZES, 20.0), RATE, MESH)
    assert not speed.located
    assert "1.08 times 400 Hz, beyond the tolerance of 5 %" in speed.method
    assert mesh_speed(recording(phase_of(1.08)[0], SIZES), RATE, MESH, tolerance=0.1).located


def test_errors_agree_with_the_stated_uncertainty() -> None:
    errors = []
    for seed in range(8):
        angle, mean = phase_of(1.01, 0.005, duration=1.0)
        speed = mesh_speed(recording(angle, SIZES, 6.0, seed), RATE, MESH)
        errors.append((speed.ratio - mean) / speed.uncertainty)
    assert isinstance(speed, MeshSpeed)
    assert 0.05 < np.sqrt(np.mean(np.square(errors))) < 2.0


@pytest.mark.parametrize(
    ("options", "text"),
    [
        ({"signal": np.ones(8000)}, "constant"),
        ({"signal": np.sin(np.arange(300.0))}, "lasts 15 mesh cycles"),
        ({"mesh_frequency": 3900.0}, "Sample faster"),
        ({"tolerance": 0.5}, "tolerance"),
        ({"harmonics": 0}, "harmonics"),
        ({"sample_rate": -1.0}, "sample_rate"),
    ],
)
def test_refusals(options, text) -> None:
    wave = np.sin(2.0 * np.pi * MESH * np.arange(8000) / RATE)
    with pytest.raises(InputError, match=text):
        mesh_speed(**{"signal": wave, "sample_rate": RATE, "mesh_frequency": MESH} | options)
