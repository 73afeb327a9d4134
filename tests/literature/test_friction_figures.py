"""Friction of an FZG type A pair: reference values along the path of contact, and claims.

Pinion of 16 teeth driving, 90 N*m and 900 rpm on the pinion, 82 mPa*s, face width 20 mm, total
normal force 2660.44 N, half of it on each pair while two are in contact. The figures are those of
tests/references/friction_table.py, from the papers of both laws.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from references import friction_table
from references.friction_table import FACE_WIDTH, NORMAL_FORCE, VISCOSITY
from tribodyn.errors import ModelWarning
from tribodyn.friction import LAWS, TribologicalContact, benedict_kelly

MODULUS = 2.30769e11

#: share, sliding speed, entrainment speed, slide-to-roll ratio, R [mm], P_h [GPa], Xu, B-K
TABLE = np.array(friction_table.TABLE)[:, 1:]
POSITIONS = ["A", "after B", "middle of B-D", "E"]


def contact(rows=slice(None), roughness=0.53e-6):
    share, sliding, entrainment, ratio, radius, pressure = TABLE[rows, :6].T
    load = share * NORMAL_FORCE / FACE_WIDTH
    return TribologicalContact(
        load_per_width=load,
        hertz_pressure=pressure * 1e9,
        sliding_speed=sliding,
        entrainment_speed=entrainment,
        slide_to_roll_ratio=ratio,
        equivalent_radius=radius * 1e-3,
        dynamic_viscosity=VISCOSITY,
        composite_roughness=roughness,
    )


def test_pressures_of_the_table_follow_from_load_and_radius():
    c = contact()
    pressure = np.sqrt(c.load_per_width * MODULUS / (2 * math.pi * c.equivalent_radius))
    assert pressure == pytest.approx(c.hertz_pressure, rel=2e-6)


def test_xu_at_all_positions():
    with pytest.warns(ModelWarning, match=r"slide_to_roll_ratio\| .* to 1\.486") as caught:
        coefficient = LAWS["xu-2007"](contact())
    assert len(caught) == 1
    assert coefficient == pytest.approx(TABLE[:, 6], rel=1e-5)


@pytest.mark.parametrize("row", range(3), ids=POSITIONS[:3])
def test_xu_inside_of_its_range_does_not_warn(row):
    coefficient = LAWS["xu-2007"](contact([row]))
    assert coefficient == pytest.approx(TABLE[row, 6], rel=1e-5)


@pytest.mark.parametrize("row", range(4), ids=POSITIONS)
def test_benedict_kelly(row):
    assert LAWS["benedict-kelly"](contact([row])) == pytest.approx(TABLE[row, 7], rel=1e-5)


@pytest.mark.parametrize(
    ("roughness", "expected"), [(0.325e-6, 0.085), (0.53e-6, 0.114), (0.991e-6, 0.493)]
)
def test_roughness_study_with_the_printed_factor(roughness, expected):
    c = contact([2])
    arguments = (c.load_per_width, c.sliding_speed, c.entrainment_speed, VISCOSITY, roughness)
    if roughness > 0.8e-6:
        with pytest.warns(ModelWarning, match="friction-roughness"):
            coefficient = benedict_kelly(*arguments, variant="he-singh")
    else:
        coefficient = benedict_kelly(*arguments, variant="he-singh")
    assert coefficient == pytest.approx(expected, abs=6e-4)


def test_claim_that_the_logarithm_is_least_at_the_pitch_point_is_refuted():
    c = contact([1])
    sliding = np.array([0.0, 0.1, 0.210801])
    coefficient = benedict_kelly(
        c.load_per_width, sliding, c.entrainment_speed, VISCOSITY, c.composite_roughness
    )
    assert np.argmax(coefficient) == 0


def test_claim_that_friction_falls_with_torque_holds_for_xu_and_not_for_benedict_kelly():
    # single pair of teeth, pitch region: 50, 150, 300 N*m
    load = np.array([50.0, 150.0, 300.0]) / 50.7434e-3 / FACE_WIDTH
    radius, ones = np.full(3, 8e-3), np.ones(3)
    c = TribologicalContact(
        load_per_width=load,
        hertz_pressure=np.sqrt(load * 2.2e11 / (2 * math.pi * radius)),
        sliding_speed=1.5 * ones,
        entrainment_speed=3.0 * ones,
        slide_to_roll_ratio=0.5 * ones,
        equivalent_radius=radius,
        dynamic_viscosity=VISCOSITY,
        composite_roughness=0.46e-6,
    )
    with pytest.warns(ModelWarning, match="hertz_pressure 0.46"):
        xu = LAWS["xu-2007"](c)
    assert np.all(np.diff(xu) < 0.0)
    assert np.all(np.diff(LAWS["benedict-kelly"](c)) > 0.0)
