"""The built-in cases give the figures that they gave."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from frozen_figures import case_figures, differences
from moved_figures import markdown, moved_figures
from write_snapshot import read


@pytest.fixture(scope="module")
def current() -> dict[str, dict[str, Any]]:
    return case_figures()


@pytest.mark.processor
@pytest.mark.filterwarnings("ignore:tribodyn. summary.* is deprecated:DeprecationWarning")
@pytest.mark.parametrize("case", list(read("figures")))
def test_figures_of_built_in_cases(case: str, current: dict[str, dict[str, Any]]) -> None:
    frozen = read("figures")[case]
    changes = differences(case, frozen["summary"], current[case]["summary"])
    assert not changes, "\n".join(changes)
    assert set(frozen["warnings"]) <= set(current[case]["warnings"])


def test_differences_are_detected() -> None:
    assert differences("a", {"x": 1.0}, {})
    assert differences("a", {"x": 1.0}, {"x": 1.0 + 2e-9})
    assert not differences("a", {"x": 1.0}, {"x": 1.0 + 5e-10, "y": 2.0})


def test_the_release_notes_list_the_figures_that_moved() -> None:
    assert markdown() in (Path(__file__).parents[2] / "CHANGELOG.md").read_text("utf-8")
    figures = read("figures")
    for moved in moved_figures():
        assert figures[moved.case]["summary"][moved.figure] == pytest.approx(moved.after, rel=1e-9)
