"""Points and ellipses solved: Hertz, symmetry, rotation, regressions and the line as limits."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from tribodyn.ehl import PointContactSolution, solve_point_contact
from tribodyn.errors import quiet
from tribodyn.lubricant import Lubricant

OIL = Lubricant(0.05, 880.0, 2e-8)
MODULUS = 2.2e11


def solve(
    force: float, radius_x: float, radius_y: float, speed: float, nodes: int = 65, **more: Any
) -> PointContactSolution:
    """Solve a contact of steel in the same oil, on any grid without a warning."""
    with quiet("film-resolution"):
        return solve_point_contact(
            force, radius_x, radius_y, speed, OIL, MODULUS, nodes=nodes, **more
        )


def test_solution_meets_its_equations_and_is_symmetric() -> None:
    contact = solve(5.0, 0.01, 0.01, 1.0)
    hx, hy = np.diff(contact.x)[0], np.diff(contact.y)[0]
    assert contact.load_error < 1e-4
    assert contact.residual < 1e-3
    # The grid carries all of the load but the far inlet.
    inside = contact.pressure[1:-1, 1:-1].sum() * hx * hy
    assert inside + contact.outside_load == pytest.approx(5.0, rel=1e-4)
    assert 0.0 < contact.outside_load < 0.1 * 5.0
    assert contact.pressure.min() == 0.0
    np.testing.assert_allclose(contact.pressure, contact.pressure[::-1], atol=1e-3 * 0.5e9)
    np.testing.assert_allclose(contact.film, contact.film[::-1], rtol=1e-3)
    assert contact.minimum_film < contact.central_film < contact.film[0, 0]


def test_entrainment_turned_by_90_degrees_is_the_contact_with_swapped_radii() -> None:
    contact = solve(20.0, 0.01, 0.02, 2.0)
    turned = solve(20.0, 0.02, 0.01, 2.0, entrainment_angle=math.pi / 2)
    back = solve(20.0, 0.02, 0.01, 2.0, entrainment_angle=-math.pi / 2)
    np.testing.assert_allclose(turned.film.T, contact.film, rtol=1e-6)
    np.testing.assert_allclose(back.film[::-1].T, contact.film, rtol=1e-6)
    assert turned.moes_load == pytest.approx(contact.moes_load)
    assert turned.semi_axis_y == pytest.approx(contact.semi_axis_x)


def test_round_contact_has_the_same_film_in_every_direction() -> None:
    straight = solve(5.0, 0.01, 0.01, 1.0)
    for angle in (math.pi / 4, -2.2):
        oblique = solve(5.0, 0.01, 0.01, 1.0, entrainment_angle=angle)
        assert oblique.central_film == pytest.approx(straight.central_film, rel=0.01)
        assert oblique.minimum_film == pytest.approx(straight.minimum_film, rel=0.02)


def test_thin_film_leaves_the_pressure_of_hertz() -> None:
    contact = solve(500.0, 0.01, 0.02, 0.2, 129)
    X, Y = np.meshgrid(contact.x / contact.semi_axis_x, contact.y / contact.semi_axis_y)
    dry = np.sqrt(np.maximum(1.0 - X**2 - Y**2, 0.0))
    inside = X**2 + Y**2 < 0.8
    difference = contact.pressure / contact.hertz_pressure - dry
    assert np.abs(difference[inside]).max() < 0.03
    assert contact.approach == pytest.approx(contact.hertz_approach, rel=0.01)
    # The film is flat where the pressure is great.
    assert np.ptp(contact.film[X**2 + Y**2 < 0.3]) < 0.15 * contact.central_film
