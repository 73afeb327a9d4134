"""A mesh of a machine or a stage is warned of as the pair of its gears is."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pytest

import tribodyn as td
from tribodyn.errors import InputError, collected
from tribodyn.model import NO_OPTIONS
from tribodyn.study import Case, MachineCase
from tribodyn.study.machine.run import balanced_machine, rehearse_machine
from tribodyn.study.pipeline.cautions import case_cautions, mesh_cautions
from tribodyn.study.pipeline.run import rehearse

CODES = {"mixed-lubrication", "hertz-pressure", "contact-ratio-reduced", "relief-large"}
pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")

GEAR = {"face_width": "6 mm", "roughness_ra": "0.8 um", "modification": {"tip_relief": "300 um"}}
MODELS = {"friction": {"law": "constant", "coefficient": 0.05}, "stiffness": {"model": "iso6336"}}
OIL = {"name": "ISO VG 32", "temperature": "90 degC"}
POINT = {"speed": "300 rpm", "torque": "220 N*m"}


def codes(warnings: Any) -> set[str]:
    return CODES & {warning.code for warning in warnings}


def test_a_machine_of_two_gears_warns_as_its_pair() -> None:
    gears = {"pinion": {"teeth": 20, **GEAR}, "wheel": {"teeth": 41, **GEAR}, "driver": "pinion"}
    gears |= {"normal_module": "3 mm", "normal_pressure_angle": "20 deg"}
    film = {"model": "dowson-higginson"}
    pair = td.run(Case(
        gears=gears, lubricant=OIL, film=film, **MODELS, operation=POINT,
        dynamics={"model": "torsional", "backlash": "0.1 mm"},
    ))  # fmt: skip
    machine = td.run(MachineCase(
        gears={"a": {"shaft": "in", "teeth": 20, **GEAR},
               "b": {"shaft": "out", "teeth": 41, **GEAR}},
        meshes={"m": {"gears": ["a", "b"], "normal_module": "3 mm", "backlash": "0.1 mm"}},
        lubricant=OIL, film=film, **MODELS, operation={"input": "in", "output": "out", **POINT},
    ))  # fmt: skip
    assert codes(pair.warnings) >= {"mixed-lubrication", "hertz-pressure"}
    assert codes(machine.warnings) == codes(pair.warnings)
    texts = {warning.code: warning.message for warning in machine.warnings}
    for warning in pair.warnings:
        if warning.code in CODES:
            assert texts[warning.code] == f"mesh m, operation: {warning.message}"


@pytest.mark.parametrize("name", ["planetary-stage", "hypoid-axle"])
def test_films_that_do_not_separate_the_flanks_are_said_once_with_all_meshes(name: str) -> None:
    case = td.load_case(name).replace({"load_cases": None})
    state = balanced_machine(case, case.operating_point)
    mixed = [each.mesh for each in state.warnings if each.warning.code == "mixed-lubrication"]
    touching = [
        mesh
        for mesh, table in state.tables.items()
        if any(each.code == "mixed-lubrication" for each in mesh_cautions(table))
    ]
    assert touching
    assert mixed == touching
    (said,) = [w.message for w in td.run(case).warnings if w.code == "mixed-lubrication"]
    assert all(f"mesh {mesh}, operation" in said for mesh in touching)


def pair_and_machine(
    pinion: dict[str, Any],
    wheel: dict[str, Any],
    point: dict[str, str],
    *,
    geometry: Mapping[str, Any] = NO_OPTIONS,
    models: Mapping[str, Any] = NO_OPTIONS,
    **dynamics: Any,
) -> tuple[Case, MachineCase]:
    """Two gears as a pair that only turns, and as a machine of rigid shafts."""
    module, names = {"normal_module": "3 mm", **geometry}, ("pinion", "wheel")
    models = {"stiffness": {"model": "potential-energy"}, "friction": MODELS["friction"], **models}
    gears = dict(zip(names, (pinion, wheel), strict=True))
    shafts = zip(names, ("in", "out"), strict=True)
    pair = Case(
        gears={**gears, **module, "normal_pressure_angle": "20 deg", "driver": "pinion"},
        dynamics={"model": "torsional", **dynamics}, operation=point, **models,
    )  # fmt: skip
    machine = MachineCase(
        gears={name: {"shaft": shaft, **gears[name]} for name, shaft in shafts},
        meshes={"m": {"gears": list(names), **module, **dynamics}},
        operation={"input": "in", "output": "out", **point}, **models,
    )  # fmt: skip
    return pair, machine


def texts_of(result: Any, code: str) -> list[str]:
    return [each.message for each in result.warnings if each.code == code]


def test_gears_of_a_machine_are_warned_of_by_their_names() -> None:
    pinion = {"teeth": 16, "face_width": "20 mm", "mass": "3 kg"}
    wheel = {"teeth": 41, "face_width": "20 mm", "modification": {"run_out": "9 um"}}
    pair, machine = pair_and_machine(pinion, wheel, POINT, backlash="0.1 mm")
    said = {each.code: each.message for each in case_cautions(pair)}
    assert set(said) == {"undercut", "mass-unlikely"}
    with collected() as checked:
        rehearse_machine(machine)
    texts = {each.code: each.message for each in checked}
    assert {code: texts.get(code) for code in said} == {n: f"mesh m: {t}" for n, t in said.items()}
    assert texts["teeth-alike"] == f"mesh m: {texts_of(td.run(pair), 'teeth-alike')[0]}"
    run = {each.code for each in td.run(machine).warnings}
    assert {*said, "teeth-alike"} <= run
    renamed = MachineCase(**{
        **machine.data,
        "gears": {"z1": machine.data["gears"]["pinion"], "z2": machine.data["gears"]["wheel"]},
        "meshes": {"m": {**machine.data["meshes"]["m"], "gears": ["z1", "z2"]}},
    })  # fmt: skip
    with collected() as checked:
        rehearse_machine(renamed)
    assert any(str(each).startswith("[mass-unlikely] mesh m: z1: mass = 3 kg") for each in checked)


def test_a_mass_of_a_machine_is_that_of_the_gear_before_its_shape_changed() -> None:
    pinion = {"teeth": 20, "face_width": "20 mm"}
    wheel = {"teeth": 41, "face_width": "20 mm", "mass": "1.85 kg"}
    pair, machine = pair_and_machine(pinion, wheel, POINT, backlash="0.1 mm")
    for case, width, module in (
        (pair, "gears.wheel.face_width", "gears.normal_module"),
        (machine, "gears.wheel.face_width", "meshes.m.normal_module"),
    ):
        changed = case.replace({width: "30 mm", module: "3.1 mm"})
        with collected() as checked:
            listed = case_cautions(changed) if case is pair else rehearse_machine(changed)
        said = {each.code: each.message for each in (listed if case is pair else checked)}
        assert "mass-of-other-gear" in said
        assert width in said["mass-of-other-gear"]
        assert module in said["mass-of-other-gear"]


def test_the_gears_of_a_stage_are_warned_of_once_for_all_planets() -> None:
    case = td.load_case("planetary-stage").replace({"load_cases": None})
    with collected() as checked:
        rehearse_machine(case)
    (undercut,) = [each.message for each in checked if each.code == "undercut"]
    assert undercut.startswith("mesh low_sun1: the sun is undercut")
    (fillet,) = [each.message for each in checked if each.code == "fillet-contact"]
    assert "the planet's flank" in fillet


def test_a_gear_with_a_name_of_its_own_has_no_article() -> None:
    def case(teeth: int) -> MachineCase:
        gears = {"z1": {"shaft": "in", "teeth": 16, **GEAR}}
        gears["wheel"] = {"shaft": "out", "teeth": teeth, **GEAR}
        meshes = {"m": {"gears": ["z1", "wheel"], "normal_module": "3 mm"}}
        operation = {"input": "in", "output": "out", **POINT}
        return MachineCase(gears=gears, meshes=meshes, **MODELS, lubricant=OIL, operation=operation)

    with collected() as checked:
        rehearse_machine(case(17))
    said = [each.message for each in checked if each.code == "undercut"]
    starts = [f"mesh m: {name} is undercut" for name in ("z1", "the wheel")]
    assert all(text.startswith(start) for text, start in zip(said, starts, strict=True))
    with pytest.raises(InputError) as error:
        case(90)
    (problem,) = error.value.problems
    assert "tip diameter of the wheel" in problem.what
    assert "shift z1 outwards" in problem.remedy


def test_a_check_of_a_machine_warns_of_its_load_as_that_of_a_pair_does() -> None:
    gear = {"face_width": "6 mm", "modification": {"tip_relief": "300 um"}}
    pair, machine = pair_and_machine(
        {"teeth": 20, **gear}, {"teeth": 41, **gear}, POINT, backlash="0.1 mm"
    )
    said = {each.code: each.message for each in rehearse(pair)}
    assert set(said) >= {"relief-large", "contact-ratio-reduced"}
    with collected() as checked:
        rehearse_machine(machine)
    texts = {each.code: each.message for each in checked}
    assert {code: texts.get(code) for code in said} == {
        code: f"mesh m, operation: {text}" for code, text in said.items()
    }


def runs_of(speed: str, torque: str, **dynamics: Any) -> tuple[Any, Any]:
    """Results of a pair and of its machine, excited by an error of both flanks."""
    gear, point = {"face_width": "20 mm"}, {"speed": speed, "torque": torque}
    error = {"transmission_error_amplitude": "10 um", **dynamics}
    pair, machine = pair_and_machine({"teeth": 20, **gear}, {"teeth": 41, **gear}, point, **error)
    return td.run(pair), td.run(machine)


@pytest.mark.parametrize(
    ("speed", "backlash", "back"), [("3000 rpm", "0.2 mm", False), ("12000 rpm", "0.012 mm", True)]
)
def test_flanks_that_part_are_reported_with_their_share(
    speed: str, backlash: str, back: bool
) -> None:
    # Of the motions that exist side by side both find the same one.
    torque, ratio = ("4 N*m", 0.03) if back else ("2.5 N*m", 0.1)
    pair, machine = runs_of(speed, torque, backlash=backlash, mesh_damping_ratio=ratio)
    (of_pair,), (of_machine,) = (texts_of(each, "contact-loss") for each in (pair, machine))
    shares = pair.summary()["contact_loss_share"], machine.summary()["meshes.m.contact_loss_share"]
    assert shares[1] == pytest.approx(shares[0], abs=3e-3)
    assert of_machine.startswith(f"mesh m, operation: the flanks lose contact for {shares[1]:.3g}")
    touches = "the back flanks touch as well"
    assert (touches in of_pair) is (touches in of_machine) is back


def test_damping_in_a_gap_that_stays_closed_is_reported() -> None:
    pair, machine = runs_of("3000 rpm", "90 N*m", backlash="0.2 mm", damping_in_gap=True)
    (of_pair,), (of_machine,) = (texts_of(each, "closed-gap") for each in (pair, machine))
    assert of_machine == f"mesh m, operation: {of_pair}"
    assert pair.summary()["contact_loss_share"] == 0.0
    loose = {"backlash": "0.012 mm", "mesh_damping_ratio": 0.03, "damping_in_gap": True}
    assert not any(texts_of(each, "closed-gap") for each in runs_of("12000 rpm", "4 N*m", **loose))


def test_tension_without_backlash_is_reported() -> None:
    tight = {"backlash": "0 mm", "mesh_law": "stiffness", "mesh_damping_ratio": 0.03}
    pair, machine = runs_of("9000 rpm", "4 N*m", **tight)
    (of_pair,), (of_machine,) = (texts_of(each, "mesh-tension") for each in (pair, machine))
    assert of_machine == f"mesh m, operation: {of_pair}"
    assert not texts_of(machine, "contact-loss")
    assert machine.summary()["meshes.m.contact_loss_share"] == 0.0


def test_loads_beyond_the_table_of_friction_are_reported() -> None:
    _, machine = runs_of(
        "9000 rpm", "20 N*m", backlash="0.2 mm", mesh_damping_ratio=0.03, friction_load="dynamic"
    )
    (text,) = texts_of(machine, "friction-load")
    figures = machine.summary()
    force, load = (figures[f"meshes.m.{name}_mesh_force"] for name in ("peak", "static"))
    assert text.startswith(f"mesh m, operation: the teeth carry up to {force / load:.3g} times")
