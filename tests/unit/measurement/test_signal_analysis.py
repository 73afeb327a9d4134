"""One channel analysed: known orders, modulations and noise come out as closed forms say."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import xarray

from tribodyn.errors import InputError
from tribodyn.measurement import Recording, SignalAnalysis, analyse_signal
from tribodyn.plot import FIGURES
from tribodyn.report import write_signal_report
from tribodyn.report.signal_report import signal_report_data
from tribodyn.types import Array

RATE = 6400.0
TEETH, MATE = 20, 31
#: Mean speed [rad/s], and how far it wanders over it.
SPEED, WANDER = 2.0 * np.pi * 15.0, 0.01


def shaft(seconds: float = 6.0, wander: float = WANDER) -> tuple[Array, Array]:
    """Times, and the angle of a shaft whose speed wanders within so much of its mean."""
    time = np.arange(round(seconds * RATE)) / RATE
    slow = 2.0 * np.pi * 0.5
    return time, SPEED * time + wander * SPEED / slow * (1.0 - np.cos(slow * time))


def recording(wave: Array, angle: Array, unit: str = "m/s^2", pulses: int = 1) -> Recording:
    tacho = np.sin(pulses * angle)
    return Recording({"acc": wave, "pulse": tacho}, RATE, {"acc": unit, "pulse": "V"})


def gears(angle: Array) -> Array:
    return 4.0 * np.cos(TEETH * angle) + 1.5 * np.cos(2 * TEETH * angle + 1.0)


def missing(analysis: SignalAnalysis) -> str:
    return "\n".join(f"{note}" for note in analysis.notes)


@pytest.mark.parametrize("pulses", [1, 8])
def test_mesh_harmonics_are_exact_at_a_wandering_speed_with_a_tachometer(pulses: int) -> None:
    _, angle = shaft()
    square = 5.0 * (np.mod(pulses * angle / (2.0 * np.pi), 1.0) < 0.2)
    run = Recording({"acc": gears(angle), "pulse": square}, RATE, {"acc": "m/s^2"})
    analysis = analyse_signal(run, "acc", tacho="pulse", pulses_per_revolution=pulses, teeth=TEETH)
    numbers = analysis.figures()
    assert numbers["mesh_harmonic_1_amplitude"] == pytest.approx(4.0, rel=0.01)
    assert numbers["mesh_harmonic_2_amplitude"] == pytest.approx(1.5, rel=0.01)
    assert numbers["order_peak_1"] == pytest.approx(TEETH, abs=0.02)
    assert numbers["speed"] == pytest.approx(SPEED, rel=1e-4)
    assert numbers["highest_speed"] == pytest.approx((1.0 + WANDER) * SPEED, rel=2e-3)
    assert numbers["mesh_frequency"] == pytest.approx(TEETH * 15.0, rel=1e-4)
    assert analysis.averages["shaft"].mesh_amplitudes(2) == pytest.approx([4.0, 1.5], rel=0.01)
    assert analysis.smeared
    assert not analysis.notes


@pytest.mark.parametrize("error", [-0.03, 0.02])
def test_mesh_lines_correct_a_wrong_stated_speed(error: float) -> None:
    _, angle = shaft()
    noise = 0.3 * np.random.default_rng(1).standard_normal(angle.size)
    run = recording(gears(angle) + noise, angle)
    analysis = analyse_signal(run, "acc", speed=(1.0 + error) * SPEED, teeth=TEETH)
    numbers = analysis.figures()
    assert numbers["speed"] == pytest.approx(SPEED, rel=1e-4)
    assert 0.0 < numbers["speed_uncertainty"] < 1e-3 * SPEED
    assert numbers["mesh_harmonic_1_amplitude"] == pytest.approx(4.0, rel=0.02)
    assert "mesh harmonics" in analysis.speed.source


def test_orders_are_relative_to_a_line_where_there_is_no_rate() -> None:
    """In samples instead of seconds: the line has the order of the teeth, or without them 1."""
    _, angle = shaft()
    wave = gears(angle) + 0.4 * np.cos(21.0 * angle)
    bare = Recording({"acc": wave}, 1.0, {"acc": "m/s^2"})
    per_sample = TEETH * SPEED / (2.0 * np.pi * RATE)
    analysis = analyse_signal(bare, "acc", line=1.02 * per_sample, teeth=TEETH)
    numbers = analysis.figures()
    assert numbers["mesh_frequency"] == pytest.approx(per_sample, rel=1e-4)
    assert numbers["mesh_harmonic_1_amplitude"] == pytest.approx(4.0, rel=0.01)
    assert numbers["sideband_index"] == pytest.approx(0.2, rel=0.03)
    alone = analyse_signal(bare, "acc", line=0.98 * per_sample)
    assert alone.orders.amplitude(1.0) == pytest.approx(4.0, rel=0.01)
    assert alone.orders.amplitude(2.0) == pytest.approx(1.5, rel=0.01)
    assert alone.orders.amplitude(21.0 / TEETH) == pytest.approx(0.4, rel=0.1)
    assert not alone.averages


def test_a_stated_speed_without_teeth_is_marked_as_not_measured() -> None:
    time, angle = shaft(wander=0.0)
    analysis = analyse_signal(recording(gears(angle), angle), "acc", speed=SPEED)
    assert analysis.figures()["order_peak_1_amplitude"] == pytest.approx(4.0, rel=0.01)
    assert "exactly 900 rpm" in missing(analysis)
    assert "--teeth" in missing(analysis)
    assert not analysis.averages
    noise = recording(np.random.default_rng(0).standard_normal(time.size), angle)
    analysis = analyse_signal(noise, "acc", speed=SPEED, teeth=TEETH)
    assert "No steady mesh line" in missing(analysis)
    assert analysis.speed.steady


def test_without_speed_the_notes_name_the_missing_results() -> None:
    _, angle = shaft(2.0)
    analysis = analyse_signal(recording(gears(angle), angle), "acc", teeth=TEETH)
    assert analysis.orders is None
    assert analysis.averages == {}
    assert "--tacho NAME --pulses N" in missing(analysis)
    assert analysis.mesh_frequency is None
    numbers = analysis.figures()
    wave = gears(angle)
    assert numbers["alternating_rms"] == pytest.approx(np.std(wave))
    assert numbers["crest_factor"] == pytest.approx(np.abs(wave - wave.mean()).max() / np.std(wave))
    assert not {"speed", "fm4", "mesh_frequency"} & set(numbers)


def test_a_modulated_carrier_gives_the_depth_of_its_modulation() -> None:
    time, angle = shaft(4.0, wander=0.0)
    wave = 5.0 * (1.0 + 0.3 * np.cos(angle)) * np.cos(TEETH * angle)
    stray = 2.0 * np.cos(2.0 * np.pi * 1700.0 * time)
    analysis = analyse_signal(recording(wave + stray, angle), "acc", tacho="pulse", teeth=TEETH)
    assert analysis.band == pytest.approx((TEETH * 15.0 / 2.0, TEETH * 15.0 * 1.5), rel=1e-3)
    numbers = analysis.figures()
    assert numbers["envelope_peak_1_frequency"] == pytest.approx(15.0, rel=1e-3)
    assert numbers["envelope_peak_1_amplitude"] == pytest.approx(1.5, rel=0.01)
    assert numbers["envelope_mean"] == pytest.approx(5.0, rel=0.01)
    chosen = analyse_signal(recording(wave + stray, angle), "acc", band=(1500.0, 1900.0))
    assert chosen.figures()["envelope_mean"] == pytest.approx(2.0, rel=0.01)


def test_noise_in_a_mean_revolution_falls_with_the_root_of_the_revolutions() -> None:
    time, angle = shaft(16.0, wander=0.0)
    noise = np.random.default_rng(5).standard_normal(time.size)
    rms = {}
    for share in (1, 4):
        part = slice(None, time.size // share)
        run = recording(gears(angle[part]) + noise[part], angle[part])
        average = analyse_signal(run, "acc", tacho="pulse", teeth=TEETH).averages["shaft"]
        clean = average.signal - np.mean(average.signal)
        lines = np.fft.rfft(clean)
        lines[[TEETH, 2 * TEETH]] = 0.0
        rms[share] = float(np.std(np.fft.irfft(lines, clean.size)))
        stated = float(np.sqrt(np.mean(average.scatter**2)))
        assert stated == pytest.approx(rms[share], rel=0.12)
        assert average.revolutions in (240 // share, 240 // share - 1)
    assert rms[4] / rms[1] == pytest.approx(2.0, rel=0.15)


def test_each_gear_has_the_mean_revolution_of_its_own_shaft() -> None:
    _, angle = shaft(20.0)
    of_mate = TEETH / MATE * angle
    wave = gears(angle) + 0.8 * np.cos(5.0 * of_mate) + 0.5 * np.cos(7.0 * angle)
    analysis = analyse_signal(
        recording(wave, angle), "acc", tacho="pulse", teeth=TEETH, mate_teeth=MATE
    )
    lines = {
        name: 2.0 * np.abs(np.fft.rfft(each.signal)) / each.signal.size
        for name, each in analysis.averages.items()
    }
    assert lines["mate"][[5, MATE, 2 * MATE]] == pytest.approx([0.8, 4.0, 1.5], rel=0.01)
    assert lines["shaft"][[7, TEETH, 2 * TEETH]] == pytest.approx([0.5, 4.0, 1.5], rel=0.01)
    assert lines["mate"][7] < 0.02
    numbers = analysis.figures()
    assert numbers["average_revolutions_mate"] == pytest.approx(300 * TEETH / MATE, abs=1.0)
    # One bad line is a sine in the difference signal: kurtosis 1.5.
    assert numbers["fm4"] == pytest.approx(1.5, abs=0.02)
    assert numbers["fm4_mate"] == pytest.approx(1.5, abs=0.02)


@pytest.mark.parametrize(
    ("unit", "factor", "si"),
    [("g", 9.80665, "m/s^2"), ("mm/s", 1e-3, "m/s"), ("mV", 1e-3, "V"), ("EU", 1.0, "EU")],
)
def test_known_units_become_si(unit: str, factor: float, si: str) -> None:
    _, angle = shaft(1.0)
    analysis = analyse_signal(recording(gears(angle), angle, unit), "acc")
    assert analysis.unit == si
    assert analysis.signal == pytest.approx(factor * gears(angle))
    assert analysis.spectrum.unit == si


def test_a_temperature_is_offset_not_scaled() -> None:
    _, angle = shaft(1.0, wander=0.0)
    analysis = analyse_signal(recording(40.0 + np.cos(angle), angle, "degC"), "acc")
    assert analysis.unit == "K"
    assert analysis.figures()["mean"] == pytest.approx(313.15, abs=1e-9)


def run_up() -> Recording:
    time = np.arange(round(6.0 * RATE)) / RATE
    angle = np.where(time < 1.0, 0.0, 2.0 * np.pi * 5.0 * (time - 1.0) ** 2)
    return recording(2.0 * np.cos(TEETH * angle), angle, pulses=30)


def test_a_run_up_from_rest_has_orders_over_the_speed_and_a_mean_of_its_fast_part() -> None:
    analysis = analyse_signal(run_up(), "acc", tacho="pulse", pulses_per_revolution=30, teeth=TEETH)
    assert analysis.order_map is not None
    cut = analysis.order_map.cut(TEETH)
    assert np.asarray(cut.amplitude)[3:] == pytest.approx(2.0, rel=0.03)
    assert "mean revolution is that from" in missing(analysis)
    average = analysis.averages["shaft"]
    assert average.mesh_amplitudes(1)[0] == pytest.approx(2.0, rel=0.03)


def test_a_mesh_above_the_sampling_is_named() -> None:
    _, angle = shaft(2.0, wander=0.0)
    analysis = analyse_signal(recording(gears(angle), angle), "acc", tacho="pulse", teeth=300)
    assert "above what the sampling resolves" in missing(analysis)
    assert analysis.averages == {}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"channel": "ac"}, 'Did you mean "acc"'),
        ({"tacho": "puls"}, 'Did you mean "pulse"'),
        ({"tacho": "pulse", "speed": SPEED}, "tacho = 'pulse' and speed = 94.2"),
        ({"line": 300.0, "speed": SPEED}, "and line = 300.0 Hz are given"),
        ({"line": 0.0}, "line"),
        ({"speed": -1.0}, "speed"),
        ({"teeth": 0, "tacho": "pulse"}, "teeth"),
        ({"band": (3000.0, 4000.0)}, "Nyquist"),
        ({"tacho": "pulse", "max_order": 500.0}, "max_order"),
        ({"tacho": "acc", "channel": "flat"}, "constant"),
    ],
)
def test_wrong_input_is_refused(arguments: dict[str, Any], message: str) -> None:
    _, angle = shaft(1.0)
    run = recording(gears(angle), angle)
    channels = {**run.channels, "flat": np.ones(angle.size)}
    run = Recording(channels, RATE, run.units)
    with pytest.raises(InputError, match=message):
        analyse_signal(run, **{"channel": "acc", **arguments})


def test_impacts_between_the_teeth_are_reported_with_band_and_rate() -> None:
    rng, rate, seconds = np.random.default_rng(4), 12_800.0, 2.0
    time = np.arange(round(seconds * rate)) / rate
    ringing = np.exp(-900.0 * time[:200]) * np.sin(2 * np.pi * 4200.0 * time[:200])
    wave = 4.0 * np.cos(2 * np.pi * 400.0 * time) + rng.normal(0.0, 0.4, time.size)
    for strike in np.arange(0.01, 1.95, 1.0 / 71.0):  # 3.55 turns of the shaft, which slip
        first = round((strike + rng.normal(0.0, 1e-4)) * rate)
        wave[first : first + 200] += 4.0 * ringing
    run = Recording({"acc": wave}, rate, {"acc": "m/s^2"})
    numbers = analyse_signal(run, "acc", speed=2 * np.pi * 20.0, teeth=20).figures()
    assert abs(numbers["kurtogram_centre"] - 4200.0) < numbers["kurtogram_bandwidth"]
    assert numbers["kurtogram_kurtosis"] > numbers["kurtogram_limit"] > 0.0
    assert numbers["coherence_frequency"] == pytest.approx(71.0, abs=0.6)
    assert numbers["coherence"] > 5.0 * numbers["coherence_of_noise"]
    still = Recording({"acc": 2.0 * rng.normal(0.0, 1.0, time.size)}, rate, {"acc": "m/s^2"})
    quiet = analyse_signal(still, "acc").figures()
    assert quiet["kurtogram_kurtosis"] < quiet["kurtogram_limit"]
    assert "coherence" not in quiet  # its rates are searched by the turns of the shaft


@pytest.mark.slow
def test_result_has_export_plot_and_report(tmp_path: Any) -> None:
    _, angle = shaft(20.0)
    wave = gears(angle) + 0.2 * np.random.default_rng(0).standard_normal(angle.size)
    analysis = analyse_signal(
        recording(wave, angle, "g"), "acc", tacho="pulse", teeth=TEETH, mate_teeth=MATE
    )
    data = analysis.to_xarray()
    assert data.signal.units == data.mean_revolution_shaft.units == "m/s^2"
    assert data.attrs["fm4_mate"] == analysis.indicators["mate"].fm4
    stored = xarray.load_dataset(analysis.save(tmp_path / "a.nc"), engine="h5netcdf")
    assert stored.order_spectrum.equals(data.order_spectrum)
    for figure in (analysis.plot(), FIGURES["signal_history"](analysis)):
        labels = [figure.layout[k].title.text for k in figure.layout if k[1:5] == "axis"]
        assert all("[" in label for label in labels if label)
    page = write_signal_report(analysis, tmp_path / "report.html", title="acc of rig.csv")
    text = page.read_text("utf-8")
    assert "<h1>acc of rig.csv</h1>" in text
    assert "FM4 of the mate" in text
    answer = signal_report_data(analysis)
    headings = [heading for heading, _, _ in answer.figures]
    assert headings == [
        "Signal",
        "Spectrum",
        "Envelope spectrum",
        "Orders",
        "Mean revolution of the shaft, 20 teeth",
        "Mean revolution of the mate, 31 teeth",
        "Sidebands in the orders, distance of the shaft",
        "Sidebands in the orders, distance of the mate",
        "Demodulated mesh harmonic over a turn of the shaft",
        "Demodulated mesh harmonic over a turn of the mate",
        "Cepstrum",
        "Kurtogram",
        "Cyclic coherence",
    ]
    assert all(np.isfinite(value) for value in analysis.figures().values())
    assert {len(row) for row in answer.rows} == {4}
