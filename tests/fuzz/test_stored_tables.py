"""Damaged stored files: refused, or read with exactly the same values."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from dataclasses import fields
from pathlib import Path

import h5py
import numpy as np
import pytest

from fuzz.damage import at_most, cut, flip
from tribodyn import load_case
from tribodyn.errors import InputError, quiet
from tribodyn.mesh import MeshTable
from tribodyn.mesh.table_file import read_table_file
from tribodyn.study.pipeline.tooth_contact import mesh_of

Draws = Callable[[int], Iterator[random.Random]]


@pytest.fixture(scope="module")
def table() -> MeshTable:
    case = load_case("fzg-roughness").replace({"stiffness.model": "iso6336"})
    with quiet():
        return mesh_of(case)


@pytest.fixture(scope="module")
def stored(table: MeshTable, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("tables") / "mesh.nc"
    table.save(path)
    return path


def _without_checksum(file: h5py.File) -> None:
    file.attrs["_NCProperties"] = np.bytes_("version=2")


def _rewrite(path: Path, rng: random.Random) -> None:
    """Damage one variable or attribute through the library that writes such files."""
    with h5py.File(path, "r+") as file, np.errstate(all="ignore"):
        if rng.random() < 0.6:
            _without_checksum(file)
        names = [name for name in file if file[name].shape]
        name = rng.choice(names)
        kind, data = rng.randrange(9), file[name]
        if kind == 0:
            del file[name]
        elif kind == 1:
            file.move(name, rng.choice(("Stiffness", "x", "path2")))
        elif kind == 2 and data.dtype.kind == "f":
            data[rng.randrange(data.shape[0])] = rng.choice((np.nan, np.inf))
        elif kind == 3:
            values = data[...]
            del file[name]
            file[name] = (
                values.astype(rng.choice(("S8", "i2", "c16", "f2")))
                if rng.random() < 0.7
                else values[:3]
            )
        elif kind == 4:
            values = data[...]
            del file[name]
            file[name] = rng.choice(
                (values[..., None], values.reshape(-1), np.float64(1.0), values[:0])
            )
        elif kind == 5 and "gear_pair" in file.attrs:
            text = rng.choice(
                (
                    "{}",
                    "",
                    "[" * 5000,
                    "null",
                    '{"pinion": 1}',
                    "x" * 100_000,
                    '{"pinion": {"rack": {}}}',
                )
            )
            file.attrs["gear_pair"] = text
        elif kind == 6:
            attribute = rng.choice(list(file.attrs))
            file.attrs[attribute] = rng.choice((np.nan, "x", -1.0, 10**18, np.arange(3), ""))
        elif kind == 7:
            del file.attrs[rng.choice(list(file.attrs))]
        else:
            file["intervals"][0] = rng.choice((-4, 0, 3, 2**60, 7))


def _read(loader: Callable[[Path], object], path: Path) -> object | None:
    try:
        with quiet(), at_most(5.0):
            return loader(path)
    except InputError as error:
        message = str(error)
    assert len(message) < 5000
    assert str(path) in message
    return None


def _same(first: object, other: object) -> bool:
    return all(
        str(getattr(first, name)) == str(getattr(other, name))
        if not isinstance(getattr(first, name), np.ndarray)
        else getattr(first, name).tobytes() == getattr(other, name).tobytes()
        for name in (field.name for field in fields(MeshTable))
    )


@pytest.mark.slow
def test_damaged_bytes_of_a_mesh_table(
    draws: Draws, table: MeshTable, stored: Path, tmp_path: Path
) -> None:
    content, path = stored.read_bytes(), tmp_path / "mesh.nc"
    for rng in draws(40):
        path.write_bytes(rng.choice((flip, flip, cut))(content, rng))
        loaded = _read(MeshTable.load, path)
        assert loaded is None or _same(loaded, table)
        _read(read_table_file, path)


@pytest.mark.slow
def test_damaged_variables_of_a_mesh_table(
    draws: Draws, table: MeshTable, stored: Path, tmp_path: Path
) -> None:
    content, path, refused = stored.read_bytes(), tmp_path / "mesh.nc", 0
    for rng in draws(30):
        path.write_bytes(content)
        _rewrite(path, rng)
        loaded = _read(MeshTable.load, path)
        refused += loaded is None
        if loaded is not None:
            for name in ("stiffness", "path", "load_share", "sliding_speed"):
                assert np.isfinite(getattr(loaded, name)).all()
                assert getattr(loaded, name).shape == getattr(table, name).shape
        _read(read_table_file, path)
    assert refused


def test_damaged_tables_as_text(draws: Draws, table: MeshTable, tmp_path: Path) -> None:
    sound, path = tmp_path / "sound.csv", tmp_path / "mesh.csv"
    table.to_csv(sound)
    lines = sound.read_text(encoding="utf-8").splitlines()
    short = [*lines[:6], *lines[6:40], *lines[-40:]]
    entries = ["nan", "inf", "", "x", "1_0", "１", "1e999", '"', "\0", "9" * 5000, "-1", "1,2"]
    for rng in draws(60):
        damaged = list(short)
        for _ in range(rng.choice((1, 3))):
            at = rng.randrange(len(damaged))
            cells = damaged[at].split(",")
            cells[rng.randrange(len(cells))] = rng.choice(
                [*entries, "stiffness_999999999 [N/m]", "stiffness_0"]
            )
            damaged[at] = rng.choice((",".join(cells), damaged[rng.randrange(len(damaged))], ""))
        path.write_bytes(
            flip("\n".join(damaged).encode(), rng)
            if rng.random() < 0.3
            else "\n".join(damaged).encode()
        )
        loaded = _read(read_table_file, path)
        assert loaded is None or np.isfinite(loaded.columns["stiffness"]).all()
