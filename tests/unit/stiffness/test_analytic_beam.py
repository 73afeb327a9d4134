"""The tooth between its foot and the place where the load crosses its axis."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tribodyn.gear import BasicRack, SpurGear, half_tooth
from tribodyn.stiffness import LoadPoint, load_point, tooth_bending_compliance
from tribodyn.stiffness.teeth.tooth_bending import beam_to_axis, flank_nodes

#: Bar of 2 mm half thickness from height 10 to 30 mm.
BAR = (np.array([0.01, 0.02, 0.03]), np.full(3, 2e-3))


def crossing(axis_height: float, load_angle: float = 0.3) -> LoadPoint:
    """A load that crosses the axis at a height, from the side of the bar."""
    return LoadPoint(
        height=np.array(axis_height + 2e-3 * math.tan(load_angle)),
        half_thickness=np.array(2e-3),
        load_angle=np.array(load_angle),
        axis_height=np.array(axis_height),
        depth=np.array(2e-3 / math.cos(load_angle)),
    )


def test_a_bar_bends_shears_and_shortens_up_to_the_axis(steel):
    length, angle = 0.012, 0.3
    parts = beam_to_axis(BAR, crossing(0.01 + length, angle), steel)
    across, along = math.cos(angle) ** 2, math.sin(angle) ** 2
    inertia, area = 4e-3**3 / 12.0, 4e-3
    modulus = steel.youngs_modulus
    assert parts.bending == pytest.approx(across * length**3 / (3.0 * modulus * inertia), rel=1e-9)
    shear = 1.2 * across * length / (steel.shear_modulus * area)
    assert parts.shear == pytest.approx(shear, rel=1e-9)
    assert parts.axial == pytest.approx(along * length / (modulus * area), rel=1e-9)


def test_below_the_foot_the_spared_piece_counts_negative(steel):
    above, below = (beam_to_axis(BAR, crossing(0.01 + reach), steel) for reach in (1e-3, -1e-3))
    assert below.shear == pytest.approx(-above.shear, rel=1e-9)
    assert below.axial == pytest.approx(-above.axial, rel=1e-9)
    assert float(below.bending) == 0.0


def test_a_load_that_pushes_straight_across_is_the_whole_beam(fzg, steel):
    gear = fzg().wheel
    outline = half_tooth(gear, 400)
    load = load_point(gear, gear.base_half_angle * gear.base_radius)
    beam = tooth_bending_compliance(outline, load.height, load.half_thickness, 0.0, 1.0, steel)
    assert beam_to_axis(outline, load, steel).total == pytest.approx(beam.total, rel=1e-6)


def test_it_passes_the_foot_without_a_kink(steel):
    gear = SpurGear(
        teeth=60,
        normal_module=3e-3,
        normal_pressure_angle=math.radians(24.0),
        profile_shift_coefficient=0.5,
        tip_diameter=0.189,
        rack=BasicRack(tip_radius_coefficient=0.25),
        face_width=0.02,
    )
    outline = half_tooth(gear, 400)
    load = load_point(gear, flank_nodes(gear, 400))
    reach = load.axis_height - outline[0][0]
    assert reach[0] < -1e-4 < 1e-3 < reach[-1]
    total = beam_to_axis(outline, load, steel).total
    slope = np.diff(total) / np.diff(load.axis_height)
    at_foot = np.argmax(reach > 0.0)
    assert np.abs(np.diff(slope[at_foot - 4 : at_foot + 4])).max() < 0.1 * slope[at_foot]
    assert np.all(slope[at_foot - 20 :] > 0.0)
