"""Machines with computed helical teeth: symmetry, balance of forces, load over the face."""

from __future__ import annotations

import math
from copy import deepcopy
from typing import Any

import numpy as np
import pytest

import tribodyn as td
from tribodyn.study.machine.case import MachineCase
from tribodyn.study.machine.result import MachineResult

SPAN = 0.2
#: A pair whose gears are off the middle of soft shafts, so that they tilt.
PARTS: dict[str, Any] = {
    "shafts": {"in": {"sections": [[SPAN, 0.03]]}, "out": {"sections": [[SPAN, 0.04]]}},
    "bearings": {
        f"{shaft}{end}": {
            "shaft": shaft,
            "position": place,
            "radial_stiffness": 4e8,
            "axial_stiffness": 2e8 if end == "A" else 0.0,
        }
        for shaft in ("in", "out")
        for end, place in (("A", 0.01), ("B", 0.19))
    },
    "gears": {
        "z1": {"shaft": "in", "position": 0.06, "teeth": 23, "face_width": 0.03},
        "z2": {"shaft": "out", "position": 0.06, "teeth": 31, "face_width": 0.03},
    },
    "meshes": {
        "first": {
            "gears": ["z1", "z2"],
            "normal_module": 3e-3,
            "helix_angle": math.radians(18.0),
            "hand": "right",
            "angle": 0.0,
        }
    },
    "lubricant": {"name": "ISO VG 220", "temperature": 343.15},
    "stiffness": {"model": "iso6336"},
    "friction": {"law": "constant", "coefficient": 0.05},
    "dynamics": {"backlash": 1e-4, "modal_damping_ratio": 0.02},
    "operation": {"input": "in", "output": "out", "speed": 150.0, "torque": 200.0},
}


def machine(**changes: Any) -> MachineCase:
    """The pair with values changed by group and dotted key in the group."""
    parts = deepcopy(PARTS)
    for group, values in changes.items():
        for key, value in values.items():
            *names, name = key.split(".")
            table = parts[group]
            for each in names:
                table = table[each]
            table[name] = value
    return MachineCase(**parts)


@pytest.fixture(scope="module")
def result() -> MachineResult:
    return td.run(machine())


#: Figures of the vibration.
MOVING = ("rms_", "peak_", "minimum_mesh_force", "dynamic_factor", ".transmission_error")


def assert_same(
    result: MachineResult, other: MachineResult, *turned: str, moving: float = 1e-6
) -> None:
    """Compare all figures; those that end with one of ``turned`` have the other sign."""
    figures, expected = result.summary(), other.summary()
    assert figures.keys() == expected.keys()
    for key, value in expected.items():
        sign = -1.0 if key.endswith(turned) else 1.0
        close = moving if any(name in key for name in MOVING) else 1e-6
        assert figures[key] == pytest.approx(sign * value, rel=close, abs=1e-9), key


def test_the_mirror_image_in_the_plane_of_the_shafts_has_the_same_figures(result) -> None:
    """Speeds and hand change, the axial forces and the misalignment do not."""
    mirrored = td.run(machine(meshes={"first.hand": "left"}, operation={"speed": -150.0}))
    assert_same(mirrored, result, ".speed")


def test_the_mirror_image_across_the_shafts_turns_axial_forces_and_misalignment(result) -> None:
    """The hand changes, and positions are counted from the other end.

    The torque still acts on the same ends of the shafts: their twist changes the vibration a bit.
    """
    places = {f"{name}.position": SPAN - 0.06 for name in PARTS["gears"]}
    bearings = {
        f"{name}.position": SPAN - body["position"] for name, body in PARTS["bearings"].items()
    }
    mirrored = td.run(machine(meshes={"first.hand": "left"}, gears=places, bearings=bearings))
    assert_same(mirrored, result, "axial_force", ".misalignment", moving=0.01)


def test_the_wheel_as_the_first_gear_has_the_same_figures(result) -> None:
    """The pinion of the pair is then the second gear of the mesh."""
    exchanged = machine(
        meshes={"first.gears": ["z2", "z1"], "first.hand": "left", "first.angle": math.pi}
    )
    pair = exchanged.pair("first", exchanged.operating_point)
    assert (pair.gears.pinion.teeth, pair.gears.driver, pair.gears.hand) == (23, "pinion", "right")
    assert_same(td.run(exchanged), result, "first.axial_force")


def test_the_wheel_drives_and_a_brake_reverses_the_axial_force(result) -> None:
    braking = machine(operation={"torque": -200.0})
    assert braking.pair("first", braking.operating_point).gears.driver == "wheel"
    other, figures = td.run(braking).summary(), result.summary()
    ratio = other["bearings.inA.mean_axial_force"] / figures["bearings.inA.mean_axial_force"]
    assert ratio == pytest.approx(-1.0, rel=0.02)  # up to the power of friction


def total_load(result: MachineResult) -> tuple[np.ndarray, np.ndarray]:
    """Mean force and moment about the origin of all bearings and torques on the shafts."""
    motion, machine = result.motion, result.machine
    mean = motion.mean(motion.bearing_force)
    force, moment = np.zeros(3), np.zeros(3)
    for name, load in zip(motion.bearing, mean, strict=True):
        place = np.array(machine.placement.bearings[name])
        force -= load[:3]
        moment -= load[3:] + np.cross(place, load[:3])
    return force, moment


def test_forces_and_moments_on_the_free_machine_balance(result) -> None:
    """Mean loads in motion: bearings, driving torque, and the torque that the output takes."""
    force, moment = total_load(result)
    axial = result.summary()["meshes.first.axial_force"]
    assert abs(axial) > 1e3
    assert force == pytest.approx(np.zeros(3), abs=1e-6 * abs(axial))
    # About x remain the torques at both ends; about y and z nothing.
    assert moment[1:] == pytest.approx(np.zeros(2), abs=1e-6 * abs(axial))


def test_bearings_carry_the_axial_force_where_the_load_is(result) -> None:
    """Hand statics of the input shaft with the force at the centre of load of the mesh table."""
    motion, machine, static = result.motion, result.machine, result.operation.static
    mean = dict(zip(motion.bearing, motion.mean(motion.bearing_force), strict=True))
    line, mesh = machine.directions["first"], static.meshes["first"]
    force = motion.mean(motion.mesh_force[:, 0])
    axial = result.summary()["meshes.first.axial_force"]
    base = math.asin(math.sin(math.radians(18.0)) * math.cos(math.radians(20.0)))
    assert abs(axial) == pytest.approx(force * math.tan(base), rel=1e-9)
    assert mean["inA"][0] == pytest.approx(axial, rel=1e-4)
    # The moment of the load about mid face, besides that of the force in the pitch point.
    table, sense = result.operation.tables["first"], line.senses[0]
    gears = table.gear_pair
    pitch = gears.pinion.base_radius * math.tan(gears.working_transverse_pressure_angle)
    lean = math.tan(base) if gears.hand == "right" else -math.tan(base)
    columns = table.face_position + lean * (table.pinion_curvature_radius - pitch)
    lever = sense * float(table.grid.mean((table.load_share * columns).sum(axis=1)))
    assert mesh.moment / mesh.force == pytest.approx(lever, rel=0.05)
    # Friction at rest is left out of the static balance: compare that with hand statics.
    turn = np.cross([1.0, 0.0, 0.0], line.normal)
    load = -mesh.force * line.direction[:6]
    load[3:] -= mesh.moment * turn
    arm, span = 0.06 - 0.01, 0.18
    by_hand = np.array([load[1] * arm + load[5], load[2] * arm - load[4]]) / span
    assert static.bearings["inB"].load[1:3] == pytest.approx(by_hand, rel=1e-6)


def test_opposite_hands_on_one_shaft_cancel_the_axial_force() -> None:
    """A double helical pair whose pinion is free along its axis, so that both halves share."""
    parts = deepcopy(PARTS)
    parts["bearings"]["inA"]["axial_stiffness"] = 0.0
    gears = parts["gears"]
    for name in ("z1", "z2"):
        gears[name]["position"] = 0.07
        gears[f"{name}b"] = {**gears[name], "position": 0.13}
    first = parts["meshes"]["first"]
    parts["meshes"]["second"] = {**first, "gears": ["z1b", "z2b"], "hand": "left"}
    figures = td.run(MachineCase(**parts)).summary()
    forces = [figures[f"meshes.{name}.axial_force"] for name in ("first", "second")]
    assert forces[0] == pytest.approx(-forces[1], rel=1e-4)
    assert abs(forces[0]) > 500.0
    assert abs(figures["bearings.outA.mean_axial_force"]) < 1e-4 * abs(forces[0])


def test_teeth_and_shafts_agree_on_the_misalignment(result) -> None:
    """Deflected shafts tilt the gears; the teeth carry more where they are pressed."""
    load = result.operation
    computed, balanced = load.misalignment["first"], load.static.meshes["first"].misalignment
    assert abs(balanced) > 2e-6
    assert computed == pytest.approx(balanced, rel=0.2)
    figures, table = result.summary(), load.tables["first"]
    assert figures["meshes.first.face_load_factor"] == table.face_load_factor
    assert table.face_load_factor > 1.05
    width, axial_pitch = 0.03, math.pi * 3e-3 / math.sin(math.radians(18.0))
    assert figures["meshes.first.overlap_ratio"] == pytest.approx(width / axial_pitch)
    # More load where the compression grows, in the direction of x.
    heavier = np.sign(load.static.meshes["first"].moment) == np.sign(balanced)
    assert heavier


def test_the_report_maps_each_mesh_over_its_face(result, tmp_path) -> None:
    text = (result.save(tmp_path / "out") / "report.html").read_text(encoding="utf-8")
    assert "Mesh first: maps over the face" in text
    again = td.load_result(tmp_path / "out")
    table, other = (each.operation.tables["first"] for each in (result, again))
    assert other.load_face_position == pytest.approx(table.load_face_position)
    static = again.operation.static.meshes["first"]
    assert static.moment == pytest.approx(result.operation.static.meshes["first"].moment, rel=1e-6)


def test_the_built_in_reducer_lets_axial_forces_of_its_middle_shaft_oppose_each_other() -> None:
    case = td.load_case("two-stage-helical").replace({"stiffness": {"model": "iso6336"}})
    figures = td.run(case.replace({"load_cases": None})).summary()
    first, second = (figures[f"meshes.{name}.axial_force"] for name in ("first", "second"))
    on_middle = figures["bearings.C.mean_axial_force"]
    assert on_middle == pytest.approx(second - first, rel=1e-4)
    assert abs(on_middle) < min(abs(first), abs(second))
    for name in ("first", "second"):
        assert figures[f"meshes.{name}.overlap_ratio"] > 1.0
        assert figures[f"meshes.{name}.minimum_film_thickness"] > 1e-7


def test_equal_loads_are_computed_once(monkeypatch) -> None:
    from tribodyn.study.machine import run

    loads, compute = [], run.run_load

    def counted(case: MachineCase, load: Any, *arguments: Any) -> Any:
        loads.append(load.name)
        return compute(case, load, *arguments)

    monkeypatch.setattr(run, "run_load", counted)
    parts = deepcopy(PARTS)
    parts["load_cases"] = [{"name": "same"}, {"name": "light", "torque": 100.0}]
    result = td.run(MachineCase(**parts))
    assert loads == ["operation", "light"]
    figures = result.summary()
    assert [load.load.name for load in result.load_cases] == ["same", "light"]
    key = "meshes.first.alternating_rms_mesh_force"
    assert figures[f"load_cases.same.{key}"] == figures[key]
    assert figures[f"load_cases.light.{key}"] != figures[key]


def test_a_helix_angle_of_zero_is_a_spur_gear() -> None:
    """The same coordinates, and the load over the face of independent slices."""
    parts = deepcopy(PARTS)
    del parts["meshes"]["first"]["helix_angle"]
    expected = td.run(MachineCase(**parts))
    zero = td.run(machine(meshes={"first.helix_angle": 0.0}))
    assert zero.summary() == pytest.approx(expected.summary(), rel=1e-12)
    assert zero.summary()["meshes.first.face_load_factor"] > 1.2
    assert "meshes.first.axial_force" not in zero.summary()
    # A small angle: slices of lines of contact in place of whole pairs, the same balance at rest.
    small = td.run(machine(meshes={"first.helix_angle": math.radians(0.1)}))
    # Its motion changes by 1.2 % with 256 in place of 128 steps, so that 256 are taken.
    motions = [each.operation.response for each in (zero, small)]
    assert [len(motion.contact_force) for motion in motions] == [128, 256]
    assert all(motion.step_error < 1e-2 for motion in motions)
    for key, close in (("misalignment", 0.02), ("mean_mesh_stiffness", 5e-3),
                       ("static_transmission_error_peak_to_peak", 5e-3), ("friction_power", 2e-3),
                       ("face_load_factor", 0.04)):  # fmt: skip
        value, limit = (each.summary()[f"meshes.first.{key}"] for each in (small, zero))
        assert value == pytest.approx(limit, rel=close), key
    loads = [each.operation.static.bearings["inB"].load for each in (small, zero)]
    assert loads[0][1:3] == pytest.approx(loads[1][1:3], rel=0.02)


def test_check_shows_overlap_and_axial_force_without_computing(result) -> None:
    from tribodyn.study.machine.first_look import kinematic_figures

    figures, computed = kinematic_figures(machine()), result.summary()
    assert figures["meshes.first.overlap_ratio"] == computed["meshes.first.overlap_ratio"]
    axial = figures["meshes.first.axial_force"] / figures["meshes.first.static_mesh_force"]
    mean = computed["meshes.first.axial_force"] / computed["meshes.first.mean_mesh_force"]
    assert axial == pytest.approx(mean, rel=1e-12)


@pytest.mark.parametrize(
    ("stated", "hand"),
    [
        ({}, "right"),
        ({"z1": "left"}, "left"),
        ({"z2": "left"}, "right"),
        ({"z1": "left", "z2": "right"}, "left"),
    ],
)
def test_the_hand_of_a_gear_is_that_of_its_mesh(stated: dict[str, str], hand: str) -> None:
    parts = deepcopy(PARTS)
    del parts["meshes"]["first"]["hand"]
    for gear, its in stated.items():
        parts["gears"][gear]["hand"] = its
    case, written = td.Case(**parts), machine(meshes={"first.hand": hand})
    assert case.machine().meshes["first"].hand == hand
    forces = [each.machine().kinematics.meshes["first"].force for each in (case, written)]
    np.testing.assert_array_equal(*forces)
    assert case.pair("first", case.operating_point).gears.hand == hand


def test_gears_whose_hands_do_not_mesh_are_refused() -> None:
    with pytest.raises(td.InputError, match=r"z2\.hand: z1 is left-handed, z2 left-handed"):
        machine(gears={"z1.hand": "left", "z2.hand": "left"}, meshes={"first.hand": "left"})
    with pytest.raises(td.InputError, match=r"hand = .right. and hand = .left. are both given"):
        machine(gears={"z1.hand": "left"})


@pytest.mark.parametrize(
    ("gear", "hand"), [("sun", "left"), ("planet", "right"), ("ring", "right")]
)
def test_the_hand_of_a_gear_is_that_of_its_stage(gear: str, hand: str) -> None:
    changes = {
        "planets.low.center_distance": "83.0059 mm",
        "planets.low.helix_angle": "20 deg",
        "dynamics.backlash": None,
    }
    stage = td.load_case("planetary-stage").replace(changes | {f"gears.{gear}.hand": hand})
    assert stage.machine().planets["low"].hand == "left"
