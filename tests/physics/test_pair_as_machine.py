"""A gear pair is the smallest machine: the models of a pair are machines of two rigid shafts."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from tribodyn.dynamics import System, spur6, steady_state, torsional
from tribodyn.machine import (
    Bearing,
    Gear,
    Machine,
    Mesh,
    Operation,
    Shaft,
    machine_structure,
    system,
)

TEETH, MODULE, ANGLE = (16, 24), 4.5e-3, np.radians(20.0)
RADII = tuple(0.5 * z * MODULE * np.cos(ANGLE) for z in TEETH)
MASS, INERTIA = (0.676, 1.084), (407e-6, 1168e-6)
STIFFNESS, DAMPING = (2e8, 3e8), (900.0, 1400.0)
TORQUE, SPEED = 80.0, 180.0

MESH = SimpleNamespace(
    stiffness=lambda x: 3e8 + 4e7 * np.cos(2 * np.pi * x),
    friction_sum=lambda x: 0.03 * np.sin(2 * np.pi * x),
    friction_moment_pinion=lambda x: 3e-4 * np.cos(2 * np.pi * x),
    friction_moment_wheel=lambda x: 5e-4 * np.cos(2 * np.pi * x + 0.4),
    event_phases=(0.0,),
)
CONTACT: dict[str, Any] = {
    "mesh_damping": 1500.0,
    "error": lambda x: 2e-6 * np.sin(2 * np.pi * x),
    "backlash": 40e-6,
}


def machine(supports: bool) -> System:
    """Two gears on rigid shafts, whose line of action lies along y."""
    gears = {
        name: Gear(name, None, z, 0.014, mass, inertia, 1e-3)
        for name, z, mass, inertia in zip(("pinion", "wheel"), TEETH, MASS, INERTIA, strict=True)
    }
    bearings = {
        name: Bearing(name, 0.0, radial_stiffness=k, radial_damping=c)
        for name, k, c in zip(gears, STIFFNESS, DAMPING, strict=True)
    }
    mesh = Mesh(
        ("pinion", "wheel"), MODULE, angle=ANGLE - np.pi / 2, stiffness=MESH.stiffness,
        damping=CONTACT["mesh_damping"], error=CONTACT["error"], gap=0.5 * CONTACT["backlash"],
        friction=MESH,
    )  # fmt: skip
    return system(
        machine_structure(Machine(
            {name: Shaft() for name in gears}, gears, {"mesh": mesh}, bearings if supports else {},
            operation=Operation("pinion", "wheel", SPEED, TORQUE),
        ), damping_ratio=0.0)
    )  # fmt: skip


def pair(supports: bool) -> System:
    """The same by the models of a pair."""
    mesh: Any = MESH
    common: dict[str, Any] = {
        "moment_of_inertia": INERTIA,
        "base_radius": RADII,
        "torque": (TORQUE, TORQUE * TEETH[1] / TEETH[0]),
        **CONTACT,
    }
    if not supports:
        return torsional(mesh, **common)
    bearings: dict[str, Any] = {"bearing_stiffness": STIFFNESS, "bearing_damping": DAMPING}
    return spur6(mesh, mass=MASS, **bearings, **common)


@pytest.mark.parametrize("supports", [True, False])
def test_matrices_and_contacts_of_a_pair_are_those_of_its_machine(supports: bool) -> None:
    plane, space = pair(supports), machine(supports)
    # columns: coordinates of the pair, x across and y along the line, angles as the gears turn
    onto = np.array([[0, 1, 0], [1, 0, 0], [0, 0, 1]]) if supports else np.eye(1)
    onto = np.kron(np.eye(2), onto)
    onto[-1] *= -1.0  # the wheel turns back
    for name in ("mass", "damping", "stiffness"):
        of_machine = onto.T @ np.asarray(getattr(space, name)) @ onto
        assert of_machine == pytest.approx(np.asarray(getattr(plane, name)), rel=1e-12, abs=1e-12)
    (first,), (second,) = plane.contacts, space.contacts
    assert np.asarray(second.direction) @ onto == pytest.approx(first.direction, rel=1e-12)
    phase = np.linspace(0.0, 0.9, 7)
    assert callable(first.friction)
    assert callable(second.friction)
    rubbing = second.friction(phase) @ onto
    assert rubbing == pytest.approx(first.friction(phase), rel=1e-12, abs=1e-15)


@pytest.mark.parametrize("supports", [True, False])
def test_a_pair_moves_as_its_machine(supports: bool) -> None:
    frequency = SPEED * TEETH[0] / (2.0 * np.pi)
    responses = [steady_state(each(supports), frequency) for each in (pair, machine)]
    forces = [response.contact_force[:, 0] for response in responses]
    errors = [response.deflection[:, 0] for response in responses]
    assert forces[0] == pytest.approx(forces[1], rel=1e-9)
    assert errors[0] == pytest.approx(errors[1], rel=1e-9)
    assert forces[0].mean() == pytest.approx(TORQUE / RADII[0], rel=0.02)
