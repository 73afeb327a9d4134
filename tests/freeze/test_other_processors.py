"""The figures of built-in cases are those of another processor, up to rounding."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import warnings

import pytest
from frozen_figures import differences
from numpy._core._multiarray_umath import __cpu_dispatch__, __cpu_features__

import tribodyn as td

pytestmark = pytest.mark.processor

CASES = (
    "fzg-stiffness", "fzg-roughness", "time-varying-friction", "planetary-stage",
    "two-stage-helical",
)  # fmt: skip
#: Relative difference of figures; errors that were estimated differ by more.
TOLERANCE = 1e-7
COMPUTE = """
import json, sys, warnings
import tribodyn as td
warnings.simplefilter("ignore")
print(json.dumps({name: td.run(name).summary() for name in sys.argv[1:]}))
"""


def wide_vectors() -> str:
    """Extensions of this processor that NumPy uses where it finds them."""
    return " ".join(name for name in __cpu_dispatch__ if __cpu_features__[name])


@pytest.mark.slow
@pytest.mark.parametrize("core", ["Prescott"])
def test_summaries_are_those_of_another_processor(core: str) -> None:
    settings = {"OPENBLAS_CORETYPE": core, "NPY_DISABLE_CPU_FEATURES": wide_vectors()}
    command = [sys.executable, "-W", "ignore", "-c", COMPUTE, *CASES]
    answer = subprocess.run(
        command, env=os.environ | settings, capture_output=True, text=True, check=True
    )
    others = json.loads(answer.stdout)
    for case in CASES:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", td.ModelWarning)
            summary = td.run(case).summary()
        assert set(others[case]) == set(summary)
        changes = differences(case, others[case], summary, TOLERANCE)
        assert not changes, "\n".join(changes)
