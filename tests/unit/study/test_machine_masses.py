"""Masses of the gears of a machine: one body of a gear for pairs, machines and stages."""

from __future__ import annotations

import math
from typing import Any

import pytest

import tribodyn as td
from tribodyn.gear import mass_properties
from tribodyn.study import MachineCase

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")


def stage_data(**changes: Any) -> dict[str, Any]:
    data = td.load_case("planetary-stage").data
    return {**{k: v for k, v in data.items() if k != "load_cases"}, **changes}


def on_shafts(data: dict[str, Any]) -> dict[str, Any]:
    """The same stage in a machine that names its shafts, whose frame does not turn."""
    named = {"sun": {"shaft": "sun"}, "ring": {"shaft": "ring"}}
    gears = {name: {**body, **named.get(name, {})} for name, body in data["gears"].items()}
    return {**data, "gears": gears, "shafts": {name: {} for name in ("sun", "ring", "carrier")}}


def alternating_force(figures: dict[str, float]) -> dict[str, float]:
    """Alternating forces of the meshes of a stage, by kind of mesh."""
    suffix = ".alternating_rms_mesh_force"
    forces = {k.split(".")[1]: v for k, v in figures.items() if k.endswith(suffix)}
    return {name: forces.get(name, forces.get(f"low_{name}1", 0.0)) for name in ("sun", "ring")}


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"material": {"density": "1400 kg/m^3", "youngs_modulus": "206 GPa"}},
    ],
)
def test_a_stage_has_one_mesh_force_by_itself_and_in_a_machine(changes: dict[str, Any]) -> None:
    source, data = td.load_case("planetary-stage").source, stage_data(**changes)
    stage, machine = MachineCase(source, **data), MachineCase(source, **on_shafts(data))
    by_itself, in_machine = (alternating_force(td.run(c).summary()) for c in (stage, machine))
    assert in_machine == pytest.approx(by_itself, rel=2e-3)


def test_masses_given_with_the_gears_of_a_stage_give_one_mesh_force() -> None:
    data, source = stage_data(), td.load_case("planetary-stage").source
    data["gears"] = {name: dict(body) for name, body in data["gears"].items()}
    data["gears"]["sun"]["density"] = "4430 kg/m^3"
    data["gears"]["planet"]["mass"] = "0.8 kg"
    data["gears"]["ring"]["rim_diameter"] = "300 mm"
    stage, machine = MachineCase(source, **data), MachineCase(source, **on_shafts(data))
    by_itself, in_machine = (alternating_force(td.run(c).summary()) for c in (stage, machine))
    assert in_machine == pytest.approx(by_itself, rel=2e-3)


def reducer(**changes: Any) -> MachineCase:
    gears = {
        "z1": {"shaft": "in", "teeth": 27, "face_width": "30 mm", "profile_shift_coefficient": 0.3},
        "z2": {"shaft": "out", "teeth": 51, "face_width": "30 mm", "bore_diameter": "50 mm"},
    }
    mesh = {"gears": ["z1", "z2"], "normal_module": "3 mm", "helix_angle": "12 deg"}
    values: dict[str, Any] = {
        "gears": gears,
        "meshes": {"first": mesh},
        "operation": {"input": "in", "output": "out", "speed": "1200 rpm", "torque": "100 N*m"},
    }
    for key, value in changes.items():
        *tables, name = key.split("__")
        table = values
        for each in tables:
            table = table.setdefault(each, {})
        table[name] = value
    return MachineCase(**values)


def test_gears_of_a_machine_have_the_masses_of_their_pair() -> None:
    case = reducer(material__density="2700 kg/m^3", gears__z1__density="1400 kg/m^3")
    bodies, pair = case.machine().gear_bodies, case.pair("first", case.operating_point)
    for name, gear, density in (("z1", "pinion", 1400.0), ("z2", "wheel", 2700.0)):
        solid = mass_properties(getattr(pair.gear_pair, gear), density)
        assert bodies[name].mass == pytest.approx(solid.mass, rel=1e-12)
        assert bodies[name].moment_of_inertia == pytest.approx(solid.moment_of_inertia, rel=1e-12)
    steel = reducer().machine().gear_bodies["z1"]
    assert bodies["z1"].mass == pytest.approx(steel.mass * 1400.0 / 7800.0, rel=1e-12)


def test_a_shaft_in_the_bore_is_no_part_of_the_gear() -> None:
    sections = [["60 mm", "40 mm"]]
    parts = {
        "shafts__in": {"sections": sections},
        "shafts__out": {},
        "gears__z1__position": "30 mm",
        "bearings__A": {"shaft": "in", "position": "5 mm", "radial_stiffness": "1e9 N/m",
                        "axial_stiffness": "1e9 N/m"},
        "bearings__B": {"shaft": "in", "position": "55 mm", "radial_stiffness": "1e9 N/m"},
    }  # fmt: skip
    around, alone = reducer(**parts).machine(), reducer().machine()
    plug = 7800.0 * math.pi * 0.02**2 * 0.03
    less = alone.gear_bodies["z1"].mass - around.gear_bodies["z1"].mass
    assert less == pytest.approx(plug, rel=1e-9)
    bored = reducer(**parts, gears__z1__bore_diameter="40 mm").machine()
    assert bored.gear_bodies["z1"].mass == pytest.approx(around.gear_bodies["z1"].mass, rel=1e-12)


def test_gears_of_a_constant_stiffness_have_their_bore_and_density() -> None:
    case = reducer(meshes__first__helix_angle="0 deg", gears__z2__density="2700 kg/m^3")
    case = case.replace({"meshes.first.stiffness": "4e8 N/m"})
    body = case.machine().gear_bodies["z2"]
    outer, inner = 0.5 * 51 * 3e-3, 0.025
    mass = 2700.0 * math.pi * (outer**2 - inner**2) * 0.03
    assert body.mass == pytest.approx(mass, rel=1e-12)
    assert body.moment_of_inertia == pytest.approx(0.5 * mass * (outer**2 + inner**2), rel=1e-12)


def test_gears_of_crossed_axes_have_the_density_of_their_material() -> None:
    case = td.load_case("hypoid-axle")
    changes = {f"gears.{name}.{key}": None for name in case.gears for key in
               ("mass", "moment_of_inertia", "transverse_moment_of_inertia")}  # fmt: skip
    light = case.replace({**changes, "material.density": 1950.0}).machine().gear_bodies
    steel = case.replace({**changes, "material.density": 7800.0}).machine().gear_bodies
    for name, body in light.items():
        assert body.mass == pytest.approx(steel[name].mass / 4.0, rel=1e-12)
