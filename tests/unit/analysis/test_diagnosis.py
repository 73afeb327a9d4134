"""Cepstrum, kurtogram and cyclic coherence of hand-made signals with known answers."""

import numpy as np
import pytest
from scipy.signal import butter, sosfilt

from tribodyn.analysis import (
    cepstrum,
    cyclic_coherence,
    envelope_spectrum,
    kurtogram,
    lifter,
    spectrum,
)
from tribodyn.errors import InputError

RATE = 10_000.0
TIME = np.arange(30_000) / RATE
NOISE = np.random.default_rng(3).standard_normal(TIME.size)


def impacts(rate, resonance, size):
    """Ringing of a resonance, struck at a rate with 1 % of random delay."""
    ring = size * np.exp(-500.0 * TIME[:300]) * np.sin(2 * np.pi * resonance * TIME[:300])
    train = np.zeros(TIME.size)
    rng = np.random.default_rng(4)
    for start in np.arange(0.01, TIME[-400], 1.0 / rate):
        first = round((start + 0.01 / rate * rng.standard_normal()) * RATE)
        train[first : first + 300] += ring
    return train


def test_cepstra_of_an_echo():
    """log|1 + a z| = a z - a^2 z^2/2 + ...: half of each value at positive quefrencies."""
    wave = NOISE[:4000]
    lag, size = 250, 0.5
    echo = wave + size * np.roll(wave, lag)
    real = cepstrum(echo, RATE).cepstrum - cepstrum(wave, RATE).cepstrum
    exact = np.zeros(real.size)
    for k in range(1, 8):
        exact[k * lag] = -0.5 * (-size) ** k / k
    assert np.abs(real - exact)[:2000].max() < 3e-4
    pulse = np.zeros(4000)
    pulse[[40, 40 + lag]] = -1.0, -size
    result = cepstrum(pulse, RATE, kind="complex")
    assert (result.delay, result.sign) == (-40, -1)
    for k in range(1, 8):
        at = int(np.argmin(np.abs(result.quefrency - k * lag / RATE)))
        assert result.cepstrum[at] == pytest.approx(-((-size) ** k) / k, abs=1e-4)
    assert np.abs(result.cepstrum[1000:2000]).max() < 1e-4, "minimum phase: nothing before zero"


def test_a_complex_cepstrum_returns_its_signal():
    for values in (NOISE[:1000], 2.0 - NOISE[:1001]):
        np.testing.assert_allclose(
            cepstrum(values, RATE, kind="complex").signal(), values, atol=1e-9
        )
    with pytest.raises(InputError, match="real cepstrum has no phase"):
        cepstrum(NOISE, RATE).signal()


def test_sidebands_are_one_peak_at_the_period_of_the_shaft():
    mesh = sum(
        np.exp(1.2 * np.cos(2 * np.pi * 23.0 * TIME + k)) * np.cos(2 * np.pi * 667.0 * k * TIME)
        for k in range(1, 6)
    )
    result = cepstrum(mesh + 0.05 * NOISE, RATE, block_length=8192)
    assert result.peak(0.01, 0.2)[0] == pytest.approx(1.0 / 23.0, rel=2e-3)
    title = result.plot(shortest=0.01).layout.title.text
    assert "at 43.4" in title
    assert "lines every 23.0" in title


def test_liftering_removes_a_family_and_nothing_else():
    family = sum(np.cos(2 * np.pi * 25.0 * k * TIME + k * k) for k in range(1, 180))
    tone = 5.0 * np.cos(2 * np.pi * 1234.0 * TIME)
    cleaned = lifter(NOISE + family + tone, RATE, remove=[1.0 / 25.0])
    before, after = (spectrum(each, RATE, window="hann") for each in (family, cleaned))
    lines = [int(np.argmin(np.abs(before.frequency - 25.0 * k))) for k in range(10, 170)]
    assert before.amplitude[lines] == pytest.approx(1.0, abs=1e-3)
    assert np.sqrt(np.mean(after.amplitude[lines] ** 2)) < 0.12
    assert np.std(cleaned) == pytest.approx(np.hypot(1.0, 5.0 / np.sqrt(2.0)), rel=0.05)
    smooth = lifter(NOISE + family, RATE, longest=0.002)
    assert spectrum(smooth, RATE, window="hann").amplitude[lines].max() < 0.2
    for options, message in (
        ({}, "nothing is to be removed"),
        ({"remove": [2.0]}, "quefrency of 2 s"),
        ({"longest": 1e-5}, "longest"),
    ):
        with pytest.raises(InputError, match=message):
            lifter(NOISE, RATE, **options)


def test_kurtogram_finds_the_band_of_impacts_and_not_that_of_the_mesh():
    mesh = 4.0 * np.cos(2 * np.pi * 700.0 * TIME) + 2.0 * np.cos(2 * np.pi * 1400.0 * TIME)
    signal = NOISE + mesh + impacts(73.0, 3100.0, 5.0)
    result = kurtogram(signal, RATE)
    low, high = result.band
    assert result.significant
    assert low < 3100.0 < high
    assert high - low < 2000.0
    lines = envelope_spectrum(signal, RATE, band=result.band, window="hann")
    assert lines.peaks(1)[0].frequency == pytest.approx(73.0, abs=0.2)
    title = result.plot().layout.title.text
    assert title.startswith("Most impulsive from ")
    assert f"{low:.0f} to {high:.0f} Hz" in title
    assert np.asarray(result.plot().data[0].z).max() == pytest.approx(
        result.kurtosis[result.best], abs=1e-3
    )


@pytest.mark.parametrize("cycles", [1000.0, 1000.25, 1000.5])
def test_a_steady_tone_is_not_impulsive_wherever_the_record_ends(cycles: float) -> None:
    """Cut off within a period, it would jump where both ends of a periodic record meet."""
    wave = 30.0 * np.cos(2.0 * np.pi * cycles / TIME.size * np.arange(TIME.size) + 0.3)
    result = kurtogram(wave + NOISE, RATE)
    assert not result.significant
    beside = (result.centre - result.width > 1000.0) & (result.splits <= 8)
    assert np.abs(result.kurtosis[beside]).max() < 0.2  # noise alone


def test_kurtogram_of_noise_and_of_tones():
    """K is 0 for noise and -1 for a tone; of two equal tones 1.5 - 2."""
    quiet = kurtogram(NOISE, RATE)
    assert not quiet.significant
    assert np.abs(quiet.kurtosis[:6]).max() < 0.1
    assert quiet.plot().layout.title.text == "No band is more impulsive than noise"
    one = kurtogram(np.cos(2 * np.pi * 1000.0 * TIME), RATE, levels=1)
    two = kurtogram(
        np.cos(2 * np.pi * 900.0 * TIME) + np.cos(2 * np.pi * 950.0 * TIME), RATE, levels=1
    )
    assert one.kurtosis[0] == pytest.approx(-1.0, abs=1e-3)
    assert two.kurtosis[0] == pytest.approx(-0.5, abs=1e-3)
    assert one.splits.tolist() == [1, 2, 2]
    with pytest.raises(InputError, match="30000 samples allow 7"):
        kurtogram(NOISE, RATE, levels=8)
    with pytest.raises(InputError, match="constant"):
        kurtogram(np.ones(4000), RATE)


def test_coherence_of_modulated_noise():
    """The spectral correlation of a(t) w(t) is the Fourier coefficient of a^2 at the frequency."""
    modulated = (1.0 + np.cos(2 * np.pi * 50.0 * TIME)) * NOISE
    result = cyclic_coherence(modulated, RATE, [33.0, 50.0, 75.0, 100.0, 150.0])
    mean = result.enhanced_envelope_spectrum((500.0, 4500.0))
    noise = 1.0 / result.blocks
    assert mean == pytest.approx(
        [0.0, (1.0 / 1.5) ** 2, 0.0, (0.25 / 1.5) ** 2, 0.0], abs=4 * noise
    )
    inner = (result.frequency > 500.0) & (result.frequency < 4500.0)
    assert np.mean(result.coherence[inner][:, [0, 2, 4]] > result.threshold) < 0.03
    assert result.strongest()[1] == 50.0


def test_coherence_is_one_for_random_impacts_and_zero_between():
    train = np.zeros(TIME.size)
    train[::200] = NOISE[::200]
    result = cyclic_coherence(train, RATE, [25.0, 50.0, 75.0, 100.0])
    inner = (result.frequency > 200.0) & (result.frequency < 4800.0)
    assert result.coherence[inner][:, [1, 3]].min() > 0.999
    assert result.coherence[inner][:, [0, 2]].max() < 0.1, "about 3 over the 150 impacts"
    assert result.coherence.max() <= 1.0 + 1e-5


def test_coherence_shows_the_carrier_that_is_modulated():
    band = butter(4, (2600.0, 3400.0), btype="bandpass", fs=RATE, output="sos")
    carrier = sosfilt(band, np.roll(NOISE, 777)) * (1.0 + np.cos(2 * np.pi * 40.0 * TIME))
    result = cyclic_coherence(0.02 * NOISE + carrier, RATE, np.arange(30.0, 50.5, 0.5))
    inside = result.enhanced_envelope_spectrum((2700.0, 3300.0))
    assert result.cyclic_frequency[np.argmax(inside)] == 40.0
    assert inside.max() == pytest.approx(4.0 / 9.0, abs=0.03)
    assert result.enhanced_envelope_spectrum((100.0, 1000.0)).max() < 0.02
    figure = result.plot()
    assert "40.00 Hz" in figure.layout.title.text
    assert figure.data[0].z.shape == result.coherence.shape
    for options, message in (
        ({"cyclic_frequencies": [0.5]}, "four periods"),
        ({"cyclic_frequencies": [50.0, 40.0]}, "must rise"),
        ({"cyclic_frequencies": [50.0], "block_length": 8192}, "independent blocks"),
    ):
        with pytest.raises(InputError, match=message):
            cyclic_coherence(NOISE, RATE, **options)
    with pytest.raises(InputError, match="band from 1 to 2 Hz"):
        result.enhanced_envelope_spectrum((1.0, 2.0))
