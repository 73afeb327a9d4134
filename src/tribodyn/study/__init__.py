"""The case and its result: what the user typed, and what came of it."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tribodyn.study.case import Case
    from tribodyn.study.films import film_over_operation
    from tribodyn.study.pipeline import run
    from tribodyn.study.read import read_case
    from tribodyn.study.result import Result
    from tribodyn.study.summary_names import SUMMARY
    from tribodyn.study.transmission_error import loaded_contact

__all__ = [
    "SUMMARY",
    "Case",
    "Result",
    "film_over_operation",
    "loaded_contact",
    "read_case",
    "run",
]

_HOMES = {
    "Case": "case",
    "film_over_operation": "films",
    "loaded_contact": "transmission_error",
    "read_case": "read",
    "run": "pipeline",
    "Result": "result",
    "SUMMARY": "summary_names",
}


def __getattr__(name: str) -> Any:
    """Load a public name when it is first used."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
