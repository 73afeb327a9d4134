"""Damaged results: refused, or read with exactly the same values."""

from __future__ import annotations

import random
import shutil
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

import tribodyn as td
from fuzz.damage import at_most, cut, flip
from tribodyn.errors import TribodynError, quiet

Draws = Callable[[int], Iterator[random.Random]]
_QUICK = {"stiffness.model": "iso6336", "friction.law": "none", "film.model": "none"}
_FILES = ("case.toml", "summary.json", "mesh.nc", "response.nc")


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> Any:
    place = tmp_path_factory.mktemp("results") / "r"
    with quiet():
        td.run(td.load_case("fzg-roughness").replace(_QUICK)).save(place)
        return td.load_result(place)


@pytest.mark.slow
def test_damaged_results(
    draws: Draws, result: Any, tmp_path_factory: pytest.TempPathFactory
) -> None:
    sound = tmp_path_factory.mktemp("sound") / "r"
    with quiet():
        result.save(sound)
    place, refused = sound.with_name("damaged"), 0
    for rng in draws(25):
        shutil.rmtree(place, ignore_errors=True)
        shutil.copytree(sound, place)
        damaged = place / rng.choice(_FILES)
        if rng.random() < 0.1:
            damaged.unlink()
        else:
            damaged.write_bytes(rng.choice((flip, cut))(damaged.read_bytes(), rng))
        try:
            with quiet(), at_most(5.0):
                loaded = td.load_result(place)
        except TribodynError:
            refused += 1
            continue
        assert loaded.summary() == result.summary()
        assert loaded.case == result.case
        for name in ("position", "velocity", "contact_force"):
            np.testing.assert_array_equal(
                getattr(loaded.response, name), getattr(result.response, name)
            )
    assert refused
