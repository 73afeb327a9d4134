"""Mass and inertia against the polygon of the outline."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from tribodyn.errors import InputError
from tribodyn.gear import SpurGear, gear_outline, mass_properties, section_moments

Maker = Callable[..., SpurGear]


def polygon_moments(gear: SpurGear, points: int) -> tuple[float, float]:
    x, y = gear_outline(gear, points)
    cross = x[:-1] * y[1:] - x[1:] * y[:-1]
    second = x[:-1] ** 2 + x[:-1] * x[1:] + x[1:] ** 2 + y[:-1] ** 2 + y[:-1] * y[1:] + y[1:] ** 2
    return float(cross.sum()) / 2.0, float(cross @ second) / 12.0


@pytest.mark.parametrize(
    ("teeth", "shift", "tip"), [(20, 0.0, 88e-3), (24, -0.5103, 0.099755), (10, 0.1, 48e-3)]
)
def test_section_is_the_limit_of_fine_polygons(
    make_gear: Maker, teeth: int, shift: float, tip: float
) -> None:
    gear = make_gear(teeth=teeth, profile_shift_coefficient=shift, tip_diameter=tip)
    exact = np.array(section_moments(gear))
    errors = [polygon_moments(gear, n) / exact - 1.0 for n in (1000, 2000)]
    assert np.abs(errors[1]).max() < 6e-7
    # Chords leave out area of the second order: halving them removes three quarters.
    assert errors[0] / errors[1] == pytest.approx([4.0, 4.0], rel=0.05)


def test_outline_is_closed_and_anticlockwise(make_gear: Maker) -> None:
    outline = gear_outline(make_gear(), 100)
    assert outline[:, 0] == pytest.approx(outline[:, -1], abs=0.0)
    turn = np.unwrap(np.arctan2(outline[1], outline[0]))
    assert turn[-1] - turn[0] == pytest.approx(2.0 * math.pi, rel=1e-12)


def test_bore_takes_away_its_cylinder(make_gear: Maker) -> None:
    solid = mass_properties(make_gear(), 7800.0)
    bored = mass_properties(make_gear(bore_diameter=30e-3), 7800.0)
    bore_mass = 7800.0 * 20e-3 * math.pi * 15e-3**2
    assert solid.mass - bored.mass == pytest.approx(bore_mass, rel=1e-12)
    inertia = solid.moment_of_inertia - bored.moment_of_inertia
    assert inertia == pytest.approx(0.5 * bore_mass * 15e-3**2, rel=1e-10)


def test_user_figures_replace_those_of_the_solid(make_gear: Maker) -> None:
    solid = mass_properties(make_gear(), 7800.0)
    heavy = mass_properties(make_gear(mass=3.0), 7800.0)
    assert heavy.mass == 3.0
    scale = 3.0 / solid.mass  # a mass alone is that of a heavier body of the same shape
    assert heavy.moment_of_inertia == pytest.approx(scale * solid.moment_of_inertia, rel=1e-14)
    assert mass_properties(make_gear(moment_of_inertia=0.1), 7800.0).moment_of_inertia == 0.1


def test_density_must_be_positive(make_gear: Maker) -> None:
    with pytest.raises(InputError, match="density"):
        mass_properties(make_gear(), 0.0)
