"""The tooth that a recording names is the one with the bump, at its angle from the first pulse."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn.analysis import time_synchronous_average
from tribodyn.measurement import Recording, SignalAnalysis, analyse_signal
from tribodyn.plot import synchronous_average
from tribodyn.report.signal_report import signal_report_data

RATE = 8000.0


def soft_tooth(
    place: float, start: float, *, teeth: int = 22, wander: float = 0.0, noise: float = 0.05
) -> Recording:
    """Mesh whose phase lags once a turn at an angle from the pulse [deg]; turns before it."""
    time = np.arange(round(5.0 * RATE)) / RATE
    angle = 2.0 * np.pi * (13.7 * time + wander * np.sin(2.3 * time) - start)
    lag = 0.3 * np.exp(60.0 * (np.cos(angle - np.radians(place)) - 1.0))
    wave = 5.0 * np.cos(teeth * angle - lag) + 2.0 * np.cos(2.0 * (teeth * angle - lag) + 1.0)
    wave += noise * np.random.default_rng(3).standard_normal(time.size)
    pulse = 5.0 * (np.mod(angle / (2.0 * np.pi), 1.0) < 0.1)
    return Recording({"acc": wave, "pulse": pulse}, RATE, {"acc": "m/s^2", "pulse": "V"})


def local_note(analysis: SignalAnalysis) -> str:
    return next(text for text in signal_report_data(analysis).statements if "FM4" in text)


@pytest.mark.parametrize("wander", [0.0, 0.02])
@pytest.mark.parametrize("start", [0.0, 0.31, 0.92])
def test_one_soft_tooth_is_named_wherever_the_record_begins(start: float, wander: float) -> None:
    recording = soft_tooth(113.5, start, wander=wander)
    analysis = analyse_signal(recording, "acc", tacho="pulse", teeth=22)
    angle, tooth = analysis.averages["shaft"].local_place()
    assert np.degrees(angle) == pytest.approx(113.5, abs=3.0)
    assert tooth == 7
    note, title = local_note(analysis), synchronous_average(analysis.averages["shaft"])
    degrees = f"about {np.degrees(angle):.0f}°"
    assert f"{degrees} from the first pulse of the tachometer: tooth 7 of 22" in note
    assert f"{degrees}, tooth 7 of 22" in title.layout.title.text


@pytest.mark.parametrize("tooth", [1, 2, 11, 22])
def test_every_tooth_has_its_number(tooth: int) -> None:
    recording = soft_tooth((tooth - 0.3) / 22 * 360.0, 0.4)
    average = analyse_signal(recording, "acc", tacho="pulse", teeth=22).averages["shaft"]
    assert average.local_place()[1] == tooth


def test_without_a_tachometer_the_angle_counts_from_the_first_sample() -> None:
    recording = soft_tooth(113.5, 0.25)
    stated = 2.0 * np.pi * 13.7
    analysis = analyse_signal(recording, "acc", speed=stated, teeth=22)
    assert "from the first sample: tooth" in local_note(analysis)
    angle, _ = analysis.averages["shaft"].local_place()
    assert np.degrees(angle) == pytest.approx(113.5 + 90.0, abs=4.0)


def test_a_difference_that_is_chance_names_no_tooth() -> None:
    """One impact in a single turn of many is local in the mean, but does not repeat."""
    recording = soft_tooth(0.0, 0.3, noise=0.0)
    rng = np.random.default_rng(5)
    time = recording.time
    wave = np.cos(22 * 2.0 * np.pi * 13.7 * time) + 0.01 * rng.standard_normal(time.size)
    wave[30_000:30_020] += 20.0 * rng.standard_normal(20)
    once = Recording({**recording.channels, "acc": wave}, RATE, recording.units)
    note = local_note(analyse_signal(once, "acc", tacho="pulse", teeth=22))
    assert "no tooth is named" in note


def test_a_mean_revolution_begins_where_the_rotation_is_zero() -> None:
    time = np.arange(20_000) / 10_000.0
    for start in (0.0, 0.4, -0.7, 12.9, -30.2):
        rotation = 2.0 * np.pi * 11.3 * time + start
        wave = np.cos(16 * rotation) + 0.5 * np.cos(3 * rotation + 0.4)
        average = time_synchronous_average(wave, time, teeth=16, rotation=rotation)
        expected = np.cos(16 * average.angle) + 0.5 * np.cos(3 * average.angle + 0.4)
        np.testing.assert_allclose(average.signal, expected, atol=2e-3)


@pytest.mark.parametrize(("stated", "doubted"), [(22, False), (23, True), (21, True), (40, True)])
def test_a_wrong_number_of_teeth_is_doubted(stated: int, doubted: bool) -> None:
    """Order 23 has a sideband of the run-out, yet the mesh is at 22 and 44."""
    recording = soft_tooth(50.0, 0.1)
    turn = 2.0 * np.pi * 13.7 * recording.time
    wave = recording["acc"] * (1.0 + 0.3 * np.cos(turn))
    run_out = Recording({**recording.channels, "acc": wave}, RATE, recording.units)
    notes = analyse_signal(run_out, "acc", tacho="pulse", teeth=stated).notes
    texts = [note.what for note in notes if "not of" in note.what]
    assert texts == (
        [f"the mesh lines seem to be multiples of order 22, not of {stated}"] * doubted
    )
