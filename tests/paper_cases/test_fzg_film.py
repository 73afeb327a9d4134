"""The built-in case fzg-film against what its source prints and claims about film and stiffness."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import tribodyn as td
from tribodyn.study.case.provenance import provenance
from tribodyn.study.pipeline.tooth_contact import mesh_of

_RPM = math.pi / 30.0

#: Printed data of the case: key and value in SI.
_GIVEN = {
    "gears.pinion.teeth": 16,
    "gears.wheel.teeth": 24,
    "gears.normal_module": 4.5e-3,
    "gears.normal_pressure_angle": math.radians(20.0),
    "gears.pinion.profile_shift_coefficient": 0.8532,
    "gears.wheel.profile_shift_coefficient": -0.5,
    "gears.pinion.face_width": 20e-3,
    "gears.wheel.face_width": 20e-3,
    "gears.pinion.bore_diameter": 30e-3,
    "gears.wheel.bore_diameter": 30e-3,
    "gears.pinion.mass": 0.64,
    "gears.wheel.mass": 1.17,
    "gears.pinion.moment_of_inertia": 0.58e-3,
    "gears.wheel.moment_of_inertia": 1.72e-3,
    "material.density": 7800.0,
    "lubricant.dynamic_viscosity": 0.082,
    "lubricant.density": 880.0,
    "lubricant.pressure_viscosity_coefficient": 2.19e-8,
    "lubricant.temperature": 313.15,
    "operation.speed": 1400.0 * _RPM,
    "operation.torque": 150.0,
    "friction.coefficient": 0.0692,
    "dynamics.mesh_damping_ratio": 0.04,
}


@pytest.fixture(scope="module")
def case() -> Any:
    return td.load_case("fzg-film")


@pytest.mark.parametrize("key", _GIVEN)
def test_printed_data_are_marked_as_given(case: Any, key: str) -> None:
    assert dict(case.values())[key] == pytest.approx(_GIVEN[key], rel=1e-12)
    assert provenance(case)[key] == "given"


def test_everything_else_that_matters_is_assumed_with_a_reason(case: Any) -> None:
    origins = provenance(case)
    given_keys = {key for key, origin in origins.items() if origin == "given"}
    choices = {
        "title", "origin", "gears.kind", "gears.driver", "stiffness.model", "friction.law",
        "dynamics.model", "solver.method",
    }  # fmt: skip
    assert given_keys - set(_GIVEN) == choices
    assert all(len(origin) > 20 for origin in origins.values() if origin.startswith("assumed"))


def test_material_and_oil_are_those_of_the_printed_line_contact(case: Any) -> None:
    steel = case.material_properties
    assert td.contact.effective_modulus(steel, steel) == pytest.approx(2.2e11, rel=1e-3)
    # the printed pressure-viscosity coefficient and Roelands' reference pressure
    assert case.lubricant_properties.dynamic_viscosity == 0.082


def test_the_film_falls_with_torque_and_rises_with_speed(case: Any) -> None:
    over_torque = td.film_over_operation(case, torque=[50.0, 150.0, 300.0])
    speeds = [f"{speed} rpm" for speed in (800, 1400, 1800, 3000)]
    over_speed = td.film_over_operation(case, speed=speeds)
    # one pair alone, in the middle of the path, as the source solves it
    alone = int(np.argmin(np.abs(over_torque.path - over_torque.path[[0, -1]].mean())))
    assert np.all(np.diff(over_torque.central_film[:, 0, alone]) < 0.0)
    assert np.all(np.diff(over_torque.minimum_film[:, 0, alone]) < 0.0)
    assert np.all(np.diff(over_speed.central_film[0, :, alone]) > 0.0)
    # with the exponent of elastic films
    film = over_speed.central_film[0, :, alone]
    exponent = math.log(film[-1] / film[0]) / math.log(3000.0 / 800.0)
    assert exponent == pytest.approx(0.68, abs=0.05)


@pytest.mark.slow
def test_the_film_is_far_stiffer_than_the_teeth_and_changes_the_series_little(case: Any) -> None:
    mesh = mesh_of(case)
    touching = mesh.in_contact
    ratio = mesh.film_stiffness[touching] / mesh.tooth_stiffness[touching]
    assert 50.0 < ratio.min() < ratio.max() < 150.0
    assert 0.98 < (mesh.stiffness[touching] / mesh.tooth_stiffness[touching]).min() < 0.995
