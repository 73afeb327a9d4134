"""Results beside each other: what differs in their cases, and what came of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import field
from typing import Any

import numpy as np

from tribodyn.errors import Argument, InputError, shortened
from tribodyn.record import Parts, Record, html_table, record
from tribodyn.study.pipeline.result import Result
from tribodyn.study.pipeline.summary import SUMMARY, by_topic

#: Relative difference of figures that are told as equal.
_SAME = 1e-9


def differing(
    tables: Sequence[Mapping[str, Any]], differ: Callable[[Any, Any], bool] | None = None
) -> dict[str, tuple[Any, ...]]:
    """Values of several tables by name, where they are not all equal; None is none."""
    differ = differ or (lambda one, other: bool(one != other))
    rows = {name: tuple(t.get(name) for t in tables) for table in tables for name in table}
    return {
        name: row for name, row in rows.items() if any(differ(row[0], other) for other in row[1:])
    }


def figures_differ(one: float | None, other: float | None) -> bool:
    """Whether two figures of a summary are to be told apart."""
    if one is None or other is None:
        return one is not other
    return abs(one - other) > _SAME * max(abs(one), abs(other))


def relative_change(one: float | None, other: float | None) -> str:
    """Relative change from the first to the second, where there is one."""
    if one is None or other is None or one == 0.0:
        return ""
    return f"{100.0 * (other - one) / abs(one):+.3g} %"


def told(value: Any) -> str:
    """A value of a case in a table."""
    return "-" if value is None else f"{value:.6g}" if isinstance(value, float) else str(value)


def difference_rows(
    values: Mapping[str, tuple[Any, ...]], figures: Mapping[str, tuple[float | None, ...]]
) -> Iterator[list[str]]:
    """Rows of a table: keys, then figures by topic, with the change from first to last."""
    for key, row in values.items():
        yield [key, *map(told, row), ""]
    for topic, names in by_topic(figures).items():
        yield [topic, *("" for _ in next(iter(figures.values()))), ""]
        for name in names:
            shown = ["-" if v is None else SUMMARY[name].show(v) for v in figures[name]]
            yield [f"  {name}", *shown, relative_change(figures[name][0], figures[name][-1])]


@record
class ResultComparison(Record):
    """Several results beside each other; made by :func:`compare_results`.

    Parameters
    ----------
    names : tuple of str
        Name of each result.
    values : dict of str to tuple
        Values of the cases by key, in SI, where they differ.
    figures : dict of str to tuple of float
        Figures of the summaries by name, in SI, where they differ; None where one has none.
    results : tuple of Result
        The results.
    """

    names: tuple[str, ...]
    values: dict[str, tuple[Any, ...]]
    figures: dict[str, tuple[float | None, ...]]
    results: tuple[Result, ...] = field(repr=False)

    def _parts(self) -> Parts:
        parts = Parts({}, {"result": (("result",), list(self.names), {})}, {})
        for name, row in self.figures.items():
            numbers = [np.nan if value is None else value for value in row]
            known = {"units": SUMMARY[name].unit or "1", "long_name": SUMMARY[name].meaning}
            parts.variables[name] = (("result",), numbers, known)
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


def compare_results(*results: Result, names: Sequence[str] | None = None) -> ResultComparison:
    """Lay results beside each other: one table of what differs, and overlaid curves.

    Parameters
    ----------
    *results : Result
        Two or more, at most twelve.
    names : sequence of str, optional
        Name of each; by default the title of its case, with a number where titles are equal.

    Returns
    -------
    ResultComparison
        ``.plot()`` overlays transmission error and mesh force, ``.to_dataframe()`` is the table.

    Raises
    ------
    InputError
        If there are fewer than two or more than twelve, or names that do not fit.

    Examples
    --------
    >>> import tribodyn as td
    >>> one = td.run("time-varying-friction")
    >>> other = td.run(one.case.replace({"operation.torque": "60 N*m"}))
    >>> compare_results(one, other, names=("as printed", "60 N m")).values
    {'operation.torque': (10.6, 60.0)}
    """
    wrong = [each for each in results if not isinstance(each, Result)]
    if wrong:
        what = f"results holds {shortened(repr(wrong[0]))}"
        raise InputError(what, Argument("results"), "Wanted: what tribodyn.run returns", "Run both")
    if not 2 <= len(results) <= 12:
        why = "Two to twelve are laid beside each other"
        raise InputError(
            f"there are {len(results)} results", Argument("results"), why, "Give several"
        )
    given = tuple(names) if names is not None else _titles(results)
    if len(given) != len(results) or len(set(given)) < len(given):
        what = f"names = {shortened(repr(given))}"
        raise InputError(
            what, Argument("names"), f"Wanted: {len(results)} different names", "Rename them"
        )
    return ResultComparison(
        given,
        differing([dict(each.case.values()) for each in results]),
        differing([each.summary() for each in results], figures_differ),
        results,
    )


def _titles(results: Sequence[Result]) -> tuple[str, ...]:
    titles = [each.case.title for each in results]
    if len(set(titles)) == len(titles):
        return tuple(titles)
    return tuple(f"{number}: {title}" for number, title in enumerate(titles, start=1))
