"""Commands of studies: what they tell, write and refuse."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import tribodyn as td
from tribodyn.cli import call

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")

_SOON = ("--set", "stiffness.model=analytic")


def _json_output(capsys: pytest.CaptureFixture[str], *arguments: str) -> Any:
    assert call([*arguments, "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def test_modes_are_those_of_the_structure(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    place = tmp_path / "modes"
    output = _json_output(
        capsys, "modes", "fzg-roughness", "1000..5000 rpm", "--out", str(place), *_SOON
    )
    case = td.load_case("fzg-roughness").replace({"stiffness.model": "analytic"})
    modes = td.natural_modes(case)
    frequency = [row["frequency"] for row in output["modes"]]
    assert frequency == pytest.approx(modes.frequency[modes.rigid :])
    teeth = case.gears.pinion.teeth
    for row in output["modes"]:
        speeds = [2.0 * np.pi * row["frequency"] / (order * teeth) for order in output["orders"]]
        assert row["speeds"] == pytest.approx(speeds)
    assert {file.name for file in place.iterdir()} == {"case.toml", "study.nc", "report.html"}
    text = (place / "report.html").read_text()
    assert "Campbell diagram" in text
    assert "rpm at harmonic 1" in text


def test_harris_prints_the_error_over_the_torque(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = (
        "harris",
        "fzg-roughness",
        "60 N*m",
        "120 N*m",
        "--out",
        str(tmp_path / "h"),
        *_SOON,
    )
    output = _json_output(capsys, *arguments)
    assert output["torque"] == [60.0, 120.0]
    assert (
        output["peak_to_peak_transmission_error"][0] < output["peak_to_peak_transmission_error"][1]
    )


@pytest.mark.slow
def test_the_better_case_of_a_relief_is_better(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    place = tmp_path / "relief"
    output = _json_output(
        capsys,
        "relief",
        "fzg-roughness",
        "60 N*m",
        "120 N*m",
        "--gears",
        "wheel",
        "--out",
        str(place),
        *_SOON,
    )
    best = td.load_case(place / "best.toml")
    assert best.gears.wheel.modification.tip_relief == pytest.approx(output["amount"], rel=1e-6)
    assert best.gears.pinion.modification is None
    swing = td.harris_map(best, output["torque"], phases=512).peak_to_peak_transmission_error
    np.testing.assert_allclose(swing, output["peak_to_peak_after"], rtol=1e-6)
    assert max(swing) < max(output["peak_to_peak_before"])
    assert call(["relief", "fzg-roughness", "--out", str(place), *_SOON]) == 2
    assert "--force" in capsys.readouterr().err


@pytest.mark.slow
def test_a_run_up_prints_its_levels(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    output = _json_output(capsys, "run-up", "fzg-roughness", "2900..3000 rpm", "--duration", "0.05",
                          "--out", str(tmp_path / "up"), *_SOON)  # fmt: skip
    assert len(output["speed"]) == len(output["rms_mesh_force"]) > 1
    assert min(output["rms_mesh_force"]) > 0.0


_QUIET = (*_SOON, "--set", "friction.law=none", "--set", "film.model=none")


@pytest.mark.parametrize(
    ("command", "arguments", "key"),
    [
        ("lyapunov", ["--cycles", "10", "--transient", "20"], "largest"),
        ("basins", ["--points", "2", "--transmission-error", "-5..30 um"], "attractors"),
        ("continuation", ["operation.speed=1430..1440 rpm", "--longest-step", "1"],
         "special_points"),
        ("sobol", ["tangential_force", "--size", "2", "--set", "operation.torque=90 N*m +- 2 %",
                   "--set", "operation.speed=1430 rpm +- 2 %"], "figures"),
    ],
)  # fmt: skip
def test_nonlinear_motions_and_tolerances_of_a_case(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], command: str, arguments: list[str], key: str
) -> None:
    place = tmp_path / command
    answer = _json_output(
        capsys, command, "fzg-roughness", *arguments, "--out", str(place), *_QUIET
    )
    assert key in answer
    assert {file.name for file in place.iterdir()} == {"case.toml", "study.nc", "report.html"}
    if command == "lyapunov":
        vibration = [
            value
            for value, free in zip(answer["exponents"], answer["free_rotation"], strict=True)
            if not free
        ]
        assert answer["largest"] == vibration[0]
        assert sum(answer["free_rotation"]) == 2
    if command == "basins":
        assert answer["transmission_error"] == pytest.approx([-5e-6, 30e-6])
        assert answer["units"] == ["m", "m/s"]


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["continuation", "fzg-roughness", "operation.speed=1..2 rpm:9"], "chooses its points"),
        (["continuation", "fzg-roughness", "fast"], "KEY=LOW..HIGH"),
        (["basins", "fzg-roughness", "--rate", "fast"], 'cannot read "fast"'),
        (["lyapunov", "fzg-roughness", "--cycles", "1"], "--cycles"),
        (["sobol", "fzg-roughness"], "no value of the case has a tolerance"),
        (["modes", "fzg-roughness", "fast"], 'cannot read "fast"'),
        (["run-up", "fzg-roughness"], "tribodyn run-up fzg-roughness"),
        (["harris", "fzg-roughness", "60 mm"], "torque"),
        (["relief", "fzg-roughness", "--gears", "both of them"], "both"),
        (["compare", "nothing", "nothing"], "no such directory"),
        (["harris", "fzg-roughness", "-5 N*m"], 'torque = "-5 N*m". Allowed: 1e-06 N*m to'),
        (["relief", "fzg-roughness", "-5 N*m", "9 N*m"], "without its sign it is in the range"),
        (["losses", "fzg-roughness", "--torque", "-5 N*m"], '--torque: torque = "-5 N*m"'),
        (["run-up", "fzg-roughness", "0..3000 rpm"], "argument between"),
        (["run-up", "fzg-roughness", "-5..3000 rpm"], "above standstill"),
    ],
)
def test_wrong_arguments_are_reported(
    arguments: list[str], says: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    assert call(arguments) == 2
    assert says in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_two_results_are_compared(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    case = td.load_case("fzg-roughness").replace({"stiffness.model": "analytic"})
    places = [str(tmp_path / name) for name in ("a", "b")]
    results = [td.run(each) for each in (case, case.replace({"operation.torque": "120 N*m"}))]
    for result, place in zip(results, places, strict=True):
        result.save(place)
    output = _json_output(capsys, "compare", *places)
    assert output["values"] == {"operation.torque": [90.0, 120.0]}
    assert output["figures"]["line_load"][1] / output["figures"]["line_load"][0] == pytest.approx(
        120.0 / 90.0
    )
    assert "center_distance" not in output["figures"]
    assert call(["compare", *places]) == 0
    text = capsys.readouterr().out
    assert "+33.3 %" in text
    assert "Operating point" in text
    assert call(["compare", places[0], places[0]]) == 0
    assert "equal" in capsys.readouterr().out


def test_a_result_is_compared_with_a_recording(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A recording made from the result with half its motion and some noise: all is found again."""
    result = td.run(td.load_case("fzg-roughness").replace({"stiffness.model": "analytic"}))
    result.save(tmp_path / "result")
    data = result.to_xarray()
    size, mesh = data["acceleration_loa_pinion_spectrum"].values, data.attrs["mesh_frequency"]
    time = np.arange(102_400) / 51_200.0
    wave = sum(
        0.5 * a * np.cos(2.0 * np.pi * k * mesh * time + k)
        for k, a in zip(data["order"].values, size, strict=True)
        if 0 < k * mesh < 25_000.0
    )
    volts = wave / 9.80665 * 0.1
    file = tmp_path / "rig.csv"
    np.savetxt(file, np.c_[time, volts], "%.9g", ",", header="time [s],acc [V]", comments="")
    arguments = ("compare", str(tmp_path / "result"), str(file), "--channel",
                 "acc=acceleration_loa_pinion, 100 mV/g")  # fmt: skip
    output = _json_output(capsys, *arguments, "--gain", "0.5", "--out", str(tmp_path / "report"))
    assert output["gains"] == {"acc": 0.5}
    for row in output["rows"]:
        if row["measure"] != "rms":
            assert row["error"] == pytest.approx(0.0, abs=2e-3), row
    assert "Computed and measured" in (tmp_path / "report" / "report.html").read_text()
    fitted = _json_output(capsys, *arguments, "--gain", "fit")
    assert fitted["fitted"]
    assert fitted["gains"]["acc"] == pytest.approx(0.5, rel=1e-3)
    for wrong, message in (
        (("--channel", "acc"), "names no pair"),
        (("--channel", "acc=force"), 'no sensor is named "force"'),
        (("--gain", "much"), "--gain"),
    ):
        assert call([*arguments, *wrong]) == 2
        assert message in capsys.readouterr().err


def test_a_result_is_compared_with_a_recording_off_speed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """3 % slow and wandering by 1 %, in g, with and without a tachometer on the wheel."""
    result = td.run(td.load_case("fzg-roughness").replace({"stiffness.model": "analytic"}))
    result.save(tmp_path / "result")
    data = result.to_xarray()
    mesh = data.attrs["mesh_frequency"]
    time = np.arange(40_000) / 20_000.0
    angle = 2.0 * np.pi * 0.97 * mesh * (time + 0.01 * np.sin(np.pi * time) / np.pi)
    size = data["acceleration_loa_pinion_spectrum"].values[1:4]
    wave = sum(a * np.cos(k * angle + k) for k, a in enumerate(size, 1)) / 9.80665
    wave += 0.1 * np.std(wave) * np.random.default_rng(0).standard_normal(time.size)
    pulses = np.sin(30.0 * angle / result.case.gears.wheel.teeth) > 0.0
    file = tmp_path / "rig.csv"
    table = np.c_[time, wave, pulses]
    np.savetxt(file, table, "%.9g", ",", header="time [s],acc [g],tacho [V]", comments="")
    arguments = ("compare", str(tmp_path / "result"), str(file), "--harmonics", "3",
                 "--channel", "acc=acceleration_loa_pinion")  # fmt: skip
    tacho = ("--tacho", "tacho", "--pulses", "30", "--gear", "wheel")
    for options, how in (((), "phase demodulation"), (tacho, "tachometer")):
        comparison = _json_output(capsys, *arguments, *options)
        uncertainty = comparison["speed_uncertainty"]
        assert abs(comparison["speed_ratio"] - 0.97) < 4.0 * uncertainty < 4e-4
        assert comparison["speed_range"] == pytest.approx([0.9603, 0.9797], abs=1e-3)
        assert how in comparison["speed_method"]
        assert comparison["harmonic_shares"]["acc"] == pytest.approx(0.99, abs=0.01)
        amplitudes = [row["measured"] for row in comparison["rows"][2:]]
        assert amplitudes == pytest.approx(size, rel=0.05)
    assert call([*arguments, *tacho]) == 0
    assert "computed one: 0.9" in capsys.readouterr().out
    for wrong in (("--tacho", "tacho"), ("--pulses", "30")):
        assert call([*arguments, *wrong]) == 2
        assert "Write --tacho CHANNEL --pulses N" in capsys.readouterr().err
    np.savetxt(file, np.c_[time, np.random.default_rng(1).standard_normal(time.size)], "%.9g", ",",
               header="time [s],acc [g]", comments="")  # fmt: skip
    nothing = _json_output(capsys, *arguments)
    assert nothing["speed_ratio"] is None
    assert nothing["rows"][2]["measured"] is None
    assert call([*arguments, "--gain", "fit"]) == 2
    assert "no gain can be fitted for channel acc" in capsys.readouterr().err
