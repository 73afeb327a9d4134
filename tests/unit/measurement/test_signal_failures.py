"""A figure that fails costs no other; the band of impacts may be narrow or begin at zero."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tribodyn.cli import call
from tribodyn.errors import ComputationError
from tribodyn.measurement import Recording, analyse_signal
from tribodyn.report import signal_report
from tribodyn.signals import cyclic_coherence, kurtogram
from tribodyn.types import Array

RATE, SHAFT, TEETH = 12_800.0, 2.0 * np.pi * 25.0, 29


def mesh(seconds: float = 4.0) -> tuple[Array, Array]:
    """Steady mesh line with noise."""
    time = np.arange(round(seconds * RATE)) / RATE
    noise = np.random.default_rng(1).normal(0.0, 0.3, time.size)
    return time, 2.0 * np.cos(TEETH * SHAFT * time) + noise


def with_bumps(width: float) -> Array:
    """The same with three slow bumps, as of a drifting sensor."""
    time, wave = mesh()
    return wave + sum(6.0 * np.exp(-(((time - at) / width) ** 2)) for at in (0.8, 2.1, 3.3))


def with_bursts(frequency: float) -> Array:
    """The same with three slow bursts of a tone, which fill a narrow band."""
    time, wave = mesh()
    swell = sum(np.exp(-(((time - at) / 0.05) ** 2)) for at in (0.8, 2.1, 3.3))
    return wave + 3.0 * swell * np.cos(2.0 * np.pi * frequency * time)


@pytest.mark.slow
@pytest.mark.parametrize("wave", [with_bumps(0.05), with_bumps(0.02), with_bursts(3190.0)])
def test_a_narrow_band_of_impacts_costs_no_figure(wave: Array) -> None:
    result = kurtogram(wave, RATE)
    low, high = result.band
    assert result.significant
    assert 0.0 < low < high < 0.5 * RATE
    analysis = analyse_signal(
        Recording({"acc": wave}, RATE, {}), "acc", speed=SHAFT, teeth=TEETH, mate_teeth=67
    )
    data = signal_report.signal_report_data(analysis)
    numbers = analysis.figures()
    assert not [note for note in data.facts["notes"] if note.startswith("No figure")]
    assert {"Kurtogram", "Cyclic coherence", "Cepstrum"} <= {each[0] for each in data.figures}
    assert numbers["mesh_harmonic_1_amplitude"] == pytest.approx(2.0, rel=0.02)
    assert numbers["coherence_limit"] > numbers["coherence_of_noise"]


@pytest.mark.parametrize("levels", range(1, 9))
def test_every_band_of_a_kurtogram_rises_inside_of_the_spectrum(levels: int) -> None:
    """Also the lowest and the highest: their ends are no further away than half their width."""
    result = kurtogram(np.random.default_rng(0).standard_normal(40_000), RATE, levels=levels)
    for row, (centre, width) in enumerate(zip(result.centre, result.width, strict=True)):
        alone = np.arange(result.kurtosis.size) == row
        low, high = replace(result, kurtosis=np.where(alone, 99.0, 0.0)).band
        assert 0.0 < low < centre < high < 0.5 * RATE
        assert high - low > 0.7 * width


@pytest.mark.slow
def test_the_command_writes_what_it_can_and_reports_what_fails(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    Recording({"acc": with_bumps(0.05)}, RATE, {"acc": "g"}).save(tmp_path / "bumps.mat")

    def no_peak(*_: object) -> None:
        raise ComputationError("no family of lines", "", "The signal is too short", "Record longer")

    def fault(*_: object, **__: object) -> None:
        raise IndexError("row 3 of 2")

    monkeypatch.setattr(signal_report, "cepstrum", no_peak)
    monkeypatch.setattr(signal_report, "sideband_cursors", fault)
    words = [str(tmp_path / "bumps.mat"), "--speed", "1500 rpm", "--teeth", "29"]
    assert call(["signal", *words, "--out", str(tmp_path / "r")]) == 0
    text = capsys.readouterr()
    page = (tmp_path / "r" / "report.html").read_text("utf-8")
    for message in (
        "No figure &quot;Cepstrum&quot;: no family of lines. The signal is too short. "
        "Record longer.",
        "this is a fault of tribodyn, not of the recording: IndexError, row 3 of 2",
    ):
        assert message.replace("&quot;", '"') in text.err
        assert message in page or message.replace("&quot;", "&#34;") in page
    assert "Mesh harmonic 1" in text.out
    assert "Kurtogram" in page
    assert call(["signal", *words, "--json"]) == 0
    assert len(json.loads(capsys.readouterr().out)["notes"]) == 2


@pytest.mark.parametrize(
    ("wave", "missing"),
    [(lambda t: np.cos(TEETH * SHAFT * t[:200]), "No kurtogram: signal has 200 samples"),
     (lambda t: np.cos(TEETH * SHAFT * t[:1200]), "No cyclic coherence: ")],
)  # fmt: skip
def test_what_a_short_recording_lacks_is_reported(
    wave: Callable[[Array], Array], missing: str
) -> None:
    run = Recording({"acc": wave(mesh()[0])}, RATE, {})
    data = signal_report.signal_report_data(analyse_signal(run, "acc", speed=SHAFT, teeth=TEETH))
    assert any(note.startswith(missing) for note in data.facts["notes"])
    assert "Spectrum" in [heading for heading, _, _ in data.figures]


@pytest.mark.slow
@pytest.mark.parametrize("band", [None, (150.0, 350.0)])
def test_noise_exceeds_the_limit_of_coherence_in_one_of_twenty_records(
    band: tuple[float, float] | None,
) -> None:
    """Monte Carlo: 3 standard deviations of the count on both sides."""
    draws, rate, size = 300, 1000.0, 1600
    rates = np.arange(3.2, 20.0, 0.5 * rate / size)
    rng, above = np.random.default_rng(3), 0
    for _ in range(draws):
        result = cyclic_coherence(rng.standard_normal(size), rate, rates, block_length=32)
        above += bool(result.enhanced_envelope_spectrum(band).max() > result.noise_limit(band))
    assert abs(above - 0.05 * draws) < 3.0 * np.sqrt(draws * 0.05 * 0.95)


def test_limit_of_coherence_for_a_single_value_is_the_closed_form() -> None:
    """P(c > x) = (1 - x)^(K - 1), and of N rates the N-th power of its complement."""
    noise = np.random.default_rng(0).standard_normal(4000)
    result = cyclic_coherence(noise, 1000.0, np.arange(20.0, 40.0), block_length=64)
    step = float(result.frequency[1])
    limit = result.noise_limit((9.5 * step, 10.5 * step), false_alarm=0.1)
    alone = (1.0 - limit) ** (result.blocks - 1.0)
    assert (1.0 - alone) ** 20 == pytest.approx(0.9, rel=1e-6)


def test_a_random_modulation_stands_above_the_limit_and_noise_does_not() -> None:
    time, wave = mesh(2.0)
    noise = np.random.default_rng(7).normal(0.0, 0.6, time.size)
    for depth, finding in ((0.0, "No cyclic coherence above"), (1.0, "modulated at 62.5")):
        beaten = (1.0 + depth * np.cos(2.5 * SHAFT * time)) * noise
        run = Recording({"acc": wave + beaten}, RATE, {})
        analysis = analyse_signal(run, "acc", speed=SHAFT, teeth=TEETH)
        numbers = analysis.figures()
        assert (numbers["coherence"] > numbers["coherence_limit"]) == (depth > 0.0)
        statements = signal_report.signal_report_data(analysis).statements
        assert any(finding in text for text in statements)


def test_coherence_of_a_transient_is_at_most_one() -> None:
    """The mean power of a step, which leaks to low rates, is subtracted."""
    step = (np.arange(10_000) > 4000) * 1.0
    result = cyclic_coherence(step, 5000.0, np.arange(2.5, 20.0, 0.25))
    assert result.coherence.max() <= 1.0


def test_a_mesh_above_half_the_rate_does_not_prevent_the_coherence() -> None:
    run = Recording({"acc": np.random.default_rng(2).standard_normal(6000)}, 3000.0, {})
    analysis = analyse_signal(run, "acc", speed=2.0 * np.pi * 20.0, teeth=100)
    assert analysis.coherence is not None
