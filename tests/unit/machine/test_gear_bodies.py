"""Mass and inertia of gears around their shafts."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from machines import two_stage_parts

from tribodyn.machine import Gear, GearBody, Machine, Section, Shaft

RADIUS, WIDTH = 0.5 * 27 * 4.5e-3 / math.cos(math.radians(21.0)), 0.05


def body(gear: Gear, sections: list[Section]) -> GearBody:
    parts = two_stage_parts()
    parts["gears"]["z1"] = gear
    parts["shafts"]["input"] = Shaft(sections)
    return Machine(**parts).gear_bodies["z1"]


def hollow(outer: float, inner: float, width: float) -> tuple[float, float, float]:
    """Mass and moments of inertia of a hollow cylinder of steel."""
    mass = 7850.0 * math.pi * (outer**2 - inner**2) * width
    square = outer**2 + inner**2
    return mass, 0.5 * mass * square, mass * (square / 4.0 + width**2 / 12.0)


def test_a_gear_is_a_cylinder_around_its_shaft() -> None:
    gear = Gear("input", 0.1, 27, WIDTH)
    result = body(gear, [Section(0.3, 0.050)])
    values = result.mass, result.moment_of_inertia, result.transverse_moment_of_inertia
    assert values == pytest.approx(hollow(RADIUS, 0.025, WIDTH), rel=1e-12)


def test_the_bore_of_the_shaft_is_no_part_of_the_gear() -> None:
    gear = Gear("input", 0.1, 27, WIDTH)
    assert body(gear, [Section(0.3, 0.05, 0.02)]) == body(gear, [Section(0.3, 0.05)])


def test_steps_and_cones_within_the_face_are_taken_out() -> None:
    gear = Gear("input", 0.1, 27, WIDTH)
    # from 40 to 50 mm over the left half of the face, 60 mm over its right half
    sections = [Section(0.075, 0.04), Section(0.025, 0.04, 0.0, 0.05), Section(0.2, 0.06)]
    result = body(gear, sections)
    x = (np.arange(200_000) + 0.5) / 200_000 * WIDTH - 0.5 * WIDTH
    r = np.where(x < 0.0, 0.025 + 0.005 * x / 0.025, 0.03)
    step = 7850.0 * math.pi * WIDTH / x.size
    mass = step * np.sum(RADIUS**2 - r**2)
    polar = step * np.sum(RADIUS**4 - r**4) / 2.0
    transverse = polar / 2.0 + step * np.sum(x**2 * (RADIUS**2 - r**2))
    assert result.mass == pytest.approx(mass, rel=1e-9)
    assert result.moment_of_inertia == pytest.approx(polar, rel=1e-9)
    assert result.transverse_moment_of_inertia == pytest.approx(transverse, rel=1e-9)


def test_user_values_stay_and_a_mass_alone_scales_the_solid() -> None:
    solid = body(Gear("input", 0.1, 27, WIDTH), [Section(0.3, 0.05)])
    light = body(Gear("input", 0.1, 27, WIDTH, mass=solid.mass / 4), [Section(0.3, 0.05)])
    assert light.moment_of_inertia == pytest.approx(solid.moment_of_inertia / 4, rel=1e-14)
    values = Gear("input", 0.1, 27, WIDTH, 1.0, 2.0, 3.0)
    assert body(values, [Section(0.3, 0.05)]) == GearBody(1.0, 2.0, 3.0)
    polar = body(replace(values, mass=None), [Section(0.3, 0.05)])
    assert polar == GearBody(solid.mass, 2.0, 3.0)


def test_a_ring_reaches_ten_modules_beyond_its_reference_diameter() -> None:
    from machines import pair

    ring = pair((21, -72)).gear_bodies["b"]
    outer, inner = 0.5 * 72 * 2e-3 + 5 * 2e-3, 0.5 * 72 * 2e-3
    values = ring.mass, ring.moment_of_inertia, ring.transverse_moment_of_inertia
    assert values == pytest.approx(hollow(outer, inner, 0.02), rel=1e-12)
