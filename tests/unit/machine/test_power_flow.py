"""Flow of power with losses of the meshes: against products by hand, Willis, and conservation."""

from __future__ import annotations

import math
from dataclasses import replace
from random import Random

import pytest
from machines import split_path, two_stages
from test_random_machines import random_parts

from tribodyn.machine import (
    Bearing,
    Coupling,
    Gear,
    Machine,
    Operation,
    PlanetaryStage,
    Shaft,
    planetary_kinematics,
)

LOSS = {"sun": 0.985, "ring": 0.992}


def lost(machine: Machine, efficiency: dict[str, float]) -> float:
    """Power that the meshes lose."""
    flow = machine.power_flow(efficiency).meshes
    return sum((1.0 - each) * flow[name].power for name, each in efficiency.items())


def test_efficiencies_of_two_stages_multiply() -> None:
    machine = two_stages()
    flow = machine.power_flow({"first": 0.98, "second": 0.97})
    power = 456.0 * machine.operation.speed
    assert flow.shafts["middle"].power == pytest.approx(0.98 * power, rel=1e-12)
    assert flow.shafts["output"].power == pytest.approx(0.98 * 0.97 * power, rel=1e-12)
    assert flow.meshes["second"].power == pytest.approx(0.98 * power, rel=1e-12)
    assert machine.power_flow({}).shafts == machine.kinematics.shafts


def test_output_that_drives_brings_up_the_losses() -> None:
    machine = two_stages()
    back = replace(machine, operation=replace(machine.operation, torque=-456.0))
    flow = back.power_flow({"first": 0.98, "second": 0.97})
    power = -456.0 * machine.operation.speed
    assert flow.shafts["input"].power == pytest.approx(power, rel=1e-12)
    assert flow.shafts["output"].power == pytest.approx(power / (0.98 * 0.97), rel=1e-12)


@pytest.mark.parametrize("speed", [50.0, -50.0])
@pytest.mark.parametrize("held", ["ring", "carrier", "sun"])
def test_stage_of_a_machine_loses_what_willis_says(held: str, speed: float) -> None:
    members = ("sun", "carrier", "ring")
    for first in members:
        if first == held:
            continue
        (last,) = set(members) - {first, held}
        machine = Machine(
            shafts={name: Shaft() for name in members},
            gears={"s": Gear("sun", 0.0, 17, 0.02), "r": Gear("ring", 0.0, -61, 0.02)},
            meshes={},
            planets={"low": PlanetaryStage("s", "r", "carrier", Gear("p", 0.0, 22, 0.02), 3, 2e-3)},
            bearings={held: Bearing(held, 0.0, 1e9, torsional_stiffness=1e8)},
            operation=Operation(first, last, speed, 200.0),
        )
        losses = {f"low_{mesh}{i}": value for mesh, value in LOSS.items() for i in (1, 2, 3)}
        stage = planetary_kinematics(
            sun_teeth=17, ring_teeth=61, held=held, input=first,  # type: ignore[arg-type]
            input_speed=speed, input_torque=math.copysign(200.0, speed),
            **{f"{mesh}_efficiency": value for mesh, value in LOSS.items()},  # type: ignore[arg-type]
        )  # fmt: skip
        shafts = machine.power_flow(losses).shafts
        assert shafts[last].power == pytest.approx(200.0 * 50.0 * stage.efficiency, rel=1e-9)
        assert lost(machine, losses) == pytest.approx(sum(stage.power.values()), rel=1e-9)


@pytest.mark.parametrize("held", ["sun", "ring", "carrier"])
def test_planets_transmit_the_rolling_power_of_their_stage(held: str) -> None:
    """Willis: torque of the sun times its speed relative to the carrier, in equal parts."""
    first, last = (name for name in ("sun", "carrier", "ring") if name != held)
    machine = Machine(
        shafts={name: Shaft() for name in ("sun", "carrier", "ring")},
        gears={"s": Gear("sun", 0.0, 17, 0.02), "r": Gear("ring", 0.0, -61, 0.02)},
        meshes={},
        planets={"low": PlanetaryStage("s", "r", "carrier", Gear("p", 0.0, 22, 0.02), 3, 2e-3)},
        bearings={held: Bearing(held, 0.0, 1e9, torsional_stiffness=1e8)},
        operation=Operation(first, last, -50.0, 200.0),
    )
    shafts = machine.kinematics.shafts
    rolling = shafts["sun"].torque * (shafts["sun"].speed - shafts["carrier"].speed)
    for number in (1, 2, 3):
        assert shafts[f"low_planet{number}"].power == pytest.approx(abs(rolling) / 3.0, rel=1e-12)


def test_split_paths_lose_by_their_shares() -> None:
    machine = split_path()
    efficiency = {"u1": 0.99, "l1": 0.98, "u2": 0.97, "l2": 0.96}
    leaving = machine.power_flow(efficiency).shafts["output"].power
    assert 80.0 * 100.0 - leaving == pytest.approx(lost(machine, efficiency), rel=1e-9)


def test_coupling_passes_the_power() -> None:
    machine = two_stages()
    coupled = replace(
        machine,
        shafts={**machine.shafts, "engine": Shaft(moment_of_inertia=0.1)},
        couplings={"clutch": Coupling(("input", "engine"), 1e5)},
        operation=replace(machine.operation, input="engine"),
    )
    torque = coupled.power_flow({"first": 0.9}).couplings["clutch"]
    assert torque == pytest.approx(-456.0, rel=1e-9)  # the engine gives it to the input


def test_random_machines_lose_what_does_not_leave() -> None:
    draw = Random(7)
    for _ in range(40):
        machine = Machine(**random_parts(draw))
        efficiency = {name: draw.uniform(0.7, 1.0) for name in machine.meshes}
        run, shafts = machine.operation, machine.power_flow(efficiency).shafts
        entering, leaving = (shafts[end].power for end in (run.input, run.output))
        assert entering - leaving == pytest.approx(lost(machine, efficiency), rel=1e-9)
