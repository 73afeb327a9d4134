"""The validation page says what is computed today."""

import re
from collections import Counter

import pytest
from validation import GROUPS, PAGE, Row, line, rows_of

from tribodyn.cases.papers.printed import papers, printed_rows

TEXT = PAGE.read_text("utf-8")


def stated(heading: str) -> dict[str, tuple[float, float]]:
    """Reference and computed figure of each row of a section of the page."""
    section = TEXT.partition(f"\n## {heading}\n")[2].partition("\n## ")[0]
    rows = re.findall(r"^\| (.+?) \| ([-\d.e]+) \| ([-\d.e]+) \|", section, re.MULTILINE)
    return {what: (float(reference), float(computed)) for what, reference, computed in rows}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("heading", "group"), [(g[0], g[2]) for g in GROUPS], ids=[g[0] for g in GROUPS]
)
def test_figures_are_within_their_tolerances_and_as_on_the_page(heading, group) -> None:
    rows, stated_figures = rows_of(group), stated(heading)
    assert list(stated_figures) == [row.what for row in rows]
    for row in rows:
        assert abs(row.deviation) <= row.tolerance, line(row)
        reference, computed = stated_figures[row.what]
        assert reference == pytest.approx(row.reference, rel=1e-6)
        assert computed == pytest.approx(row.computed, rel=max(0.1 * row.tolerance, 1e-6)), row.what


def test_printed_tables_stand_with_their_verdicts() -> None:
    """The verdicts themselves are computed by tests/paper_cases."""
    for case in papers():
        expected: dict[str, Counter[str]] = {}
        for row in printed_rows(case):
            expected.setdefault(row.table, Counter())[row.expected] += 1
        for table, counts in expected.items():
            kinds = " | ".join(str(counts[name]) for name in ("value", "trend", "cannot-reproduce"))
            assert f"| `{case}` | {table} | {counts.total()} | {kinds} |" in TEXT


def test_a_row_shows_its_deviation() -> None:
    assert line(Row("a [m]", 2.0, 2.1, 0.06)) == "| a [m] | 2 | 2.1 | +5 | 6 |"
