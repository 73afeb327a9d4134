"""Directions of meshes in space: figures, torques, reciprocity and signs."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from machines import DEGREE, pair, two_stages

from tribodyn.dynamics import Contact, spur6
from tribodyn.machine import Machine, MeshDirection

HELICAL: dict[str, Any] = {"helix_angle": 15 * DEGREE, "angle": 40 * DEGREE}
SIDES = [(21, 72), (21, -72), (-72, 21)]


def direction(teeth: tuple[int, int], **arguments: Any) -> MeshDirection:
    machine: Machine = pair(teeth, **arguments)
    return machine.directions["mesh"]


def test_figures_of_the_pairs_that_iso_21771_gives() -> None:
    first, second = two_stages().directions.values()
    assert math.degrees(first.working_pressure_angle) == pytest.approx(22.806245, abs=5e-7)
    assert math.degrees(first.base_helix_angle) == pytest.approx(19.679338, abs=5e-7)
    assert math.degrees(second.working_pressure_angle) == pytest.approx(21.775125, abs=5e-7)
    ring = direction((21, -72), helix_angle=15 * DEGREE, center_distance=-52.638e-3)
    outer = direction((21, -72), helix_angle=15 * DEGREE, center_distance=52.638e-3)
    assert ring.working_pressure_angle == outer.working_pressure_angle
    distance = 0.5 * 51 * 2e-3 / math.cos(15 * DEGREE)
    distance *= math.cos(20.646896 * DEGREE) / math.cos(20.052474 * DEGREE)
    ring = direction((21, -72), helix_angle=15 * DEGREE, center_distance=distance)
    assert math.degrees(ring.working_pressure_angle) == pytest.approx(20.052474, abs=2e-6)


@pytest.mark.parametrize("teeth", SIDES)
@pytest.mark.parametrize("torque", [100.0, -100.0])
@pytest.mark.parametrize("speed", [50.0, -50.0])
def test_rotations_compress_by_base_radii_and_mean_force_gives_the_torque(
    teeth: tuple[int, int], torque: float, speed: float
) -> None:
    machine = pair(teeth, torque=torque, speed=speed, **HELICAL)
    line, load = machine.directions["mesh"], machine.kinematics.meshes["mesh"]
    sense = math.copysign(1.0, torque * speed)
    assert line.direction[3] == pytest.approx(sense * line.base_radius[0], rel=1e-13)
    # both gears turning by the ratio neither compress nor release the teeth
    ratio = float(machine.kinematics.shafts["output"].ratio)
    assert line.direction[3] + ratio * line.direction[9] == pytest.approx(0.0, abs=1e-15)
    assert -load.force * line.direction[3] == pytest.approx(-abs(torque) * sense, rel=1e-13)
    assert -load.force * line.direction[9] == pytest.approx(load.torque[1], rel=1e-13)


@pytest.mark.parametrize("teeth", SIDES)
def test_rigid_motions_of_the_pair_do_not_compress(teeth: tuple[int, int]) -> None:
    machine = pair(teeth, **HELICAL)
    line = machine.directions["mesh"].direction
    second = np.array(machine.placement.gears["b"])
    for shift in np.eye(3):
        assert line @ [*shift, 0, 0, 0, *shift, 0, 0, 0] == pytest.approx(0.0, abs=1e-15)
    for turn in np.eye(3):
        moved = np.cross(turn, second)
        assert line @ [0, 0, 0, *turn, *moved, *turn] == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize("teeth", SIDES)
@pytest.mark.parametrize("torque", [100.0, -100.0])
def test_flanks_push_the_gear_with_external_teeth_towards_its_axis(
    teeth: tuple[int, int], torque: float
) -> None:
    machine = pair(teeth, torque=torque, **HELICAL)
    line = machine.directions["mesh"]
    axis = np.array(machine.placement.gears["b"])
    arm = line.working_radius[0] * axis * math.copysign(1.0, sum(teeth)) / np.linalg.norm(axis)
    pitch_point = arm
    forces = {"a": -line.normal, "b": line.normal}
    centers = {"a": np.zeros(3), "b": axis}
    for name, count in zip("ab", teeth, strict=True):
        radius = pitch_point - centers[name]
        assert np.linalg.norm(radius) == pytest.approx(
            abs(line.working_radius["ab".index(name)]), rel=1e-12
        )
        assert np.sign(forces[name] @ radius) == (-1 if count > 0 else 1)


def test_hand_and_flank_turn_the_axial_force() -> None:
    right = direction((21, 72), hand="right", **HELICAL)
    assert right.normal[0] == pytest.approx(-math.tan(right.base_helix_angle), rel=1e-14)
    left = direction((21, 72), hand="left", **HELICAL)
    back = direction((21, 72), hand="right", torque=-100.0, **HELICAL)
    assert left.normal == pytest.approx(right.normal * [-1, 1, 1])
    assert back.normal[0] == pytest.approx(-right.normal[0])
    c = np.array([0.0, math.cos(40 * DEGREE), math.sin(40 * DEGREE)])
    assert back.normal @ c == pytest.approx(right.normal @ c)
    assert back.normal[1:] == pytest.approx((2 * (right.normal @ c) * c - right.normal)[1:])


def test_a_screw_of_the_first_gear_slides_along_its_teeth() -> None:
    # a right-hand gear that moves along x and turns by x tan(beta)/r stays in its tooth spaces
    for teeth in SIDES:
        line = direction(teeth, hand="right", **HELICAL)
        lead = math.tan(line.base_helix_angle) / line.base_radius[0]
        assert line.direction[:6] @ [1, 0, 0, lead, 0, 0] == pytest.approx(0.0, abs=1e-15)
        # so does the second one, by its own hand: opposite for external gears, equal for rings
        hand = -1.0 if min(teeth) > 0 else 1.0
        lead = hand * math.tan(line.base_helix_angle) / line.base_radius[1]
        assert line.direction[6:] @ [1, 0, 0, lead, 0, 0] == pytest.approx(0.0, abs=1e-15)


def test_the_second_gear_as_the_first_gives_the_same_force() -> None:
    machine = pair((21, 72), hand="right", **HELICAL)
    swapped = pair(
        (72, 21),
        hand="left",
        helix_angle=15 * DEGREE,
        angle=220 * DEGREE,
        speed=-50.0 * 21 / 72,
        torque=-100.0 * 72 / 21,
    )
    loads = machine.gear_loads
    assert swapped.gear_loads["b"] == pytest.approx(loads["a"], rel=1e-12, abs=1e-9)
    assert swapped.gear_loads["a"] == pytest.approx(loads["b"], rel=1e-12, abs=1e-9)


class _Flat:
    """A mesh of constant sums of friction."""

    event_phases = (0.0,)

    def stiffness(self, phase: Any) -> Any:
        return 3e8 + 0.0 * phase

    def friction_sum(self, phase: Any) -> Any:
        return 0.03 + 0.0 * phase

    def friction_moment_pinion(self, phase: Any) -> Any:
        return 4e-4 + 0.0 * phase

    def friction_moment_wheel(self, phase: Any) -> Any:
        return 7e-4 + 0.0 * phase


@pytest.mark.parametrize("driver", ["pinion", "wheel"])
def test_contact_and_friction_of_a_spur_pair_are_those_of_the_plane_model(driver: Any) -> None:
    machine = pair((16, 24), torque=100.0 if driver == "pinion" else -100.0)
    line = machine.directions["mesh"]
    mesh: Any = _Flat()
    plane: Contact = spur6(
        mesh,
        mass=1.0,
        moment_of_inertia=1e-3,
        base_radius=line.base_radius,
        torque=(100.0, 150.0),
        bearing_stiffness=1e9,
        driver=driver,
    ).contacts[0]
    phase = np.zeros(2)
    rubbing = line.friction(
        *(
            f(phase)
            for f in (
                _Flat().friction_sum,
                _Flat().friction_moment_pinion,
                _Flat().friction_moment_wheel,
            )
        )
    )
    # the plane has y along the line of action of a driving pinion, x in the sense of the surface
    # speeds, and angles in the sense of rotation
    sign = 1.0 if driver == "pinion" else -1.0
    onto = np.zeros((12, 6))
    for node, turn in ((0, 1.0), (1, -1.0)):
        onto[6 * node : 6 * node + 3, 3 * node] = line.across
        onto[6 * node : 6 * node + 3, 3 * node + 1] = sign * line.normal
        onto[6 * node + 3, 3 * node + 2] = turn
    assert line.direction @ onto == pytest.approx(np.asarray(plane.direction), rel=1e-12)
    assert callable(plane.friction)
    assert rubbing @ onto == pytest.approx(plane.friction(phase), rel=1e-12)


@pytest.mark.parametrize("teeth", SIDES)
@pytest.mark.parametrize("speed", [50.0, -50.0])
@pytest.mark.parametrize("torque", [100.0, -100.0])
def test_both_flanks_move_across_the_line_of_action_in_the_sense_of_friction(
    teeth: tuple[int, int], speed: float, torque: float
) -> None:
    machine = pair(teeth, speed=speed, torque=torque, **HELICAL)
    line, axis = machine.directions["mesh"], np.array(machine.placement.gears["b"])
    towards = math.copysign(1.0, sum(teeth)) * axis / np.linalg.norm(axis)
    pitch_point = line.working_radius[0] * towards
    for shaft, center in (("input", np.zeros(3)), ("output", axis)):
        spin = np.array([machine.kinematics.shafts[shaft].speed, 0.0, 0.0])
        velocity = np.cross(spin, pitch_point - center)
        assert velocity @ line.across > 0.0
    # friction that holds the first gear back takes power from it where it moves faster
    rub = line.friction(1.0, 0.01, 0.02)
    assert rub[3] * speed > 0.0
    assert rub[9] * machine.kinematics.shafts["output"].speed < 0.0
    assert rub[:3] == pytest.approx(line.across)
