"""Files that an earlier state wrote are read, and are written with the same columns and values."""

from __future__ import annotations

import json
import tomllib
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pint
import pytest
import xarray
from frozen_figures import differences
from write_stored import COMMANDS, MESHES, write_results

import tribodyn as td
from tribodyn.mesh import MeshTable

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")

_ARCHIVE = Path(__file__).parent / "stored.zip"
#: A pair with coupled load and film and a machine, in the layout before that of all results.
_LAST = _ARCHIVE.with_name("stored-results.zip")
_RESULTS = sorted(COMMANDS)
with zipfile.ZipFile(_ARCHIVE) as _archive:
    #: Built-in cases of that state; later ones are not in it.
    _CASES = sorted(
        Path(n).stem for n in _archive.namelist() if n.startswith("cases/") and n.endswith(".toml")
    )
#: Columns of the solved film.
_FILMS = {"central_film", "minimum_film", "film_ratio", "film_pressure", "film_stiffness"}


@pytest.fixture(scope="module")
def stored(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("stored")
    with zipfile.ZipFile(_ARCHIVE) as archive:
        archive.extractall(folder)
    return folder


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder: Path = tmp_path_factory.mktemp("written")
    write_results(folder)
    return folder


def _entries(table: dict[str, Any], place: str = "") -> Iterator[tuple[str, Any]]:
    for name, value in table.items():
        if isinstance(value, dict):
            yield from _entries(value, f"{place}{name}.")
        else:
            yield place + name, value


def _open(path: Path) -> xarray.Dataset:
    with xarray.open_dataset(path, engine="h5netcdf") as data:
        return data.load()


def _assert_same_data(old: xarray.Dataset, new: xarray.Dataset) -> None:
    assert set(old.variables) <= set(new.variables)
    assert set(old.attrs) <= set(new.attrs)
    for name, column in old.variables.items():
        other = new.variables[name]
        assert other.dims == column.dims, name
        if " or " not in column.attrs.get("units", ""):  # now each coordinate has its own
            assert other.attrs.get("units") == column.attrs.get("units"), name
        if name == "steady_state_error":  # what is left of the search, not a figure of the motion
            assert np.all(other.values < 1e-9)
        elif name == "warnings":  # earlier warnings still come
            pairs = zip(column.values.flat, other.values.flat, strict=True)
            assert all(set(old.split()) <= set(new.split()) for old, new in pairs)
        elif column.dtype.kind in "fc":
            if name in _FILMS:  # missing where a pair hardly touches: compared where it is
                untold = np.isnan(other.values)
                assert untold.mean() < 0.2, name
                column = column.where(~untold)
            scale = float(np.nanmax(np.abs(column.values), initial=0.0))
            assert other.values == pytest.approx(
                column.values, rel=1e-9, abs=1e-9 * scale + 1e-15, nan_ok=True
            ), name
        else:
            assert (other.values == column.values).all(), name


@pytest.mark.parametrize("name", _CASES)
def test_stored_cases_read_back(name: str, stored: Path) -> None:
    path = stored / "cases" / f"{name}.toml"
    again = dict(_entries(tomllib.loads(td.load_case(path).to_toml())))
    for key, value in _entries(tomllib.loads(path.read_text("utf-8"))):
        place = key if key in again else f"{key}.reason"  # of a case that has changed since
        assert again[place] == value or _in_si(again[place]) == _in_si(value), key


def _in_si(text: Any) -> tuple[float, str]:
    """Number and dimensions of a quantity, to the digits that a file holds."""
    quantity = pint.UnitRegistry()(str(text)).to_base_units()
    return float(f"{quantity.magnitude:.14g}"), str(quantity.units)


@pytest.mark.parametrize("name", _RESULTS)
def test_stored_data_are_those_of_today(name: str, stored: Path, written: Path) -> None:
    for path in sorted((stored / name).iterdir()):
        today = written / name / path.name
        assert today.exists(), path.name
        if path.suffix == ".nc":
            _assert_same_data(_open(path), _open(today))


@pytest.mark.parametrize("name", ["result", "transient"])
def test_stored_summary_is_that_of_today(name: str, stored: Path, written: Path) -> None:
    old, new = (json.loads((f / name / "summary.json").read_text()) for f in (stored, written))
    assert not differences(name, old, new)


def test_columns_of_a_sweep_keep_their_names(stored: Path, written: Path) -> None:
    old, new = (
        (folder / "sweep" / "sweep.csv").read_text("utf-8").splitlines()
        for folder in (stored, written)
    )
    rows = [i for i, line in enumerate(old) if line and not line.startswith("#")]
    assert set(old[rows[0]].split(",")) <= set(new[rows[0]].split(","))


@pytest.mark.parametrize("name", _RESULTS)
def test_case_of_a_stored_result_reads_back(name: str, stored: Path) -> None:
    path = stored / name / "case.toml"
    again = dict(_entries(tomllib.loads(td.load_case(path).to_toml())))
    for key, value in _entries(tomllib.loads(path.read_text("utf-8"))):
        place = key if key in again else f"{key}.reason"  # of a case that has changed since
        assert again[place] == value or _in_si(again[place]) == _in_si(value), key


def _in_si(text: Any) -> tuple[float, str]:
    """Number and dimensions of a quantity, to the digits that a file holds."""
    quantity = pint.UnitRegistry()(str(text)).to_base_units()
    return float(f"{quantity.magnitude:.14g}"), str(quantity.units)


@pytest.mark.parametrize("kind", ["pair", "machine"])
def test_results_of_the_last_layout_are_read_and_written(kind: str, tmp_path: Path) -> None:
    with zipfile.ZipFile(_LAST) as archive:
        archive.extractall(tmp_path)
    result = td.load_result(tmp_path / kind)
    assert result.summary() == json.loads((tmp_path / kind / "summary.json").read_text())
    again = td.load_result(result.save(tmp_path / "again"))
    assert again.to_xarray().identical(result.to_xarray())
    assert dict(again.tables) == dict(result.tables)
    assert again.summary() == result.summary()
    assert again.case.to_toml() == result.case.to_toml()
    if kind == "pair":
        assert again.coupling == result.coupling
        assert result.coupling.loading.size == result.mesh.phase.size


@pytest.mark.parametrize("name", [*MESHES, "result"])
def test_stored_mesh_tables_are_read(name: str, stored: Path, tmp_path: Path) -> None:
    path = stored / ("result/mesh.nc" if name == "result" else f"meshes/{name}.nc")
    table = MeshTable.load(path)
    _assert_same_data(_open(path), table.to_xarray())
    again = tmp_path / "mesh.nc"
    table.save(again)
    _assert_same_data(_open(path), _open(again))


@pytest.mark.parametrize("name", list(MESHES))
def test_stored_mesh_tables_are_those_of_today(name: str, stored: Path) -> None:
    _assert_same_data(_open(stored / "meshes" / f"{name}.nc"), MESHES[name]().to_xarray())
