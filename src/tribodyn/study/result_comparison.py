"""Comparison of results: values and summary figures that differ, and overlaid curves."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import field
from typing import Any

import numpy as np

from tribodyn.drawing import draw
from tribodyn.errors import Argument, InputError, shortened
from tribodyn.record import Parts, Record, html_table, record
from tribodyn.study.pipeline.result_of_case import ResultOfCase
from tribodyn.study.pipeline.summary_figures import by_topic, figure_of
from tribodyn.types import ByName

#: Relative difference below which figures count as equal.
_TOLERANCE = 1e-9


def differing(
    tables: Sequence[ByName], differ: Callable[[Any, Any], bool] | None = None
) -> dict[str, tuple[Any, ...]]:
    """Return the values of several tables by name where they differ; None if absent."""
    differ = differ or (lambda first, value: bool(first != value))
    rows = {name: tuple(t.get(name) for t in tables) for table in tables for name in table}
    return {
        name: row for name, row in rows.items() if any(differ(row[0], value) for value in row[1:])
    }


def figures_differ(first: float | None, second: float | None) -> bool:
    """Return whether two summary figures differ by more than rounding."""
    if first is None or second is None:
        return first is not second
    return abs(first - second) > _TOLERANCE * max(abs(first), abs(second))


def relative_change(first: float | None, second: float | None) -> str:
    """Format the relative change from the first to the second; empty if undefined."""
    if first is None or second is None or first == 0.0:
        return ""
    return f"{100.0 * (second - first) / abs(first):+.3g} %"


def format_value(value: Any) -> str:
    """Format a value of a case for a table."""
    return "-" if value is None else f"{value:.6g}" if isinstance(value, float) else str(value)


def difference_rows(
    values: Mapping[str, tuple[Any, ...]], figures: Mapping[str, tuple[float | None, ...]]
) -> Iterator[list[str]]:
    """Yield table rows: keys, then figures by topic, with the change from first to last."""
    for key, row in values.items():
        yield [key, *map(format_value, row), ""]
    for topic, names in by_topic(figures).items():
        yield [topic, *("" for _ in next(iter(figures.values()))), ""]
        for name in names:
            cells = ["-" if v is None else figure_of(name).show(v) for v in figures[name]]
            yield [f"  {name}", *cells, relative_change(figures[name][0], figures[name][-1])]


@record
class ResultComparison(Record):
    """Comparison of several results; created by :func:`compare_results`.

    Parameters
    ----------
    names : tuple of str
        Name of each result.
    values : dict of str to tuple
        Values of the cases by key, in SI, where they differ.
    figures : dict of str to tuple of float
        Figures of the summaries by name, in SI, where they differ; None where a result lacks it.
    results : tuple of Result
        The results.
    """

    names: tuple[str, ...]
    values: dict[str, tuple[Any, ...]]
    figures: dict[str, tuple[float | None, ...]]
    results: tuple[ResultOfCase, ...] = field(repr=False)

    def plot(self, *arguments: Any, **options: Any) -> Any:
        """Draw the motions of pairs overlaid, or the levels of the parts of machines.

        Parameters
        ----------
        *arguments, **options
            Of the figure.

        Returns
        -------
        plotly.graph_objects.Figure
        """
        return draw(self, self.results[0]._COMPARISON, *arguments, **options)

    def _parts(self) -> Parts:
        parts = Parts({}, {"result": (("result",), list(self.names), {})}, {})
        for name, row in self.figures.items():
            numbers = [np.nan if value is None else value for value in row]
            figure = figure_of(name)
            attributes = {"units": figure.unit or "1", "long_name": figure.meaning}
            parts.variables[name] = (("result",), numbers, attributes)
        return parts

    def __repr__(self) -> str:
        """One line."""
        return (
            f"ResultComparison({', '.join(self.names)}: {len(self.values)} values and "
            f"{len(self.figures)} figures differ)"
        )

    def _repr_html_(self) -> str:
        """Table for notebooks."""
        head = ("", *self.names, "change")
        return html_table(repr(self), head, difference_rows(self.values, self.figures))


def compare_results(*results: ResultOfCase, names: Sequence[str] | None = None) -> ResultComparison:
    """Compare results: a table of differing values and figures, and overlaid curves.

    Parameters
    ----------
    *results : Result
        Two or more, at most twelve, all of pairs or all of machines.
    names : sequence of str, optional
        Name of each; by default the title of its case, with a number where titles are equal.

    Returns
    -------
    ResultComparison
        ``.plot()`` overlays transmission error and mesh force, or the levels of a machine;
        ``.to_dataframe()`` is the table.

    Raises
    ------
    InputError
        If there are fewer than two or more than twelve results, or the names do not match.

    Examples
    --------
    >>> import tribodyn as td
    >>> base = td.run("time-varying-friction")
    >>> reduced = td.run(base.case.replace({"operation.torque": "60 N*m"}))
    >>> compare_results(base, reduced, names=("as printed", "60 N m")).values
    {'operation.torque': (10.6, 60.0)}
    """
    invalid: list[object] = [each for each in results if not isinstance(each, ResultOfCase)]
    if not invalid:
        invalid += [each for each in results if each._COMPARISON != results[0]._COMPARISON]
    if invalid:
        what = f"results holds {shortened(repr(invalid[0]))}"
        why = "Expected: results of tribodyn.run, of pairs or of machines"
        raise InputError(what, Argument("results"), why, "Run each case first")
    if not 2 <= len(results) <= 12:
        why = "Between 2 and 12 results can be compared"
        raise InputError(
            f"number of results = {len(results)}", Argument("results"), why, "Pass 2 to 12 results"
        )
    labels = tuple(names) if names is not None else _titles(results)
    if len(labels) != len(results) or len(set(labels)) < len(labels):
        what = f"names = {shortened(repr(labels))}"
        raise InputError(
            what, Argument("names"), f"Expected: {len(results)} distinct names", "Rename them"
        )
    return ResultComparison(
        labels,
        differing([dict(result.case.values()) for result in results]),
        differing([result.summary() for result in results], figures_differ),
        results,
    )


def _titles(results: Sequence[ResultOfCase]) -> tuple[str, ...]:
    titles = [result.case.title for result in results]
    if len(set(titles)) == len(titles):
        return tuple(titles)
    return tuple(f"{number}: {title}" for number, title in enumerate(titles, start=1))
