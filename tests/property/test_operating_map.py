"""A sweep over speed and torque: every point is that of a run of its own, in any order."""

import numpy as np
import pytest

import tribodyn as td

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")

_SPEEDS, _TORQUES = [120.0, 300.0], [60.0, 150.0]
_CASES = {
    "formula film": {},
    "mixed friction under the load of the moment": {
        "friction.law": "mixed",
        "friction.variant": None,
        "dynamics.friction_load": "dynamic",
    },
    "tangent stiffness on rigid supports": {
        "dynamics.model": "torsional",
        "dynamics.bearing_stiffness": None,
        "dynamics.bearing_damping_ratio": None,
        "dynamics.mesh_law": "tangent",
    },
}
#: Residuals of a computation rather than its results [1].
_ERRORS = ("steady_state_error", "step_error")


@pytest.mark.parametrize("changes", _CASES.values(), ids=_CASES)
def test_every_point_is_that_of_a_run_of_its_own(changes: dict[str, object]) -> None:
    case = td.load_case("fzg-roughness").replace(changes)
    over = {"operation.torque": _TORQUES[::-1], "operation.speed": _SPEEDS}
    sweep = td.sweep(case, over)
    for place, point in zip(np.ndindex(sweep.shape), sweep.points, strict=True):
        torque, speed = point.values
        alone = td.run(case.replace({"operation.speed": speed, "operation.torque": torque}))
        figures = alone.summary()
        assert set(point.figures) == set(figures), place
        for name, value in figures.items():
            limit = {"abs": 1e-8} if name in _ERRORS else {"rel": 1e-9, "abs": 1e-30}
            assert point.figures[name] == pytest.approx(value, **limit), name
        assert point.warned == tuple(warning.code for warning in alone.warnings)


def test_cached_values_belong_to_their_gears() -> None:
    case = td.load_case("fzg-roughness")
    usual = td.run(case).summary()
    thicker = td.run(case.replace({"gears.pinion.bore_diameter": "20 mm"})).summary()
    assert thicker["gear_body_share"] > usual["gear_body_share"]
    lighter = td.run(case.replace({"material.density": 3900.0, "gears.wheel.mass": None})).summary()
    heavy = td.run(case.replace({"gears.wheel.mass": None})).summary()
    assert lighter["mass_wheel"] == pytest.approx(0.5 * heavy["mass_wheel"], rel=1e-12)
    assert td.run(case).summary() == usual
