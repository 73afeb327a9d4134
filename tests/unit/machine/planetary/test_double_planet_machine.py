"""Double planets as parts of a machine: plane model, Willis, statics, messages."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from tribodyn.dynamics import natural_modes
from tribodyn.errors import InputError
from tribodyn.machine import (
    Bearing,
    Gear,
    Machine,
    MachineStructure,
    MeshedPlanets,
    Operation,
    PlanetaryStage,
    Shaft,
    SteppedPlanets,
    planetary_kinematics,
    planetary_plane_model,
    static_balance,
    system,
)

RACK, FORCE = math.radians(20.0), 3000.0
#: Teeth of sun, planet at the sun, planet at the ring, ring; modules of sun and ring [m].
STAGES: dict[str, Any] = {
    "stepped": ((18, 30, 18, 66), (2e-3, 2e-3)),
    "meshed": ((24, 16, 18, 66), (2e-3, 2e-3)),
}


#: Face width of the gears, also the distance of those of stepped planets [m]: nearly a plane.
THIN = 1e-5


def gear(
    shaft: str, teeth: int, module: float, mass: float, inertia: float, at: float = 0.0
) -> Gear:
    base = 0.5 * abs(teeth) * module * math.cos(RACK)
    return Gear(shaft, at, teeth, THIN, mass, inertia * base**2, 1e-3)


def stage(kind: str, **more: Any) -> tuple[Machine, dict[str, Any]]:
    """A stage of parts, and the arguments of its plane model."""
    (sun, first, second, ring), (module, at_ring) = STAGES[kind]
    pins, stepped = 0.5 * module * (sun + first), kind == "stepped"
    second_gear = gear("planet", second, at_ring, 1e-9 if stepped else 0.7, 0.5, stepped * THIN)
    low = PlanetaryStage(
        *("s", "r", "carrier", gear("planet", first, module, 0.66, 0.61), 3, module),
        pin=Bearing("planet", 0.0, 1e8, tilting_stiffness=1e9),
        sun_mesh={"stiffness": 5e8},
        ring_mesh={"stiffness": 4e8, "normal_module": at_ring},
        planet_mesh={"stiffness": 6e8},
        planet_type=kind,  # type: ignore[arg-type]
        ring_planet=second_gear,
        **more,
    )
    base = {"sun": sun * module, "ring": ring * at_ring}
    base = {name: 0.5 * math.cos(RACK) * value for name, value in base.items()}
    machine = Machine(
        shafts={
            "sun": Shaft(),
            "ring": Shaft(),
            "carrier": Shaft(
                mass=5.43, moment_of_inertia=6.29 * pins**2, transverse_moment_of_inertia=1e-3
            ),
        },
        gears={
            "s": gear("sun", sun, module, 0.4, 0.39),
            "r": gear("ring", -ring, at_ring, 2.35, 3.0),
        },
        meshes={},
        planets={"low": low},
        bearings={
            "S": Bearing("sun", 0.0, 1e8, tilting_stiffness=1e9),
            "R": Bearing(
                *("ring", 0.0, 1e8),
                tilting_stiffness=1e9,
                torsional_stiffness=1e9 * base["ring"] ** 2,
            ),
            "C": Bearing("carrier", 0.0, 1e8, tilting_stiffness=1e9),
        },
        operation=Operation("sun", "carrier", 157.0, 3 * FORCE * base["sun"]),
    )
    ratio = second * at_ring / (first * module)
    inertia = 0.61 + 0.5 * ratio**2 * stepped
    data = {
        "carrier_mass": 5.43, "carrier_inertia": 6.29, "ring_mass": 2.35, "ring_inertia": 3.0,
        "sun_mass": 0.4, "sun_inertia": 0.39, "planet_mass": 0.66, "planet_inertia": inertia,
        "sun_mesh_stiffness": 5e8, "ring_mesh_stiffness": 4e8, "pin_stiffness": 1e8,
        "carrier_support": 1e8, "ring_support": 1e8, "sun_support": 1e8,
        "ring_torsional_support": 1e9, "sun_pressure_angle": RACK, "ring_pressure_angle": RACK,
        "force_per_planet": FORCE, "planets": 3,
    }  # fmt: skip
    if stepped:
        return machine, {**data, "double_planets": SteppedPlanets(ratio)}
    to_ring, between = 0.5 * at_ring * (ring - second), 0.5 * module * (first + second)
    cosine = (pins**2 + to_ring**2 - between**2) / (2.0 * pins * to_ring)
    pair = MeshedPlanets(0.7, 0.5, 6e8, RACK, angle=math.acos(cosine), radius_ratio=to_ring / pins)
    return machine, {**data, "double_planets": pair}


@pytest.mark.parametrize("kind", STAGES)
def test_frequencies_and_loads_are_those_of_the_plane_model(kind: str) -> None:
    machine, data = stage(kind, pin_errors=[30e-6, 0.0, 0.0])
    plane_model = planetary_plane_model(**data, pin_errors=[30e-6, 0.0, 0.0])
    plane = natural_modes(plane_model).frequency
    parts = natural_modes(system(MachineStructure(machine, 0.0))).frequency
    nearest = np.abs(parts[:, None] / plane[plane > 1.0] - 1.0).min(axis=0)
    assert nearest.max() < (1e-5 if kind == "stepped" else 1e-7)
    rows = np.array([contact.direction for contact in plane_model.contacts])
    springs = np.array([float(contact.stiffness) for contact in plane_model.contacts])
    matrix = np.asarray(plane_model.stiffness) + (rows.T * springs) @ rows
    at_rest = np.linalg.lstsq(matrix, np.asarray(plane_model.force), rcond=1e-13)[0]
    forces = (springs * (rows @ at_rest)).reshape(-1, 3)
    balance, names = static_balance(machine), machine.planets["low"].mesh_names("low")
    for mesh, expected in zip(("sun", "ring", "planet"), forces, strict=False):
        loads = [balance.meshes[name].force for name in names[mesh]]
        assert loads == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("kind", STAGES)
def test_speeds_and_phases(kind: str) -> None:
    machine, _ = stage(kind)
    sun, first, second, ring = STAGES[kind][0]
    willis = planetary_kinematics(
        sun_teeth=sun, ring_teeth=ring, planet_teeth=(first, second), planet_type=kind,  # type: ignore[arg-type]
        held="ring", input="sun", input_speed=157.0,
    )  # fmt: skip
    flow, names = machine.kinematics, machine.planets["low"].mesh_names("low")
    assert flow.shafts["carrier"].speed == pytest.approx(willis.speeds["carrier"], rel=1e-12)
    assert flow.shafts["carrier"].ratio == pytest.approx(1.0 / willis.ratio, rel=1e-12)
    power = sum(flow.meshes[name].power for name in names["sun"])
    driving = abs(machine.operation.torque * machine.operation.speed)
    unit = planetary_kinematics(
        sun_teeth=sun, ring_teeth=ring, planet_teeth=(first, second), planet_type=kind,  # type: ignore[arg-type]
        held="ring", input="sun", input_speed=157.0, input_torque=machine.operation.torque,
    )  # fmt: skip
    assert power == pytest.approx(unit.rolling_power, rel=1e-9)
    assert unit.power["sun"] == pytest.approx(driving)
    lag = [-machine.meshes[name].offset % 1.0 for name in names["sun"]]
    assert lag == pytest.approx((sun * np.arange(3) / 3) % 1.0, abs=1e-9)
    cycles = [machine.clock.cycles[names[mesh][0]] for mesh in ("sun", "ring")]
    assert cycles[0] * second == cycles[1] * (first if kind == "stepped" else second)


@pytest.mark.parametrize("efficiency", [1.0, 0.98])
@pytest.mark.parametrize("kind", STAGES)
def test_a_carrier_has_the_torque_that_balances_sun_and_ring(kind: str, efficiency: float) -> None:
    """Willis: T_r = -i_0 eta T_s at rest of the carrier, and T_c = -T_s - T_r of the three."""
    machine, _ = stage(kind)
    flow = machine.power_flow(dict.fromkeys(machine.meshes, efficiency))
    (sun, first, second, ring), _ = STAGES[kind]
    ratio = -first * ring / (sun * second) if kind == "stepped" else ring / sun
    held = ratio * efficiency ** (2 if kind == "stepped" else 3)
    torque = machine.operation.torque
    assert flow.shafts["ring"].torque == pytest.approx(abs(held) * torque, rel=1e-12)
    carrier = flow.shafts["carrier"]
    assert carrier.torque == pytest.approx(abs(1.0 - held) * torque, rel=1e-12)
    out = 157.0 / abs(1.0 - ratio)
    assert carrier.power == pytest.approx(abs(1.0 - held) * torque * out, rel=1e-12)


def test_planets_that_cannot_be_are_refused() -> None:
    with pytest.raises(InputError, match="Double planets have a second gear"):
        PlanetaryStage("s", "r", "c", Gear("p", 0.0, 22, 0.05), 3, 4e-3, planet_type="meshed")
    for name, changes, message in (
        ("pair_center_distance", 0.09, r"do not reach each other.*90 mm apart"),
        ("ring_center_distance", 0.042, r"overlap by"),
    ):
        with pytest.raises(InputError, match=message):
            stage("meshed", **{name: changes})
