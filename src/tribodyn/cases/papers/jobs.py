"""Computations of a page, each done once however many rows ask for it."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from functools import cache
from typing import TYPE_CHECKING, Any

from tribodyn.cases.load import load_case
from tribodyn.cases.papers.computations import Figures, Meshes, figures_of, loads_of
from tribodyn.cases.papers.printed import PrintedRow, course
from tribodyn.checkpoints import Members
from tribodyn.errors import ComputationError, InputError, quiet
from tribodyn.progress import SILENT, Progress
from tribodyn.study.studies.grid import over_cases
from tribodyn.units import shown_in

if TYPE_CHECKING:
    from tribodyn.study.case.case import Case

#: What is asked of a case: computation, case, changes, and arguments, the last two as text.
Asked = tuple[str, str, str, str]
#: Why a computation has no figures.
FAILED = "failed"


def asked_by(row: PrintedRow) -> list[Asked]:
    """Computations of a row: one, one for each value along a key, or two that are compared."""
    if not row.compute:
        return []
    if row.along:
        ((key, values),) = row.along.items()
        changes = [{key: value} for value in values]
        if "." in key:
            return [_asked(row, {**row.set, **change}, row.given) for change in changes]
        return [_asked(row, row.set, {**row.given, **change}) for change in changes]
    both = [row.set] if row.against is None else [row.set, {**row.set, **row.against}]
    return [_asked(row, each, row.given) for each in both]


def _asked(row: PrintedRow, changes: Mapping[str, Any], given: Mapping[str, Any]) -> Asked:
    changed, arguments = (json.dumps(each, sort_keys=True) for each in (changes, given))
    return row.compute, row.case, changed, arguments


class Jobs:
    """What rows ask for, with equal computations as one, grouped by the loads that they share."""

    def __init__(self, rows: Sequence[PrintedRow]) -> None:
        self.asked = [each for row in rows for each in asked_by(row)]
        self.names = {each: self._name(each) for each in dict.fromkeys(self.asked)}
        self.groups: dict[str, dict[str, Asked]] = {}
        for each, name in self.names.items():
            key = loads_of(self.case(each)) if each[0] in ("run", "mesh", "modes") else name
            self.groups.setdefault(key, {}).setdefault(name, each)

    @staticmethod
    @cache
    def _changed(name: str, changes: str) -> Case:
        # TOML has no word for no value: an empty text takes one out, as --set KEY= does.
        items = json.loads(changes).items()
        return load_case(name).replace({key: None if v == "" else v for key, v in items})

    def case(self, asked: Asked) -> Case:
        """Case of a computation."""
        return self._changed(asked[1], asked[2])

    def _name(self, asked: Asked) -> str:
        text = f"{asked[0]} {asked[3]} {self.case(asked).to_toml()}"
        return hashlib.sha256(text.encode()).hexdigest()

    def done(self, kept: Members, partial: bool, progress: Progress = SILENT) -> dict[str, Figures]:
        """Figures of every computation by name; of those that are done, where it is interrupted."""
        groups, done = list(self.groups.values()), dict[int, Any]()
        found = {name: kept.get(name) for group in groups for name in group}
        found = {name: figures for name, figures in found.items() if figures is not None}

        def compute(group: Mapping[str, Asked]) -> None:
            meshes = Meshes()
            for name, asked in group.items():
                if name not in found:
                    figures = self._figures(asked, meshes)
                    kept.keep(name, figures)
                    found[name] = figures

        progress.start("Computations", len(groups))
        try:
            over_cases(compute, groups, done, progress)
        except KeyboardInterrupt:
            if not (partial and found):
                raise
        progress.finish()
        return found

    def _figures(self, asked: Asked, meshes: Meshes) -> Any:
        try:
            with quiet():
                return figures_of(asked[0], self.case(asked), meshes, json.loads(asked[3]))
        except (InputError, ComputationError) as error:
            return {FAILED: str(error.problems[0])}


def value_of(
    row: PrintedRow, jobs: Jobs, found: Mapping[str, Figures]
) -> tuple[float | str | None, str]:
    """What is computed for a row in its unit, or a word with its values; and why nothing is."""
    values = []
    for asked in asked_by(row):
        figures: Mapping[str, Any] = found[jobs.names[asked]]
        if row.of not in figures:
            return None, str(figures.get(FAILED, f"There is no {row.of.replace('_', ' ')} here"))
        values.append(figures[row.of])
    if not values:
        return None, ""
    if row.along:
        shown = ", ".join(f"{shown_in(value, row.unit):.4g}" for value in values)
        unit = f" {row.unit}" if row.unit != "1" else ""
        return f"{course(values, row.level)}: {shown}{unit}", ""
    if row.against is not None:
        return shown_in(values[0] / values[1] - 1.0, row.unit), ""
    return shown_in(values[0], row.unit), ""
