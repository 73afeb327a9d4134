"""``tribodyn warm-up``: processes compile into the cache, and load what is there."""

from __future__ import annotations

import pytest

import tribodyn
from tribodyn.cases.compile_ahead import _children
from tribodyn.errors import ComputationError, InputError

_ENGINE = "dynamics._engine.marching.march_block"


def test_kernels_compiled_by_one_process_are_loaded_by_the_next() -> None:
    reports = []
    for _ in range(2):
        with _children([""], 1) as results:
            reports += list(results)
    assert _ENGINE in {*reports[0]["compiled"], *reports[0]["loaded"]}
    assert reports[1] == {"compiled": {}, "loaded": [_ENGINE]}


def test_a_case_that_fails_is_reported() -> None:
    with (
        pytest.raises(ComputationError, match="kernels of nowhere"),
        _children(["nowhere"], 1) as results,
    ):
        list(results)


def test_unknown_cases_are_refused_before_anything_compiles() -> None:
    with pytest.raises(InputError, match="nowhere"):
        tribodyn.warm_up("nowhere")
    with pytest.raises(InputError, match="jobs = 0"):
        tribodyn.warm_up("fzg-roughness", jobs=0)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["two-stage-spur", "planetary-stage"])
def test_machines_and_stages_compile_by_a_run(name: str) -> None:
    with _children([name], 1) as results:
        (report,) = results
    assert report["compiled"] or report["loaded"]
