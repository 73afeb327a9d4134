"""The energy method against beams with a closed form."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn.errors import InputError
from tribodyn.gear import Material
from tribodyn.stiffness import tooth_bending_compliance

LENGTH, HALF, WIDTH = 8e-3, 3e-3, 20e-3
MATERIAL = Material()
E, G = MATERIAL.youngs_modulus, MATERIAL.shear_modulus
INERTIA, AREA = (2 * HALF) ** 3 * WIDTH / 12, 2 * HALF * WIDTH


def bar(points=7, foot=0.03):
    return foot + np.linspace(0.0, LENGTH, points), np.full(points, HALF)


def test_a_bar_loaded_across_is_the_cantilever():
    compliance = tooth_bending_compliance(bar(), 0.03 + LENGTH, 0.0, 0.0, WIDTH, MATERIAL)
    assert compliance.bending == pytest.approx(LENGTH**3 / (3 * E * INERTIA), rel=1e-12)
    assert compliance.shear == pytest.approx(1.2 * LENGTH / (G * AREA), rel=1e-12)
    assert compliance.axial == 0.0
    assert compliance.total == compliance.bending + compliance.shear + compliance.axial


def test_a_load_within_the_length_uses_only_the_part_below():
    reach = np.array([0.0, 0.3, 0.77]) * LENGTH
    compliance = tooth_bending_compliance(bar(), 0.03 + reach, 0.0, 0.0, WIDTH, MATERIAL)
    assert compliance.bending == pytest.approx(reach**3 / (3 * E * INERTIA), rel=1e-12)


def test_an_oblique_load_off_the_axis():
    angle, offset = 0.4, 2e-3
    compliance = tooth_bending_compliance(bar(), 0.03 + LENGTH, offset, angle, WIDTH, MATERIAL)
    # M(s) = cos a (L - s) - sin a x: a tip force and a tip moment.
    force, moment = np.cos(angle), -np.sin(angle) * offset
    by_hand = force**2 * LENGTH**3 / 3 + force * moment * LENGTH**2 + moment**2 * LENGTH
    assert compliance.bending == pytest.approx(by_hand / (E * INERTIA), rel=1e-12)
    assert compliance.axial == pytest.approx(np.sin(angle) ** 2 * LENGTH / (E * AREA), rel=1e-12)


def test_a_wedge_has_its_closed_form():
    # Half thickness c (L1 - y) for y up to L: integral of (L - y)^2 / (c^3 (L1 - y)^3).
    slope, apex, reach = 0.5, 12e-3, 8e-3
    y = np.linspace(0.0, reach, 801)
    bending = tooth_bending_compliance(
        (y, slope * (apex - y)), reach, 0.0, 0.0, WIDTH, MATERIAL
    ).bending
    gap = apex - reach
    closed_form = np.log(apex / gap) - 2 * gap * (1 / gap - 1 / apex) + gap**2 / 2 * (
        1 / gap**2 - 1 / apex**2
    )  # fmt: skip
    assert bending == pytest.approx(1.5 * closed_form / (E * WIDTH * slope**3), rel=1e-7)


def test_compliance_scales_with_modulus_and_width():
    first = tooth_bending_compliance(bar(), 0.035, 1e-3, 0.3, WIDTH, MATERIAL).total
    harder = tooth_bending_compliance(bar(), 0.035, 1e-3, 0.3, WIDTH, Material(2 * E)).total
    wider = tooth_bending_compliance(bar(), 0.035, 1e-3, 0.3, 3 * WIDTH, MATERIAL).total
    assert first == pytest.approx(2 * harder, rel=1e-14)
    assert first == pytest.approx(3 * wider, rel=1e-14)


@pytest.mark.parametrize(
    ("outline", "height", "message"),
    [
        (bar(), 0.03 + 1.01 * LENGTH, "The tooth reaches from"),
        (bar(), 0.029, "The tooth reaches from"),
        ((bar()[0][::-1], bar()[1]), 0.035, "does not increase"),
        ((bar()[0], -bar()[1]), 0.035, "half thickness"),
    ],
)
def test_invalid_beams_are_refused(outline, height, message):
    with pytest.raises(InputError, match=message):
        tooth_bending_compliance(outline, height, 0.0, 0.0, WIDTH, MATERIAL)
