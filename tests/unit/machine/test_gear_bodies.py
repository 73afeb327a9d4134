"""Mass and inertia of gears around their shafts."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from machines import two_stage_parts

from tribodyn.errors import InputError
from tribodyn.gear import cylindrical_pair, mass_properties
from tribodyn.machine import Gear, GearBody, Machine, Section, Shaft

HELIX, WIDTH = math.radians(21.0), 0.05
RADIUS = 0.5 * 27 * 4.5e-3 / math.cos(HELIX)


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


@pytest.mark.parametrize("left", [0.013, 0.029, 0.041, 0.058])
@pytest.mark.parametrize("width", [0.021, 0.023, 0.025, 0.03])
def test_a_face_that_ends_at_a_shoulder_stays_before_it(left: float, width: float) -> None:
    """Ends of sections add up to 0.07800000000000001: that is the end of the face."""
    sections = [
        Section(0.3 * left, 0.03),
        Section(0.7 * left, 0.025),
        Section(0.1 * width, 0.02),
        Section(0.2 * width, 0.02),
        Section(0.7 * width, 0.02),
        Section(0.05, 0.2),  # thicker than the gear
    ]
    result = body(Gear("input", left + width / 2, 27, width), [*sections, Section(0.2, 0.05)])
    values = result.mass, result.moment_of_inertia, result.transverse_moment_of_inertia
    assert values == pytest.approx(hollow(RADIUS, 0.01, width), rel=1e-12)


def test_a_lumped_gear_may_be_smaller_than_its_shaft() -> None:
    parts = two_stage_parts()
    parts["shafts"]["input"] = Shaft([Section(0.3, 0.15)])
    parts["meshes"]["first"] = replace(parts["meshes"]["first"], stiffness=4e8)
    parts["gears"]["z1"] = Gear("input", 0.1, 27, WIDTH, 5.0, 0.004)
    result = Machine(**parts).gear_bodies["z1"]
    # a uniform disc has the transverse moment of inertia J / 2 + m b^2 / 12
    assert (result.mass, result.moment_of_inertia) == (5.0, 0.004)
    disc = 0.002 + 5.0 * WIDTH**2 / 12.0
    assert result.transverse_moment_of_inertia == pytest.approx(disc, rel=1e-14)
    parts["gears"]["z1"] = Gear("input", 0.1, 27, WIDTH, 5.0, 0.004, 0.003)
    assert Machine(**parts).gear_bodies["z1"] == GearBody(5.0, 0.004, 0.003)
    for gear, mesh in (
        (Gear("input", 0.1, 27, WIDTH, 5.0), parts["meshes"]["first"]),
        (parts["gears"]["z1"], replace(parts["meshes"]["first"], stiffness=None)),
    ):
        parts["gears"]["z1"], parts["meshes"]["first"] = gear, mesh
        with pytest.raises(InputError, match="give mass and moment_of_inertia of the gear and the"):
            Machine(**parts)


def test_user_values_stay_and_a_mass_alone_scales_the_solid() -> None:
    solid = body(Gear("input", 0.1, 27, WIDTH), [Section(0.3, 0.05)])
    light = body(Gear("input", 0.1, 27, WIDTH, mass=solid.mass / 4), [Section(0.3, 0.05)])
    assert light.moment_of_inertia == pytest.approx(solid.moment_of_inertia / 4, rel=1e-14)
    values = Gear("input", 0.1, 27, WIDTH, 1.0, 2.0, 3.0)
    assert body(values, [Section(0.3, 0.05)]) == GearBody(1.0, 2.0, 3.0)
    polar = body(replace(values, mass=None), [Section(0.3, 0.05)])
    assert polar == GearBody(solid.mass, 2.0, 3.0)


def test_a_ring_has_a_root_and_a_rim_of_three_and_a_half_modules() -> None:
    from machines import pair

    ring = pair((21, -72)).gear_bodies["b"]
    outer, inner = 0.5 * 72 * 2e-3 + 4.75 * 2e-3, 0.5 * 72 * 2e-3
    values = ring.mass, ring.moment_of_inertia, ring.transverse_moment_of_inertia
    assert values == pytest.approx(hollow(outer, inner, 0.02), rel=1e-12)


def test_the_larger_of_bore_and_shaft_is_taken_out() -> None:
    gear = Gear("input", 0.1, 27, WIDTH, bore_diameter=0.06, density=1400.0)
    for sections in ([Section(0.3, 0.05)], [Section(0.1, 0.05), Section(0.2, 0.06)]):
        result = body(gear, sections)
        values = result.mass, result.moment_of_inertia, result.transverse_moment_of_inertia
        steel = np.array(hollow(RADIUS, 0.03, WIDTH))
        assert values == pytest.approx(steel * 1400.0 / 7850.0, rel=1e-12)
    assert body(gear, [Section(0.3, 0.07)]) == body(
        replace(gear, bore_diameter=0.0), [Section(0.3, 0.07)]
    )
    # a cone of 50 to 70 mm passes the bore in the middle of the face
    cone = body(gear, [Section(0.075, 0.05), Section(0.05, 0.05, 0.0, 0.07), Section(0.2, 0.05)])
    x = (np.arange(200_000) + 0.5) / 200_000 * WIDTH - 0.5 * WIDTH
    r = np.maximum(0.03 + 0.2 * x, 0.03)
    assert cone.mass == pytest.approx(1400.0 * math.pi * WIDTH * np.mean(RADIUS**2 - r**2))
    ends = body(gear, [Section(0.1, 0.08), Section(0.2, 0.05)])  # the shaft fills half of the face
    half = 0.5 * WIDTH * math.pi * 1400.0
    assert ends.mass == pytest.approx(half * (2 * RADIUS**2 - 0.03**2 - 0.04**2), rel=1e-12)


def test_a_tooth_form_gives_the_mass_of_the_gear_alone() -> None:
    pinion = cylindrical_pair(
        normal_module=4.5e-3, normal_pressure_angle=math.radians(20.0), helix_angle=HELIX,
        pinion_teeth=27, wheel_teeth=51, pinion_profile_shift_coefficient=0.3,
        wheel_profile_shift_coefficient=0.0, pinion_face_width=WIDTH, wheel_face_width=WIDTH,
        pinion_bore_diameter=0.05,
    ).pinion  # fmt: skip
    gear = Gear("input", 0.1, 27, WIDTH, form=pinion)
    result, alone = body(gear, [Section(0.3, 0.05)]), mass_properties(pinion, 7850.0)
    assert result.mass == pytest.approx(alone.mass, rel=1e-13)
    assert result.moment_of_inertia == pytest.approx(alone.moment_of_inertia, rel=1e-13)


def test_bodies_of_which_nothing_is_left_are_refused() -> None:
    with pytest.raises(InputError, match=r"gears\.z1\.bore_diameter"):
        body(Gear("input", 0.1, 27, WIDTH, bore_diameter=0.2), [Section(0.3, 0.05)])
    for changes, name in (
        ({"rim_diameter": 0.2}, "rim_diameter"),
        ({"density": 0.0}, "density"),
        ({"form": Gear}, "form"),
    ):
        with pytest.raises(InputError, match=name):
            Gear("input", 0.1, 27, WIDTH, **changes)
