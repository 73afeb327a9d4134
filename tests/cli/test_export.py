"""``tribodyn export``: models of pairs, machines and stages that name what they lack."""

from __future__ import annotations

from pathlib import Path

import pytest

import tribodyn as td
from tribodyn.cli import call
from tribodyn.exchange import case_from_rexs, machine_from_rexs, read_rexs


@pytest.mark.parametrize("name", ["fzg-roughness", "two-stage-spur", "planetary-stage"])
def test_a_model_is_written_and_read_back(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    case, path = td.load_case(name), tmp_path / "model.rexs"
    assert call(["export", name, "--rexs", str(path)]) == 0
    note = capsys.readouterr().err.partition("from the model: ")[2].strip()
    names = note.split(", ")
    # Only what the file states is missing: no key that has its default, none of hypoid gears.
    assert "friction" in names
    assert all(key.partition(".")[0] in case.data for key in names), names
    assert not any("cutter" in key or "ease_off" in key or "mounting" in key for key in names)
    again = (case_from_rexs if case.lumped else machine_from_rexs)(read_rexs(path))
    assert dict(again.values()).keys() >= {key for key in dict(case.values()) if "gears." in key}


def test_hypoid_gears_are_refused_by_name(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for name, what in (("hypoid-axle", "meshes.axle"), ("hypoid-mixed-ehl", "hypoid pair")):
        assert call(["export", name, "--rexs", str(tmp_path / "x.rexs")]) == 2
        assert what in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
