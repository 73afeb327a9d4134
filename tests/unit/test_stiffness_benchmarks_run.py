"""The benchmark of the static studies runs, on the pairs that it names, against an equal rival."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

_FOLDER = Path(__file__).resolve().parents[2] / "benchmarks"


@pytest.fixture
def bench(monkeypatch: pytest.MonkeyPatch) -> Any:
    """The benchmark of the static studies."""
    monkeypatch.syspath_prepend(str(_FOLDER))
    return importlib.import_module("stiffness_speed")


def test_rival_solves_the_same_problem(bench: Any) -> None:
    mesh = bench.problem(bench.fzg(), 8)
    totals = np.array([2660.4, 8868.0])
    ours, theirs = bench.compiled(mesh, totals), bench.plain(mesh, totals)
    assert ours.shape == (2, 8)
    np.testing.assert_allclose(ours, theirs, rtol=1e-10)
    # the deflection of this pair under 90 and 300 N*m
    np.testing.assert_allclose(ours.mean(axis=1), [11.8e-6, 37.4e-6], rtol=0.03)


def test_pair_of_the_race_with_ross_is_a_standard_one(bench: Any) -> None:
    pair = bench.standard_pair()
    assert pair.pinion.profile_shift_coefficient == pair.wheel.profile_shift_coefficient == 0.0
    assert pair.pinion.tip_diameter == pytest.approx(2e-3 * 64)


def test_quick_run(bench: Any, capsys: pytest.CaptureFixture[str]) -> None:
    bench.main(["--quick"])
    output = capsys.readouterr().out
    for expected in ("16 phases x 3 torques, fe2d", "best tip relief", "compiled", "ROSS"):
        assert expected in output
