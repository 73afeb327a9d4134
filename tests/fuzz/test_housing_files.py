"""Files of a housing that are no regular files, or damaged, end in a message with the key."""

from __future__ import annotations

import io
import os
import random
from pathlib import Path

import numpy as np
import pytest
from scipy.io import mmwrite
from scipy.sparse import csc_matrix

import tribodyn as td
from fuzz.damage import at_most
from tribodyn.errors import InputError
from tribodyn.study.machine.housing_files import _market
from unit.study.test_superelement_files import FORMATS

CASE = """
[gears.z1]
shaft = "a"
teeth = 20
face_width = "20 mm"
[gears.z2]
shaft = "b"
teeth = 40
face_width = "20 mm"
[meshes.m]
gears = ["z1", "z2"]
normal_module = "2 mm"
stiffness = "4e8 N/m"
[operation]
input = "a"
output = "b"
speed = "100 rpm"
torque = "10 N*m"
[dynamics]
backlash = "0.1 mm"
[housing.nodes]
left = [0, 1, 2, 3, 4, 5]
"""


def stored(folder: Path, keys: str) -> Path:
    path = folder / "m.toml"
    path.write_text(f"{CASE}\n[housing]\n{keys}\n", "utf-8")
    return path


def damaged(content: bytes, rng: random.Random) -> bytes:
    """Content with some bytes changed, left out, or cut."""
    changed = bytearray(content)
    for _ in range(rng.choice((1, 3, 30))):
        changed[rng.randrange(len(changed))] = rng.randrange(256)
    return bytes(changed[: rng.randrange(len(changed))] if rng.random() < 0.3 else changed)


@pytest.mark.parametrize("file", ["pipe", "/dev/zero", "folder", "missing"])
@pytest.mark.parametrize("key", ["matrices", "stiffness_file", "mass_file"])
def test_files_that_are_not_regular(file, key, tmp_path):
    if file == "pipe":
        os.mkfifo(tmp_path / "pipe")
    (tmp_path / "folder").mkdir()
    mmwrite(tmp_path / "K.mtx", np.eye(6))
    names = (
        {"matrices": file}
        if key == "matrices"
        else dict.fromkeys(("stiffness_file", "mass_file"), "K.mtx") | {key: file}
    )
    path = stored(tmp_path, "\n".join(f'{k} = "{v}"' for k, v in names.items()))
    with at_most(5.0), pytest.raises(InputError, match=rf"m\.toml:\d+: housing\.{key}"):
        td.load_case(path)


@pytest.mark.parametrize("symmetry", ["general", "symmetric"])
@pytest.mark.parametrize("make", [np.asarray, csc_matrix])
def test_matrices_are_those_that_were_written(make, symmetry):
    draw = np.random.default_rng(1).integers(-3, 4, (7, 7)) / 8.0
    matrix = draw + draw.T if symmetry == "symmetric" else draw
    file = io.BytesIO()
    mmwrite(file, make(matrix), symmetry=symmetry, comment="of a test")
    file.seek(0)
    assert np.array_equal(_market(file), matrix)


@pytest.mark.parametrize("form", FORMATS)
def test_damaged_files_of_other_programs(form, draws, tmp_path):
    files, keys = FORMATS[form]
    messages = []
    for rng in draws(12):
        for name, content in files.items():
            changed = rng.random() < 0.7 or name == next(iter(files))
            raw = content.encode()
            (tmp_path / name).write_bytes(damaged(raw, rng) if changed else raw)
        path = tmp_path / "m.toml"
        body = CASE.partition("[housing.nodes]")[0]
        path.write_text(f"{body}\n[housing]\n{keys}\n", "utf-8")
        try:
            with at_most(5.0):
                td.load_case(path)
        except InputError as error:
            messages += [str(problem) for problem in error.problems]
    assert messages
    assert [text for text in messages if "m.toml" not in text or "housing" not in text] == []


def test_damaged_files(draws, tmp_path):
    matrix = np.diag(np.arange(1.0, 7.0))
    archive, market, dense = io.BytesIO(), io.BytesIO(), io.BytesIO()
    np.savez(archive, K=matrix, M=matrix)
    mmwrite(market, csc_matrix(matrix))
    mmwrite(dense, matrix)
    messages = []
    for rng in draws(120):
        kind, file = rng.choice([("matrices", archive), ("mtx", market), ("mtx", dense)])
        (tmp_path / "sound.mtx").write_bytes(market.getvalue())
        (tmp_path / "file").write_bytes(damaged(file.getvalue(), rng))
        keys = 'stiffness_file = "sound.mtx"\nmass_file = "file"'
        path = stored(tmp_path, 'matrices = "file"' if kind == "matrices" else keys)
        try:
            with at_most(5.0):
                td.load_case(path)
        except InputError as error:
            messages += [str(problem) for problem in error.problems]
    assert messages
    assert [text for text in messages if "m.toml" not in text or "housing" not in text] == []
