"""The case and its result: what the user typed, and what came of it."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tribodyn.study.bifurcation_diagram import bifurcation
    from tribodyn.study.case import Case
    from tribodyn.study.films import film_over_operation
    from tribodyn.study.parameter_sweep import sweep
    from tribodyn.study.pipeline import run
    from tribodyn.study.read import read_case
    from tribodyn.study.result import Result
    from tribodyn.study.run_up_study import run_up
    from tribodyn.study.static_studies import (
        comprehensive_stiffness,
        harris_map,
        optimize_tip_relief,
    )
    from tribodyn.study.summary_names import SUMMARY
    from tribodyn.study.sweep_result import Sweep
    from tribodyn.study.transmission_error import loaded_contact

__all__ = [
    "SUMMARY",
    "Case",
    "Result",
    "Sweep",
    "bifurcation",
    "comprehensive_stiffness",
    "film_over_operation",
    "harris_map",
    "loaded_contact",
    "optimize_tip_relief",
    "read_case",
    "run",
    "run_up",
    "sweep",
]

_HOMES = {
    "Case": "case",
    "bifurcation": "bifurcation_diagram",
    "comprehensive_stiffness": "static_studies",
    "film_over_operation": "films",
    "harris_map": "static_studies",
    "loaded_contact": "transmission_error",
    "optimize_tip_relief": "static_studies",
    "read_case": "read",
    "run": "pipeline",
    "run_up": "run_up_study",
    "Result": "result",
    "SUMMARY": "summary_names",
    "Sweep": "sweep_result",
    "sweep": "parameter_sweep",
}


def __getattr__(name: str) -> Any:
    """Load a public name when it is first used."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
