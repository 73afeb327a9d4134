"""The benchmark of hypoid pairs runs, and its rivals find the same."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tribodyn.mesh import hypoid_loaded_contact

_FOLDER = Path(__file__).resolve().parents[2] / "benchmarks"


@pytest.fixture
def bench(monkeypatch: pytest.MonkeyPatch) -> Any:
    """The benchmark of hypoid pairs."""
    monkeypatch.syspath_prepend(str(_FOLDER))
    return importlib.import_module("hypoid_speed")


def test_rivals_find_the_same(bench: Any) -> None:
    flanks = bench.design()
    exact = bench.Exact(flanks, 3)
    np.testing.assert_allclose(exact.own(), exact.general(), rtol=0.0, atol=1e-11)
    loaded = hypoid_loaded_contact(flanks, 500.0, steps=16, cells=5)
    assert bench.cells(loaded, 1) < 1e-12
    np.testing.assert_allclose(bench.balance(loaded), loaded.loaded_rotation, rtol=1e-12)


def test_quick_run(bench: Any, capsys: pytest.CaptureFixture[str]) -> None:
    bench.main(["--quick"])
    output = capsys.readouterr().out
    assert "design to loaded contact" in output
    assert "general exact contact" in output
