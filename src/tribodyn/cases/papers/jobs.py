"""Computations behind the rows of a page; equal ones are done once."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from functools import cache
from typing import TYPE_CHECKING, Any

from tribodyn.cases.load import load_case
from tribodyn.cases.papers.computations import Figures, Meshes, figures_of, loads_of
from tribodyn.cases.papers.printed import PrintedRow, course
from tribodyn.checkpoints import Checkpoints
from tribodyn.errors import ComputationError, InputError, quiet
from tribodyn.progress import SILENT, Progress
from tribodyn.study.studies.case_grid import over_cases
from tribodyn.units import shown_in

if TYPE_CHECKING:
    from tribodyn.study.case.case import Case

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


def _request(row: PrintedRow, changes: Mapping[str, Any], arguments: Mapping[str, Any]) -> Request:
    changes_text, arguments_text = (
        json.dumps(values, sort_keys=True) for values in (changes, arguments)
    )
    return row.compute, row.case, changes_text, arguments_text


class Jobs:
    """Computations of rows without repetition, grouped by the tooth loads that they share."""

    def __init__(self, rows: Sequence[PrintedRow]) -> None:
        self.requests = [request for row in rows for request in requests_of(row)]
        self.names = {request: self._name(request) for request in dict.fromkeys(self.requests)}
        self.groups: dict[str, dict[str, Request]] = {}
        for request, name in self.names.items():
            shares = request[0] in ("run", "mesh", "modes")
            key = loads_of(self.case(request)) if shares else name
            self.groups.setdefault(key, {}).setdefault(name, request)

    @staticmethod
    @cache
    def _changed(name: str, changes: str) -> Case:
        # TOML has no null: an empty text removes a value, as --set KEY= does.
        items = json.loads(changes).items()
        case: Case = load_case(name)
        return case.replace({key: None if v == "" else v for key, v in items})

    def case(self, request: Request) -> Case:
        """Case of a computation."""
        return self._changed(request[1], request[2])

    def _name(self, request: Request) -> str:
        text = f"{request[0]} {request[3]} {self.case(request).to_toml()}"
        return hashlib.sha256(text.encode()).hexdigest()

    def done(
        self, checkpoints: Checkpoints, partial: bool, progress: Progress = SILENT
    ) -> dict[str, Figures]:
        """Figures of every computation by name; of the finished ones if interrupted."""
        groups, done = list(self.groups.values()), dict[int, Any]()
        stored = {name: checkpoints.get(name) for group in groups for name in group}
        results = {name: figures for name, figures in stored.items() if figures is not None}

        def compute(group: Mapping[str, Request]) -> None:
            meshes = Meshes()
            for name, request in group.items():
                if name not in results:
                    figures = self._figures(request, meshes)
                    checkpoints.keep(name, figures)
                    results[name] = figures

        progress.start("Computations", len(groups))
        try:
            over_cases(compute, groups, done, progress)
        except KeyboardInterrupt:
            if not (partial and results):
                raise
        progress.finish()
        return results

    def _figures(self, request: Request, meshes: Meshes) -> Any:
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
        figures: Mapping[str, Any] = results[jobs.names[request]]
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
