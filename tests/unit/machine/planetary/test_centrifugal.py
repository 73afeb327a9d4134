"""Centrifugal forces of the planets in the pins, by hand and in both models; thick planet teeth."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import tribodyn as td
from known_planetary import LIN_PARKER
from tribodyn.machine import (
    Bearing,
    Gear,
    Machine,
    Operation,
    PlanetaryStage,
    Shaft,
    planetary_plane_model,
    static_balance,
)
from tribodyn.study.machine.run import balanced_machine

SPEED, MASS, PINS = 100.0, 0.66, 0.078


def at_rest(**changes: float) -> np.ndarray:
    """Position of the plane model under its loads, the free rotation at its least."""
    data = {**LIN_PARKER, "force_per_planet": 3000.0, "carrier_speed": SPEED, **changes}
    system = planetary_plane_model(planets=3, **data)
    rows = np.array([contact.direction for contact in system.contacts])
    springs = np.array([float(contact.stiffness) for contact in system.contacts])
    matrix = np.asarray(system.stiffness) + (rows.T * springs) @ rows
    return np.linalg.lstsq(matrix, np.asarray(system.force), rcond=1e-13)[0]


def test_planets_pull_outwards_on_their_pins() -> None:
    """With equal pressure angles a planet turns until both meshes carry nothing of it."""
    outward = (at_rest(pin_radius=PINS) - at_rest())[9::3]
    stiffness = LIN_PARKER["pin_stiffness"] - MASS * SPEED**2
    assert outward[0] == pytest.approx(MASS * PINS * SPEED**2 / stiffness, rel=1e-6)


def machine(speed: float) -> Machine:
    """A stage with the sun driving under nearly no torque."""
    stage = PlanetaryStage(
        *("s", "r", "c", Gear("p", 0.0, 22, 0.05, MASS, 1e-3, 1e-3), 3, 4e-3),
        pin=Bearing("p", 0.0, 1e8),
        sun_mesh={"stiffness": 5e8},
        ring_mesh={"stiffness": 5e8},
    )
    hold = Bearing("r", 0.0, 1e8, torsional_stiffness=1e8)
    return Machine(
        shafts={"s": Shaft(), "r": Shaft(), "c": Shaft(mass=5.0, moment_of_inertia=0.03)},
        gears={"s": Gear("s", 0.0, 17, 0.05), "r": Gear("r", 0.0, -61, 0.05)},
        meshes={},
        planets={"low": stage},
        bearings={"S": Bearing("s", 0.0, 1e8), "R": hold, "C": Bearing("c", 0.0, 1e8)},
        operation=Operation("s", "c", speed, 1e-3),
    )


def test_pins_of_a_machine_carry_the_centrifugal_force() -> None:
    turning = machine(4.588235294117647 * SPEED)
    for i in range(3):
        load = static_balance(turning).bearings[f"low_pin{i + 1}"].load[1:3]
        angle = math.tau * i / 3
        expected = MASS * PINS * SPEED**2 * np.array([math.cos(angle), math.sin(angle)])
        np.testing.assert_allclose(load, expected, atol=1e-3 * abs(expected).max())
    slow = static_balance(machine(1.0)).bearings["low_pin1"].load[1:3]
    assert np.abs(slow).max() < 0.1


@pytest.mark.slow
def test_thick_teeth_of_a_planet_with_computed_teeth(tmp_path: Path) -> None:
    """An excess of the thickness is a pin that is behind by e/(2 cos alpha)."""
    alpha, excess = math.radians(20.0), 10e-6
    text = """
[lubricant]
name = "ISO VG 220"
temperature = "70 degC"
[film]
model = "dowson-higginson"
[friction]
law = "constant"
coefficient = 0.05
[dynamics]
backlash = "0.1 mm"
[shafts.sun]
[shafts.ring]
[gears]
s = { shaft = "sun", teeth = 17, face_width = "50 mm" }
p = { teeth = 22, face_width = "50 mm" }
r = { shaft = "ring", teeth = -61, face_width = "50 mm" }
[planets.low]
sun = "s"
ring = "r"
planet = "p"
carrier = "c"
count = 3
normal_module = "4 mm"
ERRORS
[operation]
input = "sun"
output = "c"
speed = "1500 rpm"
torque = "600 N*m"
"""
    shares = []
    for key, value in (
        ("thickness_errors", excess),
        ("pin_errors", -excess / (2.0 * math.cos(alpha))),
        ("thickness_errors", 0.0),
    ):
        path = tmp_path / f"{key}{len(shares)}.toml"
        errors = f'{key} = ["{value * 1e6} um", "0 um", "0 um"]'
        path.write_text(text.replace("ERRORS", errors), encoding="utf-8")
        case = td.load_case(path)
        balance = balanced_machine(case, case.operating_point).static
        force = np.array([balance.meshes[f"low_sun{i}"].force for i in (1, 2, 3)])
        shares.append(force / force.mean())
    np.testing.assert_allclose(shares[2], 1.0, atol=1e-6)
    assert shares[0][0] > 1.02
    np.testing.assert_allclose(shares[0], shares[1], rtol=2e-3)
