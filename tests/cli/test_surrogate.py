"""``tribodyn surrogate``: a model from one command, evaluated by another."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import tribodyn as td
from tribodyn.cli import call

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")

_WORDS = ("surrogate", "train", "time-varying-friction", "force_scale=0.8 .. 1.6",
          "friction_scale=0 .. 2", "--size", "128", "--set", "stiffness.model=rectangular",
          "--set", "stiffness.pair_stiffness=2e8 N/m")  # fmt: skip


def test_a_model_is_trained_and_evaluated(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "model.nc"
    assert call([*_WORDS, "--out", str(path), "--json"]) == 0
    output = json.loads(capsys.readouterr().out)
    assert output["features"] == ["force_scale", "friction_scale"]
    error = output["errors"]["rms_mesh_force"]
    assert error["rows"] == 26
    assert error["determination"] > 0.999
    assert error["unit"] == "N"

    arguments = ["surrogate", "predict", str(path), "force_scale=1", "friction_scale=1"]
    assert call([*arguments, "--json"]) == 0
    predicted = json.loads(capsys.readouterr().out)["rms_mesh_force"]
    assert predicted["low"] < predicted["value"] < predicted["high"]
    case = td.load_case("time-varying-friction").replace(
        {"stiffness.model": "rectangular", "stiffness.pair_stiffness": 2e8}
    )
    computed = td.run(case).summary()["rms_mesh_force"]
    assert predicted["value"] == pytest.approx(computed, abs=4.0 * error["band"])

    assert call(arguments) == 0
    assert "rms_mesh_force" in capsys.readouterr().out
    assert call([*arguments[:3], "force_scale=1", "friction=1"]) == 2
    message = capsys.readouterr().err
    assert "friction is no input of this model" in message
    assert "friction_scale is missing" in message
    assert call([*_WORDS, "--out", str(path)]) == 2
    assert "exists already" in capsys.readouterr().err


def test_a_band_that_too_few_points_leave_open_is_reported(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "model.nc"
    arguments = [*_WORDS, "--out", str(path)]
    arguments[arguments.index("128")] = "16"
    assert call(arguments) == 0
    text = capsys.readouterr().out
    assert "A band of 95% takes 19 of them" in text
    assert "open" in text
    assert "inf" not in text
    assert call(["surrogate", "predict", str(path), "force_scale=1", "friction_scale=1"]) == 0
    text = capsys.readouterr().out
    assert "open" in text
    assert "inf" not in text
