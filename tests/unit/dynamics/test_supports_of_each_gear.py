"""Pinion and wheel on supports of their own: what moves across the line of action swings alone."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

import tribodyn as td
from tribodyn.dynamics import STRUCTURES, Gearing
from tribodyn.study import read_case

FLAT = SimpleNamespace(
    stiffness=lambda phase: 3e8 + 0 * phase,
    friction_sum=lambda phase: 0 * phase,
    friction_moment_pinion=lambda phase: 0 * phase,
    friction_moment_wheel=lambda phase: 0 * phase,
    event_phases=(0.0,),
)
GEARS = Gearing(FLAT, (1.0, 3.0), (1e-3, 3e-3), (0.03, 0.05), (90.0, 150.0), {})
STIFFNESS, RATIO = (2e8, 5e8), 0.03


def _system(name: str, **options: object):
    return STRUCTURES[name](
        GEARS, bearing_stiffness=STIFFNESS, bearing_damping_ratio=RATIO, **options
    )


@pytest.mark.parametrize(
    ("name", "coordinates", "gear"),
    [
        ("spur-6dof", ("pinion_x", "wheel_x"), (0, 1)),
        ("fzg-12dof", ("pinion_v", "wheel_v"), (0, 1)),
        ("fzg-12dof", ("shaft2_v", "shaft1_v"), (0, 1)),
    ],
)
def test_each_support_has_its_own_frequency_and_damping(name, coordinates, gear) -> None:
    system = _system(name)
    for coordinate, which in zip(coordinates, gear, strict=True):
        n = system.names.index(coordinate)
        mass, damping, stiffness = (
            float(matrix[n, n]) for matrix in (system.mass, system.damping, system.stiffness)
        )
        frequency = np.sqrt(STIFFNESS[which] / mass)
        assert np.sqrt(stiffness / mass) == pytest.approx(frequency, rel=1e-12)
        assert damping / (2.0 * mass * frequency) == pytest.approx(RATIO, rel=1e-12)


def test_a_pair_of_equal_values_is_the_single_value() -> None:
    single = STRUCTURES["spur-6dof"](GEARS, bearing_stiffness=2e8, bearing_damping=4e3)
    two = STRUCTURES["spur-6dof"](GEARS, bearing_stiffness=(2e8, 2e8), bearing_damping=(4e3, 4e3))
    np.testing.assert_array_equal(single.stiffness, two.stiffness)
    np.testing.assert_array_equal(single.damping, two.damping)


def test_a_case_gives_pinion_and_wheel_in_one_list() -> None:
    case = td.load_case("fzg-roughness")
    case = case.replace({"dynamics.bearing_stiffness": ["200 N/um", "500 N/um"]})
    assert case.dynamics.bearing_stiffness == STIFFNESS
    assert read_case(case.to_toml()) == case
    assert 'bearing_stiffness = ["200 N/um", "500 N/um"]' in case.to_toml()
