"""Planetary stages of parts in a machine: plane model, statics in space, several stages."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tribodyn.dynamics import harmonic_balance, natural_modes
from tribodyn.errors import InputError
from tribodyn.machine import (
    Bearing,
    Gear,
    Machine,
    MachineStructure,
    Mesh,
    Operation,
    PlanetaryStage,
    Shaft,
    StaticBalance,
    load_shares,
    planetary_kinematics,
    planetary_plane_model,
    static_balance,
    system,
)
from tribodyn.study.machine.motion import machine_motion

ANGLE, MODULE, FORCE = math.radians(24.6), 4e-3, 3000.0
#: Stage of Lin and Parker (1999) [kg, N/m].
DATA: dict[str, Any] = {
    "carrier_mass": 5.43, "carrier_inertia": 6.29, "ring_mass": 2.35, "ring_inertia": 3.0,
    "sun_mass": 0.4, "sun_inertia": 0.39, "planet_mass": 0.66, "planet_inertia": 0.61,
    "sun_mesh_stiffness": 5e8, "ring_mesh_stiffness": 5e8, "pin_stiffness": 1e8,
    "carrier_support": 1e8, "ring_support": 1e8, "sun_support": 1e8,
    "ring_torsional_support": 1e9, "sun_pressure_angle": ANGLE, "ring_pressure_angle": ANGLE,
    "force_per_planet": FORCE,
}  # fmt: skip


def lin_parker(count: int, sun_support: float = 1e8, **stage: Any) -> Machine:
    """The same stage as parts of a machine: spur teeth on rigid shafts that move in the plane."""
    sun, planet, ring = (17, 22, 61) if count == 3 else (17, 23, 63)
    base = {z: 0.5 * MODULE * z * math.cos(ANGLE) for z in (sun, planet, ring)}
    pins = 0.5 * MODULE * (sun + planet)
    low = PlanetaryStage(
        *("s", "r", "carrier"),
        Gear("planet", 0.0, planet, 0.05, 0.66, 0.61 * base[planet] ** 2, 0.0),
        *(count, MODULE),
        pressure_angle=ANGLE,
        pin=Bearing("planet", 0.0, 1e8),
        sun_mesh={"stiffness": 5e8},
        ring_mesh={"stiffness": 5e8},
        **stage,
    )
    return Machine(
        shafts={
            "sun": Shaft(),
            "ring": Shaft(),
            "carrier": Shaft(mass=5.43, moment_of_inertia=6.29 * pins**2),
        },
        gears={
            "s": Gear("sun", 0.0, sun, 0.05, 0.4, 0.39 * base[sun] ** 2, 0.0),
            "r": Gear("ring", 0.0, -ring, 0.05, 2.35, 3.0 * base[ring] ** 2, 0.0),
        },
        meshes={},
        planets={"low": low},
        bearings={
            "S": Bearing("sun", 0.0, sun_support),
            "R": Bearing("ring", 0.0, 1e8, torsional_stiffness=1e9 * base[ring] ** 2),
            "C": Bearing("carrier", 0.0, 1e8),
        },
        operation=Operation("sun", "carrier", 157.0, count * FORCE * base[sun]),
    )


@pytest.mark.parametrize(
    ("count", "angles"), [(3, None), (4, None), (3, np.array([0, 25, 53]) * math.tau / 78)]
)
def test_frequencies_are_those_of_the_plane_model(count: int, angles: Any) -> None:
    machine = lin_parker(count, angles=angles)
    plane = natural_modes(planetary_plane_model(planets=count, angles=angles, **DATA)).frequency
    parts = natural_modes(system(MachineStructure(machine, 0.0))).frequency
    elastic = plane > 1.0
    assert np.array_equal(elastic, parts > 1.0)
    assert parts[elastic] == pytest.approx(plane[elastic], rel=1e-9)


def shares(balance: StaticBalance, count: int) -> Any:
    """Static loads of the sun meshes over their mean."""
    forces = np.array([balance.meshes[f"low_sun{i + 1}"].force for i in range(count)])
    return forces / forces.mean()


@pytest.mark.parametrize(
    ("count", "support", "figures"),
    [
        (4, 1e3, [0.877, 1.123, 0.877, 1.123]),  # gearboxes.md, section 4
        (3, 1e12, [0.881, 1.060, 1.060]),
        (3, 0.0, [1.0, 1.0, 1.0]),
    ],
)
def test_a_pin_error_shifts_the_load_as_in_the_plane_model(
    count: int, support: float, figures: Any
) -> None:
    errors = [30e-6] + [0.0] * (count - 1)
    machine = lin_parker(count, support, pin_errors=errors)
    part = shares(static_balance(machine), count)
    data = {**DATA, "sun_support": support, "pin_errors": errors}
    assert part == pytest.approx(load_shares(planets=count, **data).share, rel=1e-7)
    assert part == pytest.approx(figures, abs=1e-9 if not support else 6e-4)


def helical_stage(count: int = 3, *, helix: float = 0.2, **operation: Any) -> Machine:
    """A helical stage that moves in all coordinates; carrier and ring are rigid bodies."""
    radial = {"radial_stiffness": 2e8, "axial_stiffness": 1e8, "tilting_stiffness": 2e5}
    low = PlanetaryStage(
        *("s", "r", "carrier", Gear("planet", 0.0, 22, 0.05), count, MODULE, helix),
        pin=Bearing("planet", 0.0, **radial),
        sun_mesh={"stiffness": 5e8},
        ring_mesh={"stiffness": 6e8},
    )
    run = {"input": "sun", "output": "carrier", "speed": 157.0, "torque": 200.0, **operation}
    held = {"sun", "ring", "carrier"} - {run["input"], run["output"]}
    names = {"sun": "S", "ring": "R", "carrier": "C"}
    return Machine(
        shafts={
            "sun": Shaft(),
            "ring": Shaft(),
            "carrier": Shaft(mass=5.0, moment_of_inertia=0.02, transverse_moment_of_inertia=0.01),
        },
        gears={"s": Gear("sun", 0.0, 17, 0.05), "r": Gear("ring", 0.0, -61, 0.05)},
        meshes={},
        planets={"low": low},
        bearings={
            mark: Bearing(name, 0.0, **radial, torsional_stiffness=1e7 * (name in held))
            for name, mark in names.items()
        },
        operation=Operation(**run),
    )


def test_loads_of_a_helical_stage_balance_in_space() -> None:
    machine = helical_stage()
    balance = static_balance(machine)
    planet = machine.placement.gears["low_planet2"]
    meshes = {mesh: machine.directions[f"low_{mesh}2"] for mesh in ("sun", "ring")}
    force = balance.meshes["low_sun2"].force
    assert force == pytest.approx(balance.meshes["low_ring2"].force, rel=1e-9)
    # Both axial forces act on the planet at its pitch points: they cancel and tilt it.
    assert meshes["sun"].normal[0] == pytest.approx(meshes["ring"].normal[0], rel=1e-12)
    axial = force * math.tan(meshes["sun"].base_helix_angle)
    radius = 0.5 * 22 * MODULE / math.cos(0.2)
    load = balance.bearings["low_pin2"].load
    assert load[0] == pytest.approx(0.0, abs=1e-6 * force)
    assert np.hypot(*load[4:]) == pytest.approx(2.0 * axial * radius, rel=1e-9)
    assert np.dot(load[4:], planet[1:]) == pytest.approx(0.0, abs=1e-6 * force)
    # Sun and ring are pressed against their bearings by the axial forces of all planets.
    assert abs(balance.bearings["S"].load[0]) == pytest.approx(3.0 * axial, rel=1e-9)
    assert balance.bearings["S"].load[0] == pytest.approx(-balance.bearings["R"].load[0], rel=1e-9)
    total = sum((balance.bearings[name].load for name in "SRC"), np.zeros(6))
    assert total[:3] == pytest.approx(0.0, abs=1e-6 * force)
    assert total[4:] == pytest.approx(0.0, abs=1e-6 * force)
    torque = 200.0 - total[3] + balance.output_torque
    assert torque == pytest.approx(0.0, abs=1e-6)
    assert balance.output_torque == pytest.approx(-200.0 * 78 / 17, rel=1e-9)


def test_plane_motion_of_spur_planets_is_apart_from_axial_motion_and_tilting() -> None:
    plain, helical = helical_stage(helix=0.0), helical_stage()
    for machine, coupled in ((plain, False), (helical, True)):
        structure = MachineStructure(machine, 0.0)
        names = np.array(structure.names)
        plane = np.array([not n.endswith(("_x", "theta_y", "theta_z")) for n in names])
        plane |= np.array([n.endswith("theta_x") for n in names])
        matrix = structure.stiffness + sum(
            structure.mesh_stiffness(m) * np.outer(structure.mesh(m), structure.mesh(m))
            for m in machine.meshes
        )
        across = np.abs(matrix[np.ix_(plane, ~plane)]).max()
        assert (across > 1e-3 * np.abs(matrix).max()) == coupled
        if not coupled:
            assert across < 1e-9 * np.abs(matrix).max()


MEMBERS = ("sun", "ring", "carrier")


@pytest.mark.parametrize("held", MEMBERS)
@pytest.mark.parametrize("backwards", [False, True])
def test_speeds_and_torques_are_those_of_willis(held: str, backwards: bool) -> None:
    ends = [name for name in MEMBERS if name != held]
    first, last = ends[::-1] if backwards else ends
    machine = helical_stage(input=first, output=last, speed=-50.0 if backwards else 50.0)
    sign = -1.0 if backwards else 1.0
    stage = planetary_kinematics(
        sun_teeth=17, ring_teeth=61, planet_teeth=22, held=held, input=first,
        input_speed=sign * 50.0, input_torque=sign * 200.0,
    )  # type: ignore[arg-type]  # fmt: skip
    flow = machine.kinematics
    for name in MEMBERS:
        assert flow.shafts[name].speed == pytest.approx(stage.speeds[name], abs=1e-9)
        assert flow.shafts[name].torque == pytest.approx(abs(stage.torques[name]), rel=1e-9)
    assert flow.shafts["low_planet1"].speed == pytest.approx(stage.speeds["planet"], abs=1e-9)
    rolling = sum(flow.meshes[f"low_sun{i}"].power for i in (1, 2, 3))
    assert rolling == pytest.approx(stage.rolling_power, rel=1e-9)
    assert flow.meshes["low_ring1"].mesh_frequency == pytest.approx(stage.mesh_frequency, rel=1e-12)
    balance = static_balance(machine)
    assert balance.output_torque == pytest.approx(stage.torques[last], rel=1e-6)
    assert balance.meshes["low_sun1"].force == pytest.approx(
        flow.meshes["low_sun1"].force, rel=1e-6
    )


def wind_turbine() -> Machine:
    """Carrier in, two planetary stages, then a parallel stage."""
    stages = {
        "first": PlanetaryStage("s1", "r1", "rotor", Gear("p", 0.0, 29, 0.2), 3, 10e-3),
        "second": PlanetaryStage("s2", "r2", "middle", Gear("p", 0.0, 29, 0.1), 3, 6e-3),
    }
    return Machine(
        shafts={
            "rotor": Shaft(mass=900.0, moment_of_inertia=60.0),
            "middle": Shaft(mass=100.0, moment_of_inertia=4.0),
            **{name: Shaft() for name in ("ring1", "ring2", "low", "high")},
        },
        gears={
            "s1": Gear("middle", 0.0, 22, 0.2), "r1": Gear("ring1", 0.0, -80, 0.2),
            "s2": Gear("low", 0.0, 22, 0.1), "r2": Gear("ring2", 0.0, -80, 0.1),
            "wheel": Gear("low", 0.4, 88, 0.1), "pinion": Gear("high", 0.0, 23, 0.1),
        },
        meshes={"last": Mesh(("wheel", "pinion"), 6e-3, 0.2)},
        planets=stages,
        bearings={n: Bearing(n, 0.0, 1e9, torsional_stiffness=1e8) for n in ("ring1", "ring2")},
        operation=Operation("rotor", "high", 2.0, 1e5),
    )  # fmt: skip


def test_two_stages_and_a_parallel_one_by_hand() -> None:
    machine = wind_turbine()
    shafts, step = machine.kinematics.shafts, 1.0 + 80.0 / 22.0
    ratio = step * step * 88.0 / 23.0
    assert shafts["low"].speed == pytest.approx(2.0 * step**2, rel=1e-12)
    assert shafts["high"].speed == pytest.approx(-2.0 * ratio, rel=1e-12)
    assert shafts["high"].torque == pytest.approx(1e5 / ratio, rel=1e-9)
    assert shafts["high"].power == pytest.approx(2e5, rel=1e-9)
    # Torque sums of each stage: carrier in, sun out, ring held.
    assert shafts["ring1"].torque == pytest.approx(1e5 * (1.0 - 1.0 / step), rel=1e-9)
    assert shafts["ring2"].torque == pytest.approx(1e5 / step * (1.0 - 1.0 / step), rel=1e-9)
    frequency = {n: m.mesh_frequency * math.tau for n, m in machine.kinematics.meshes.items()}
    assert frequency["first_ring2"] == pytest.approx(80 * 2.0, rel=1e-12)
    assert frequency["second_sun1"] == pytest.approx(80 * 2.0 * step, rel=1e-12)
    assert frequency["last"] == pytest.approx(88 * 2.0 * step**2, rel=1e-12)
    clock = machine.clock
    first = clock.cycles["first_sun1"] * frequency["last"]
    assert clock.cycles["last"] * 2 * 80 == pytest.approx(first)
    assert clock.cycles["first_sun1"] == clock.cycles["first_ring3"]
    start = machine.placement.shafts
    assert start["rotor"][1:] == start["middle"][1:] == start["low"][1:]
    assert math.dist(start["low"][1:], start["high"][1:]) == pytest.approx(
        0.5 * 111 * 6e-3 / math.cos(0.2)
    )
    balance = static_balance(machine)
    assert balance.output_torque == pytest.approx(1e5 / ratio, rel=1e-6)


def test_two_stages_in_a_row_move_with_the_lines_of_their_meshes() -> None:
    """Linear meshes with errors: torques balance, and lines are those of one stage or the other."""
    laws = {"stiffness": 4e8, "error": lambda phase: 2e-6 * np.cos(2.0 * np.pi * phase)}
    meshes = {"sun_mesh": laws, "ring_mesh": laws}
    stages = {
        "first": PlanetaryStage("s1", "r1", "rotor", Gear("p", 0.0, 24, 0.1), 3, 6e-3, **meshes),
        "second": PlanetaryStage("s2", "r2", "middle", Gear("p", 0.0, 21, 0.1), 3, 4e-3, **meshes),
    }
    machine = Machine(
        shafts={"rotor": Shaft(mass=90.0, moment_of_inertia=6.0),
                "middle": Shaft(mass=20.0, moment_of_inertia=1.0),
                **{name: Shaft() for name in ("ring1", "ring2", "high")}},
        gears={"s1": Gear("middle", 0.0, 24, 0.1), "r1": Gear("ring1", 0.0, -72, 0.1),
               "s2": Gear("high", 0.0, 21, 0.1), "r2": Gear("ring2", 0.0, -63, 0.1)},
        meshes={},
        planets=stages,
        bearings={"middle": Bearing("middle", 0.0, 1e9), "high": Bearing("high", 0.0, 1e9),
                  "rotor": Bearing("rotor", 0.0, 1e9),
                  **{n: Bearing(n, 0.0, 1e9, torsional_stiffness=1e8) for n in ("ring1", "ring2")}},
        operation=Operation("rotor", "high", 12.0, 9e3),
    )  # fmt: skip
    assert machine.clock.cycles["first_sun1"] == 2  # (1 + 72/24) 63/72 = 7/2 cycles of the second
    assert machine.clock.cycles["second_ring2"] == 7
    structure = MachineStructure(static_balance(machine).linearized(), 0.02)
    response = harmonic_balance(system(structure), machine.clock.frequency, steps=32)
    assert response.converged
    motion = machine_motion(structure, response)
    forces = dict(zip(motion.mesh, motion.mesh_force.T, strict=True))
    mean = {name: float(motion.mean(force)) for name, force in forces.items()}
    torque = {}
    for name, (sun, ring, module) in {"first": (24, 72, 6e-3), "second": (21, 63, 4e-3)}.items():
        base = 0.5 * module * math.cos(math.radians(20.0))
        suns, rings = (sum(mean[f"{name}_{m}{i}"] for i in (1, 2, 3)) for m in ("sun", "ring"))
        torque[name] = (base * sun * suns, base * ring * rings)
    carrier = 9e3
    for name in stages:  # Willis: the sun takes 1/4 of the torque of the carrier, the ring the rest
        assert torque[name] == pytest.approx((carrier / 4.0, carrier * 3.0 / 4.0), rel=1e-9)
        carrier = torque[name][0]
    assert carrier * machine.kinematics.shafts["high"].speed == pytest.approx(9e3 * 12.0, rel=1e-9)
    lines = np.abs(motion.harmonics(motion.mesh_force, np.arange(1, 12)))
    largest = lines.max(axis=1)
    assert largest[[0, 2, 3, 4, 5, 7, 8, 9, 10]].max() < 1e-6 * largest[[1, 6]].min()
    first = motion.mesh.index("first_sun1")
    assert lines[6, first] > 1e-3 * lines[1, first]  # errors of the second stage reach the first


def test_a_stage_that_does_not_work_is_refused_by_the_part() -> None:
    machine = lin_parker(3)
    free = {**machine.bearings, "R": Bearing("ring", 0.0, 1e8)}
    with pytest.raises(InputError, match=r"torsional_stiffness"):
        replace(machine, bearings=free)
    low = replace(machine.planets["low"], count=5, pin_errors=0.0, thickness_errors=0.0)
    with pytest.raises(InputError, match=r"planets\.low.*5 planets"):
        replace(machine, planets={"low": low})
    broken = {**machine.bearings, "low_pin1": replace(machine.bearings["low_pin1"], carrier="x")}
    with pytest.raises(InputError, match=r"bearings\.low_pin1\.carrier"):
        replace(machine, bearings=broken)


def test_a_negative_torque_loads_the_other_flanks() -> None:
    drive, brake = helical_stage(), helical_stage(torque=-200.0)
    for mesh in drive.meshes:
        loads = [machine.kinematics.meshes[mesh] for machine in (drive, brake)]
        assert loads[0].driver == loads[1].driven
        assert loads[0].force == pytest.approx(loads[1].force, rel=1e-12)
        normals = [machine.directions[mesh].normal for machine in (drive, brake)]
        along = np.array([0.0, *drive.placement.gears["low_planet" + mesh[-1]][1:]])
        # Radial parts stay, tangential and axial ones change their signs.
        assert normals[0] @ along == pytest.approx(normals[1] @ along, rel=1e-9)
        assert normals[0][0] == pytest.approx(-normals[1][0], rel=1e-12)
        assert drive.meshes[mesh].offset == brake.meshes[mesh].offset
    balance = static_balance(brake)
    assert balance.output_torque == pytest.approx(200.0 * 78 / 17, rel=1e-9)
    assert all(mesh.force > 0.0 for mesh in balance.meshes.values())
