"""Every key of a pair reaches teeth, structure or geometry, is refused, or is named by a check."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

import tribodyn as td
from tribodyn.errors import InputError
from tribodyn.gear.hypoid.ease_off import eased_gap
from tribodyn.mesh import MeshTable
from tribodyn.model import Option
from tribodyn.study.case.section import options_of, section_at
from tribodyn.study.machine.first_look import idle_keys
from tribodyn.study.mesh_inputs import mesh_inputs
from tribodyn.study.pipeline.assembly import geometry, whole_system
from tribodyn.study.pipeline.cautions import idle_values
from tribodyn.study.pipeline.tooth_contact import mesh_of

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")

PLAIN = {"friction.law": "none"}
CONJUGATE = {
    f"gears.ease_off.{name}": 0.0 for name in ("lengthwise_crowning", "profile_crowning", "bias")
}
CASES: dict[str, tuple[str, dict[str, Any]]] = {
    "hypoid": ("hypoid-mixed-ehl", PLAIN),
    "conjugate hypoid": ("hypoid-mixed-ehl", PLAIN | CONJUGATE),
    "helical": ("helical-pair", PLAIN | {"film.model": "none", "stiffness.model": "iso6336"}),
}
#: Keys that the tables of teeth, or the motion over its period, read from the case; the hand of a
#: gear may be stated beside that of the pair.
BY_NAME = {
    "line_stiffness", "stiffness_model", "entrainment", "composite_roughness",
    "transmission_error_amplitude", "transmission_error_phase", "mesh_law", "speed", "torque",
    "hand",
}  # fmt: skip


def numbers_of(value: Any) -> Iterator[bytes]:
    """Every number in nested values."""
    if dataclasses.is_dataclass(value):
        value = [getattr(value, field.name) for field in dataclasses.fields(value)]
    elif isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, tuple | list):
        for each in value:
            yield from numbers_of(each)
    elif value is None or isinstance(value, str | float | int | np.ndarray):
        yield np.asarray(value).tobytes()


def figures(case: Any, mesh: MeshTable) -> list[bytes]:
    """Numbers from which teeth and structure are computed, with the teeth of another case."""
    inputs, flanks = mesh_inputs(case), case.hypoid_flanks
    teeth: Any = inputs.teeth
    if flanks is not None:
        places = 1e-3 * np.array([[9.0, 3.0], [-9.0, -4.0], [0.0, 20.0], [0.0, -20.0]])
        gap = eased_gap(flanks.ease_off, flanks.blank, places)
        teeth = gap, flanks.blank, flanks.conjugate.touch(np.zeros(2)), teeth.mounting
    return [*numbers_of([teeth, inputs.contact, geometry(case), whole_system(case, mesh)])]


def other_values(option: Option, value: Any) -> Iterator[Any]:
    if option.names is not None:
        yield from (name for name in option.names() if name != value)
    elif option.kind in ("flag", "integer"):
        yield not value if option.kind == "flag" else int(option.low) + 1
    elif option.kind == "numbers":
        yield option.example.replace('"', "").split(", ")
    elif option.kind == "number":
        yield from (factor * value for factor in (1.05, 0.95) if isinstance(value, float) and value)
        yield option.example.strip('"')
        if math.isfinite(option.high):
            yield option.low + 1e-3 * (option.high - option.low)


def silent(case: Any, key: str, option: Option, before: list[bytes], mesh: MeshTable) -> bool:
    """Whether another value of a key is accepted, changes nothing, and is not named."""
    for value in other_values(option, case.get(key)):
        try:
            changed = case.replace({key: value})
            after = figures(changed, mesh)
        except InputError:
            continue
        if changed.get(key) != case.get(key):
            return after == before and key not in dict(idle_values(changed))
    return False


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_no_key_of_a_pair_is_ignored_in_silence(name: str) -> None:
    file, changes = CASES[name]
    case = td.load_case(file).replace(changes)
    mesh = mesh_of(case)
    before = figures(case, mesh)
    options = [
        each
        for table in ("gears", "dynamics", "material", "operation")
        for each in options_of(section_at((table,)), f"{table}.")  # type: ignore[arg-type]
        if each[0].rpartition(".")[2] not in BY_NAME
    ]
    assert [key for key, option in options if silent(case, key, option, before, mesh)] == []


@pytest.mark.parametrize(
    ("name", "changes"),
    [
        ("hypoid", {"gears.thickness_factor": 0.1}),
        ("hypoid", {"gears.outer_backlash": "0.3 mm"}),
        ("conjugate hypoid", {"gears.ease_off.relief_length": "3 mm"}),
        ("conjugate hypoid", {"gears.ease_off.center": ["1 mm", "2 mm"]}),
        ("hypoid", {"lubricant.thermal_conductivity": "0.13 W/m/K"}),
        ("hypoid", {"material.density": "7000 kg/m^3"}),
        ("helical", {"dynamics.damping_in_gap": True, "dynamics.backlash": 0.0}),
    ],
)
def test_what_a_check_names_changes_no_figure(name: str, changes: Any) -> None:
    file, plain = CASES[name]
    base = {each: 0.0 for each in changes if each == "dynamics.backlash"}
    case = td.load_case(file).replace(plain | base)
    changed = case.replace(changes)
    assert next(iter(changes)) in dict(idle_values(changed))
    assert td.run(changed).summary() == td.run(case).summary()


def test_oil_of_crossed_flanks_has_an_effect() -> None:
    """Their films are those of ellipses, which are computed without a film model too."""
    case = td.load_case("hypoid-mixed-ehl").replace(PLAIN)
    assert not any(key.startswith("lubricant") for key, _ in idle_values(case))


def test_the_wider_of_two_gears_with_their_masses_is_named() -> None:
    case = td.load_case("fzg-roughness").replace({**PLAIN, "film.model": "none"})
    wide = case.replace({"gears.wheel.face_width": "24 mm"})
    assert "gears.wheel.face_width" in dict(idle_values(wide))
    first, second = (td.run(each).summary() for each in (case, wide))
    assert {key for key in first if first[key] != second[key]} == {"face_width_wheel"}
    heavy = wide.replace({"gears.wheel.mass": None})
    assert "gears.wheel.face_width" not in dict(idle_values(heavy))


def test_a_hypoid_mesh_of_a_machine_names_its_keys() -> None:
    case = td.load_case("hypoid-axle").replace({"meshes.axle.ease_off.relief_length": "3 mm"})
    assert "meshes.axle.ease_off.relief_length" in idle_keys(case)


def test_a_stage_by_itself_names_the_places_of_its_gears() -> None:
    fast = {"film.model": "none", "stiffness.model": "rectangular",
            "stiffness.pair_stiffness": "5e8 N/m", "friction.law": "none"}  # fmt: skip
    case = td.load_case("planetary-stage").replace(fast)
    moved = case.replace({"gears.sun.position": "85 mm"})
    assert "gears.sun.position" in idle_keys(moved)
    assert "gears.ring.position" not in idle_keys(moved)
    tilted = td.load_case("planetary-stage").replace(
        {"gears.sun.transverse_moment_of_inertia": 4e-4}
    )
    assert [*idle_keys(tilted)] == ["gears.sun.transverse_moment_of_inertia"]
    assert td.run(moved).summary() == td.run(case).summary()
