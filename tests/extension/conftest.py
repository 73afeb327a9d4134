"""Extensions in one file each: loaded as a user's script, forgotten after the test."""

from __future__ import annotations

import runpy
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from registries import as_before

FOLDER = Path(__file__).resolve().parents[2] / "docs" / "extending"


@pytest.fixture
def load() -> Iterator[Callable[[str], dict[str, object]]]:
    """Run one of the files of ``docs/extending``; what it registers is forgotten afterwards."""
    with as_before():
        yield lambda name: runpy.run_path(str(FOLDER / f"{name}.py"))
