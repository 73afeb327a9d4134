"""Faults in a machine: motion over whole turns, sensors, impacts of damaged bearings."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.unit.study.test_machine_run import GEARED

import tribodyn as td
from tribodyn.errors import InputError
from tribodyn.machine import Gear, Machine, Mesh, Operation, Shaft
from tribodyn.measurement import read, shaft_angle
from tribodyn.study import read_case
from tribodyn.study.faults.machine_motion import (
    machine_turning_motion,
    turning_machine,
)
from tribodyn.study.faults.machine_section import bearing_impacts, faults_of_mesh
from tribodyn.study.faults.machine_signals import impact_spectrum, pulse
from tribodyn.study.machine.first_look import warn_of_period

AXIS = {"kind": "eccentricity", "gear": "gears.z1", "amplitude": "2 um"}
DEFECT = {
    "kind": "bearing-defect", "bearing": "A", "place": "outer", "impact_force": "200 N",
    "rolling_elements": 9, "element_diameter": "7.94 mm", "pitch_diameter": "39.04 mm", "slip": 0.0,
}  # fmt: skip
RIPPLE = {"kind": "torque-ripple", "shaft": "input", "orders": [1.0], "torques": ["5 N*m"]}
#: A spur stage with computed teeth on the same shafts.
TEETH = {
    "gears.z1.teeth": 17, "gears.z2.teeth": 24, "meshes.first.helix_angle": "0 deg",
    "meshes.first.center_distance": None, "meshes.first.stiffness": None,
    "meshes.first.transmission_error_amplitude": None, "stiffness.model": "analytic",
    "film.model": "none", "friction.law": "constant", "friction.coefficient": 0.05,
    "dynamics.backlash": "60 um", "operation.speed": "900 rpm", "load_cases": None,
}  # fmt: skip
SEAT = {"dynamics.seat_mass": "10 kg", "dynamics.seat_frequency": "2 kHz"}


@cache
def result() -> Any:
    return td.run(read_case(GEARED))


def case_with(seat: bool = True, **faults: dict[str, Any]) -> Any:
    changes = {f"faults.{n}.{key}": v for n, fault in faults.items() for key, v in fault.items()}
    return result().case.replace({**changes, **(SEAT if seat else {})})


def motion_with(**faults: dict[str, Any]) -> Any:
    return machine_turning_motion(case_with(**faults), result().operation)


def test_lines_are_those_of_the_shafts() -> None:
    motion = motion_with(axis=AXIS)
    assert motion.turns["input"] == 1
    assert motion.cycles == 27
    assert repr(motion) == "MachineTurningMotion(0.02 s, turns: input 1, output 0.529412)"
    frequency, lines = motion.harmonics("bearings.A.force_y")
    size = np.abs(lines)
    tall = np.flatnonzero(size[:1000] > 1e-6 * size[1:].max())
    # a linear machine superposes the wave of the shaft and the harmonics of the mesh
    assert set(tall.tolist()) <= {0, 1, 27}
    assert frequency[1] == pytest.approx(3000 / 60)
    sound = np.abs(motion_with().harmonics("bearings.A.force_y")[1])
    assert size[27] == pytest.approx(sound[1], rel=1e-6)


def test_a_fault_of_no_size_changes_nothing_and_a_longer_clock_neither() -> None:
    sound = motion_with().signal("bearings.C.acceleration_30deg")[0]
    none = motion_with(axis={**AXIS, "amplitude": "0 um"})
    first = motion_with(axis={**AXIS, "amplitude": "1e-7 um"})
    other = motion_with(wheel={**AXIS, "gear": "z2", "amplitude": "1e-7 um"})
    assert (none.cycles, first.cycles, other.cycles) == (1, 27, 51)
    for motion in (none, first, other):
        values = motion.signal("bearings.C.acceleration_30deg")[0]
        expected = np.tile(sound, motion.cycles)
        np.testing.assert_allclose(values, expected, atol=1e-5 * np.ptp(sound))


def test_computed_teeth_with_a_fault_of_no_size_move_as_sound_ones() -> None:
    case = case_with().replace({**TEETH, "dynamics.friction_load": "dynamic"}, by="test")
    sound, sensor = td.run(case), "bearings.C.acceleration_30deg"

    def motion(amplitude: str) -> Any:
        fault = {"kind": "eccentricity", "gear": "z1", "amplitude": amplitude}
        stated = {f"faults.axis.{key}": value for key, value in fault.items()}
        return machine_turning_motion(case.replace(stated, by="test"), sound.operation)

    expected = machine_turning_motion(case, sound.operation).signal(sensor)[0]
    np.testing.assert_array_equal(motion("0 um").signal(sensor)[0], expected)
    # With a size the phases of the teeth are coarser; friction follows their load all the same.
    small = motion("1e-4 um")
    assert small.cycles == 17
    mesh = small.machine.meshes["first"]
    assert len(mesh.frictions) == len(sound.operation.machine.meshes["first"].frictions) > 0
    error = small.signal(sensor)[0].reshape(17, -1) - expected
    assert np.abs(error).max() < 0.02 * np.ptp(expected)


def test_a_long_period_is_announced() -> None:
    both = case_with(axis=AXIS, wheel={**AXIS, "gear": "z2"})
    machine = turning_machine(both, result().operation)
    with pytest.warns(td.ModelWarning, match=r"459 cycles of mesh first .* unequal teeth"):
        warn_of_period(machine)


def test_a_wave_is_that_of_the_forced_response() -> None:
    from tribodyn.dynamics import forced_response

    wave = {"kind": "waviness", "gear": "z2", "amplitude": "2 um", "order": 64, "phase": "0 deg"}
    motion = motion_with(wave=wave)
    frequency, lines = motion.harmonics("meshes.first.mesh_force")
    assert frequency[64] == pytest.approx(64 * 3000 / 60 * 27 / 51)
    forced = forced_response(result().operation.system, frequency[64:65], error=-2e-6)
    assert lines[64] == pytest.approx(forced.mesh_force[0], rel=2e-3)


def test_impacts_reach_the_sensor_through_the_structure() -> None:
    motion = motion_with(outer=DEFECT)
    system, structure = result().operation.system, result().structure
    frequency = np.array([130.0, 640.0, 2100.0])
    place = motion.places.place("bearings.C.force_z")
    spectrum = impact_spectrum(motion, "A", place, frequency)
    across = motion.sound.motion.mean(motion.sound.motion.bearing_force[:, 2])[1:3]
    load = -structure.bearing("A").T @ np.array([0.0, *across / np.hypot(*across), 0, 0, 0])
    contact = structure.mesh("first")
    for hertz, value in zip(frequency, spectrum, strict=True):
        omega = 2 * np.pi * hertz
        stiffness = system.stiffness + 5.2e8 * np.outer(contact, contact)
        damper = system.rate_matrix + system.contacts[0].damping * np.outer(contact, contact)
        moved = np.linalg.solve(stiffness - omega**2 * system.mass + 1j * omega * damper, load)
        expected = 5e8 * (structure.bearing("C") @ moved)[2]
        assert value == pytest.approx(expected, rel=1e-6)
    seat = impact_spectrum(motion, "A", motion.places.place("bearings.C.acceleration_z"), frequency)
    ratio = frequency / 2000.0
    np.testing.assert_allclose(
        seat / spectrum, -(ratio**2) / (10.0 * (1 - ratio**2 + 0.1j * ratio)), rtol=1e-9
    )


def test_half_a_sine_has_its_spectrum() -> None:
    time = (np.arange(4000) + 0.5) * 1e-3 / 4000
    force = 20.0 * np.sin(np.pi * time / 1e-3)
    for hertz in (0.0, 300.0, 500.0, 1700.0):
        expected = np.sum(force * np.exp(-2j * np.pi * hertz * time)) * 1e-3 / 4000
        assert pulse(np.array([hertz]), 20.0, 1e-3)[0] == pytest.approx(expected, abs=1e-8)


def test_a_recording_has_the_frequency_of_the_bearing(tmp_path: Path) -> None:
    damaged = td.run(case_with(outer=DEFECT))
    names = ["bearings.A.acceleration_y", "bearings.C.force_30deg"]
    recording = damaged.recording(names, 2.0, 12_800.0, tacho="output", seed=3)
    quiet = td.run(case_with(outer={**DEFECT, "impact_force": "0 N"}))
    quiet = quiet.recording(names, 2.0, 12_800.0, tacho="output", seed=3)
    impacts = bearing_impacts(damaged.case, damaged.case.faults["outer"])
    rate = impacts.frequency(3000 / 60)
    assert rate == pytest.approx(4.5 * 50.0 * (1 - 7.94 / 39.04))
    for name in names:
        added = recording[name] - quiet[name]
        size = np.abs(np.fft.rfft(added * np.hanning(added.size)))
        line = np.fft.rfftfreq(added.size, 1 / 12_800.0)
        near = np.abs(line / rate - np.round(line / rate)) * rate < 2.0
        assert (size[near & (line > 100.0)] ** 2).sum() > 0.98 * (size[line > 100.0] ** 2).sum()
    edges = np.flatnonzero(np.diff(recording["tacho"]) > 0.0) / 12_800.0
    assert np.diff(edges).mean() == pytest.approx(51 / 27 / 50.0, rel=1e-3)
    saved = read(recording.save(tmp_path / "machine.h5", truth={"fault": "outer"}))
    np.testing.assert_allclose(saved[names[0]], recording[names[0]], atol=1e-6)


def test_a_wrong_name_hides_no_other_fault() -> None:
    with pytest.raises(InputError) as caught:
        case_with(
            named={**AXIS, "gear": "z9"},
            other={**DEFECT, "element_diameter": "50 mm"},
            kind={"kind": "crack", "gear": "z1", "tooth": 1, "depth": "1 mm"},
        )
    keys = [str(problem.where) for problem in caught.value.problems]
    assert all(any(key in each for each in keys) for key in ("named.gear", "kind.kind"))
    assert any("other" in each for each in keys)


def test_a_damaged_tooth_is_counted_on_the_gear_of_the_machine() -> None:
    crack = {"kind": "crack", "gear": "z2", "tooth": 38, "depth": "1 mm"}
    gears = {n: {"shaft": s, "teeth": z, "face_width": "20 mm"}
             for n, s, z in (("z1", "in", 23), ("z2", "out", 37))}  # fmt: skip
    with pytest.raises(InputError, match=r"tooth = 38\. z2 has 37 teeth, 1 to 37"):
        td.Case(
            gears=gears,
            meshes={"one": {"gears": ["z1", "z2"], "normal_module": "3 mm"}},
            operation={"input": "in", "output": "out", "speed": "900 rpm", "torque": "20 N*m"},
            faults={"crack": crack},
        )


@pytest.mark.parametrize(
    ("faults", "expected"),
    [
        (
            {"f": {**RIPPLE, "shaft": "middle"}},
            r"faults\.f\.shaft.*no shaft \"middle\".*input, output",
        ),
        (
            {"f": {**RIPPLE, "orders": [0.33333]}},
            r"faults\.f\.orders.*nearest order that does is 1/3",
        ),
        ({"f": {**RIPPLE, "gear": "z1"}}, r"faults\.f\.gear.*has: shaft, orders"),
        ({"f": {**AXIS, "gear": "z9"}}, r"faults\.f\.gear.*no gear \"z9\".*z1, z2"),
        ({"f": {**AXIS, "tooth": 1}}, r"faults\.f\.tooth.*has: gear, amplitude"),
        (
            {"f": {"kind": "crack", "gear": "z1", "tooth": 1, "depth": "1 mm"}},
            r"faults\.f\.kind.*constant stiffness",
        ),
        ({"f": {**DEFECT, "pitch_diameter": None}}, r"faults\.f\.pitch_diameter.*no type"),
        ({"f": {**DEFECT, "element_diameter": "50 mm"}}, r"element_diameter = 50 mm"),
    ],
)
def test_a_wrong_fault_names_its_key(faults: dict[str, Any], expected: str) -> None:
    with pytest.raises(InputError, match=expected):
        case_with(**faults)


def test_faults_are_written_and_read_back() -> None:
    case = case_with(axis=AXIS, outer=DEFECT)
    again = read_case(case.to_toml())
    assert dict(again.values()) == dict(case.values())
    assert again.faults == case.faults


def test_a_rigid_seat_does_not_accelerate() -> None:
    with pytest.raises(InputError, match="seat_mass and seat_frequency"):
        result().recording("bearings.A.acceleration_y", 0.1)
    with pytest.raises(InputError, match=r"The sensors are bearings\.A\.force_y, .*B\.force_y"):
        result().recording("bearings.A.accel_y", 0.1)
    with pytest.raises(InputError, match="Known: input, output"):
        result().recording("bearings.A.force_y", 0.1, tacho="middle")


def test_an_idler_is_eccentric_in_one_direction() -> None:
    shafts = {name: Shaft() for name in "abc"}
    gears = {n: Gear(n, 0.0, z, 0.02) for n, z in zip("abc", (20, 30, 25), strict=True)}
    meshes = {
        "ab": Mesh(("a", "b"), 2e-3, stiffness=1e8),
        "bc": Mesh(("b", "c"), 2e-3, stiffness=1e8, angle=0.7),
    }
    machine = Machine(shafts, gears, meshes, operation=Operation("a", "c", 100.0, 50.0))
    tables = read_case(
        GEARED.replace("z1", "a").replace("z2", "b") + '[faults.f]\nkind = "eccentricity"\n'
        'gear = "b"\namplitude = "1 um"\nphase = "20 deg"\n'
    ).faults
    names = {"faults": tables, "stages": {}, "_pinion_and_wheel": lambda _, mesh: tuple(mesh)}
    idler: Any = type("Idler", (), names)()
    (first,), (second,) = (faults_of_mesh(idler, machine, mesh) for mesh in ("ab", "bc"))
    assert (first.gear, second.gear) == ("wheel", "pinion")
    pushes = (-machine.directions["ab"].normal, machine.directions["bc"].normal)
    sense = np.sign(machine.kinematics.shafts["b"].speed)
    start = np.arctan2(pushes[0][2], pushes[0][1])
    for angle in (0.0, 1.0, 2.5):
        # the axis of the toothing circles with the shaft, towards the mate where the wave is high
        place = start + sense * (angle + first.phase)
        moved = np.array([0.0, np.cos(place), np.sin(place)])
        across = [moved @ push / np.hypot(*push[1:]) for push in pushes]
        waves = [np.cos(angle + fault.phase) for fault in (first, second)]
        np.testing.assert_allclose(waves, across, atol=1e-12)


@pytest.mark.slow
def test_a_cracked_tooth_shows_on_its_shaft_alone() -> None:
    from tribodyn.signals import condition_indicators, time_synchronous_average

    crack = {"kind": "crack", "gear": "z1", "tooth": 5, "depth": "2.5 mm"}
    stated = {f"faults.crack.{key}": value for key, value in crack.items()}
    cracked = td.run(case_with().replace({**TEETH, **stated}, by="test"))
    sensor = "bearings.B.acceleration_y"
    recording = cracked.recording(sensor, 4.0, 12_800.0, noise=0.05, speed_fluctuation=1e-3, seed=1)
    rate = recording.sample_rate
    angle = shaft_angle(recording["tacho"], rate, 1)
    time = np.arange(angle.size) / rate
    fm4 = {}
    for gear, teeth in (("z1", 17), ("z2", 24)):
        average = time_synchronous_average(
            recording[sensor], time, teeth=teeth, rotation=angle * 17 / teeth,
            mesh_harmonics=3,
        )  # fmt: skip
        fm4[gear] = condition_indicators(average).fm4
    assert fm4["z1"] > 9.0 > 6.5 > fm4["z2"]


def test_a_ripple_on_a_shaft_forces_the_machine_at_its_order() -> None:
    from tribodyn.dynamics.linear.linear_system import linear_system

    engine = {
        "kind": "torque-ripple", "shaft": "input", "orders": [1.0, 3.0],
        "torques": ["20 N*m", "8 N*m"], "phases": ["0 deg", "40 deg"],
    }  # fmt: skip
    motion, system = motion_with(engine=engine), result().operation.system
    frequency, lines = motion.harmonics("meshes.first.mesh_force")
    assert frequency[1] == pytest.approx(50.0)
    linear, contact = linear_system(system), system.contacts[0]
    place = result().structure.at("input", 0.0)[3]
    for order, torque in ((1, 20.0), (3, 8.0 * np.exp(1j * np.radians(40.0)))):
        omega = 2.0 * np.pi * 50.0 * order
        dynamic = linear.stiffness - omega**2 * linear.mass
        dynamic = dynamic + 1j * omega * (linear.damping + linear.gyroscopic)
        moved = contact.direction @ np.linalg.solve(dynamic, torque * place)
        force = (contact.stiffness + 1j * omega * contact.damping) * moved
        assert lines[order] == pytest.approx(force, rel=1e-4)
    # the clock of half an order is twice as long, and a fault of no size changes nothing
    none = motion_with(engine={**engine, "orders": [0.5, 1.0], "torques": ["0 N*m", "0 N*m"]})
    assert (none.cycles, none.rotation_frequency("input")) == (54, pytest.approx(50.0))
    sound = motion_with().signal("meshes.first.mesh_force")[0]
    values = none.signal("meshes.first.mesh_force")[0]
    np.testing.assert_allclose(values, np.tile(sound, 54), atol=1e-5 * np.ptp(sound))


def test_a_fluctuating_shaft_modulates_the_mesh_and_shows_in_the_tacho() -> None:
    from scipy.special import jv

    from tribodyn.dynamics import forced_response
    from tribodyn.study.faults.recording import Scatter, recording_of

    joint = {
        "kind": "speed-fluctuation",
        "shaft": "output",
        "orders": [2.0],
        "fluctuations": [0.02],
    }
    motion = motion_with(joint=joint)
    frequency, lines = motion.harmonics("meshes.first.mesh_force")
    assert (motion.cycles, frequency[102 // 4]) == (51, pytest.approx(25 * 1350.0 / 51))
    sound = motion_with().harmonics("meshes.first.mesh_force")[1][1]
    index = 51 * 0.02 / 2.0
    at = np.array([47.0, 49.0, 51.0, 53.0]) * 1350.0 / 51
    system = result().operation.system
    receptance = forced_response(system, at, error=1e-6).mesh_force
    sides = np.abs(receptance / receptance[2]) * jv([2, 1, 0, 1], index) * abs(sound)
    np.testing.assert_allclose(np.abs(lines[[47, 49, 51, 53]]), sides, rtol=2e-3)
    ahead = 0.02 * 51 / 2.0 / (2.0 * np.pi)  # cycles, so that a quarter of a turn differs most
    clock = np.arange(8) / 8 / 2
    ahead_of = motion.lead_at(clock * motion.period)
    np.testing.assert_allclose(ahead_of, ahead * np.sin(4 * np.pi * clock), atol=1e-12)
    # a turn of the input is 27 of the 51 cycles in which the speed changes twice
    tacho = recording_of(motion, [], "meshes.first.mesh_force", 1.0, 409_600.0, Scatter(0, 0, 0, 1))
    edges = np.flatnonzero(np.diff(tacho["tacho"]) > 0.0) / 409_600.0
    step = 2.0 * ahead / 27 * abs(np.sin(2.0 * np.pi * 27 / 51))
    assert np.ptp(np.diff(edges)) * 50.0 == pytest.approx(2.0 * step, rel=0.1)


def test_a_labelled_set_of_a_machine(tmp_path: Path) -> None:
    from tribodyn.cli import call

    case = tmp_path / "geared.toml"
    text = case_with(outer=DEFECT).to_toml()
    case.write_text(text, encoding="utf-8")
    options = ["--sensor", "bearings.A.force_y", "--duration", "0.5 s", "--sample-rate", "8000 Hz"]
    command = ["recording", str(case), "faults.outer.impact_force=0,400 N", "--repeats", "2"]
    assert call([*command, *options, "--out", str(tmp_path / "set")]) == 0
    over = {"faults.outer.impact_force": ["0 N", "400 N"]}
    labelled = td.study.record_set(
        td.load_case(case), tmp_path / "set", over, sensor="bearings.A.force_y", duration=0.5,
        sample_rate=8000.0, repeats=2,
    )  # fmt: skip
    assert [label["faults.outer.impact_force"] for label in labelled.labels] == [0, 0, 400, 400]
    assert {*labelled[2].channels} == {"bearings.A.force_y", "tacho"}
    spread = [float(np.abs(recording["bearings.A.force_y"]).max()) for _, recording in labelled]
    assert min(spread[2:]) > 1.01 * max(spread[:2])
    assert call(["recording", str(case), *options, "--out", str(tmp_path / "one.h5")]) == 0
    assert '"impact_force": 200.0' in (tmp_path / "one.json").read_text("utf-8")


def rigid_shafts() -> Any:
    """The same gears on rigid shafts, without excitation by the mesh."""
    lines = [
        line for line in GEARED.splitlines() if not line.startswith(("sections", "transmission"))
    ]
    return td.run(read_case("\n".join(lines)).replace({"operation.torque": "5 N*m"}))


def test_a_loose_seat_lifts_once_a_turn() -> None:
    """A piecewise linear support against a march of the equations by hand."""
    run = rigid_shafts()
    sound, structure, system = run.operation, run.structure, run.operation.system
    torque = {**RIPPLE, "orders": [5.0], "torques": ["20 N*m"]}
    loose = {"kind": "looseness", "bearing": "A", "stiffness_share": 0.25, "press_angle": "-91 deg"}

    def motion_of(**faults: dict[str, Any]) -> Any:
        stated = {f"faults.{n}.{k}": v for n, fault in faults.items() for k, v in fault.items()}
        return machine_turning_motion(run.case.replace(stated), sound)

    def forces_of(motion: Any) -> np.ndarray:
        return np.asarray(motion.signal("bearings.A.force_-91deg")[0])

    expected = forces_of(motion_of(motor=RIPPLE))
    pressed = forces_of(motion_of(motor=RIPPLE, seat=loose))  # its load never falls to zero
    np.testing.assert_allclose(pressed, expected, atol=1e-6)
    motion = motion_of(motor=torque, seat=loose)
    force = forces_of(motion)
    assert 0.05 < np.mean(force < 0.0) < 0.95
    # M q'' + C q' + K q = f, with the stiffness of the seat by the sign of its displacement
    along = np.array([0.0, np.cos(np.radians(91.0)), -np.sin(np.radians(91.0)), 0.0, 0.0, 0.0])
    row, contact = along @ structure.bearing("A"), system.contacts[0]
    mesh = np.outer(contact.direction, contact.direction)
    stiffness = system.stiffness + contact.stiffness * mesh
    damping = system.damping + system.gyroscopic + contact.damping * mesh
    inverse, place = np.linalg.inv(system.mass), structure.at("input", 0.0)[3]
    step, per_turn = 0.02 / 1000, 1000
    drive = np.outer(20.0 * np.cos(10 * np.pi * np.arange(2 * per_turn) / (2 * per_turn)), place)

    def rate(state: np.ndarray, load: np.ndarray) -> np.ndarray:
        q, v = np.split(state, 2)
        lifted = 0.75 * 4e8 * min(float(row @ q), 0.0) * row
        return np.concatenate([v, inverse @ (load - stiffness @ q - damping @ v + lifted)])

    state, moved = np.concatenate([np.linalg.pinv(stiffness) @ system.force, 0.0 * row]), []
    for turn in range(10):
        for i in range(per_turn):
            loads = [
                system.force + drive[k % (2 * per_turn)] for k in (2 * i, 2 * i + 1, 2 * i + 2)
            ]
            a = rate(state, loads[0])
            b = rate(state + 0.5 * step * a, loads[1])
            c = rate(state + 0.5 * step * b, loads[1])
            d = rate(state + step * c, loads[2])
            if turn == 9:
                moved.append(float(row @ state[: row.size]))
            state = state + step / 6.0 * (a + 2.0 * b + 2.0 * c + d)
    marched = 4e8 * (np.array(moved) - 0.75 * np.minimum(moved, 0.0))
    lines = [2.0 * np.fft.rfft(x)[[5, 10, 15]] / x.size for x in (force, marched)]
    np.testing.assert_allclose(*lines, atol=5e-4 * np.abs(lines[1]).max())
    assert abs(lines[1][1]) > 0.02 * abs(lines[1][0])  # twice the order
    with pytest.raises(InputError, match=r"faults\.f\.stiffness_share.*missing"):
        case_with(f={"kind": "looseness", "bearing": "A"})


def test_a_drive_whose_shafts_slide_freely_along_their_axes_turns_all_the_same(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    from tribodyn.study.faults import driven_shafts

    spur = {
        "meshes.first.helix_angle": None, "meshes.first.hand": None, "load_cases": None,
        "meshes.first.center_distance": None,
    }  # fmt: skip
    loose = {f"bearings.{name}.axial_stiffness": None for name in "AC"}
    uneven = {
        "kind": "speed-fluctuation", "shaft": "output", "orders": [2], "fluctuations": [0.01],
    }  # fmt: skip
    stated = {f"faults.motor.{key}": value for key, value in uneven.items()}

    def force(changes: dict[str, Any]) -> np.ndarray:
        run = td.run(result().case.replace({**spur, **stated, **changes}, by="test"))
        return np.asarray(run.turning_motion.signal("meshes.first.mesh_force")[0])

    held = force({})
    assert np.ptp(held) > 50.0
    np.testing.assert_allclose(force(loose), held, atol=1e-6 * held.max())
    motions = driven_shafts.free_motions
    turned = np.linalg.qr(np.random.default_rng(1).standard_normal((3, 3)))[0]
    monkeypatch.setattr(driven_shafts, "free_motions", lambda system: motions(system) @ turned)
    np.testing.assert_allclose(force(loose), held, atol=1e-6 * held.max())
