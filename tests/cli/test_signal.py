"""``tribodyn signal``: what it lists, analyses, writes and refuses."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import tribodyn
from tribodyn.cli import call

RATE, SPEED = 6400.0, 2.0 * np.pi * 15.0


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A rig: 16 teeth on a shaft of 900 rpm, 2 m/s^2 at the mesh, one pulse per revolution."""
    time = np.arange(round(4.0 * RATE)) / RATE
    wave = 2.0 * np.cos(16.0 * SPEED * time) + 0.3 * np.cos(3.0 * SPEED * time)
    wave += 0.2 * np.random.default_rng(0).standard_normal(time.size)
    path = tmp_path_factory.mktemp("rig") / "rig.csv"
    table = np.stack([time, wave / 9.80665, np.sin(SPEED * time)], axis=1)
    np.savetxt(path, table, "%.7g", ",", header="time [s],acc [g],pulses [V]", comments="")
    return path


def run_json(capsys: pytest.CaptureFixture[str], *arguments: Any) -> Any:
    assert call(["signal", *map(str, arguments), "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def test_channels_are_listed_with_units_rate_and_duration(
    file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert call(["signal", str(file)]) == 0
    text = capsys.readouterr()
    assert "25600 samples at 6400 Hz, 4 s" in text.out
    assert "acc      g" in text.out
    assert '--channel "acc"' in text.err
    facts = run_json(capsys, file)
    assert [each["name"] for each in facts["channels"]] == ["acc", "pulses"]
    assert facts["sample_rate"] == pytest.approx(RATE)
    assert facts["channels"][1]["alternating_rms"] == pytest.approx(np.sqrt(0.5), rel=1e-4)


def test_a_verdict_has_the_zone_and_the_gear_whose_lines_stand_out(
    file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """2 m/s^2 at 240 Hz and 0.3 m/s^2 at 45 Hz have 1.2 mm/s rms, most of it at the mesh."""
    expected = np.hypot(2.0 / (16.0 * SPEED), 0.3 / (3.0 * SPEED)) / np.sqrt(2.0)
    rate = ("--channel", "acc", "--case", "fzg-roughness", "--limits")
    for limits, zone in (("II", "zone B"), ("0.5/1/2 mm/s", "zone C")):
        facts = run_json(capsys, file, *rate, limits)
        written = float(facts["verdict"][0].partition(" mm/s rms")[0].rpartition(" ")[2])
        assert written == pytest.approx(1e3 * expected, rel=0.03)  # with some of the noise
        assert zone in facts["verdict"][0]
        assert facts["verdict"][-1].startswith("Mesh ")
    assert call(["signal", str(file), *rate, "V"]) == 2
    assert "--limits" in capsys.readouterr().err


@pytest.mark.slow
def test_figures_are_in_si_and_the_report_is_self_contained(
    file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = (file, "--channel", "acc", "--tacho", "pulses", "--teeth", "16/24", "--out",
                 tmp_path / "r", "--earlier", file)  # fmt: skip
    facts = run_json(capsys, *arguments)
    assert facts["unit"] == "m/s^2"
    assert facts["mesh_harmonic_1_amplitude"] == pytest.approx(2.0, rel=0.01)
    assert facts["speed"] == pytest.approx(SPEED, rel=1e-4)
    assert facts["average_revolutions_mate"] in (39, 40)
    assert facts["notes"] == []
    assert facts["na4_star"] == pytest.approx(facts["na4"])  # as strong as the earlier record
    assert [key for key in facts if not np.isscalar(facts[key])] == ["notes", "verdict"]
    assert "alternating rms x1," in facts["verdict"][0]
    assert {each.name for each in (tmp_path / "r").iterdir()} == {"report.html", "study.nc"}
    page = (tmp_path / "r" / "report.html").read_text("utf-8")
    assert "acc of rig.csv" in page
    assert "Mean revolution of the mate, 24 teeth" in page
    for figure in (
        "distance of the mate",
        "over a turn of the shaft",
        "Cepstrum",
        "Kurtogram",
        "Cyclic c",
    ):
        assert figure in page
    assert 'src="http' not in page
    assert call(["signal", *map(str, arguments)]) == 2
    assert "exists" in capsys.readouterr().err
    assert call(["signal", *map(str, arguments), "--force"]) == 0
    text = capsys.readouterr()
    assert "Mesh harmonic 1" in text.out
    assert "report.html" in text.err


def test_teeth_and_speed_come_from_a_case(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    facts = run_json(
        capsys, file, "--channel", "acc", "--case", "fzg-roughness", "--speed", "910 rpm"
    )
    assert facts["speed"] == pytest.approx(SPEED, rel=1e-4)
    assert facts["mesh_harmonic_1_amplitude"] == pytest.approx(2.0, rel=0.01)
    assert "mesh harmonic" in facts["speed_source"]


def test_missing_results_are_named_with_the_option_they_need(
    file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert call(["signal", str(file), "--channel", "acc"]) == 0
    text = capsys.readouterr()
    assert "Alternating rms" in text.out
    assert "--tacho NAME --pulses N" in text.err
    facts = run_json(capsys, file, "--channel", "acc", "--tacho", "pulses")
    assert facts["order_peak_1"] == pytest.approx(16.0, abs=0.1)
    assert "--teeth 29" in facts["notes"][0]


def test_a_part_a_band_and_a_sensitivity_are_read(
    file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    facts = run_json(capsys, file, "--channel", "pulses", "--between", "1..3 s", "--band",
                     "3..60 Hz", "--sensitivity", "500 mV/N")  # fmt: skip
    assert facts["duration"] == pytest.approx(2.0)
    assert facts["unit"] == "N"
    assert facts["envelope_mean"] == pytest.approx(2.0, rel=0.02)


def test_a_file_without_a_rate_takes_one(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "bare.csv"
    wave = np.sin(np.arange(640) / 5.0)
    head = "acc [m/s^2],pulses [V]"
    np.savetxt(path, np.stack([wave, wave], axis=1), "%.7g", ",", header=head, comments="")
    assert call(["signal", str(path)]) == 2
    assert '--sample-rate "25600 Hz"' in capsys.readouterr().err
    facts = run_json(capsys, path, "--sample-rate", "6.4 kHz", "--tacho", "pulses")
    assert facts["channel"] == "acc", "the only other channel needs no name"
    assert facts["spectrum_peak_1_frequency"] == pytest.approx(6400.0 / (10 * np.pi), rel=1e-2)


def test_a_file_without_a_rate_has_orders_relative_to_a_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "bare.csv"
    turn = 2 * np.pi * 0.002 * np.arange(20_000)
    waves = np.stack([np.cos(16 * turn) + 0.3 * np.cos(17 * turn), 0.0 * turn], axis=1)
    np.savetxt(path, waves, "%.5f", ",", header="acc,other", comments="")
    assert call(["signal", str(path), "--channel", "acc"]) == 2
    assert "the strongest are 0.032, 0.034" in capsys.readouterr().err
    assert call(["signal", str(path), "--channel", "acc", "--line", "725 Hz"]) == 2
    assert "cycles per sample" in capsys.readouterr().err
    facts = run_json(capsys, path, "--channel", "acc", "--line", "0.0322", "--teeth", "16")
    assert facts["mesh_harmonic_1_amplitude"] == pytest.approx(1.0, rel=0.01)
    assert facts["order_peak_2"] == pytest.approx(17.0, abs=0.03)
    assert "no sampling rate" in facts["notes"][0]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--channel", "acc", "--line", "0.7"), "between 0 and 0.5"),
        (("--channel", "acc", "--line", "240 Hz", "--speed", "9 rpm"), "--speed: speed = "),
        (("--channel", "ac"), '--channel: there is no channel "ac"'),
        (("--channel", "ac"), 'Did you mean "acc"'),
        (("--channel", "acc", "--tacho", "pulse"), '--tacho: there is no channel "pulse"'),
        (("--channel", "acc", "--tacho", "acc"), "acc is both"),
        (("--channel", "acc", "--tacho", "pulses", "--pulses", "0"), "--pulses"),
        (("--channel", "acc", "--speed", "1500"), 'Write --speed "1500 rpm"'),
        (("--channel", "acc", "--speed", "0 rpm"), "greater than zero"),
        (("--channel", "acc", "--tacho", "pulses", "--speed", "900 rpm"), "both given"),
        (("--channel", "acc", "--teeth", "16.5"), "--teeth"),
        (("--channel", "acc", "--teeth", "16", "--case", "fzg-roughness"), "both given"),
        (("--channel", "acc", "--case", "fzg-ruffness"), "Did you mean"),
        (("--channel", "acc", "--band", "5..2 kHz"), "--band"),
        (("--channel", "acc", "--band", "2..4 kHz"), "--band: The upper end"),
        (("--channel", "acc", "--between", "2..9 s"), "The recording lasts 4 s"),
        (("--channel", "acc", "--tacho", "pulses", "--max-order", "900"), "--max-order"),
        (("--speed", "900 rpm"), "no channel is named"),
        (("--sensitivity", "100 mV/g"), "--sensitivity"),
    ],
)
def test_wrong_input_names_the_option_and_the_remedy(
    file: Path, capsys: pytest.CaptureFixture[str], arguments: tuple[str, ...], message: str
) -> None:
    assert call(["signal", str(file), *arguments]) == 2
    text = capsys.readouterr()
    assert message in text.err
    assert "fault of tribodyn" not in text.err


def test_a_file_that_is_none_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert call(["signal", "nowhere.csv"]) == 2
    assert "There is no such file" in capsys.readouterr().err


def test_teeth_and_speed_of_a_gear_of_a_machine_are_taken(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    time = np.arange(0.0, 1.0, 1e-4)
    table = np.column_stack([time, np.sin(2.0 * np.pi * 1150.0 * time)])
    path = tmp_path / "rig.csv"
    np.savetxt(path, table, delimiter=",", header="time [s],acc [m/s^2]", comments="")
    base = [path, "--channel", "acc"]
    written = run_json(capsys, *base, "--teeth", "23/57", "--speed", "3000 rpm")
    of_case = run_json(capsys, *base, "--case", "two-stage-spur", "--gear", "z1")
    case = tribodyn.load_case("two-stage-spur")
    assert (case.gears["z1"].teeth, case.gears["z2"].teeth) == (23, 57)
    assert of_case == written
    for name, gear, message in (
        ("two-stage-spur", "pinion", 'there is no gear "pinion". Gears of two-stage-spur: z1'),
        ("planetary-stage", "sun", "turns with a carrier"),
        ("fzg-roughness", "z1", "Gears of fzg-roughness: pinion, wheel"),
    ):
        arguments = [*map(str, base), "--case", name, "--gear", gear]
        assert call(["signal", *arguments]) == 2
        assert message in capsys.readouterr().err
