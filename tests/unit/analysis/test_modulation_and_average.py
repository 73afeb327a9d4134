"""Envelope, sidebands, time-synchronous average, condition indicators, dynamic factor."""

import numpy as np
import pytest

from tribodyn.analysis import (
    SynchronousAverage,
    condition_indicators,
    direction_shares,
    dynamic_factor,
    envelope,
    envelope_spectrum,
    kurtosis,
    line_of_action_indicator,
    sidebands,
    time_synchronous_average,
)
from tribodyn.errors import ComputationError, InputError

RATE = 8000.0
TIME = np.arange(8000) / RATE
CARRIER, SHAFT = 1000.0, 12.5


def modulated(depth, index, lag=0.7):
    turn = 2 * np.pi * SHAFT * TIME
    phase = 2 * np.pi * CARRIER * TIME + index * np.cos(turn + lag) + 0.3
    return 2.0 * (1.0 + depth * np.cos(turn)) * np.cos(phase)


def test_envelope_of_a_band_is_the_modulation():
    hull = envelope(
        modulated(0.4, 0.0) + 3.0 * np.cos(2 * np.pi * 150.0 * TIME), RATE, band=(800, 1200)
    )
    inside = slice(800, -800)
    exact = 2.0 * (1.0 + 0.4 * np.cos(2 * np.pi * SHAFT * TIME))
    assert np.abs(hull - exact)[inside].max() < 0.01


@pytest.mark.parametrize("depth", [0.1, 0.6])
def test_envelope_spectrum_shows_frequency_and_depth(depth):
    envelope = envelope_spectrum(modulated(depth, 0.0), RATE)
    peak = envelope.peaks(1)[0]
    assert peak.frequency == pytest.approx(SHAFT, abs=0.1)
    assert peak.amplitude / envelope.amplitude[0] == pytest.approx(depth, rel=5e-3)
    assert envelope.amplitude[0] == pytest.approx(2.0, rel=1e-3)


def test_half_amplitude_at_the_ends_of_the_band():
    tone = np.cos(2 * np.pi * 1000.0 * TIME)
    hull = envelope(tone, RATE, band=(1000.0, 1400.0))
    assert hull[3000:5000] == pytest.approx(0.5, rel=0.01)


@pytest.mark.parametrize(("depth", "index"), [(0.4, 0.0), (0.0, 0.9), (0.3, 0.5)])
def test_amplitude_and_phase_modulation_are_distinguished(depth, index):
    bands = sidebands(modulated(depth, index), RATE, CARRIER, SHAFT, count=7)
    assert bands.amplitude_modulation == pytest.approx(depth, abs=1e-5)
    assert bands.phase_modulation == pytest.approx(index, abs=1e-5)
    assert bands.frequency_swing == pytest.approx(index * SHAFT, abs=1e-3)


def test_lines_of_both_kinds_of_modulation():
    from scipy.special import jv

    bands = sidebands(modulated(0.4, 0.0), RATE, CARRIER, SHAFT, count=2)
    assert bands.amplitude == pytest.approx([0.0, 0.4, 2.0, 0.4, 0.0], abs=1e-9)
    assert bands.sideband_ratio == pytest.approx(0.4)
    assert bands.phase[1:4] == pytest.approx(0.3, abs=1e-9)
    bands = sidebands(modulated(0.0, 0.9), RATE, CARRIER, SHAFT, count=7)
    assert bands.amplitude == pytest.approx(2.0 * np.abs(jv(np.arange(-7, 8), 0.9)), abs=1e-6)
    assert bands.frequency[[0, 7]] == pytest.approx([CARRIER - 7 * SHAFT, CARRIER])


def test_both_kinds_together_make_unequal_sidebands():
    """In phase with the frequency they add above the carrier; opposed, below it."""
    upper = sidebands(modulated(0.2, 0.2, -np.pi / 2), RATE, CARRIER, SHAFT).amplitude
    lower = sidebands(modulated(0.2, 0.2, np.pi / 2), RATE, CARRIER, SHAFT).amplitude
    assert upper[6] > 5.0 * upper[4]
    assert lower[4] == pytest.approx(upper[6], rel=1e-9)


def test_record_need_not_hold_whole_periods():
    bands = sidebands(modulated(0.3, 0.2)[:7133], RATE, CARRIER, SHAFT, count=6)
    assert (bands.amplitude_modulation, bands.phase_modulation) == pytest.approx(
        (0.3, 0.2), abs=1e-5
    )
    assert bands.to_xarray().sel(number=0) == pytest.approx(2.0, rel=0.02)
    assert "amplitude modulation 0.3" in repr(bands)


def test_bad_bands_and_sidebands_are_refused():
    wave = modulated(0.3, 0.2)
    with pytest.raises(InputError, match="Nyquist"):
        envelope(wave, RATE, band=(1000.0, 4000.0))
    with pytest.raises(InputError, match="band from 500 to 300"):
        envelope(wave, RATE, band=(500.0, 300.0))
    with pytest.raises(InputError, match="Nyquist"):
        sidebands(wave, RATE, 3990.0, SHAFT)
    with pytest.raises(InputError, match="sideband -5 is at -2"):
        sidebands(wave, RATE, 60.5, SHAFT)
    with pytest.raises(InputError, match="periods"):
        sidebands(wave[:1000], RATE, CARRIER, SHAFT)
    with pytest.raises(ComputationError, match="nothing vibrates at the carrier"):
        sidebands(np.zeros(8000), RATE, CARRIER, SHAFT)
    with pytest.raises(InputError, match="nan at sample 3"):
        sidebands(np.array([0.0, 1.0, 2.0, np.nan] * 8), RATE, CARRIER, SHAFT)


TEETH = 16
TURNING = 2 * np.pi * (20.0 * TIME + 2.0 * TIME**2)


def gear(angle):
    return 2.0 * np.cos(TEETH * angle + 0.2) + 0.5 * np.cos(2 * TEETH * angle) + np.cos(angle)


def test_average_preserves_signals_synchronous_with_the_shaft():
    other = 0.3 * np.cos(7.37 * TURNING)
    mean = time_synchronous_average(
        gear(TURNING) + other, TIME, teeth=TEETH, rotation=TURNING, mesh_harmonics=3, unit="N"
    )
    assert mean.revolutions == 22
    assert mean.mesh_amplitudes(3) == pytest.approx([2.0, 0.5, 0.0], abs=0.03)
    assert np.abs(mean.signal - gear(mean.angle)).max() < 0.06
    assert mean.residual(0) == pytest.approx(np.cos(mean.angle), abs=0.06)
    assert np.abs(mean.residual(1)).max() < 0.06
    assert set(mean.to_xarray()) == {"signal", "scatter", "residual", "difference"}


def test_the_ends_of_the_record_leave_no_trace_in_the_average():
    """Strong lines above the retained harmonics: their abrupt start and end are broadband."""
    rate = 25_600.0
    time = np.arange(40_000) / rate
    turn = 2 * np.pi * 15.0 * time + 0.05 * np.sin(3.0 * time)
    wave = np.cos(TEETH * turn) + 50.0 * np.cos(23 * TEETH * turn + 1.0)
    mean = time_synchronous_average(wave, time, teeth=TEETH, rotation=turn)
    assert mean.revolutions == 23
    assert mean.mesh_amplitudes(1)[0] == pytest.approx(1.0, abs=1e-3)
    assert np.abs(mean.residual()).max() < 2e-3


def test_noise_falls_with_the_root_of_the_number_of_revolutions():
    """Standard deviation 1 over N revolutions leaves 1/sqrt(N), and the scatter says so."""
    rng = np.random.default_rng(7)
    time = np.arange(200_000) / 10_000.0
    noise = rng.standard_normal(time.size)
    left = {}
    for turns in (25, 100, 400):
        part = slice(0, turns * 500 + 1)
        mean = time_synchronous_average(
            noise[part], time[part], teeth=TEETH, speed=2 * np.pi * 20.0, mesh_harmonics=5
        )
        assert mean.revolutions == turns
        left[turns] = mean.signal.std()
        assert np.sqrt(np.mean(mean.scatter**2)) == pytest.approx(left[turns], rel=0.15)
    assert left[25] / left[100] == pytest.approx(2.0, rel=0.12)
    assert left[100] / left[400] == pytest.approx(2.0, rel=0.12)


def average(wave, angle, revolutions=50):
    return SynchronousAverage(angle, wave, 0.0 * angle, revolutions, TEETH)


def test_difference_removes_mesh_and_first_sidebands_only():
    angle = 2 * np.pi * np.arange(400) / 400
    remainder = 0.1 * np.cos((TEETH + 2) * angle) + 0.05 * np.cos(5 * angle)
    sidebands_ = 0.3 * np.cos((TEETH + 1) * angle + 0.4) + 0.2 * np.cos((2 * TEETH - 1) * angle)
    mean = average(3.0 + gear(angle) + sidebands_ + remainder, angle)
    np.testing.assert_allclose(mean.residual(), sidebands_ + remainder, atol=1e-12)
    np.testing.assert_allclose(mean.difference(), remainder, atol=1e-12)


def test_indicators_of_known_waves():
    angle = 2 * np.pi * np.arange(4000) / 4000
    indicators = condition_indicators(average(gear(angle) + 0.1 * np.cos(21 * angle), angle))
    assert indicators.fm4 == pytest.approx(1.5, rel=1e-9)
    assert indicators.na4 == pytest.approx(1.5, rel=1e-9)
    plain = condition_indicators(average(np.cos(TEETH * angle) + 1e-6 * np.cos(21 * angle), angle))
    assert plain.fm0 == pytest.approx(2.0, rel=1e-5)
    assert plain.crest_factor == pytest.approx(np.sqrt(2.0), rel=1e-5)
    assert plain.kurtosis == pytest.approx(1.5, rel=1e-5)
    noise = np.random.default_rng(8).standard_normal(4000)
    assert condition_indicators(average(gear(angle) + noise, angle)).fm4 == pytest.approx(
        3.0, abs=0.3
    )


def test_one_bad_tooth_raises_fm4_and_growth_raises_na4():
    angle = 2 * np.pi * np.arange(1600) / 1600
    noise = 0.02 * np.random.default_rng(9).standard_normal(angle.size)
    bump = np.exp(-(((angle - 2.0) / 0.05) ** 2)) * np.cos(60 * angle)
    sound = average(gear(angle) + noise, angle)
    bad = average(gear(angle) + noise + 0.5 * bump, angle)
    worse = average(gear(angle) + 3.0 * (noise + 0.5 * bump), angle)
    assert condition_indicators(bad).fm4 > 3.0 * condition_indicators(sound).fm4
    assert condition_indicators(worse).fm4 == pytest.approx(condition_indicators(bad).fm4, rel=1e-6)
    history = condition_indicators(worse, earlier=[bad])
    # second moments 1 and 9: the fourth moment is compared with the square of their mean
    assert history.na4 == pytest.approx(
        condition_indicators(worse).na4 * (9.0 / 5.0) ** 2, rel=1e-6
    )


def test_bad_averages_are_refused():
    angle = 2 * np.pi * np.arange(400) / 400
    with pytest.raises(ComputationError, match="nothing but mesh"):
        condition_indicators(average(np.cos(TEETH * angle), angle))
    with pytest.raises(ComputationError, match="no mesh harmonics"):
        condition_indicators(average(np.cos(5 * angle), angle))
    with pytest.raises(ComputationError, match="does not change"):
        kurtosis(np.full(20, 3.0))
    wave = gear(TURNING)
    with pytest.raises(InputError, match="two complete revolutions"):
        time_synchronous_average(wave[:600], TIME[:600], teeth=TEETH, rotation=TURNING[:600])
    with pytest.raises(InputError, match="Nyquist"):
        time_synchronous_average(wave, TIME, teeth=400, rotation=TURNING)
    with pytest.raises(InputError, match="neither or both"):
        time_synchronous_average(wave, TIME, teeth=TEETH)


def test_dynamic_factor_and_shares_of_the_directions():
    turn = 2 * np.pi * np.arange(90) / 90
    assert dynamic_factor(1000.0 + 400.0 * np.sin(turn), 1000.0) == pytest.approx(1.4, rel=1e-3)
    shares = direction_shares(2.0 * np.sin(turn), 3.0 + 0.5 * np.cos(2 * turn))
    assert shares == pytest.approx((16 / 17, 1 / 17))
    with pytest.raises(InputError, match="static_force"):
        dynamic_factor(turn, 0.0)
    with pytest.raises(InputError, match="one must vibrate"):
        direction_shares(np.ones(9), np.ones(9))


def test_shares_agree_with_the_indicator_of_a_motion():
    from tribodyn.dynamics import System, simulate

    free = System([[1.0]], [[0.0]], [[0.0]], [0.0])
    fine = simulate(free, 1.0, 1, ([0.0], [0.0]), steps=256).fine
    along, across = 2.0 * np.cos(2 * np.pi * fine.phase), 0.3 * np.cos(6 * np.pi * fine.phase)
    first, second = direction_shares(along[1::3], across[1::3])
    assert np.sqrt(second / first) == pytest.approx(
        line_of_action_indicator(fine, along, across), rel=1e-6
    )
