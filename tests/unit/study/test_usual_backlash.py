"""Play of teeth that touch early: a usual backlash where a case gives none, in check and in run."""

import numpy as np
import pytest

import tribodyn as td
from tribodyn.errors import ComputationError, InputError
from tribodyn.gear import FlankModification, cylindrical_pair
from tribodyn.gear.flank_gap import least_gap
from tribodyn.study import read_case
from tribodyn.study.case.provenance import assumptions
from tribodyn.study.case.to_models import has_usual_backlash
from tribodyn.study.machine.run import balanced_machine, rehearse_machine, run_machine
from tribodyn.study.pipeline.run import prepare_run, rehearse

#: A pinion behind its bearings: its shaft bends and misaligns the teeth by some micrometres.
OVERHUNG = """
[shafts.in]
sections = [["120 mm", "40 mm"]]
[shafts.out]
sections = [["120 mm", "60 mm"]]
[bearings]
A = { shaft = "in", position = "10 mm", radial_stiffness = "4e8 N/m", axial_stiffness = "2e8 N/m" }
B = { shaft = "in", position = "60 mm", radial_stiffness = "4e8 N/m" }
C = { shaft = "out", position = "10 mm", radial_stiffness = "4e8 N/m", axial_stiffness = "2e8 N/m" }
D = { shaft = "out", position = "60 mm", radial_stiffness = "4e8 N/m" }
[gears]
z1 = { shaft = "in", position = "100 mm", teeth = 27, face_width = "30 mm" }
z2 = { shaft = "out", position = "100 mm", teeth = 51, face_width = "30 mm" }
[meshes.low]
gears = ["z1", "z2"]
normal_module = "3 mm"
[stiffness]
model = "analytic"
[operation]
input = "in"
output = "out"
speed = "1200 rpm"
torque = "150 N*m"
"""


def spur(misalignment: float = 0.0, **pinion: object):
    return cylindrical_pair(
        pinion_teeth=20,
        wheel_teeth=30,
        normal_module=4e-3,
        normal_pressure_angle=np.radians(20.0),
        helix_angle=0.0,
        pinion_face_width=50e-3,
        pinion_modification=FlankModification(**pinion),
        misalignment=misalignment,
    )


def problem(study, case):
    """Location and fault of an error, without its figures."""
    with pytest.raises((InputError, ComputationError)) as error:
        study(case)
    first = error.value.problems[0]
    return str(first.where), " ".join(w for w in first.what.split() if not w[-1].isdigit())


def test_least_gap_of_shapes_is_that_of_closed_forms():
    assert least_gap(spur()) == 0.0
    assert least_gap(spur(tip_relief=20e-6, crowning=5e-6)) == 0.0
    tilt, crown = 20e-6, 4e-6
    assert least_gap(spur(tilt)) == pytest.approx(-tilt / 2, rel=1e-12)
    # tilt u + 4 crown u^2 over -1/2 < u < 1/2
    assert least_gap(spur(tilt, crowning=8e-6)) == pytest.approx(-(tilt**2) / 16 / 8e-6, rel=1e-3)
    assert least_gap(spur(tilt, crowning=crown)) == pytest.approx(crown - tilt / 2, rel=1e-12)
    assert least_gap(spur(profile_slope=-6e-6)) == pytest.approx(-6e-6, rel=1e-12)
    late = (0.0, *[7e-6] * 2, *[0.0] * 16, -3e-6)
    assert least_gap(spur(cumulative_pitch_deviation=late)) == pytest.approx(-3e-6, rel=1e-12)
    assert least_gap(spur(run_out=10e-6)) == pytest.approx(-5e-6, rel=1e-12)


@pytest.mark.parametrize("key", ["gears.misalignment", "gears.pinion.modification.lead_slope"])
def test_a_pair_that_touches_early_has_a_usual_backlash(key):
    case = td.load_case("helical-pair").replace({"stiffness.model": "fe2d"})
    assert case.backlash < 1e-6
    assert not has_usual_backlash(case)
    early = case.replace({key: 20e-6})
    assert early.backlash == pytest.approx(0.1e-3)
    row = next(each for each in assumptions(early) if each.key == "dynamics.backlash")
    assert (row.value, row.kind) == ("0.1 mm", "default")
    assert "clamped between both flanks" in row.reason
    rehearse(early)
    linear = early.replace({"dynamics.mesh_law": "stiffness"})
    assert linear.backlash == case.backlash
    # as given, in check and in run
    needed = -2.0 * least_gap(early.gear_pair)
    rehearse(early.replace({"dynamics.backlash": 1.01 * needed}))
    narrow = early.replace({"dynamics.backlash": 0.99 * needed})
    assert problem(rehearse, narrow) == problem(prepare_run, narrow)
    assert problem(rehearse, narrow)[0] == "replace: dynamics.backlash"


def test_small_gears_have_less_play():
    case = td.load_case("fzg-roughness").replace(
        {"dynamics.backlash": None, "gears.misalignment": 20e-6}
    )
    assert case.backlash == pytest.approx(0.1e-3)
    scale = {"gears.normal_module": 0.5e-3, "gears.center_distance": None}
    scale |= {f"gears.{gear}.tip_diameter": None for gear in ("pinion", "wheel")}
    scale |= {f"gears.{gear}.bore_diameter": 5e-3 for gear in ("pinion", "wheel")}
    assert case.replace(scale).backlash == pytest.approx(0.05e-3)


def test_meshes_of_a_machine_have_a_usual_backlash_each():
    machine = td.load_case("two-stage-spur")
    free = machine.replace({"dynamics.backlash": None, "meshes.first.backlash": "80 um"})
    rows = {a.key: a for a in free.assumptions if a.key.endswith("backlash")}
    assert list(rows) == ["meshes.second.backlash"]
    assert (rows["meshes.second.backlash"].value, rows["meshes.second.backlash"].kind) == (
        "0.1 mm",
        "default",
    )
    plays = [pair.backlash for _, pair, _ in free.mesh_pairs()]
    assert plays == pytest.approx([0.08e-3, 0.1e-3])
    assert not [a for a in machine.assumptions if a.key.endswith("backlash")]
    # play by the centre distance is that of the drawing
    wide = read_case(OVERHUNG.replace('"3 mm"', '"3 mm"\ncenter_distance = "117.5 mm"'), "w")
    assert next(pair.backlash for _, pair, _ in wide.mesh_pairs()) > 0.3e-3
    assert not [a for a in wide.assumptions if a.key.endswith("backlash")]


def test_stages_have_a_usual_backlash():
    stage = td.load_case("planetary-stage").replace({"dynamics.backlash": None})
    rows = [a for a in stage.assumptions if a.key.endswith("backlash")]
    assert [(a.key.split(".")[0], a.value) for a in rows] == [("planets", "0.1 mm")]


def test_check_and_run_of_a_machine_name_the_mesh_that_touches_early():
    case = read_case(OVERHUNG, "box.toml")
    rehearse_machine(case)
    balanced = balanced_machine(case, case.operating_point)
    tilt = abs(balanced.misalignment["low"])
    assert tilt > 5e-6  # by the deflected shafts alone
    narrow = read_case(OVERHUNG + '[dynamics]\nbacklash = "2 um"\n', "box.toml")
    place, fault = problem(rehearse_machine, narrow)
    assert (place, fault) == problem(run_machine, narrow)
    assert place == "box.toml:25: dynamics.backlash"
    assert fault.startswith('mesh "low": a pair touches')
    wide = case.replace({"dynamics.backlash": 1.2 * tilt})
    rehearse_machine(wide)


@pytest.mark.parametrize("direction", [1, -1])
def test_check_finds_a_bearing_that_the_load_pulls_out(direction):
    angular = 'type = "angular-contact", bore_diameter = "40 mm", outer_diameter = "80 mm"'
    angular += ', width = "18 mm", contact_angle = "25 deg", preload = "500 N", direction = '
    helical = OVERHUNG.replace('module = "3 mm"', 'module = "3 mm"\nhelix_angle = "20 deg"')
    helical = helical.replace('"60 mm", radial', '"110 mm", radial').replace('"100 mm"', '"60 mm"')
    for name, sense in (("A", -direction), ("B", direction)):
        begin = helical.index(f"{name} = ")
        line = helical[begin : helical.index("\n", begin)]
        place = line[: line.index("radial")]
        helical = helical.replace(line, f"{place}{angular}{sense} }}")
    rehearse_machine(read_case(helical, "box.toml"))
    outward = helical.replace("direction = 1", "direction = -1")
    inward = helical.replace("direction = -1", "direction = 1")
    failing = 0
    for text in (outward, inward):
        try:
            rehearse_machine(read_case(text, "box.toml"))
        except InputError:
            place, fault = problem(lambda text: read_case(text, "box.toml"), text)
            assert place.endswith(": shafts.in")
            assert "x only, and its meshes push it with" in fault
            failing += 1
    assert failing == 1  # the load pulls out bearings of one of both directions


def test_teeth_of_a_stage_that_touch_early_are_named():
    stage = td.load_case("planetary-stage")
    (part,) = stage.stages.values()
    sun, planet = part.table.sun, part.table.planet
    early = {"dynamics.backlash": 1e-6, f"gears.{sun}.modification.lead_slope": 20e-6}
    fault = problem(rehearse_machine, stage.replace(early))
    assert fault == problem(run_machine, stage.replace(early))
    who = f'mesh {part.name}_sun1: stage "{part.name}", gears {sun} and {planet}: a pair touches'
    assert fault[1].startswith(who)
