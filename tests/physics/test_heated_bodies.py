"""Flanks of different materials: each takes up the heat of the film by its own properties."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import tribodyn as td
from tribodyn.errors import InputError
from tribodyn.mesh.build import loaded_mesh
from tribodyn.study.case.provenance import derived_values
from tribodyn.study.mesh_inputs import contact_settings

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
STEEL = 13.6e3
POLYMER = {"thermal_conductivity": "0.25 W/m/K", "specific_heat": "1.7 kJ/kg/K",
           "density": "1.14 g/cm^3"}  # fmt: skip


def case(**more):
    changes = {
        "friction.law": "ehl", "friction.flash_temperature": True, "lubricant.name": "80W",
        "film.positions": 16, "film.nodes": 129, "film.stiffness": "none", **more,
    }  # fmt: skip
    oil = ("dynamic_viscosity", "density", "pressure_viscosity_coefficient", "temperature")
    dropped = {f"lubricant.{name}": None for name in oil} | {"friction.coefficient": None}
    return td.load_case("fzg-film").replace(dropped | changes)


def test_coefficient_and_mass_are_those_of_the_gear():
    polymer = {f"gears.wheel.{name}": value for name, value in POLYMER.items()}
    heated_case = case(**polymer)
    steel, wheel = heated_case.thermal_contact_coefficients
    assert steel == STEEL
    assert wheel == pytest.approx(np.sqrt(0.25 * 1140.0 * 1700.0), rel=1e-12)
    solid = {"gears.wheel.mass": None, "gears.wheel.moment_of_inertia": None}
    masses = [
        derived_values(each.replace(solid))["gears.wheel.mass"] for each in (heated_case, case())
    ]
    assert masses[0] / masses[1] == pytest.approx(1140.0 / 7800.0, rel=1e-12)


@pytest.mark.parametrize("name", ["thermal_conductivity", "specific_heat"])
def test_half_of_a_thermal_property_is_refused(name):
    with pytest.raises(InputError, match="of the pinion is missing"):
        case(**{f"gears.pinion.{name}": POLYMER[name]})


def test_which_body_is_the_faster_one_matters():
    base_case = case()
    settings = contact_settings(base_case)
    mesh = loaded_mesh(
        base_case.gear_pair, settings, (base_case.pinion_speed, base_case.pinion_torque)
    )

    def friction(*bodies):
        return mesh.table(replace(settings, bodies=bodies)).friction_coefficient

    equal, nearly = friction(STEEL, STEEL), friction(STEEL, STEEL * (1.0 + 1e-9))
    assert nearly == pytest.approx(equal, rel=2e-3, abs=1e-5)  # other sliding speeds are computed
    soft_pinion, soft_wheel = friction(680.0, STEEL), friction(STEEL, 680.0)
    table = mesh.table(settings)
    for sign, slower, faster in ((1.0, soft_wheel, soft_pinion), (-1.0, soft_pinion, soft_wheel)):
        # far from the pitch point: the slower body carries less heat away, so that it matters less
        sliding = table.in_contact & (sign * table.sliding_speed > 0.5)
        assert np.any(sliding)
        assert np.all(faster[sliding] < slower[sliding])
        assert np.all(slower[sliding] < equal[sliding])
