"""Faults of a planetary stage: waves of its gears, and the sensor that planets pass."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import tribodyn as td
from tribodyn.errors import InputError
from tribodyn.study.faults.machine_motion import RingPlace, machine_turning_motion
from tribodyn.study.faults.machine_section import faults_of_mesh

QUICK = {
    "film.model": "dowson-higginson", "friction.law": "constant", "friction.coefficient": 0.05,
    "load_cases": None, "planets.low.sun_support": "1e9 N/m", "dynamics.seat_mass": "20 kg",
    "dynamics.seat_frequency": "1.5 kHz",
}  # fmt: skip


@pytest.fixture(scope="module")
def result() -> Any:
    return td.run(td.load_case("planetary-stage").replace(QUICK, by="test"))


def with_fault(result: Any, **fault: Any) -> Any:
    return result.case.replace({f"faults.f.{key}": value for key, value in fault.items()})


@pytest.mark.parametrize(
    ("gear", "driver"),
    [("sun", "sun"), ("planet", "sun"), ("ring", "sun"), ("planet", "carrier")],
)
def test_an_eccentric_gear_moves_as_its_axis_would(result: Any, gear: str, driver: str) -> None:
    case = with_fault(result, kind="eccentricity", gear=gear, amplitude="2 um", phase="25 deg")
    if gear == "planet":
        case = case.replace({"faults.f.planet": 2})
    if driver == "carrier":
        case = case.replace({"operation.input": "carrier", "operation.output": "sun"})
    machine, name = case.machine(), {"planet": "low_planet2"}.get(gear, gear)
    meshes = [mesh for mesh in machine.meshes if name in machine.meshes[mesh].gears]
    assert len(meshes) == (2 if gear == "planet" else 3)
    offsets = []
    for mesh in meshes:
        (wave,) = faults_of_mesh(case, machine, mesh)
        place = machine.meshes[mesh].gears.index(name)
        along = machine.directions[mesh].direction[6 * place + 1 : 6 * place + 3]
        speed = machine.kinematics.meshes[mesh].speeds[place]
        turned = 2.0 * np.pi * machine.meshes[mesh].offset / abs(machine.gears[name].teeth)
        # a gap -A cos(angle + phase) is a displacement of the axis whose direction turns
        angle = np.sign(speed) * (wave.phase + turned)  # where the clock begins
        offsets.append(np.arctan2(along[1], along[0]) + angle)
    for offset in offsets:
        assert np.cos(offset - offsets[0]) == pytest.approx(1.0, abs=1e-9)


def line(motion: Any, sensor: str, frequency: float) -> complex:
    """Amplitude at a frequency; zero where there is no line."""
    at, lines = motion.harmonics(sensor)
    near = np.abs(at - frequency) < 1e-6 * frequency
    return complex(lines[near].sum())


def test_without_faults_the_recording_is_that_of_the_ring_sensor(result: Any) -> None:
    motion = result.turning_motion
    assert motion.cycles == 1
    sidebands = result.operation.ring_sensor(0.4).sidebands()
    place = RingPlace(angle=0.4)
    turned = replace(motion, ring=place)
    carrier = motion.mesh_frequency / 61
    for distance, amplitude in sidebands.items():
        size = abs(line(turned, "ring.force", (61 + distance) * carrier))
        assert size == pytest.approx(amplitude, abs=1e-3 * sidebands[-1])
    recording = result.recording("ring.acceleration", 0.5, tacho="carrier", noise=0.1, seed=2)
    edges = np.flatnonzero(np.diff(recording["tacho"]) > 0.0) / recording.sample_rate
    carrier = speed_of(result, "carrier") / (2 * np.pi)
    assert np.diff(edges) * carrier == pytest.approx(1.0, rel=1e-3)
    force, value = (line(motion, f"ring.{n}", 60 * carrier) for n in ("force", "acceleration"))
    ratio = 60 * carrier / 1500.0
    seat = -(ratio**2) / (20.0 * (1.0 - ratio**2 + 0.1j * ratio))
    assert value == pytest.approx(seat * force, rel=1e-9)


def test_lines_of_an_eccentric_planet_are_those_of_the_kinematics(result: Any) -> None:
    case = with_fault(result, kind="eccentricity", gear="planet", amplitude="1 um")
    motion = machine_turning_motion(case, result.operation)
    size = np.abs(motion.harmonics("ring.force")[1])
    carrier, absolute = (speed_of(result, name) for name in ("carrier", "low_planet1"))
    planet, carrier = (abs(n) / (2 * np.pi) for n in (absolute - carrier, carrier))
    frequency = motion.harmonics("ring.force")[0]
    # turns of the planet, and one line of the passing window on both sides
    lines = np.flatnonzero(size > 1e-4 * size[1:].max())
    away = [(frequency[lines] + n * carrier) / planet for n in (-1, 0, 1)]
    distance = np.min([np.abs(ratio - np.round(ratio)) for ratio in away], axis=0)
    assert distance.max() < 1e-9
    # all planets together carry the torque: only their passing shows the wave
    assert abs(line(motion, "ring.force", planet)) < 0.02
    for away in (planet - carrier, planet + carrier):
        assert abs(line(motion, "ring.force", away)) > 10.0
    # the other planets feel the sun and the carrier move
    own, other = (abs(line(motion, f"planet_{n}.sun_mesh_force", planet)) for n in (1, 2))
    assert own > other > 0.0


def speed_of(result: Any, shaft: str) -> float:
    """Speed of a shaft [rad/s]."""
    return float(result.operation.power_flow.shafts[shaft].speed)


@pytest.mark.parametrize(
    ("fault", "expected"),
    [
        ({"gear": "pin"}, r"faults\.f\.gear.*Known: sun, ring, planet"),
        ({"gear": "sun", "planet": 1}, r"faults\.f\.planet.*Other gears are one each"),
        ({"planet": 4}, r"faults\.f\.planet.*3 planets"),
        ({"order": 5}, r"faults\.f\.order.*has: gear, amplitude, phase, planet"),
    ],
)
def test_a_wrong_fault_names_its_key(result: Any, fault: dict[str, Any], expected: str) -> None:
    stated = {"kind": "eccentricity", "gear": "planet", "amplitude": "1 um", **fault}
    with pytest.raises(InputError, match=expected):
        with_fault(result, **stated)


def test_a_ripple_on_the_carrier_accelerates_the_stage(result: Any) -> None:
    ripple = {"kind": "torque-ripple", "shaft": "carrier", "orders": [15.25], "torques": ["20 N*m"]}
    case = with_fault(result, **ripple)
    motion = machine_turning_motion(case, result.operation)
    data, flow = result.operation.stage().plane_data, result.operation.power_flow.shafts
    ripple_frequency = 15.25 * abs(flow["carrier"].speed) / (2 * np.pi)
    # all turns as one below the natural frequencies: a sun mesh carries what turns the sun
    radius = 78e-3
    sun = abs(flow["sun"].torque) / (3.0 * data["force_per_planet"])
    inertia = data["carrier_inertia"] * radius**2 + 3.0 * data["planet_mass"] * radius**2
    inertia += data["sun_inertia"] * sun**2 * (78.0 / 17.0) ** 2
    inertia += 3.0 * data["planet_inertia"] * (39.0 / 17.0 * sun) ** 2  # 1 - 61/22 turns
    expected = data["sun_inertia"] * sun * (78.0 / 17.0) * 20.0 / inertia / 3.0
    lines = [line(motion, f"planet_{i}.sun_mesh_force", ripple_frequency) for i in (1, 2, 3)]
    assert np.mean(lines) == pytest.approx(-expected, rel=0.05)
    with pytest.raises(InputError, match=r"faults\.f\.shaft: ring does not turn"):
        with_fault(result, **{**ripple, "shaft": "ring"})
