"""Reports by the class of result that they tell of, as figures in :mod:`tribodyn.drawing`.

The writers register themselves; those of the package come from the same entry-point group
``tribodyn.figures``, whose modules are imported when the first report is asked for.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from tribodyn.drawing import load_figures
from tribodyn.errors import InputError, Problem
from tribodyn.model import Registry

Writer = TypeVar("Writer", bound=Callable[..., Path])

#: Takes a result and a path, writes the file and returns its path; by the name of the class.
REPORTS: Registry[Callable[..., Path]] = Registry("report")


def report_of(kind: str) -> Callable[[Writer], Writer]:
    """Register a function that writes the report of a class, given by its name."""

    def keep(writer: Writer) -> Writer:
        REPORTS.register(kind)(writer)
        return writer

    return keep


def write_report_of(result: Any, path: Path) -> Path:
    """Write the report of a result to a file."""
    load_figures()
    kinds = [kind.__name__ for kind in type(result).__mro__]
    for kind in kinds:
        if kind in REPORTS:
            return REPORTS[kind](result, path)
    raise InputError(
        Problem(
            what=f"no report tells of a {kinds[0]}",
            why="Reports say which class they tell of when they register",
            remedy=f'Register one with @report_of("{kinds[0]}")',
        )
    )
