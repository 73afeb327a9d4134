"""Spectra of recorded signals: gains of the windows, Parseval, peaks, zoom, spectrogram."""

import numpy as np
import pytest

from tribodyn.analysis import spectrogram, spectrum, zoom_spectrum
from tribodyn.errors import InputError

RATE = 1000.0
TIME = np.arange(1000) / RATE
#: Largest loss of amplitude between two lines.
LOSS = {"flattop": 0.0012, "hann": 0.152, "boxcar": 0.364}


def wave(frequency, amplitude=3.0, phase=0.4):
    return amplitude * np.cos(2 * np.pi * frequency * TIME + phase)


@pytest.mark.parametrize("window", ["flattop", "hann", "boxcar", "blackman"])
def test_sine_on_a_line_has_its_amplitude_and_phase(window):
    lines = spectrum(2.0 + wave(50.0), RATE, window=window)
    line = int(np.argmin(np.abs(lines.frequency - 50.0)))
    assert lines.amplitude[line] == pytest.approx(3.0, rel=1e-9)
    assert lines.phase[line] == pytest.approx(0.4, abs=1e-9)
    assert lines.amplitude[0] == pytest.approx(2.0, rel=1e-9)


@pytest.mark.parametrize("window", list(LOSS))
def test_loss_between_lines_is_within_the_stated_bound(window):
    away = np.linspace(-0.5, 0.5, 11)
    amplitudes = [spectrum(wave(100.0 + d), RATE, window=window).amplitude.max() for d in away]
    assert min(amplitudes) > 3.0 * (1.0 - LOSS[window])
    assert min(amplitudes) < 3.0 * (1.0 - 0.8 * LOSS[window])
    assert max(amplitudes) < 3.0 * 1.001


@pytest.mark.parametrize(("window", "bound"), [("flattop", 1e-5), ("hann", 1e-5), ("boxcar", 0.01)])
def test_peaks_between_lines(window, bound):
    for away in (-0.48, -0.2, 0.0, 0.31):
        peak = spectrum(wave(120.0 + away), RATE, window=window).peaks(1)[0]
        assert peak.frequency == pytest.approx(120.0 + away, abs=2.0 * bound)
        assert peak.amplitude == pytest.approx(3.0, rel=bound)
        assert peak.phase == pytest.approx(0.4, abs=5.0 * bound)


def test_peaks_come_from_the_largest_down():
    lines = spectrum(wave(50.3, 1.0) + wave(150.2, 4.0) + wave(333.0, 2.0), RATE, window="hann")
    assert [round(peak.frequency, 2) for peak in lines.peaks(3)] == [150.2, 333.0, 50.3]
    assert len(lines.peaks(2)) == 2


@pytest.mark.parametrize("size", [999, 1000])
def test_parseval(size):
    noise = np.random.default_rng(3).standard_normal(size) + 0.5
    density = spectrum(noise, RATE, window="boxcar", scaling="density")
    spacing = density.frequency[1]
    assert np.sum(density.amplitude) * spacing == pytest.approx(np.mean(noise**2), rel=1e-12)
    power = spectrum(noise, RATE, window="boxcar", scaling="power")
    assert np.sum(power.amplitude) == pytest.approx(np.mean(noise**2), rel=1e-12)


@pytest.mark.parametrize("window", ["hann", "flattop"])
def test_density_of_white_noise_is_its_variance_over_half_the_rate(window):
    noise = 2.0 * np.random.default_rng(4).standard_normal(200_000)
    density = spectrum(noise, RATE, window=window, scaling="density", block_length=500, unit="N")
    assert np.median(density.amplitude[5:-5]) == pytest.approx(4.0 / 500.0, rel=0.02)
    assert density.averages > 300
    assert density.phase is None
    assert density.value_unit == "(N)^2/Hz"


def test_same_as_scipy_welch():
    from scipy.signal import welch

    noise = np.random.default_rng(5).standard_normal(5000)
    density = spectrum(noise, RATE, window="hann", scaling="density", block_length=512)
    _, other = welch(noise, RATE, "hann", 512, detrend=False)
    np.testing.assert_allclose(density.amplitude, other, rtol=1e-10)


def test_zoom_separates_two_close_lines():
    zoom = zoom_spectrum(wave(50.0, 2.0) + wave(56.3, 1.0), RATE, 45.0, 60.0, points=1501)
    lower, far = zoom.frequency < 53.0, zoom.frequency > 53.0
    for part, frequency, amplitude in ((lower, 50.0, 2.0), (far, 56.3, 1.0)):
        top = np.argmax(zoom.amplitude[part])
        assert zoom.frequency[part][top] == pytest.approx(frequency, abs=0.02)
        assert zoom.amplitude[part][top] == pytest.approx(amplitude, rel=0.005)


def test_spectrogram_follows_a_jump_and_preserves_the_mean_square():
    signal = np.where(TIME < 0.5, wave(100.0, 1.0), wave(200.0, 3.0))
    spectrogram_ = spectrogram(signal, RATE, block_length=100, unit="m/s^2")
    early, late = spectrogram_.time < 0.4, spectrogram_.time > 0.6
    assert spectrogram_.frequency[spectrogram_.amplitude[:, early].argmax(axis=0)] == pytest.approx(
        100.0
    )
    assert spectrogram_.frequency[spectrogram_.amplitude[:, late].argmax(axis=0)] == pytest.approx(
        200.0
    )
    assert spectrogram_.amplitude[:, late].max(axis=0) == pytest.approx(3.0, rel=1e-6)
    assert spectrogram_.rms()[early] == pytest.approx(1.0 / np.sqrt(2.0), rel=1e-6)
    assert spectrogram_.rms()[late] == pytest.approx(3.0 / np.sqrt(2.0), rel=1e-6)
    assert spectrogram_.time[0] == pytest.approx(0.05)
    assert spectrogram_.to_xarray().sel(frequency=200.0).attrs["units"] == "m/s^2"


@pytest.mark.parametrize("length", [99, 100])
def test_rms_of_a_spectrogram_is_exact_for_any_signal(length):
    noise = np.random.default_rng(6).standard_normal(length) + 1.0
    levels = spectrogram(noise, RATE, block_length=length, window="boxcar")
    assert levels.rms() == pytest.approx([np.sqrt(np.mean(noise**2))], rel=1e-12)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"signal": np.append(np.zeros(20), np.nan)}, "sample 20"),
        ({"signal": np.zeros(5)}, "5 samples"),
        ({"signal": np.zeros(20, dtype=complex)}, "complex128 values"),
        ({"signal": ["1 mm"] * 20}, "real numbers"),
        ({"signal": np.zeros((9, 2))}, "shape"),
        ({"sampling_rate": 0.0}, "sampling_rate"),
        ({"scaling": "decibel"}, "no scaling"),
        ({"window": "door"}, "no window"),
        ({"block_length": 2000}, "block_length"),
        ({"overlap": 1.0}, "overlap"),
    ],
)
def test_bad_input_is_refused(change, message):
    arguments = {"signal": wave(50.0), "sampling_rate": RATE, **change}
    with pytest.raises(InputError, match=message):
        spectrum(arguments.pop("signal"), arguments.pop("sampling_rate"), **arguments)


def test_refusals_of_zoom_and_peaks():
    with pytest.raises(InputError, match="Nyquist"):
        zoom_spectrum(wave(50.0), RATE, 400.0, 500.0)
    with pytest.raises(InputError, match="band from 40 to 30"):
        zoom_spectrum(wave(50.0), RATE, 40.0, 30.0)
    with pytest.raises(InputError, match="scaling density"):
        spectrum(wave(50.0), RATE, scaling="density").peaks()
    assert "(m)^2" in repr(spectrum(wave(50.0), RATE, scaling="power", unit="m"))
    assert spectrum(wave(50.0), RATE, unit="m").to_xarray().attrs["units"] == "m"


def test_lines_of_the_mains_are_flagged_in_a_recording():
    """Sines of the mains lie between lines of the spectrum; a mesh line near them is not one."""
    rate = 4096.0
    time = np.arange(8192) / rate
    parts = {50.1: 0.5, 119.8: 0.4, 53.7: 0.3, 240.0: 1.0}
    signal = sum(size * np.sin(2.0 * np.pi * f * time) for f, size in parts.items())
    peaks_by_frequency = {
        round(peak.frequency, 1): peak for peak in spectrum(signal, rate).peaks(4)
    }
    assert {f: peaks_by_frequency[f].mains for f in parts} == {
        50.1: 50.0,
        119.8: 60.0,
        53.7: 0.0,
        240.0: 0.0,
    }
    assert "mains of 50 Hz?" in repr(peaks_by_frequency[50.1])


def shaft_at(rotation, mains=0.0):
    """Peaks of a shaft with 29 teeth: once, twice and three times a turn, the mesh twice."""
    rate = 8192.0
    time = np.arange(32768) / rate
    parts = {1: 0.3, 2: 0.2, 3: 0.15, 29: 2.0, 58: 1.0}
    wave = sum(size * np.sin(2.0 * np.pi * k * rotation * time) for k, size in parts.items())
    return spectrum(wave + mains * np.sin(2.0 * np.pi * 50.0 * time), rate, window="hann")


@pytest.mark.parametrize("rotation", [50.0, 50.07, 60.0, 49.93])
def test_orders_of_a_shaft_that_turns_as_fast_as_the_mains_are_not_doubted(rotation):
    for speed in (None, 2.0 * np.pi * rotation):
        peaks = shaft_at(rotation).peaks(5, speed=speed)
        assert sorted(peak.shaft_order for peak in peaks) == [1, 2, 3, 29, 58]
        assert not any(peak.mains for peak in peaks)
        assert "mains" not in repr(peaks)


def test_mains_near_a_shaft_order_are_still_flagged():
    """A two-pole motor with slip: the shaft turns at 49.2 Hz, the mains stand at 50 Hz."""
    for speed in (None, 2.0 * np.pi * 49.2):
        peaks = shaft_at(49.2, mains=0.4).peaks(6, speed=speed)
        flagged = [round(peak.frequency, 1) for peak in peaks if peak.mains]
        assert flagged == [50.0]
    assert [peak.mains for peak in shaft_at(33.3, mains=3.0).peaks(1)] == [50.0]
    with pytest.raises(InputError, match="speed"):
        shaft_at(50.0).peaks(5, speed=-1.0)
