"""Computations behind the rows of a page; equal ones are done once."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from functools import cache, partial
from typing import TYPE_CHECKING, Any

from tribodyn.cases.load import load_case
from tribodyn.cases.papers.computations import Figures, Meshes, figures_of
from tribodyn.cases.papers.printed import PrintedRow, course
from tribodyn.checkpoints import Checkpoints
from tribodyn.errors import ComputationError, InputError, quiet
from tribodyn.progress import SILENT, Progress
from tribodyn.study.studies.runner import run_each
from tribodyn.types import ByName
from tribodyn.units import shown_in

if TYPE_CHECKING:
    from tribodyn.study.case.pair import PairCase

#: A computation: its name, the case, and as text the changes of the case and its arguments.
Request = tuple[str, str, str, str]
#: Why a computation has no figures.
FAILED = "failed"


def requests_of(row: PrintedRow) -> list[Request]:
    """Computations of a row: one, one for each value along a key, or two that are compared."""
    if not row.compute:
        return []
    if row.along:
        ((key, values),) = row.along.items()
        changes = [{key: value} for value in values]
        if "." in key:
            return [_request(row, {**row.set, **change}, row.arguments) for change in changes]
        return [_request(row, row.set, {**row.arguments, **change}) for change in changes]
    others = [] if row.against is None else [{**row.set, **row.against}]
    return [_request(row, change, row.arguments) for change in (row.set, *others)]


def _request(
    row: PrintedRow, changes: Mapping[str, object], arguments: Mapping[str, object]
) -> Request:
    changes_text, arguments_text = (
        json.dumps(values, sort_keys=True) for values in (changes, arguments)
    )
    return row.compute, row.case, changes_text, arguments_text


class Jobs:
    """Computations of rows without repetition; they share the tooth loads of equal cases."""

    def __init__(self, rows: Sequence[PrintedRow]) -> None:
        self.requests = [request for row in rows for request in requests_of(row)]
        self.names = {request: self._name(request) for request in dict.fromkeys(self.requests)}

    @staticmethod
    @cache
    def _changed(name: str, changes: str) -> PairCase:
        # TOML has no null: an empty text removes a value, as --set KEY= does.
        items = json.loads(changes).items()
        case: PairCase = load_case(name)
        return case.replace({key: None if v == "" else v for key, v in items})

    def case(self, request: Request) -> PairCase:
        """Case of a computation."""
        return self._changed(request[1], request[2])

    def _name(self, request: Request) -> str:
        text = f"{request[0]} {request[3]} {self.case(request)._text(comments=True)}"
        return hashlib.sha256(text.encode()).hexdigest()

    def done(
        self, checkpoints: Checkpoints, partly: bool, progress: Progress = SILENT
    ) -> dict[str, Figures]:
        """Figures of every computation by name; of the finished ones if interrupted."""
        requests = {name: request for request, name in self.names.items()}
        names, stored = list(requests), {name: checkpoints.get(name) for name in requests}
        results = {name: figures for name, figures in stored.items() if figures is not None}

        def store(number: int, figures: Figures) -> None:
            checkpoints.keep(names[number], figures)
            results[names[number]] = figures

        run_each(
            partial(self._figures, Meshes()),
            list(requests.values()),
            task="Computations",
            progress=progress,
            earlier={names.index(name): figures for name, figures in results.items()},
            store=store,
            partly=partly,
        )
        return results

    def _figures(self, meshes: Meshes, request: Request) -> Any:
        try:
            with quiet():
                return figures_of(request[0], self.case(request), meshes, json.loads(request[3]))
        except (InputError, ComputationError) as error:
            return {FAILED: str(error.problems[0])}


def value_of(
    row: PrintedRow, jobs: Jobs, results: Mapping[str, Figures]
) -> tuple[float | str | None, str]:
    """Computed value of a row in its unit, or a trend with its values; and why there is none."""
    values = []
    for request in requests_of(row):
        figures: ByName = results[jobs.names[request]]
        if row.of not in figures:
            return None, str(figures.get(FAILED, f"There is no {row.of.replace('_', ' ')} here"))
        values.append(figures[row.of])
    if not values:
        return None, ""
    if row.along:
        value_list = ", ".join(f"{shown_in(value, row.unit):.4g}" for value in values)
        unit = f" {row.unit}" if row.unit != "1" else ""
        return f"{course(values, row.level)}: {value_list}{unit}", ""
    if row.against is not None:
        return shown_in(values[0] / values[1] - 1.0, row.unit), ""
    return shown_in(values[0], row.unit), ""
