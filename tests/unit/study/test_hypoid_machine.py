"""Machines with a hypoid mesh: from the case file to figures, and back from the directory."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import tribodyn as td
from tribodyn.app.case_form import CaseForm
from tribodyn.errors import InputError
from tribodyn.gear import Misalignment
from tribodyn.study import MachineCase
from tribodyn.study.pipeline.tooth_contact import mesh_of

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")


def axle(**changes: Any) -> MachineCase:
    """The built-in axle without friction, at one load."""
    plain = {"friction": None, "lubricant": None, "load_cases": None,
             "meshes.axle.composite_roughness": None}  # fmt: skip
    case: MachineCase = td.load_case("hypoid-axle").replace(
        {**plain, **{key.replace("__", "."): value for key, value in changes.items()}}
    )
    return case


@pytest.fixture(scope="module")
def result() -> Any:
    return td.run(axle())


def test_bearings_balance_torques_and_teeth_in_space(result: Any) -> None:
    machine, motion = result.machine, result.motion
    mean = dict(zip(motion.bearing, motion.mean(motion.bearing_force), strict=True))
    force, moment = np.zeros(3), np.zeros(3)
    for name, load in mean.items():
        axes = machine.placement.axes[machine.bearings[name].shaft]
        force += axes @ load[:3]
        moment += axes @ load[3:] + np.cross(machine.placement.bearings[name], axes @ load[:3])
    ways = [machine.placement.axes[name][:, 0] for name in ("pinion", "wheel")]
    assert force == pytest.approx(np.zeros(3), abs=0.05)
    assert moment == pytest.approx(500.0 * ways[0] + 2150.0 * ways[1], abs=0.5)
    figures = result.summary()
    axial = [figures[f"bearings.{name}.mean_axial_force"] for name in ("rear", "head")]
    assert sum(axial) == pytest.approx(figures["meshes.axle.axial_force"], rel=2e-4)
    assert axial[1] < -1e4  # the drive side pushes the pinion away from its apex


def test_teeth_are_those_of_the_pair_with_the_mounting_errors_of_the_deflection(
    result: Any,
) -> None:
    errors, balance = result.operation.misalignment["axle"], result.operation.static.meshes["axle"]
    assert isinstance(errors, Misalignment)
    figures = result.summary()
    for name in ("offset", "pinion_axial", "wheel_axial", "shaft_angle"):
        assert figures[f"meshes.axle.{name}_error"] == getattr(balance.mounting, name)
    assert abs(errors.wheel_axial) > 1e-5
    pair = result.case.pair("axle", result.operation.load, errors)
    assert pair.gears.mounting.wheel_axial == errors.wheel_axial
    stored = result.operation.tables["axle"]
    np.testing.assert_array_equal(stored.mesh_stiffness, mesh_of(pair).mesh_stiffness)
    study = result.mounting_study("axle")
    assert study.wheel_axial.tolist() == [0.0, errors.wheel_axial]


def test_a_stated_mounting_adds_to_the_deflection(result: Any) -> None:
    errors = result.operation.misalignment["axle"]
    case = axle(meshes__axle__mounting__wheel_axial="50 um")
    pair = case.pair("axle", case.operating_point, errors)
    assert pair.gears.mounting.wheel_axial == pytest.approx(errors.wheel_axial + 50e-6)
    assert pair.gears.mounting.offset == errors.offset
    assert dict(case.values())["meshes.axle.mounting.wheel_axial"] == pytest.approx(50e-6)


def test_directory_and_case_file_give_the_same_result(result: Any, tmp_path: Path) -> None:
    again = td.load_result(result.save(tmp_path / "axle"))
    assert again.summary() == result.summary()
    assert again.operation.misalignment == result.operation.misalignment
    assert "contact with deflected shafts" in (tmp_path / "axle/report.html").read_text()
    case = td.load_case(tmp_path / "axle" / "case.toml")
    assert case.machine().directions["axle"].direction == pytest.approx(
        result.machine.directions["axle"].direction
    )


def test_the_torque_decides_which_side_of_the_teeth_carries() -> None:
    case = axle()
    assert case.pair("axle", case.operating_point).gears.side == "drive"
    back = axle(operation__speed="-1000 rpm")
    assert back.pair("axle", back.operating_point).gears.side == "coast"
    mirrored = axle(meshes__axle__hand_pinion="right")
    assert mirrored.pair("axle", mirrored.operating_point).gears.side == "coast"
    turned = axle(meshes__axle__apex_pinion="-x")
    assert turned.pair("axle", turned.operating_point).gears.side == "coast"
    speeds = [c.machine().kinematics.shafts["wheel"].speed for c in (case, turned)]
    assert speeds[1] == -speeds[0]


def test_a_deflection_beyond_the_range_of_the_teeth_names_the_mesh() -> None:
    soft = {f"bearings__{name}__{key}": None for name in ("rear", "head")
            for key in ("type", "bore_diameter", "outer_diameter", "width", "contact_angle",
                        "preload", "direction")}  # fmt: skip
    springs = {f"bearings__{name}__{key}_stiffness": "2e6 N/m" for name in ("rear", "head")
               for key in ("radial", "axial")}  # fmt: skip
    with pytest.raises(td.ComputationError, match=r"meshes\.axle: the deflection displaces"):
        td.run(axle(**soft, **springs))


@pytest.mark.slow
def test_a_driving_wheel_turns_the_coast_side_back_in_time() -> None:
    """The flank of the reversed pinion carries, at the same load; friction acts the other way."""
    rubbing = {"friction__law": "constant", "friction__coefficient": 0.05}
    loads = []
    for changes in (
        {"operation__speed": "-3000 rpm"},  # the pinion drives on its coast side
        {"operation__torque": "-500 N*m"},  # the wheel drives the same flank
    ):
        smooth, rough = (td.run(axle(**changes, **more)) for more in ({}, rubbing))
        assert smooth.case.pair("axle", smooth.case.operating_point).gears.side == "coast"
        loads.append((smooth, rough))
    mean = [[each.motion.mean(each.motion.mesh_force)[0] for each in pair] for pair in loads]
    assert mean[1][0] == pytest.approx(mean[0][0], rel=1e-4)
    bearings = [pair[0].motion.mean(pair[0].motion.bearing_force) for pair in loads]
    assert bearings[1][:, :3] == pytest.approx(bearings[0][:, :3], rel=2e-3, abs=20.0)
    # The torque of the pinion is the force over lever plus and minus that of the friction.
    levers = [smooth / rough for smooth, rough in mean]
    assert levers[0] > 1.02
    assert sum(levers) == pytest.approx(2.0, abs=2e-4)


def test_engine_and_load_are_coupled_in_the_case_file() -> None:
    tables = {key: value for key, value in axle().data.items() if key != "assumed"}
    tables["shafts"] = {**tables["shafts"], "engine": {"moment_of_inertia": "6000 kg*mm^2"}}
    tables["couplings"] = {"clutch": {"shafts": ["engine", "pinion"],
                                      "torsional_stiffness": "1e5 N*m/rad"}}  # fmt: skip
    tables["operation"] = {**tables["operation"], "input": "engine"}
    # A constant stiffness leaves no teeth, whose keys would have no effect.
    case = MachineCase(**tables).replace({"meshes.axle.stiffness": "5e8 N/m"})
    machine = case.machine()
    assert machine.kinematics.shafts["pinion"].torque == pytest.approx(500.0)
    assert machine.couplings["clutch"].torsional_stiffness == 1e5
    assert case.option_of("couplings.clutch.torsional_stiffness").unit == "N*m/rad"
    fields = CaseForm(case, {}, {}).options()
    assert fields["meshes.axle.offset"].unit == "m"
    assert "couplings.clutch.torsional_damping" in fields
    assert "meshes.axle.normal_module" not in fields


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"meshes.axle.side": "drive"}, r"meshes\.axle\.side.*unknown key"),
        ({"meshes.axle.cutter_radius": "20 mm"}, r"meshes\.axle\.cutter_radius.*limit curvature"),
        ({"meshes.axle.cutter_radius": None}, r"meshes\.axle\.cutter_radius.*missing"),
        ({"meshes.axle.apex_wheel": "x"}, r"meshes\.axle\.apex_wheel"),
        ({"meshes.axle.kind": "worm"}, r'^replace: meshes\.axle\.kind: kind = "worm"'),
        ({"meshes.axle.gears": [["z1"], "z2"]}, r"meshes\.axle\.gears"),
        ({"meshes.axle.gears": ["z2", "z1"]}, "meshes.axle"),
        ({"meshes.axle.normal_module": "5 mm"}, r"normal_module.*unknown key"),
        ({"gears.z1.profile_shift_coefficient": 0.3}, r"gears\.z1\.profile_shift_coefficient"),
    ],
)
def test_impossible_values_name_the_key(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(td.InputError, match=message):
        axle().replace(changes)


@pytest.mark.slow
def test_faults_of_hypoid_gears_are_those_of_the_pair() -> None:
    """At low speed an eccentricity is a line of its size, beside the lines of the sound mesh."""
    from tribodyn.study.faults.machine_motion import machine_turning_motion

    case = axle(operation__speed="60 rpm")
    sound = td.run(case).operation

    def lines(**fault: Any) -> np.ndarray:
        stated = {f"faults.f.{key}": value for key, value in {"gear": "z1", **fault}.items()}
        motion = machine_turning_motion(case.replace(stated), sound)
        assert motion.cycles == 10
        return np.abs(motion.harmonics("meshes.axle.transmission_error")[1])

    none = lines(kind="eccentricity", amplitude="1e-6 um")
    wave = lines(kind="waviness", order=3, amplitude="10 um")
    assert none[1:10].max() < 1e-10
    assert wave[3] == pytest.approx(10e-6, rel=5e-3)
    assert wave[[10, 20]] == pytest.approx(none[[10, 20]], rel=5e-3)
    assert wave[[1, 2, 4, 5, 6]].max() < 1e-8
    pitch = lines(kind="pitch-deviations", accuracy_class=6)
    assert pitch[1:10].max() > 1e-6
    with pytest.raises(InputError, match=r"faults\.f\.kind.*hypoid pair"):
        lines(kind="broken-tooth", tooth=1)
