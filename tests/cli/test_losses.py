"""``tribodyn losses`` and ``tribodyn friction-from-loss``: what they tell, write and refuse."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import tribodyn as td
from tribodyn.cli import call

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")

_SOON = ("--set", "friction.law=schlenk")


def _json_output(capsys: pytest.CaptureFixture[str], *arguments: str) -> Any:
    assert call([*arguments, "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def test_losses_are_printed_over_torque_and_speed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = (
        "losses",
        "fzg-roughness",
        "--torque",
        "50..150 N*m:3",
        "--speed",
        "400,1400 rpm",
        "--set",
        "losses.pinion.seal_diameter=30 mm",
        "--out",
        str(tmp_path / "l"),
        *_SOON,
    )
    output = _json_output(capsys, *arguments)
    assert output["pinion_torque"] == [50.0, 100.0, 150.0]
    assert output["pinion_speed"] == pytest.approx([400 * np.pi / 30, 1400 * np.pi / 30])
    assert output["seal"][0] == pytest.approx([9.69 * 400 / 1400, 9.69], rel=1e-3)
    parts = [np.array(output[name]) for name in ("gear", "seal", "windage")]
    assert np.array(output["total"]) == pytest.approx(sum(parts))
    assert np.all(np.array(output["efficiency"]) < output["gear_efficiency"])
    assert {file.name for file in (tmp_path / "l").iterdir()} == {
        "case.toml",
        "study.nc",
        "report.html",
    }
    assert call([*arguments, "--force"]) == 0
    text = capsys.readouterr().out
    assert "Included losses: teeth, shaft seals, windage." in text
    assert "400 rpm" in text
    assert "100 N*m" in text


def test_losses_of_teeth_alone_are_marked_and_a_rig_has_its_power_flow(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ("losses", "fzg-roughness", "--torque", "90 N*m", "--speed", "900 rpm", *_SOON)
    assert call([*arguments, "--out", str(tmp_path / "a")]) == 0
    assert "add [losses] to the case for bearings, seals and oil" in capsys.readouterr().out
    bearings = ("--set", "losses.pinion.bearing=NJ 406", "--set", "losses.wheel.bearing=NJ 406")
    output = _json_output(
        capsys, *arguments, *bearings, "--rig", "QJ 308", "--out", str(tmp_path / "b")
    )
    rig = output["rig"]
    assert rig["motor_power"] == pytest.approx(
        sum(rig["test"].values()) + sum(rig["slave"].values())
    )
    assert rig["test"]["gear"] == rig["slave"]["gear"] == output["gear"][0][0]
    assert rig["test"]["bearing_rolling"] != rig["slave"]["bearing_rolling"]
    assert "circulate in the loop" in (tmp_path / "b" / "report.html").read_text()


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["--torque", "50 N*m", "--speed", "1400"], '--speed: speed = 1400.*"400..3500 rpm:8"'),
        (["--torque", "50..20 N*m:3"], "--torque: operation.torque goes from 50"),
        (["--torque", "1e12 N*m"], "--torque: torque = .1e12"),
        (["--rig", "NJ 407"], 'losses.pinion.bearing.*Did you mean "NJ 406"'),
        (["--set", "losses.wheel.immersion=20 mm"], "losses.oil_volume: oil_volume is missing"),
        (["--set", "losses.seal=30 mm"], "seal = .30 mm.*unknown key"),
    ],
)
def test_wrong_arguments_of_losses_are_reported(
    arguments: list[str], says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    import re

    assert call(["losses", "fzg-roughness", "--out", str(tmp_path / "no"), *arguments]) == 2
    assert re.search(says, capsys.readouterr().err)
    assert not (tmp_path / "no").exists()


def _file(
    tmp_path: Path, *rows: str, head: str = "speed [rpm], torque [N*m], torque_loss [N*m]"
) -> str:
    file = tmp_path / "losses.csv"
    file.write_text("\n".join(["# a rig", head, *rows]) + "\n")
    return str(file)


def test_friction_of_a_file_is_printed_written_and_plotted(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    factor = td.losses.gear_loss_factor(td.load_case("fzg-roughness").gear_pair)
    rows = [
        f"{n}, {t}, {1.0 + n / 2000 + 0.05 * t * factor + d:.9f}"
        if t > 5
        else f"{n}, 5, {1.0 + n / 2000 + d}"
        for n in (400, 1400)
        for t in (5, 50, 300)
        for d in (-0.02, 0.0, 0.02)
    ]
    place = tmp_path / "f"
    arguments = (
        "friction-from-loss",
        _file(tmp_path, *rows),
        "--case",
        "fzg-roughness",
        "--out",
        str(place),
    )
    output = _json_output(capsys, *arguments)
    assert output["friction_coefficient"] == pytest.approx([0.05] * 4, rel=1e-6)
    assert output["torque"] == pytest.approx([50.0, 300.0, 50.0, 300.0])
    assert output["standard_uncertainty"] == pytest.approx(
        [0.02 * np.sqrt(2.0 / 3.0) / (t * factor) for t in output["torque"]], rel=1e-9
    )
    assert output["verdict"] == ["sound"] * 4
    names = {"friction.csv", "study.nc", "report.html"}
    assert {file.name for file in place.iterdir()} == names
    table = (place / "friction.csv").read_text().splitlines()
    assert table[0].startswith("speed [rpm],torque [N*m],mu,")
    assert len(table) == 5
    assert "Friction from losses" in (place / "report.html").read_text()
    assert call([*arguments, "--set", "gear_sets=2", "--force"]) == 0
    assert "0.025" in capsys.readouterr().out
    assert call([*arguments]) == 2
    assert "--force" in capsys.readouterr().err


def test_the_printed_table_is_available_by_name(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output = _json_output(
        capsys, "friction-from-loss", "fzg-wheel-driven", "--out", str(tmp_path / "f")
    )
    assert output["friction_coefficient"] == pytest.approx([0.0271, 0.0692, 0.119, 0.1505, 0.0554])
    assert output["degrees_of_freedom"] == [None] * 5
    assert "Prediction of Vibration" in output["source"]


_KNOWN = ("--set", "gear_loss_factor=0.3", "--set", "torque_loss_uncertainty=0.05 N*m")


@pytest.mark.parametrize(
    ("rows", "arguments", "says"),
    [
        (["400, 5, 2", "400, 50, 1"], _KNOWN, r"losses.csv:4: torque_loss = 1 N\*m is below the 2"),
        (
            ["400, 5, 2", "800, 50, 3"],
            _KNOWN,
            "losses.csv:4: no run without load at 800 rpm.*400 rpm",
        ),
        (["400, 5, 2", "400, x, 3"], _KNOWN, 'losses.csv:4: "x" is not a number'),
        (["400, 5, 2", "400, 50"], _KNOWN, "losses.csv:4: a number is missing"),
        (["400, 5, 2", "400, 50, -3"], _KNOWN, "losses.csv:4: torque_loss = -3"),
        ([], _KNOWN, "the table has no rows"),
        (["400, 5, 2", "400, 50, 3"], (), "the gear loss factor is missing.*--case"),
        (
            ["400, 5, 2", "400, 50, 3"],
            ("--case", "fzg-roughness"),
            "losses.csv:4: one reading at 50",
        ),
        (["400, 5, 2", "400, 50, 3"], (*_KNOWN, "--case", "fzg-roughness"), "are both given"),
        (["400, 5, 2"], (*_KNOWN, "--set", "gear_set=2"), 'Did you mean "gear_sets"'),
        (["400, 5, 2"], (*_KNOWN, "--set", "gear_sets=7"), "gear_sets = 7"),
        (["400, 5, 2"], (*_KNOWN, "--set", "other_loss=3 mm"), "other_loss = .3 mm"),
    ],
)
def test_wrong_measurements_are_explained_with_their_line(
    rows: list[str],
    arguments: tuple[str, ...],
    says: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    import re

    out = ("--out", str(tmp_path / "no"))
    assert call(["friction-from-loss", _file(tmp_path, *rows), *arguments, *out]) == 2
    assert re.search(says, capsys.readouterr().err)
    assert not (tmp_path / "no").exists()


def test_negative_friction_is_printed_with_its_verdict(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    head = "speed [rpm]; torque [N*m]; torque_loss [N*m]; other_loss [N*mm]"
    file = _file(tmp_path, "400; 5; 1; 0", "400; 50; 1.2; 500", "400; 150; 4; 500", head=head)
    assert call(["friction-from-loss", file, *_KNOWN, "--out", str(tmp_path / "f")]) == 0
    captured = capsys.readouterr()
    assert "-0.02" in captured.out
    assert "negative: what was taken off" in captured.out
    assert "friction-from-loss" in captured.err
    assert "losses.csv:4" in captured.err
    assert "negative" in (tmp_path / "f" / "friction.csv").read_text()
