"""Indicators and spectra against closed forms."""

import numpy as np
import pytest

from tribodyn.analysis import (
    alternating_rms,
    amplitude_spectrum,
    crest_factor,
    extremes,
    line_of_action_indicator,
    mean,
    mesh_harmonics,
    peak_to_peak,
    rms,
)
from tribodyn.dynamics import Contact, System, simulate
from tribodyn.errors import InputError


@pytest.fixture(scope="module")
def motion():
    """Two cycles on a grid with unequal steps; only its samples are used."""
    contact = Contact([1.0], stiffness=1.0, events=(0.0, 0.3, 0.31))
    return simulate(System([[1.0]], [[0.0]], [[0.0]], [0.0], [contact]), 50.0, 2, ([0.0], [1.0]))


def _wave(motion):
    phase = 2 * np.pi * motion.fine.phase
    return 3.0 + 2.0 * np.cos(phase + 0.4) + 0.5 * np.cos(5 * phase - 1.0)


def test_means_and_rms(motion):
    wave = _wave(motion)
    assert mean(motion.fine, wave) == pytest.approx(3.0, abs=1e-9)
    assert rms(motion.fine, wave) == pytest.approx(np.sqrt(9 + 2 + 0.125), abs=1e-8)
    assert alternating_rms(motion.fine, wave) == pytest.approx(np.sqrt(2.125), abs=1e-8)


def test_harmonics_have_amplitude_and_phase(motion):
    harmonics = mesh_harmonics(motion, _wave(motion), 6)
    exact = np.array([2.0 * np.exp(0.4j), 0, 0, 0, 0.5 * np.exp(-1j), 0])
    np.testing.assert_allclose(harmonics, exact, atol=1e-7)


def test_spectrum_lines(motion):
    spectrum = amplitude_spectrum(motion, _wave(motion), highest=8, unit="um")
    assert spectrum.frequency[1] == pytest.approx(50.0)
    assert spectrum.amplitude[1] == pytest.approx(2.0, abs=1e-7)
    assert spectrum.amplitude[9] == pytest.approx(0.5, abs=1e-7)
    assert np.delete(spectrum.amplitude, [1, 9]).max() < 1e-7
    assert "largest 2 um at 50 Hz" in repr(spectrum)
    assert spectrum.to_xarray().attrs["units"] == "um"


def test_parseval(motion):
    wave = _wave(motion)
    power = 0.5 * np.sum(np.abs(mesh_harmonics(motion, wave, 10)) ** 2)
    assert np.sqrt(power) == pytest.approx(float(alternating_rms(motion.fine, wave)), rel=1e-7)


def test_jump_is_integrated_exactly(motion):
    phase = motion.fine.phase.reshape(-1, 3)
    inside = phase[:, 1] % 1.0 < 0.3
    wave = np.repeat(np.where(inside, 2.0, 1.0), 3)
    assert mean(motion.fine, wave) == pytest.approx(1.3, abs=1e-12)


def test_peaks_between_samples():
    """A sine sampled so that every sample misses its peak."""
    edges = np.linspace(0.0, 1.0, 16)
    t = np.stack([edges[:-1], (edges[:-1] + edges[1:]) / 2, edges[1:]], axis=1).reshape(-1)
    wave = np.sin(2 * np.pi * t + 0.05)
    low, high = extremes(wave)
    assert high - 1.0 == pytest.approx(0.0, abs=2e-4)
    assert abs(high - 1.0) < 0.2 * abs(wave.max() - 1.0)
    assert peak_to_peak(wave) == pytest.approx(high - low)


def test_crest_factor(motion):
    phase = 2 * np.pi * motion.fine.phase
    assert crest_factor(motion.fine, np.cos(phase)) == pytest.approx(np.sqrt(2), rel=1e-6)
    assert crest_factor(motion.fine, np.ones_like(phase)) == 0.0


def test_direction_indicator(motion):
    wave = _wave(motion)
    assert line_of_action_indicator(motion.fine, wave, 0.25 * wave + 7.0) == pytest.approx(0.25)
    assert line_of_action_indicator(motion.fine, wave, np.ones_like(wave)) == pytest.approx(0.0)
    assert line_of_action_indicator(motion.fine, 0 * wave, wave) == float("inf")


def test_harmonics_beyond_the_resolution_are_refused(motion):
    with pytest.raises(InputError, match="resolved up to harmonic"):
        mesh_harmonics(motion, _wave(motion), 100)
    with pytest.raises(InputError, match="one signal"):
        amplitude_spectrum(motion, np.ones((3, 3)))


@pytest.mark.parametrize("shape", [(), (2,), (2, 3)])
def test_extremes_are_those_of_the_parabolas_of_all_steps(shape):
    steps = np.random.default_rng(6).standard_normal((40, 3, *shape))
    tau = np.linspace(0.0, 1.0, 2001).reshape(-1, *(1,) * (steps.ndim - 1))
    left, middle, right = np.moveaxis(steps, 1, 0)
    weights = (1 - tau) * (1 - 2 * tau), 4 * tau * (1 - tau), tau * (2 * tau - 1)
    along = weights[0] * left + weights[1] * middle + weights[2] * right
    low, high = extremes(steps.reshape(-1, *shape))
    assert low == pytest.approx(along.min(axis=(0, 1)), rel=1e-6)
    assert high == pytest.approx(along.max(axis=(0, 1)), rel=1e-6)
