"""Points and ellipses solved: Hertz, symmetry, rotation, regressions and the line as limits."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from tribodyn.ehl import (
    PointContactSolution,
    hamrock_dowson_central,
    hamrock_dowson_minimum,
    nijenbanning_central,
    solve_line_contact,
    solve_point_contact,
)
from tribodyn.errors import ComputationError, InputError, ModelWarning, quiet
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
        assert oblique.cycles < 8
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


@pytest.mark.parametrize(
    ("force", "radius_x", "radius_y", "speed"),
    [(5.0, 0.01, 0.01, 1.0), (20.0, 0.01, 0.03, 1.0), (100.0, 0.01, 0.02, 10.0)],
)
def test_regressions_meet_the_solved_film(
    force: float, radius_x: float, radius_y: float, speed: float
) -> None:
    # Both were fitted to solutions: of an incompressible oil, and of coarse grids.
    oil = force, radius_x, radius_y, speed, 0.05, 2e-8, MODULUS
    contact = solve(*oil[:4], compressible=False)
    film = contact.central_film_extrapolated
    assert film == pytest.approx(nijenbanning_central(*oil), rel=0.1)
    film = solve(*oil[:4])
    assert film.central_film_extrapolated == pytest.approx(hamrock_dowson_central(*oil), rel=0.15)
    assert film.minimum_film == pytest.approx(hamrock_dowson_minimum(*oil), rel=0.3)


def test_rigid_bodies_have_the_film_of_brewe_and_hamrock() -> None:
    # Little load on an isoviscous oil, a point: H = 128 D f^2 (0.131 atan(D/2) + 1.683)^2 (U/W)^2
    # with D = 1 and f = 1/(1 + 2/(3 D)) of Brewe, Hamrock and Taylor (1979).
    contact = solve(0.2, 0.01, 0.01, 2.0, viscosity_law="isoviscous", compressible=False)
    speed = 0.05 * 2.0 / (MODULUS * 0.01)
    load = 0.2 / (MODULUS * 0.01**2)
    film = 128.0 * 0.6**2 * (0.131 * math.atan(0.5) + 1.683) ** 2 * (speed / load) ** 2
    assert contact.moes_load < 0.5
    assert contact.central_film == pytest.approx(0.01 * film, rel=0.04)
    assert contact.outside_load < 0.2 * 0.2


def test_wide_ellipse_has_the_film_of_a_line() -> None:
    contact = solve(300.0, 0.01, 1.0, 5.0, 129)
    load = contact.hertz_pressure**2 * 2.0 * math.pi * 0.01 / MODULUS
    line = solve_line_contact(load, 0.01, 5.0, OIL, MODULUS)
    assert contact.central_film_extrapolated == pytest.approx(line.central_film, rel=0.01)


@pytest.mark.slow
def test_film_converges_with_the_square_of_the_interval() -> None:
    films = [solve(20.0, 0.01, 0.01, 5.0, nodes).central_film for nodes in (65, 129, 257)]
    assert (films[1] - films[0]) / (films[2] - films[1]) == pytest.approx(4.0, abs=1.0)


def test_friction_falls_as_the_film_heats_up() -> None:
    oil = Lubricant(
        0.05, 880.0, 2e-8, temperature=313.15, temperature_viscosity_coefficient=0.04,
        thermal_conductivity=0.13,
    )  # fmt: skip
    contact = solve_point_contact(10.0, 0.01, 0.01, 2.0, oil, MODULUS, nodes=65)
    cold, warm = (contact.friction(1.0, flash_temperature=heated) for heated in (False, True))
    assert 0.0 < warm.coefficient < cold.coefficient < 0.1
    assert 1.0 < warm.mean_temperature_rise < 100.0
    # A little sliding shears the film like a Newtonian liquid.
    slow = contact.friction(1e-9), contact.friction(2e-9)
    assert slow[1].force == pytest.approx(2.0 * slow[0].force, rel=1e-6)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"normal_force": 0.0}, "normal_force"),
        ({"radius_y": math.inf}, "radius_y"),
        ({"radius_y": 50.0}, "times as long as wide"),
        ({"normal_force": 1e5}, "narrow against the radii|Hertz pressure"),
        ({"nodes": 100}, "nodes = 100"),
        ({"entrainment_angle": 45.0}, "entrainment_angle"),
        ({"lubricant": 0.05}, "argument lubricant"),
    ],
)
def test_values_out_of_range_are_refused(change: dict[str, Any], message: str) -> None:
    values = {"normal_force": 20.0, "radius_x": 0.01, "radius_y": 0.01, "lubricant": OIL}
    with pytest.raises(InputError, match=message):
        solve_point_contact(
            entrainment_speed=1.0, effective_modulus=MODULUS, **{**values, **change}
        )


def test_grid_too_coarse_for_the_film_is_reported() -> None:
    with pytest.warns(ModelWarning, match="estimated error"):
        solve_point_contact(20.0, 0.01, 0.01, 1.0, OIL, MODULUS, nodes=33)
    with pytest.raises(ComputationError, match="Use more nodes than 33"):
        solve_point_contact(1000.0, 0.02, 0.02, 0.1, OIL, MODULUS, nodes=33)


@pytest.mark.slow
def test_case_of_venner_and_lubrecht_keeps_its_film() -> None:
    # M = 20, L = 10 in SI; own films of three nested grids on the domain of that case, -4.5..1.5
    # by -3..3, extrapolate to H = 0.4309. The flooded film of this grid lies within 1 % of it.
    radius, viscosity, modulus = 0.01, 0.03595, 2.2e11
    viscous = (10.0 / (2.2e-8 * modulus)) ** 4
    speed = viscous * modulus * radius / (2.0 * viscosity)
    oil = Lubricant(viscosity, 880.0, 2.2e-8)
    assert oil.roelands_index == pytest.approx(0.68, abs=1e-3)
    force = 20.0 * modulus * radius**2 * viscous**0.75
    contact = solve_point_contact(force, radius, radius, speed, oil, modulus, nodes=129)
    assert contact.moes_load == pytest.approx(20.0)
    assert contact.moes_viscosity == pytest.approx(10.0)
    film = contact.central_film_extrapolated / (contact.semi_axis_x**2 / radius)
    assert film == pytest.approx(0.4309, rel=0.015)
