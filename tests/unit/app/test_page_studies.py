"""Every study of the page computes with the values that stand in its form at first, and saves."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("dash", reason="the page needs Dash")

from tribodyn.app.studies import STUDIES, first_values
from tribodyn.cases.load import load_case
from tribodyn.errors import InputError
from tribodyn.progress import SILENT

#: Fewer points than at first, to be quick.
_FEW = {
    "sweep": {"values": "800..900 rpm:2"},
    "losses": {"torque": "50, 90 N*m", "speed": "900 rpm"},
    "film": {"torque": "50, 90 N*m", "speed": "900 rpm"},
    "bifurcation": {"values": "800..900 rpm:2", "cycles": "4", "transient": "2"},
    "relief": {"torque": "90 N*m"},
    "harris": {"torque": "60 N*m, 90 N*m"},
    "run-up": {"duration": "0.2"},
}


@pytest.mark.parametrize("kind", STUDIES)
def test_every_study_shows_and_saves_what_it_finds(kind: str, tmp_path: Path) -> None:
    case = load_case("fzg-roughness")
    values = first_values(kind, case) | _FEW.get(kind, {})
    shown = STUDIES[kind].compute(case, values, SILENT, tmp_path / "result")
    assert shown["told"]
    assert all(figure.data for _, figure, _ in shown["figures"])
    assert shown["figures"]
    assert all(len(row) == len(head) for _, head, rows in shown["tables"] for row in rows)
    assert any(path.suffix == ".html" for path in (tmp_path / "result").iterdir())


def test_a_range_that_is_none_is_told_with_one_that_is() -> None:
    with pytest.raises(InputError, match=r'"fast".*Write for example "90 N\*m"'):
        STUDIES["harris"].compute(load_case("fzg-roughness"), {"torque": "fast"}, SILENT, Path())
