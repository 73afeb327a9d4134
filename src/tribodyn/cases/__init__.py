"""The built-in cases. The module itself can be called: ``tribodyn.cases()`` lists them."""

from __future__ import annotations

import sys
from types import ModuleType

from tribodyn.arguments import guard
from tribodyn.cases.catalogue import case_files, cases
from tribodyn.cases.compile_ahead import warm_up
from tribodyn.cases.load import load_case, load_result, run
from tribodyn.cases.papers.comparison import PaperComparison, compare_with_paper

__all__ = [
    "PaperComparison",
    "case_files",
    "cases",
    "compare_with_paper",
    "load_case",
    "load_result",
    "run",
    "warm_up",
]

guard(__name__)


class _Catalogue(ModuleType):
    """A module that lists the cases when called, since both go by the same name."""

    def __call__(self, *, machines: bool = False) -> dict[str, str]:
        """Names and one-line descriptions of all named cases."""
        return cases(machines=machines)


sys.modules[__name__].__class__ = _Catalogue
