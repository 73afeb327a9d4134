"""Printed tables of one source or of all, each row compared with the computed figure."""

from __future__ import annotations

import csv
import io
import os
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import ClassVar

from tribodyn.aliases import with_old_names
from tribodyn.cases.papers.printed import (
    PrintedRow,
    deviation,
    papers,
    printed_rows,
    series_of,
    verdicts,
)
from tribodyn.checkpoints import Checkpoints
from tribodyn.drawing import write_report_of
from tribodyn.progress import SILENT, Progress
from tribodyn.record import Record, record
from tribodyn.study.pipeline.save import new_directory
from tribodyn.types import Tree


@with_old_names
@record
class PaperComparison(Record):
    """What :func:`compare_with_paper` returns.

    Parameters
    ----------
    papers : tuple of str
        Cases of the sources.
    rows : tuple of dict
        ``case``, ``table``, ``row``, ``unit``, ``printed``, ``computed``, ``deviation`` (computed
        over printed, less 1; None where one is no number), ``expected``, ``verdict`` and
        ``reason``.
    points : tuple of str
        Computations that are done.
    computation_count : int
        Computations that there are.
    """

    papers: tuple[str, ...]
    rows: tuple[Tree, ...]
    points: tuple[str, ...]
    computation_count: int
    HEAD: ClassVar[tuple[str, ...]] = (
        "Table",
        "Row",
        "Unit",
        "Printed",
        "Computed",
        "Deviation [%]",
        "Verdict",
    )

    @property
    def complete(self) -> bool:
        """Whether every computation was done."""
        return len(self.points) == self.computation_count

    @property
    def surprises(self) -> tuple[Tree, ...]:
        """Rows whose verdict is not the one that is expected."""
        return tuple(row for row in self.rows if row["verdict"] != row["expected"])

    @property
    def lead(self) -> str:
        """Verdicts counted, in a line."""
        counts = Counter(row["verdict"] for row in self.rows)
        totals = ", ".join(f"{count} {name}" for name, count in counts.most_common())
        odd = f"; {len(self.surprises)} not as expected" if self.surprises else ""
        return f"{len(self.rows)} printed figures: {totals}{odd}"

    def table(self) -> Iterator[list[str]]:
        """Rows as text under ``HEAD``.

        Yields
        ------
        list of str
        """
        for row in self.rows:
            percent = "" if row["deviation"] is None else f"{100.0 * row['deviation']:+.3g}"
            percent = "0" if row["deviation"] == 0.0 else percent
            unit = "" if row["unit"] == "1" else row["unit"]
            odd = "" if row["verdict"] == row["expected"] else f" (expected {row['expected']})"
            yield [
                row["table"],
                row["row"],
                unit,
                _text(row["printed"]),
                _text(row["computed"]),
                percent,
                row["verdict"] + odd,
            ]

    def save(self, directory: str | os.PathLike[str], *, force: bool = False) -> Path:
        """Write ``report.html`` and ``rows.csv`` into a new directory.

        Parameters
        ----------
        directory : str or path
            Directory to make.
        force : bool
            Replace an earlier result.

        Raises
        ------
        InputError
            If the directory exists or cannot be written.
        """
        with new_directory(Path(directory), force=force) as place:
            text = io.StringIO()
            writer = csv.DictWriter(text, list(self.rows[0]) if self.rows else ["table"])
            writer.writeheader()
            writer.writerows(self.rows)
            (place / "rows.csv").write_text(text.getvalue(), encoding="utf-8")
            write_report_of(self, place / "report.html")
        return Path(directory)

    def __repr__(self) -> str:
        """One line."""
        return f"PaperComparison({self.lead})"


def _text(value: object) -> str:
    if value is None:
        return "-"
    if isinstance(value, list):
        return " to ".join(f"{each:.6g}" for each in value)
    return value if isinstance(value, str) else f"{value:.5g}"


@with_old_names
def compare_with_paper(
    *names: str,
    partial: bool = False,
    progress: Progress = SILENT,
    checkpoints: Checkpoints | None = None,
) -> PaperComparison:
    """Compute the figures that the sources of built-in cases print, and compare them.

    Parameters
    ----------
    *names : str
        Cases with printed tables, such as ``"fzg-12dof"``; all of them by default.
    partial : bool
        Return the rows that are done when the computation is interrupted with Ctrl-C.
    progress : Progress
        Reports how many computations are done; silent by default.
    checkpoints : tribodyn.checkpoints.Checkpoints, optional
        Stores every computation when it is finished, and supplies those of a killed process.

    Returns
    -------
    PaperComparison
        One row for each printed figure. The verdict is ``"value"`` where the printed one is met
        within its tolerance, ``"trend"`` where its series or its word runs the same way, and else
        ``"cannot-reproduce"``.

    Raises
    ------
    InputError
        If there are no printed tables for a name.

    Notes
    -----
    Equal computations are done once, and cases that differ in friction and motion alone share
    the loads of their teeth and their oil films.

    Examples
    --------
    >>> comparison = compare_with_paper("fzg-12dof")
    >>> sorted(comparison.rows[0])[:4]
    ['case', 'computed', 'deviation', 'expected']
    """
    import tribodyn
    from tribodyn.cases.papers.jobs import Jobs, requests_of, value_of

    chosen = tuple(dict.fromkeys(names)) or tuple(papers())
    rows = [row for name in chosen for row in printed_rows(name)]
    jobs = Jobs(rows)
    identity = {
        "study": "paper",
        "version": tribodyn.__version__,
        "options": list(chosen),
        "case": "",
        "over": sorted(jobs.names.values()),
    }
    checkpoints = (Checkpoints() if checkpoints is None else checkpoints).begin(identity)
    results = jobs.done(checkpoints, partial, progress)
    lacking = [
        row
        for row in rows
        if any(jobs.names[request] not in results for request in requests_of(row))
    ]
    broken = {series_of(row) for row in lacking if row.series}
    done = [row for row in rows if row not in lacking and series_of(row) not in broken]
    values = [value_of(row, jobs, results) for row in done]
    return PaperComparison(
        chosen, tuple(_rows(done, values)), tuple(results), len(set(jobs.names.values()))
    )


def _rows(
    rows: Sequence[PrintedRow], values: Sequence[tuple[float | str | None, str]]
) -> Iterator[Tree]:
    computed = [value for value, _ in values]
    judged = verdicts(rows, computed)
    for row, (value, failed), verdict in zip(rows, values, judged, strict=True):
        yield {
            "case": row.paper,
            "table": row.table,
            "row": row.row,
            "unit": row.unit,
            "printed": row.printed,
            "computed": value,
            "deviation": deviation(row, value),
            "expected": row.expected,
            "verdict": verdict,
            "reason": f"{row.reason} {failed}".strip(),
        }
