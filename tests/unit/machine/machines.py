"""Machines and hand statics for the tests of the machine."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tribodyn.machine import Bearing, Gear, Machine, Mesh, Operation, Section, Shaft

DEGREE = math.radians(1.0)
RPM = math.pi / 30.0


def two_stages(**changes: Any) -> Machine:
    """Two stages of the gears FVA-1 and FVA-2 on three shafts of 300 mm."""
    return Machine(**{**two_stage_parts(), **changes})


def two_stage_parts() -> dict[str, Any]:
    """Parts of the two-stage machine, as arguments."""
    names = ("input", "middle", "output")
    return {
        "shafts": {name: Shaft([Section(0.3, 0.050)]) for name in names},
        "gears": {
            "z1": Gear("input", 0.1, 27, 0.050),
            "z2": Gear("middle", 0.1, 51, 0.050),
            "z3": Gear("middle", 0.2, 23, 0.074),
            "z4": Gear("output", 0.2, 34, 0.074),
        },
        "meshes": {
            "first": Mesh(("z1", "z2"), 4.5e-3, 21 * DEGREE, "right", 0.190, 30 * DEGREE),
            "second": Mesh(("z3", "z4"), 6.5e-3, 10 * DEGREE, "left", 0.190, -20 * DEGREE),
        },
        "bearings": {
            f"{name} {end}": Bearing(name, position, 4e8, axial_stiffness=axial)
            for name in names
            for end, position, axial in (("left", 0.02, 2e8), ("right", 0.28, 0.0))
        },
        "operation": Operation("input", "output", speed=1234 * RPM, torque=456.0),
    }


def split_path(**changes: Any) -> Machine:
    """A spur reducer whose power goes over two lay shafts to one wheel."""
    shafts = {name: Shaft() for name in ("input", "upper", "lower", "output")}
    gears = {
        "pinion": Gear("input", 0.0, 20, 0.03),
        "upper wheel": Gear("upper", 0.0, 40, 0.03),
        "lower wheel": Gear("lower", 0.0, 40, 0.03),
        "upper pinion": Gear("upper", 0.1, 20, 0.03),
        "lower pinion": Gear("lower", 0.1, 20, 0.03),
        "bull": Gear("output", 0.1, 40, 0.03),
    }
    up, down = 60 * DEGREE, -60 * DEGREE
    meshes = {
        "u1": Mesh(("pinion", "upper wheel"), 4e-3, angle=up, stiffness=3e8),
        "l1": Mesh(("pinion", "lower wheel"), 4e-3, angle=down, stiffness=1e8),
        "u2": Mesh(("upper pinion", "bull"), 4e-3, angle=-up, stiffness=3e8),
        "l2": Mesh(("lower pinion", "bull"), 4e-3, angle=-down, stiffness=1e8),
    }
    parts: dict[str, Any] = {"shafts": shafts, "gears": gears, "meshes": meshes}
    operation = Operation("input", "output", speed=100.0, torque=80.0)
    return Machine(**{**parts, "operation": operation, **changes})


def pair(teeth: tuple[int, int], *, torque: float = 100.0, speed: float = 50.0, **mesh: Any) -> Any:
    """Two gears on rigid shafts."""
    return Machine(
        shafts={"input": Shaft(), "output": Shaft()},
        gears={"a": Gear("input", 0.0, teeth[0], 0.02), "b": Gear("output", 0.0, teeth[1], 0.02)},
        meshes={"mesh": Mesh(("a", "b"), **{"normal_module": 2e-3, **mesh})},
        operation=Operation("input", "output", speed=speed, torque=torque),
    )


def bearing_reactions(
    machine: Machine, shaft: str, fixed: str, free: str
) -> dict[str, np.ndarray[Any, Any]]:
    """Forces on the bearings of a shaft by hand: moments about the fixed bearing, then forces."""
    positions = {name: machine.bearings[name].position for name in (fixed, free)}
    force, moment = np.zeros(3), np.zeros(3)
    for name, gear in machine.gears.items():
        if gear.shaft == shaft:
            load = machine.gear_loads[name]
            arm = np.array([gear.node_position - positions[fixed], 0.0, 0.0])
            force += load[:3]
            moment += load[3:] + np.cross(arm, load[:3])
    span = positions[free] - positions[fixed]
    # The free bearing carries y and z only: its moments -span F_z and span F_y balance the loads.
    at_free = np.array([0.0, moment[2] / span, -moment[1] / span])
    return {free: at_free, fixed: force - at_free}
