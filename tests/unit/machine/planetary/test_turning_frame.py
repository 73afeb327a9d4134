"""A stage of parts in the frame of its carrier: frequencies and types of the plane model."""

from __future__ import annotations

import numpy as np
import pytest
from tests.unit.machine.planetary.test_planetary_machine import DATA, helical_stage, lin_parker

from tribodyn.errors import InputError
from tribodyn.machine import (
    MachineStructure,
    machine_modes,
    planetary_modes,
    planetary_plane_model,
)
from tribodyn.machine.modes import machine_frequencies
from tribodyn.machine.planetary.turning_frame import frame_terms


@pytest.mark.parametrize(("count", "angles"), [(3, None), (4, None), (3, [0.0, 2.0, 4.2])])
@pytest.mark.parametrize("speed", [0.0, 900.0, -2500.0])
def test_frequencies_and_types_are_those_of_the_plane_model(count, angles, speed):
    at = (
        None
        if angles is None
        else np.round(np.array(angles) * 78 / (2.0 * np.pi)) * (2.0 * np.pi) / 78
    )
    structure = MachineStructure(lin_parker(count, angles=at), 0.0, frame="carrier")
    carrier = float(structure.machine.kinematics.shafts["carrier"].ratio)
    plane = planetary_modes(
        planetary_plane_model(planets=count, angles=at, carrier_speed=speed, **DATA)
    )
    modes = machine_modes(structure, speed / carrier).of_stage("low")
    elastic = plane.frequency > 0.0
    assert elastic.sum() == modes.frequency.size
    assert modes.frequency == pytest.approx(plane.frequency[elastic], rel=1e-9)
    assert modes.types == tuple(np.array(plane.types)[elastic])
    assert modes.names == plane.names
    (row,) = machine_frequencies(structure, np.array([speed / carrier]))
    assert row == pytest.approx(plane.frequency[elastic], rel=1e-9)


def test_a_free_helical_stage_moves_straight_on():
    """Seen from the turning frame a body that moves straight on, or does not tilt, turns."""
    machine = helical_stage()
    structure = MachineStructure(machine, 0.0, frame=machine.planets["low"].carrier)
    speed = machine.operation.speed * float(machine.kinematics.shafts[structure.frame].ratio)
    moved = np.zeros(structure.size)
    names = list(structure.names)
    for shaft in structure.shafts:  # all translate by 1 m along y of the frame at rest
        moved[names.index(f"{shaft}_y")] = 1.0
    turned = np.zeros(structure.size)
    for shaft in structure.shafts:
        turned[names.index(f"{shaft}_z")] = -1.0
    # y = cos(W t), z = -sin(W t): no force but that of the springs
    mass, coriolis = (
        structure.mass,
        structure.gyroscopic() - MachineStructure(machine, 0.0).gyroscopic(),
    )
    force = -(speed**2) * mass @ moved + speed * coriolis @ turned
    force += frame_terms(structure, machine.operation.speed)[1] @ moved
    across = [i for i, name in enumerate(names) if name.endswith(("_y", "_z"))]
    scale = np.abs(speed**2 * mass @ moved).max()
    assert np.abs(force[across]).max() < 1e-9 * scale


def test_a_stage_that_there_is_not_is_refused():
    modes = machine_modes(lin_parker(3))
    with pytest.raises(InputError, match="Known: low"):
        modes.of_stage("high")
    with pytest.raises(InputError, match="Carriers: carrier"):
        machine_modes(MachineStructure(lin_parker(3), frame="sun"))
