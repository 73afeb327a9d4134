"""Loads and films that cases of a study share: computed once, and those of each case by itself."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn import load_case
from tribodyn.cases.papers.computations import Meshes
from tribodyn.errors import collected
from tribodyn.study.pipeline.tooth_contact import mesh_of
from tribodyn.study.studies.runner import run_each

CHANGES = (
    {},
    {"gears.composite_roughness": "0.7 um"},
    {"friction.law": "xu-2007", "operation.torque_balance": "load"},
    {"friction.law": "constant", "friction.coefficient": 0.04, "gears.composite_roughness": "1 um"},
)


@pytest.mark.parametrize("name", ["fzg-roughness", "time-varying-friction"])
def test_cases_that_differ_in_friction_alone_share_their_loads(name: str) -> None:
    base, meshes = load_case(name), Meshes()
    cases = [base.replace(change) if change else base for change in CHANGES]
    loaded = run_each(meshes.loaded, cases)
    assert all(each is loaded[0] for each in loaded)
    faster = base.replace({"operation.speed": 1.1 * base.operation.speed})
    assert meshes.loaded(faster) is not loaded[0]
    for case in cases:
        with collected():
            shared, alone = meshes.table(case), mesh_of(case)
        for column in ("friction_coefficient", "load_per_width", "film_ratio", "hertz_pressure"):
            values = getattr(alone, column)
            if values is not None:
                np.testing.assert_allclose(getattr(shared, column), values, rtol=1e-12)
        assert shared.composite_roughness == alone.composite_roughness
