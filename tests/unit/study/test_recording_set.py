"""Labelled recordings: stored and continued, and what a simple classifier makes of them."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import tribodyn
from tribodyn.errors import InputError
from tribodyn.interrupt import alone
from tribodyn.study import Case, RecordingSet, record_set

SIZES = {"faults.crack.depth": ["0 mm", "1.5 mm", "3 mm"]}
SETTINGS: dict[str, Any] = {"sensor": "pinion_y", "duration": 1.0, "sample_rate": 20_000.0}


@pytest.fixture(scope="module")
def case() -> Case:
    crack = {"kind": "crack", "gear": "pinion", "tooth": 3, "depth": "1 mm"}
    changes = {f"faults.crack.{key}": value for key, value in crack.items()}
    return tribodyn.load_case("fzg-roughness").replace({"stiffness.model": "analytic", **changes})


def test_a_set_is_stored_and_goes_on(case: Case, tmp_path: Path) -> None:
    folder = tmp_path / "set"
    first = record_set(case, folder, SIZES, repeats=2, noise=0.1, seed=5, **SETTINGS)
    assert len(first) == 6
    kept = (folder / "variant-00000.h5").stat().st_mtime_ns
    lost = first[3]["pinion_y"]
    (folder / "variant-00001.h5").unlink()
    with alone():  # one after the other, what threads computed at once
        again = record_set(case, folder, SIZES, repeats=2, noise=0.1, seed=5, **SETTINGS)
    assert (folder / "variant-00000.h5").stat().st_mtime_ns == kept
    np.testing.assert_array_equal(again[3]["pinion_y"], lost)
    assert not np.array_equal(again[2]["pinion_y"], lost)  # draws differ
    rows = list(csv.DictReader((folder / "labels.csv").open(encoding="utf-8")))
    assert [float(row["faults.crack.depth"]) for row in rows] == [
        0,
        0,
        0.0015,
        0.0015,
        0.003,
        0.003,
    ]
    card = json.loads((folder / "card.json").read_text(encoding="utf-8"))
    assert card["units"]["pinion_y"] == "m/s^2"
    assert card["keys"]["faults.crack.depth"]["unit"] == "m"
    with pytest.raises(InputError, match="holds another set"):
        record_set(case, folder, SIZES, repeats=3, noise=0.1, seed=5, **SETTINGS)
    (tmp_path / "note.txt").write_text("mine", encoding="utf-8")
    with pytest.raises(InputError, match="is not empty"):
        record_set(case, tmp_path, SIZES, **SETTINGS)
    with pytest.raises(InputError, match=r"faults\.crack\.tooth"):
        record_set(case, tmp_path / "new", {"faults.crack.tooth": [1, 17]}, **SETTINGS)


def share_told_apart(recordings: RecordingSet, teeth: int = 16) -> float:
    """Part of the sizes found by the nearest mean level of what lies between the mesh harmonics."""
    levels, sizes = [], []
    for label, recording in recordings:
        values = recording["pinion_y"][:-1]  # 15 turns a second: lines of the turns are exact
        size = np.abs(np.fft.rfft(recording["pinion_y"])) / values.size
        turns = size[15::15][:400]
        order = np.arange(1, turns.size + 1)
        levels.append(np.log(np.sum(turns[order % teeth != 0] ** 2)))
        sizes.append(label["faults.crack.depth"])
    level, size_of = np.array(levels), np.array(sizes)
    draws = np.array([label["draw"] for label in recordings.labels])
    learned, kinds = draws % 2 == 0, np.unique(size_of)
    means = np.array([level[learned & (size_of == kind)].mean() for kind in kinds])
    nearest = kinds[np.argmin(np.abs(level[~learned, None] - means), axis=1)]
    return float(np.mean(nearest == size_of[~learned]))


def test_sizes_are_told_apart_unless_noise_hides_them(case: Case, tmp_path: Path) -> None:
    clear, hidden = (
        record_set(case, tmp_path / str(noise), SIZES, repeats=16, noise=noise, **SETTINGS)
        for noise in (0.02, 2000.0)
    )
    assert share_told_apart(clear) == 1.0
    assert share_told_apart(hidden) < 0.67  # a third by chance
