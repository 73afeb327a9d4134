"""Machines that are linear about the working load of their bearings."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from tribodyn.dynamics import harmonic_balance
from tribodyn.errors import ModelWarning
from tribodyn.machine import (
    Bearing,
    CylindricalRollerBearing,
    DeepGrooveBallBearing,
    Gear,
    Machine,
    MachineStructure,
    Mesh,
    Operation,
    Section,
    Shaft,
    StaticBalance,
    machine_modes,
    machine_structure,
    reduce_structure,
    static_balance,
    system,
)
from tribodyn.machine.modes import machine_frequencies
from tribodyn.machine.static.supports import stiffness_under, weight_share

RING = {"bore_diameter": 0.04, "outer_diameter": 0.08, "width": 0.018}
BALLS, ROLLERS = DeepGrooveBallBearing, CylindricalRollerBearing


def pair(bearings: dict[str, Bearing], helix: float = 0.0) -> Machine:
    wave = {"error": lambda phase: 1e-6 * np.cos(2.0 * np.pi * phase)}
    mesh = Mesh(("z1", "z2"), 3e-3, helix, stiffness=4e8, damping_ratio=0.05, **wave)
    return Machine(
        shafts={"a": Shaft([Section(0.2, 0.04)]), "b": Shaft()},
        gears={"z1": Gear("a", 0.09, 27, 0.03), "z2": Gear("b", 0.0, 51, 0.03)},
        meshes={"m": mesh},
        bearings=bearings,
        operation=Operation("a", "b", 120.0, 200.0),
    )


def springs_with_clearance() -> dict[str, Bearing]:
    stiff = {"clearance": 10e-6, "axial_stiffness": 1e8}
    return {name: Bearing("a", x, 4e8, **stiff) for name, x in (("A", 0.02), ("B", 0.18))}


def rolling(helix: float = 0.0) -> dict[str, Bearing]:
    bearings = {n: Bearing("a", x, rolling=BALLS(**RING)) for n, x in (("A", 0.02), ("B", 0.18))}
    held = Bearing("b", 0.0, 1e9, axial_stiffness=1e9, tilting_stiffness=1e6)
    return {**bearings, "C": held} if helix else bearings


@pytest.mark.parametrize(
    ("bearings", "helix"),
    [(rolling(), 0.0), (rolling(0.2), 0.2), (springs_with_clearance(), 0.0)],
)
def test_bearing_loads_of_a_motion_sum_to_the_mesh_force(
    bearings: dict[str, Bearing], helix: float
) -> None:
    machine = pair(bearings, helix)
    structure = machine_structure(static_balance(machine).linearized())
    motion = harmonic_balance(system(structure), machine.clock.frequency).fine
    loads = [
        motion.mean(structure.bearing_load(name, motion.position, motion.velocity))[:3]
        for name in ("A", "B")
    ]
    force = float(motion.mean(motion.contact_force[:, 0]))
    direction = machine.directions["m"].direction[:3]
    np.testing.assert_allclose(sum(loads), -force * direction, atol=1e-3 * force)


def with_idle_branch(torque: float, kind: Any = BALLS, **ring: Any) -> Machine:
    """A loaded pair of gears, and a third gear on a shaft that drives nothing."""
    shaft = Shaft([Section(0.2, 0.04)])
    places = [(s, i, x) for s in "abc" for i, x in ((1, 0.02), (2, 0.18))]
    meshes = {
        "m": Mesh(("z1", "z2"), 3e-3, stiffness=4e8, damping_ratio=0.05),
        "n": Mesh(("z1", "z3"), 3e-3, angle=math.pi, stiffness=4e8, damping_ratio=0.05),
    }
    return Machine(
        shafts=dict.fromkeys("abc", shaft),
        gears={
            "z1": Gear("a", 0.1, 27, 0.03),
            "z2": Gear("b", 0.1, 51, 0.03),
            "z3": Gear("c", 0.1, 40, 0.03),
        },
        meshes=meshes,
        bearings={f"{s}{i}": Bearing(s, x, rolling=kind(**RING, **ring)) for s, i, x in places},
        operation=Operation("a", "b", 120.0, torque),
    )


def linear(rest: StaticBalance) -> Machine:
    with pytest.warns(ModelWarning, match='bearing "c[12]" carries no load, or less'):
        return rest.linearized()


@pytest.mark.parametrize(
    ("kind", "ring"), [(BALLS, {}), (BALLS, {"radial_clearance": 10e-6}), (ROLLERS, {})]
)
def test_an_idle_branch_has_frequencies_that_no_rounding_changes(kind: Any, ring: Any) -> None:
    rest = static_balance(with_idle_branch(200.0, kind, **ring))
    machine = linear(rest)
    stiffness = machine.bearings["c1"].stiffness_matrix
    assert stiffness[1, 1] == pytest.approx(stiffness[2, 2], rel=0.1)
    assert stiffness[1, 1] > 1e7
    noise = dict(rest.bearings)
    for name in ("c1", "c2"):  # other rounding of a load that is zero
        state = noise[name]
        noise[name] = type(state)(
            state.displacement, 3.0 * state.load, 1.4 * state.stiffness, state.state
        )
    other = linear(StaticBalance(**{**vars(rest), "bearings": noise}))
    frequencies = [machine_modes(each).frequency for each in (machine, other)]
    np.testing.assert_allclose(*frequencies, rtol=1e-9)


def test_least_stiffness_is_that_under_the_weight() -> None:
    machine = with_idle_branch(200.0)
    mass = 7850.0 * math.pi * 0.02**2 * 0.2 + machine.gear_bodies["z3"].mass
    assert weight_share(machine, "c1") == pytest.approx(0.5 * 9.80665 * mass, rel=1e-12)
    bearing = BALLS(**RING)
    # Hertzian points without clearance: the stiffness grows with the cube root of the load.
    few, many = (stiffness_under(bearing, force)[1, 1] for force in (10.0, 80.0))
    assert many / few == pytest.approx(2.0, rel=1e-3)


def test_loaded_bearings_have_the_stiffness_of_their_load() -> None:
    rest = static_balance(with_idle_branch(200.0))
    machine = linear(rest)
    for name in ("a1", "b2"):
        np.testing.assert_array_equal(
            machine.bearings[name].stiffness_matrix, rest.bearings[name].stiffness
        )


def test_modes_of_a_reduced_machine_end_at_its_limit() -> None:
    shaft = Shaft([Section(0.2, 0.03)])
    machine = Machine(
        shafts={"in": shaft, "out": shaft},
        gears={"z1": Gear("in", 0.05, 20, 0.02), "z2": Gear("out", 0.05, 40, 0.02)},
        meshes={"first": Mesh(("z1", "z2"), 3e-3, stiffness=3e8)},
        bearings={f"{s}{x}": Bearing(s, x) for s in ("in", "out") for x in (0.0, 0.2)},
        operation=Operation("in", "out", 100.0, 60.0),
    )
    full = machine_modes(MachineStructure(machine), 0.0).frequency
    for limit in (None, 3e3):
        reduced = reduce_structure(MachineStructure(machine), limit)
        modes = machine_modes(reduced, 0.0)
        assert reduced.reduction is not None
        within = full[full <= reduced.reduction.limit]
        np.testing.assert_allclose(modes.frequency, within, rtol=reduced.reduction.error + 1e-9)
        assert modes.shape.shape[0] == modes.strain_share.shape[0] == len(within)
        for speed, frequency in zip(
            (0.0, 300.0), machine_frequencies(reduced, np.array([0.0, 300.0])), strict=True
        ):
            np.testing.assert_allclose(frequency, machine_modes(reduced, speed).frequency)
            assert frequency.max() <= reduced.reduction.limit
    assert full.max() > 1e4
