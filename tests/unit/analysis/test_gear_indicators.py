"""Condition indicators and narrowband demodulation of hand-made revolutions."""

import numpy as np
import pytest
from scipy import stats

from tribodyn import analysis, signals
from tribodyn.errors import ComputationError, InputError
from tribodyn.signals import (
    SynchronousAverage,
    condition_indicators,
    energy_ratio,
    fm0,
    fm4,
    locked_variance,
    m6a,
    m8a,
    na4,
    na4_star,
    narrowband_demodulation,
    nb4,
    sideband_index,
    sideband_level_factor,
)

TEETH = 21
ANGLE = 2 * np.pi * np.arange(840) / 840


def average(wave, angle=ANGLE):
    return SynchronousAverage(angle, wave, 0.0 * angle, 50, TEETH, "m/s^2")


def test_indicators_are_on_their_pages():
    for name in signals.__all__:
        assert getattr(analysis, name) is getattr(signals, name)


def test_moments_of_gaussian_differences():
    """3, 15 and 105 are the standardized moments of a normal distribution."""
    angle = 2 * np.pi * np.arange(400_000) / 400_000
    noise = 0.1 * np.random.default_rng(1).standard_normal(angle.size)
    noisy = average(np.cos(TEETH * angle) + noise, angle)
    assert fm4(noisy) == pytest.approx(3.0, rel=0.02)
    assert m6a(noisy) == pytest.approx(15.0, rel=0.05)
    assert m8a(noisy) == pytest.approx(105.0, rel=0.1)


def test_moments_against_another_implementation():
    bump = np.exp(-(((ANGLE - 2.0) / 0.05) ** 2)) * np.cos(70 * ANGLE)
    faulty = average(3.0 + np.cos(TEETH * ANGLE) + 0.3 * np.cos(ANGLE) + bump)
    difference = faulty.difference()
    scaled = stats.zscore(difference)
    assert fm4(faulty) == pytest.approx(stats.kurtosis(difference, fisher=False), rel=1e-12)
    assert m6a(faulty) == pytest.approx(stats.moment(scaled, 6), rel=1e-12)
    assert m8a(faulty) == pytest.approx(stats.moment(scaled, 8), rel=1e-12)
    assert na4(faulty) == pytest.approx(stats.kurtosis(faulty.residual(), fisher=False), rel=1e-12)
    everything = condition_indicators(faulty, earlier=[faulty])
    assert (everything.m6a, everything.m8a) == (m6a(faulty), m8a(faulty))
    assert (everything.nb4, everything.fm0) == (nb4(faulty), fm0(faulty))


def test_regular_and_difference_complete_the_revolution():
    low = 3.0 + 0.3 * np.cos(ANGLE) + 0.1 * np.sin(2 * ANGLE)
    mesh = np.cos(TEETH * ANGLE) + 0.2 * np.cos((TEETH + 1) * ANGLE)
    rest = 0.05 * np.cos((2 * TEETH + 2) * ANGLE)
    revolution = average(low + mesh + rest)
    assert revolution.regular() == pytest.approx(mesh, abs=1e-12)
    assert revolution.difference() == pytest.approx(rest, abs=1e-12)
    assert energy_ratio(revolution) == pytest.approx(0.05 / np.hypot(1.0, 0.2), rel=1e-9)


def test_running_variance_and_that_of_the_sound_gear():
    """A residual that grows by 1, 2, 3 has the fourth moment 81 of a kurtosis of 1.5."""
    records = [average(np.cos(TEETH * ANGLE) + k * np.cos(30 * ANGLE)) for k in (1, 2, 3)]
    assert na4(records[2], earlier=records[:2]) == pytest.approx(1.5 * 81.0 / (14.0 / 3.0) ** 2)
    assert na4_star(records[2], records[:1]) == pytest.approx(1.5 * 81.0)
    assert na4_star(records[2], records[:2]) == pytest.approx(1.5 * 81.0 / 2.5**2)
    with pytest.raises(InputError, match="good condition"):
        na4_star(records[2], [])
    # records of squares 1.0, 1.1, 1.2, 4 and 9: the mean is locked before the fourth
    damaged = [
        average(np.cos(TEETH * ANGLE) + np.sqrt(v) * np.cos(30 * ANGLE))
        for v in (1.0, 1.1, 1.2, 4.0, 9.0)
    ]
    assert na4_star(damaged[4], earlier=damaged[:4]) == pytest.approx(1.5 * 81.0 / 1.1**2)
    assert na4(damaged[4], earlier=damaged[:4]) == pytest.approx(1.5 * 81.0 / 3.26**2)
    assert condition_indicators(damaged[4], earlier=damaged[:4]).na4_star > 100.0
    # L = 1.1 + 3.09 * 0.1 / sqrt(3) = 1.278
    assert locked_variance([1.0, 1.1, 1.2, 1.27]) == (pytest.approx(1.1425), 4)
    assert locked_variance([1.0, 1.1, 1.2, 1.29]) == (pytest.approx(1.1), 3)


def test_envelope_moment_is_that_of_the_load():
    """NB4 sees the load on the teeth, not the phase of the mesh nor what is outside the band."""
    load = 1.0 - 0.4 * np.exp(8.0 * (np.cos(ANGLE - 1.0) - 1.0))
    wave = load * np.cos(TEETH * ANGLE + 0.4) + 0.3 * np.cos(2 * TEETH * ANGLE) + np.cos(ANGLE)
    exact = stats.kurtosis(load, fisher=False)
    assert exact > 3.0
    assert nb4(average(wave)) == pytest.approx(exact, rel=1e-3)
    twice = average(2.0 * wave)
    growth = 16.0 * exact / 2.5**2
    assert nb4(twice, earlier=[average(wave)]) == pytest.approx(growth, rel=1e-3)
    with pytest.raises(ComputationError, match="nothing but mesh"):
        nb4(average(np.cos(TEETH * ANGLE)))


def test_sidebands_of_a_modulated_mesh():
    wave = 3.0 * (1.0 + 0.2 * np.cos(ANGLE + 0.3)) * np.cos(TEETH * ANGLE)
    assert sideband_index(average(wave + 5.0)) == pytest.approx(0.3)
    rms = 3.0 * np.sqrt(0.5 * (1.0 + 0.2**2 / 2.0))
    assert sideband_level_factor(average(wave + 5.0)) == pytest.approx(0.6 / rms)
    with pytest.raises(ComputationError, match="does not change"):
        sideband_level_factor(average(0.0 * ANGLE))


@pytest.mark.parametrize("harmonic", [1, 3])
def test_modulation_of_amplitude_and_phase_is_recovered(harmonic):
    size = 0.3 * np.cos(ANGLE + 0.2) + 0.05 * np.cos(3 * ANGLE)
    crack = -0.2 * np.exp(12.0 * (np.cos(ANGLE - 2.0) - 1.0))
    wave = (1.0 + size) * np.cos(harmonic * TEETH * ANGLE + 0.7 + crack)
    other = 0.4 * np.cos(5 * TEETH * ANGLE) + np.cos(ANGLE)
    result = narrowband_demodulation(average(2.0 * wave + other), harmonic=harmonic)
    assert result.amplitude_modulation == pytest.approx(size, abs=1e-3)
    assert result.phase_modulation == pytest.approx(crack - crack.mean(), abs=1e-3)
    assert result.carrier_amplitude == pytest.approx(2.0, rel=1e-3)
    assert result.largest_lag == pytest.approx(2.0, abs=0.02)
    title = result.plot().layout.title.text
    assert "phase lags most at 115°" in title


def test_strongest_harmonic_is_demodulated_unless_named():
    wave = 0.5 * np.cos(TEETH * ANGLE) + (2.0 + np.cos(ANGLE)) * np.cos(2 * TEETH * ANGLE)
    result = narrowband_demodulation(average(wave))
    assert (result.harmonic, result.sidebands) == (2, 10)
    assert result.amplitude_modulation == pytest.approx(0.5 * np.cos(ANGLE), abs=1e-9)
    assert set(result.to_xarray()) == {"amplitude_modulation", "phase_modulation"}


def test_bands_without_a_carrier_are_refused():
    weak = 0.1 * np.cos(TEETH * ANGLE) + np.cos((TEETH + 1) * ANGLE)
    with pytest.raises(ComputationError, match="weaker than its sidebands"):
        narrowband_demodulation(average(weak), harmonic=1)
    with pytest.raises(InputError, match="Pass 1 to 20"):
        narrowband_demodulation(average(weak), sidebands=21)
    with pytest.raises(InputError, match="mesh harmonic 20 with 10 sidebands ends at 430"):
        narrowband_demodulation(average(weak), harmonic=20)
