"""Every key that a machine or a stage accepts changes a figure, or is refused by its name."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from copy import deepcopy
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from broken import SOUND

import tribodyn as td
from tribodyn.cli import call
from tribodyn.errors import ComputationError, InputError
from tribodyn.model import Option
from tribodyn.study import MachineCase, read_case
from tribodyn.study.case.checks import case_options
from tribodyn.study.case.gears import Modification
from tribodyn.study.case.section import Section
from tribodyn.study.machine.first_look import idle_keys
from tribodyn.study.machine.tables import (
    MESH_KEYS,
    BearingTable,
    CouplingTable,
    GearTable,
    MeshTable,
    MotionTable,
    OperationTable,
    ShaftTable,
    SolverTable,
)
from tribodyn.study.machine_tables import PlanetsTable
from tribodyn.study.pipeline.cautions import idle_values

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")

GEAR = {"face_width": "30 mm", "roughness_ra": "0.3 um"}
RELIEF = {"tip_relief": "15 um", "root_relief": "15 um", "end_relief": "15 um"}
MODELS = {
    "lubricant": {"name": "ISO VG 220", "temperature": "70 degC"},
    "film": {"model": "moes"},
    "friction": {"law": "mixed-ehl"},
}


def spur(**mesh: Any) -> dict[str, Any]:
    stiff = {"radial_stiffness": "4e8 N/m", "axial_stiffness": "1e8 N/m"}
    first = {"gears": ["z1", "z2"], "normal_module": "3 mm", "backlash": "0.1 mm"}
    return {
        "shafts": {
            "engine": {"moment_of_inertia": "0.1 kg*m^2"},
            "in": {"sections": [["100 mm", "30 mm"]]},
            "out": {"moment_of_inertia": "0.05 kg*m^2"},
        },
        "couplings": {"k": {"shafts": ["engine", "in"], "torsional_stiffness": "1e5 N*m/rad"}},
        "bearings": {
            "A": {"shaft": "in", "position": "10 mm", **stiff},
            "B": {"shaft": "in", "position": "90 mm", **stiff},
            "C": {"shaft": "out", "position": "0 mm", **stiff, "tilting_stiffness": "1e5 N*m/rad"},
        },
        "gears": {
            "z1": {"shaft": "in", "position": "40 mm", "teeth": 21, **GEAR},
            "z2": {"shaft": "out", "teeth": 42, **GEAR},
        },
        "meshes": {"first": {**first, "transmission_error_amplitude": "1 um", **mesh}},
        "operation": {"input": "engine", "output": "out", "speed": "1500 rpm", "torque": "90 N*m"},
    }


def computed_teeth() -> dict[str, Any]:
    data = spur(helix_angle="10 deg", hand="right")
    data["gears"]["z1"] |= {"hand": "right", "modification": RELIEF}
    return {**data, **deepcopy(MODELS), "stiffness": {"model": "fe2d"}}


def constant_stiffness() -> dict[str, Any]:
    data = spur(stiffness="4e8 N/m")
    for gear in data["gears"].values():
        del gear["roughness_ra"]
    return data


def stage() -> dict[str, Any]:
    names = "gears", "planets", "operation", "dynamics"
    data = {k: deepcopy(v) for k, v in td.load_case("planetary-stage").data.items() if k in names}
    data["planets"]["low"]["transmission_error_amplitude"] = "1 um"
    return {**data, **deepcopy(MODELS), "stiffness": {"model": "fe2d"}}


def stage_in_a_machine() -> dict[str, Any]:
    """A stage with a pair of gears of the same mesh frequency behind its carrier."""
    data, stiff = stage(), {"position": "0 mm", "radial_stiffness": "1e9 N/m"}
    del data["planets"]["low"]["carrier_support"]
    stiff |= {"axial_stiffness": "1e9 N/m", "tilting_stiffness": "1e7 N*m/rad"}
    data["gears"] |= {
        "x": {"shaft": "carrier", "teeth": 61, **GEAR},
        "y": {"shaft": "out", "teeth": 83, **GEAR},
    }
    data["meshes"] = {"last": {"gears": ["x", "y"], "normal_module": "5 mm"}}
    data["bearings"] = {name: {"shaft": name, **stiff} for name in ("carrier", "out")}
    data["operation"] = {**data["operation"], "output": "out"}
    return data


#: Keys that no summary needs, and where they are used.
ELSEWHERE = {
    "seat_mass": "acceleration in a recording",
    "seat_frequency": "acceleration in a recording",
    "seat_damping_ratio": "acceleration in a recording",
    "harmonics": "spectra of a mesh",
    "extended_contact": "ends of the path of spur teeth whose gap is even over the face",
}


def keys_of(data: dict[str, Any]) -> Iterator[tuple[str, str, Option]]:
    """Table, name and option of every key of a machine or a stage; of a part the first of each."""
    outer = Section.case_class.fields
    of_pair = {name: outer[name].kind for name in ("lubricant", "dynamics", "material")}  # type: ignore[union-attr]
    groups = {
        "shafts": ShaftTable, "bearings": BearingTable, "couplings": CouplingTable,
        "gears": GearTable, "meshes": MeshTable, "planets": PlanetsTable,
    }  # fmt: skip
    for group, kind in groups.items():
        for part in list(data.get(group, {}))[-1:]:
            yield from ((f"{group}.{part}", key, option) for key, option in kind.specs())
            if group in ("meshes", "planets"):
                for key in MESH_KEYS:
                    yield f"{group}.{part}", key, of_pair["dynamics"].spec(key)
            if group == "gears":
                for key, option in Modification.specs():
                    yield f"gears.{part}.modification", key, option
    tables = {
        **of_pair, "dynamics": MotionTable, "operation": OperationTable, "solver": SolverTable,
    }  # fmt: skip
    for section, selector in (("film", "model"), ("friction", "law"), ("stiffness", "model")):
        if section in data:
            options = case_options(section, data[section][selector])
            yield from ((section, key, option) for key, option in options.items())
    for table in tables:
        yield from ((table, key, option) for key, option in tables[table].specs())
    yield from (("dynamics", key, of_pair["dynamics"].spec(key)) for key in MESH_KEYS)


def keys_read(kind: Any, data: dict[str, Any], monkeypatch: pytest.MonkeyPatch) -> set[str]:
    """Names of the keys that the computation of a case reads from its tables."""
    names: set[str] = set()
    plain = object.__getattribute__

    def reading(table: Any, name: str) -> Any:
        value = plain(table, name)
        if not name.startswith("_") and name in plain(table, "__dict__"):
            names.add(name)
        return value

    with monkeypatch.context() as patch:
        patch.setattr(Section, "__getattribute__", reading, raising=False)
        td.run(kind(**data)).summary()
    return names


def with_value(data: dict[str, Any], key: str, value: Any) -> dict[str, Any]:
    changed, (*tables, name) = deepcopy(data), key.split(".")
    table = changed
    for each in tables:
        table = table.setdefault(each, {})
    table[name] = value
    return changed


def refusal(kind: Any, data: dict[str, Any], key: str, value: Any) -> str:
    with pytest.raises(InputError) as caught:
        kind(**with_value(data, key, value))
    return str(caught.value)


def other_value(option: Option) -> Any:
    if option.names is not None:
        return next(each for each in option.names() if each != option.default)
    if option.kind == "flag":
        return not option.default
    return option.example.strip('"') if option.unit else 0.1


@pytest.mark.parametrize(
    ("kind", "make"),
    [
        (MachineCase, constant_stiffness),
        (MachineCase, computed_teeth),
        (MachineCase, stage),
        pytest.param(MachineCase, stage_in_a_machine, marks=pytest.mark.slow),
    ],
)
def test_every_key_is_used_or_refused(
    kind: Any, make: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    data, ignored = make(), []
    names, figures = keys_read(kind, data, monkeypatch), td.run(kind(**data)).summary()
    for table, key, option in keys_of(data):
        if key in names or key in ELSEWHERE:
            continue
        with suppress(InputError, ComputationError):
            case = kind(**with_value(data, f"{table}.{key}", other_value(option)))
            if td.run(case).summary() == figures:
                ignored.append(f"{table}.{key}")
    assert ignored == []


@pytest.mark.parametrize(
    ("kind", "make", "key", "value"),
    [
        (MachineCase, computed_teeth, "meshes.first.lubricant.heat_transfer", "15 W/K"),
        (MachineCase, stage, "planets.low.lubricant.heat_transfer", "15 W/K"),
        (MachineCase, stage, "gears.planet.position", "9 mm"),
        (MachineCase, stage, "planets.low.pair_center_distance", "90 mm"),
        (MachineCase, stage, "planets.low.ring_normal_module", "3 mm"),
        (MachineCase, stage_in_a_machine, "planets.low.carrier_support", "1e8 N/m"),
        (MachineCase, constant_stiffness, "lubricant", MODELS["lubricant"]),
        (MachineCase, constant_stiffness, "friction.law", "constant"),
        (MachineCase, constant_stiffness, "meshes.first.film.model", "moes"),
        (MachineCase, constant_stiffness, "meshes.first.mesh_law", "tangent"),
        (MachineCase, constant_stiffness, "gears.z1.tip_diameter", "69 mm"),
        (MachineCase, constant_stiffness, "gears.z2.modification.tip_relief", "9 um"),
        (MachineCase, constant_stiffness, "dynamics.friction_load", "dynamic"),
    ],
)
def test_keys_without_effect_are_refused_by_name(
    kind: Any, make: Any, key: str, value: Any
) -> None:
    text = refusal(kind, make(), key, value)
    place = key.removesuffix(".law").removesuffix(".model").removesuffix(".tip_relief")
    assert f"{place}: " in text
    assert "has no effect here" in text


def test_a_hypoid_machine_refuses_keys_that_do_nothing() -> None:
    case = td.load_case("hypoid-axle")
    for key, value in (
        ("meshes.axle.lubricant.heat_transfer", "15 W/K"),
        ("stiffness.model", "fe2d"),
    ):
        with pytest.raises(InputError, match="has no effect here"):
            case.replace({key: value}, by="--set")


def test_harmonics_are_those_of_the_spectra_of_a_mesh() -> None:
    data = constant_stiffness()
    few = td.run(MachineCase(**data, dynamics={"harmonics": 3})).mesh_spectra()
    assert float(np.max(few["order"])) == pytest.approx(3.0)


def test_a_change_drops_what_it_leaves_without_effect() -> None:
    case = td.load_case("two-stage-spur")
    stiff = {f"meshes.{name}.stiffness": 4e8 for name in case.meshes}
    constant = case.replace(stiff)
    assert "roughness_ra" not in constant.data["gears"]["z1"]
    assert "film" not in constant.data
    assert "bore_diameter" in constant.data["gears"]["z2"]
    with pytest.raises(InputError, match=r"film: film has no effect here"):
        case.replace({**stiff, "film.model": "moes"})
    with pytest.raises(InputError, match=r"gears\.z1\.roughness_ra"):
        constant.replace({"gears.z1.roughness_ra": 3e-7})


#: Values without effect beside others, and others of them.
IDLE = {
    "hand": ("left", "right"),
    "modification.tip_relief_length": ("2 mm", "3 mm"),
    "modification.root_relief_shape": ("parabolic", "linear"),
    "modification.run_out_phase": ("10 deg", "20 deg"),
    "roughness_rms": ("0.2 um", "0.4 um"),
}


def test_a_check_names_what_has_no_effect_in_a_pair(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "pair.toml"
    file.write_text(SOUND, encoding="utf-8")
    first, second = (
        {f"gears.pinion.{key}": values[place] for key, values in IDLE.items()}
        | {"gears.composite_roughness": None, "gears.wheel.roughness_rms": "0.2 um"}
        | {"lubricant.temperature": ("60 degC", "80 degC")[place]}
        for place in (0, 1)
    )
    case = read_case(SOUND, "pair.toml").replace(first)
    named = dict(idle_values(case))
    assert {key for key, value in first.items() if value is not None} <= set(named)
    before, after = (td.run(each).summary() for each in (case, case.replace(second)))
    moved = {key for key in before if before[key] != after[key]}
    assert all(key.startswith("oil_") for key in moved)
    call(["check", str(file)])
    line = 1 + SOUND[: SOUND.index('name = "80W"')].count("\n")
    assert (
        f"pair.toml:{line}: lubricant.name has no effect: neither film" in capsys.readouterr().err
    )


def test_a_check_names_what_has_no_effect_in_a_machine() -> None:
    data = {**spur(hand="left"), "friction": {"law": "constant", "coefficient": 0.05}}
    data["meshes"]["first"] |= {"transmission_error_amplitude": "0 um"}
    data["gears"]["z1"]["modification"] = {"tip_relief_length": "2 mm"}
    case = MachineCase(**data)
    named = {"meshes.first.hand", "gears.z1.modification.tip_relief_length"}
    named |= {"gears.z1.roughness_ra", "gears.z2.roughness_ra"}
    assert set(idle_keys(case)) == named
    other = case.replace({
        "meshes.first.hand": "right", "gears.z1.modification.tip_relief_length": "3 mm",
        "gears.z1.roughness_ra": "0.5 um",
    })  # fmt: skip
    assert td.run(case).summary() == td.run(other).summary()
    assert idle_keys(td.load_case("planetary-stage")) == {}
