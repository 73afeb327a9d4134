"""Meshes that carry nothing are named, at the key that causes it; zipped models are cases."""

from __future__ import annotations

import zipfile
from pathlib import Path

import pytest

import tribodyn as td
from tribodyn.errors import InputError
from tribodyn.exchange import write_rexs


@pytest.mark.parametrize("name", ["two-stage-spur", "two-stage-helical"])
def test_a_mesh_behind_the_output_is_named(name: str) -> None:
    case = td.load_case(name)
    inner = next(shaft for shaft in case.shafts if shaft not in case.ends)
    with pytest.raises(InputError, match="mesh second carries no torque") as refused:
        case.replace({"operation.output": inner}, by="--set")
    assert "operation.output" in str(refused.value)
    with pytest.raises(InputError, match=r"operation\.torque: mesh first carries no torque"):
        case.replace({"operation.torque": "0 N*m"}, by="--set")


@pytest.mark.parametrize("name", ["two-stage-spur", "planetary-stage", "hypoid-axle"])
def test_a_load_without_torque_is_refused_when_it_is_read(name: str) -> None:
    loads = [{"name": "drive"}, {"name": "idle", "torque": 0.0}]
    with pytest.raises(InputError, match=r"load_cases\.idle\.torque: mesh \w+ carries no torque"):
        td.load_case(name).replace({"load_cases": loads})


def test_a_zip_of_a_model_is_a_case(tmp_path: Path) -> None:
    plain = tmp_path / "gearbox.rexs"
    write_rexs(td.load_case("fzg-roughness"), plain)
    packed = tmp_path / "gearbox.rexs.zip"
    with zipfile.ZipFile(packed, "w") as archive:
        archive.write(plain, "gearbox.rexs")

    def outcome(path: Path) -> str:
        try:
            return str(td.load_case(path).to_toml())
        except InputError as error:
            return str(error.problems[0].what)

    assert outcome(packed) == outcome(plain)
