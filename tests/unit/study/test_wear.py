"""Wear of flanks: Archard by hand, the volume that is lost, and flanks that level their load."""

from __future__ import annotations

import numpy as np
import pytest

import tribodyn
from tribodyn.errors import InputError
from tribodyn.gear.mesh_geometry import flank_ranges
from tribodyn.study import wear
from tribodyn.study.pipeline.tooth_contact import mesh_of

COEFFICIENT, TURNS = 1e-17, 1e6


@pytest.fixture(scope="module")
def case() -> tribodyn.Case:
    return tribodyn.load_case("fzg-roughness").replace({"stiffness.model": "analytic"})


HELICAL = {"stiffness.model": "analytic", "film.model": "none", "friction.law": "none"}


@pytest.mark.parametrize("name", ["spur", "helical"])
def test_one_step_is_archard_by_hand(case: tribodyn.Case, name: str) -> None:
    if name == "helical":
        case = tribodyn.load_case("helical-pair").replace(HELICAL)
    worn = wear(case, COEFFICIENT, TURNS, steps=1)
    mesh = mesh_of(case)
    pair, pinion_speed = case.gear_pair, abs(case.pinion_speed)
    volume = {}
    for gear, turned in (("pinion", TURNS), ("wheel", TURNS / case.gear_ratio)):
        flank = flank_ranges(pair)[("pinion", "wheel").index(gear)]
        depth = getattr(worn, f"depth_{gear}")[-1]
        radius = flank.lowest + worn.place * flank.length
        base = getattr(pair, gear).base_radius
        # volume of all teeth: arc length of an involute is rho d(rho)/r_b
        teeth = abs(getattr(pair, gear).teeth)
        volume[gear] = np.trapezoid(depth * radius, radius) / base * pair.common_face_width * teeth
        volume[gear] /= np.cos(pair.base_helix_angle)  # the flank is inclined to the axis
        pitch = base * np.tan(pair.operating_pressure_angle)
        at_pitch = np.interp(pitch, radius, depth)
        assert at_pitch < 0.1 * depth.max()  # no sliding there, between two places
        mesh_cycles = turned * teeth
        sliding = mesh.grid.mean((mesh.normal_force * np.abs(mesh.sliding_speed)).sum(axis=1))
        cycle = 2.0 * np.pi / pinion_speed / pair.pinion.teeth
        expected = COEFFICIENT * sliding * cycle * mesh_cycles
        expected /= np.cos(pair.base_helix_angle)  # normal_force is its transverse part
        assert abs(volume[gear] / expected - 1.0) < 0.02  # 41 places over jumps of the load
    assert abs(volume["pinion"] / volume["wheel"] - 1.0) < 0.01


def test_wear_is_linear_at_first_and_spreads_the_load(case: tribodyn.Case) -> None:
    little, twice = (wear(case, COEFFICIENT, turns, steps=1) for turns in (TURNS, 2.0 * TURNS))
    np.testing.assert_allclose(twice.depth_wheel, 2.0 * little.depth_wheel, rtol=1e-12)
    long = wear(case, COEFFICIENT, 30.0 * TURNS, steps=4)
    assert np.all(np.diff(long.depth_pinion, axis=0) >= 0.0)
    fresh = np.diff(long.depth_pinion, axis=0)
    assert fresh[-1].max() < fresh[0].max()  # what has worn off carries less
    again = wear(long.case, COEFFICIENT, TURNS, steps=1)
    np.testing.assert_allclose(again.depth_pinion[0], long.depth_pinion[-1], rtol=1e-9)


def test_what_cannot_wear_is_refused(case: tribodyn.Case) -> None:
    with pytest.raises(InputError, match="coefficient"):
        wear(case, 0.0, TURNS)
    with pytest.raises(InputError, match="not cylindrical"):
        wear(tribodyn.load_case("hypoid-mixed-ehl"), COEFFICIENT, TURNS)
