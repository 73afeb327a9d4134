"""Machines with faults whose motion has no short period: phases of meshes and shafts."""

from __future__ import annotations

import re
from functools import cache
from typing import Any

import numpy as np
import pytest
from tests.unit.study.test_machine_phases import case

import tribodyn as td
from tribodyn.dynamics import PhaseResponse
from tribodyn.study.faults.clock import check_motion, excitations_of, fault_cost
from tribodyn.study.faults.machine_motion import (
    _work,
    machine_turning_motion,
    rehearse_faults,
)
from tribodyn.study.machine.run import rehearse_machine

SPEED = 1000.0 / 60.0
SHORT = {"z1": 20, "z2": 24, "z3": 15, "z4": 25}
RIPPLE = {"kind": "torque-ripple", "shaft": "in", "orders": [0.5, 2.0], "torques": [0.3, 0.4]}


def eccentric(*gears: str) -> dict[str, Any]:
    """Faults of gears, each of another size."""
    return {
        f"of_{gear}": {
            "kind": "eccentricity", "gear": gear, "amplitude": f"{3 + n} um",
            "phase": f"{50 * n} deg",
        }
        for n, gear in enumerate(gears)
    }  # fmt: skip


def with_faults(base: Any, **faults: dict[str, Any]) -> Any:
    changes = {f"faults.{n}.{key}": v for n, fault in faults.items() for key, v in fault.items()}
    return base.replace(
        {**changes, "dynamics.seat_mass": "10 kg", "dynamics.seat_frequency": "2 kHz"}
    )


@cache
def sound(phases: str = "auto") -> Any:
    return td.run(case(SHORT, phases=phases))


@cache
def hunting() -> Any:
    """An eccentric gear on each of the shafts of two hunting stages."""
    faulty = with_faults(
        case({"z1": 19, "z2": 23, "z3": 17, "z4": 31}), **eccentric("z1", "z2", "z3", "z4")
    )
    return td.run(faulty)


def motion_of(phases: str, **faults: dict[str, Any]) -> Any:
    faulty = with_faults(case(SHORT, phases=phases), **faults)
    return machine_turning_motion(faulty, sound().operation)


def assert_same_lines(phased: Any, clocked: Any, sensor: str, part: float = 1e-4) -> None:
    """Lines over phases are those of the period, but for a part of the largest."""
    frequency, lines = clocked.harmonics(sensor)
    at, values = phased.harmonics(sensor)
    size = np.abs(lines[1:]).max()
    spacing = frequency[1]
    assert (np.diff(at) > 1e-6 * spacing).all()  # phases in a ratio share lines of the period
    strong = np.abs(values) > part * size
    number = np.rint(at[strong] / spacing).astype(int)
    assert at[strong] == pytest.approx(number * spacing, abs=1e-6 * spacing)
    total = np.zeros(number.max() + 1, dtype=complex)
    total[number] = values[strong]
    expected = lines[: total.size]
    assert np.abs(total - expected).max() < 2.0 * part * size


def test_each_shaft_has_its_phase_and_its_sidebands() -> None:
    motion = hunting().turning_motion
    assert isinstance(motion.response, PhaseResponse)
    shafts = {"in": SPEED, "shaft1": SPEED * 19 / 23, "out": SPEED * 19 / 23 * 17 / 31}
    meshes = {"mesh1": SPEED * 19, "mesh2": SPEED * 19 / 23 * 17}
    lines = {line.cause: line.frequency for line in motion.lines("meshes.mesh1.mesh_force")}
    for name, frequency in {**shafts, **meshes}.items():
        assert lines[f"1 x {name}"] == pytest.approx(frequency, rel=1e-12)
    assert set(lines) == {f"1 x {name}" for name in (*shafts, *meshes)}  # it is linear


def test_lines_are_those_of_the_period_where_there_is_one() -> None:
    faults = eccentric("z1", "z2", "z3", "z4")
    phased, clocked = (motion_of(phases, **faults) for phases in ("on", "off"))
    assert isinstance(phased.response, PhaseResponse)
    assert not isinstance(clocked.response, PhaseResponse)
    for sensor in ("meshes.mesh1.mesh_force", "meshes.mesh2.transmission_error"):
        assert_same_lines(phased, clocked, sensor)


@pytest.mark.slow
def test_a_mesh_feels_the_teeth_of_another_that_differ() -> None:
    """Few points over each of their cycles suffice for it."""
    of_mesh = ("stiffness", "transmission_error_amplitude")
    motions = []
    for phases in ("on", "off"):
        teeth = case(SHORT, phases=phases).replace({
            **{f"meshes.mesh1.{key}": None for key in of_mesh}, "stiffness.model": "analytic",
            "dynamics.backlash": "0.2 mm",
        })  # fmt: skip
        pitch = {"kind": "pitch-deviations", "gear": "z1", "accuracy_class": 8}
        faulty = with_faults(teeth, pitch=pitch)
        motions.append(machine_turning_motion(faulty, td.run(faulty).operation))
    phased, clocked = motions
    assert isinstance(phased.response, PhaseResponse)
    deviations = [
        np.sqrt(each.mean((each.mesh_force - each.mean(each.mesh_force)) ** 2))
        for each in (phased.motion, clocked.motion)
    ]
    assert deviations[0] == pytest.approx(deviations[1], rel=1e-2)


@cache
def stages() -> Any:
    """A planetary stage before two pairs, with computed teeth."""
    gears = {
        "sun": {"shaft": "low", "teeth": 21, "face_width": 0.25},
        "planet": {"teeth": 33, "face_width": 0.25},
        "ring": {"shaft": "held", "teeth": -87, "face_width": 0.25},
    }
    shafts = ["low", "middle", "middle", "high"]
    for n, (teeth, shaft) in enumerate(zip((97, 25, 91, 29), shafts, strict=True)):
        place = {"position": 0.1 * (n + 1)}
        gears[f"z{n}"] = {"shaft": shaft, "teeth": teeth, "face_width": 0.1, **place}
    pairs = {f"mesh{n}": {"gears": [f"z{2 * n}", f"z{2 * n + 1}"], "normal_module": 8e-3}
             for n in (0, 1)}  # fmt: skip
    stage = {"sun": "sun", "ring": "ring", "planet": "planet", "carrier": "rotor", "count": 3}
    run = {"input": "rotor", "output": "high", "speed": "15 rpm", "torque": "90 kN*m"}
    return td.study.MachineCase(
        gears=gears, meshes=pairs, planets={"stage": {**stage, "normal_module": 11e-3}},
        stiffness={"model": "iso6336"}, operation=run,
    )  # fmt: skip


@pytest.mark.parametrize("gear", ["sun", "planet", "z3"])
def test_a_cracked_tooth_of_a_train_of_three_stages_needs_no_phase_more(gear: str) -> None:
    """With one more for the shaft it would take three times the memory."""
    crack = {"kind": "crack", "gear": gear, "tooth": 1, "depth": "3 mm"}
    faulty = with_faults(stages(), crack=crack)  # within the default memory
    cost = fault_cost(faulty, faulty.machine())
    assert len(cost.phases) == 3
    assert cost.memory < 3e9


def test_a_ripple_leads_the_meshes_over_its_own_phase() -> None:
    phased, clocked = (motion_of(phases, ripple=RIPPLE) for phases in ("on", "off"))
    assert phased.ahead is not None
    for sensor in ("meshes.mesh1.mesh_force", "meshes.mesh2.mesh_force"):
        assert_same_lines(phased, clocked, sensor, 1e-3)
    causes = {line.cause for line in phased.lines("meshes.mesh1.mesh_force", 8)}
    assert {"1/2 x in", "2 x in", "1 x mesh1 + 1/2 x in", "1 x mesh1 - 1/2 x in"} <= causes
    time = np.linspace(0.0, 0.3, 50)
    ahead = clocked.lead_at(time)
    start = clocked.lead_at(np.zeros(1))
    scale = phased.mesh_frequency / clocked.mesh_frequency
    assert phased.lead_at(time) == pytest.approx(scale * (ahead - start), abs=1e-3 * np.ptp(ahead))


def test_recordings_of_any_length_are_sums_of_the_lines() -> None:
    result = hunting()
    sensor = "meshes.mesh2.mesh_force"
    rate, seconds = 2000.0, 40.0  # the hunting period is 43 s
    recording = result.recording(sensor, seconds, rate, seed=3)
    values = np.asarray(recording[sensor])
    assert values.size == rate * seconds
    window = np.hanning(values.size)
    spectrum = np.abs(np.fft.rfft(values * window)) * 4.0 / values.size
    frequency, lines = result.turning_motion.harmonics(sensor)
    place = np.fft.rfftfreq(values.size, 1.0 / rate)
    passed = (frequency > 1.0) & (frequency < 0.35 * rate)
    for hertz, size in zip(frequency[passed], np.abs(lines[passed]), strict=True):
        if size > 1e-3 * np.abs(lines[1:]).max():
            near = np.abs(place - hertz) < 0.1
            assert spectrum[near].max() == pytest.approx(size, rel=0.16)  # a window between lines
    pulses = np.asarray(recording["tacho"])
    assert np.count_nonzero(np.diff(pulses) > 0) == pytest.approx(SPEED * seconds, abs=1.0)


def test_costs_are_stated_and_refused_before_the_run() -> None:
    faulty = hunting().case
    text = " ".join(check_motion(faulty))
    assert "With its faults" in text
    assert "5 phases" in text
    small = faulty.replace({"solver.memory": "100 MB"})
    with pytest.raises(td.ComputationError, match=r"allowed by solver.memory"):
        fault_cost(small, small.machine())


def test_the_trial_has_the_phases_of_what_drives() -> None:
    """More points over the phase of the ripple change the motion of both meshes."""
    once = {**RIPPLE, "orders": [0.5], "torques": [0.3]}
    faulty = with_faults(case(SHORT, phases="on"), ripple=once)
    excited = excitations_of(faulty)
    work = _work(rehearse_machine(faulty).structure(faulty), excited)
    (ripple,) = {each[1] for each in work.changes} - {each[0] for each in work.changes}
    assert ripple == pytest.approx(0.5 * SPEED)
    changes = [change for _, over, change, _ in work.changes if over == ripple]
    assert len(changes) == 2
    assert all(change > 0.0 for change in changes)


def needed(faulty: Any) -> float:
    """Memory of the motion over phases [GB]; zero on one clock."""
    cost = fault_cost(faulty, faulty.machine())
    return 1e-9 * cost.memory if cost else 0.0


def refusal(faulty: Any) -> str:
    """Why a motion is refused."""
    with pytest.raises(td.ComputationError, match=r"solver\.memory") as refused:
        fault_cost(faulty, faulty.machine())
    return str(refused.value)


def test_a_refusal_names_the_faults_without_which_the_motion_fits() -> None:
    faulty = hunting().case
    tight = faulty.replace({"solver.memory": 0.99e9 * needed(faulty)})
    ((name, least),) = re.findall(
        r"fewer faults: without (\w+) it takes about (\S+) GB", refusal(tight)
    )
    fits = tight.replace({f"faults.{name}": None})
    assert needed(fits) == pytest.approx(float(least), rel=5e-3)


def test_a_refusal_names_no_faults_that_do_not_help() -> None:
    faulty = hunting().case.replace({"solver.phases": "on"})
    sound = faulty.replace({f"faults.{name}": None for name in faulty.faults})
    for each in (faulty, sound):
        text = refusal(each.replace({"solver.memory": 0.5e9 * needed(sound)}))
        assert text.endswith("Raise solver.memory, or compute a part of the machine.")


def test_teeth_that_would_be_clamped_name_their_mesh_before_the_run() -> None:
    base = case({"z1": 29, "z2": 71, "z3": 23, "z4": 67})
    computed = {
        f"meshes.mesh{n}.{key}": None
        for n in (1, 2)
        for key in ("stiffness", "transmission_error_amplitude")
    }
    narrow = base.replace(
        {
            **computed, "stiffness.model": "analytic", "dynamics.backlash": "2 um",
            "faults.pitch.kind": "pitch-deviations", "faults.pitch.gear": "z3",
            "faults.pitch.accuracy_class": 8,
        }
    )  # fmt: skip
    crack = {"kind": "crack", "gear": "z2", "tooth": 1, "depth": "1 mm"}
    pitch = {"kind": "pitch-deviations", "gear": "z3", "accuracy_class": 8}
    listed = narrow.replace({"faults": [crack, pitch]})
    for faulty in (narrow, listed):
        with pytest.raises(td.InputError, match=r"mesh mesh2: a pair touches .* um before"):
            rehearse_faults(faulty, rehearse_machine(faulty))


@pytest.mark.slow
def test_a_run_up_over_phases_passes_steady_motions() -> None:
    levels = td.run_up(case(SHORT, phases="on"), ("900 rpm", "1000 rpm"), 2.0)
    assert levels.speed[[0, -1]] * 30.0 / np.pi == pytest.approx([900.0, 1000.0])
    assert levels.time[-1] == pytest.approx(2.0)
    steady = sound("on").motion
    expected = steady.rms(steady.mesh_force)
    assert levels.mesh_force[-1] == pytest.approx(expected, rel=1e-3)
