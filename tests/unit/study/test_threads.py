"""Runs in parallel threads give the figures and the warnings of runs one by one."""

from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest

import tribodyn as td

BASES: tuple[tuple[str, dict[str, Any]], ...] = (
    ("fzg-roughness", {}),
    ("time-varying-friction", {}),
    ("fzg-roughness", {"operation.torque": "900 N*m"}),
    ("fzg-roughness", {"operation.torque": "20 N*m", "friction.law": "benedict-kelly"}),
    ("fzg-roughness", {"friction.law": "mixed"}),
    ("hypoid-mixed-ehl", {}),
    ("fzg-roughness", {"gears.composite_roughness": "0.9 um", "friction.law": "benedict-kelly"}),
    ("fzg-stiffness", {}),
)
SPEEDS = ("1100 rpm", "2300 rpm")


def cases() -> list[Any]:
    return [
        td.load_case(name).replace({**changes, "operation.speed": speed})
        for name, changes in BASES
        for speed in SPEEDS
    ]


def figures_and_warnings(case: Any) -> tuple[dict[str, Any], list[tuple[str, str]]]:
    result = td.run(case)
    return result.summary(), [(warning.code, warning.message) for warning in result.warnings]


@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
def test_threads_change_neither_figures_nor_warnings(request: pytest.FixtureRequest) -> None:
    ready = cases()
    alone = [figures_and_warnings(case) for case in ready]
    assert (
        len({codes for _, cautions in alone for codes in [tuple(code for code, _ in cautions)]})
        >= 4
    )
    for _ in range(request.config.getoption("--runs") or 2):
        with ThreadPoolExecutor(8) as pool:
            threaded = list(pool.map(figures_and_warnings, ready))
        for (figures, cautions), (same, also) in zip(alone, threaded, strict=True):
            assert also == cautions
            assert same == pytest.approx(figures, rel=1e-12, abs=0.0, nan_ok=True)
