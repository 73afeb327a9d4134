"""Rollers of finite length: the line as limit, the ends, and the balance of forces."""

from __future__ import annotations

import functools

import numpy as np
import pytest

from tribodyn.contact import hertz_line
from tribodyn.ehl import FiniteLineSolution, RollerProfile, solve_finite_line_contact
from tribodyn.errors import InputError, ModelWarning, quiet
from tribodyn.lubricant import Lubricant

OIL = Lubricant(0.05, 880.0, 2e-8)
MODULUS, RADIUS, SPEED, LOAD = 2.2e11, 8e-3, 2.0, 2e5
HALF_WIDTH = float(hertz_line(LOAD, RADIUS, MODULUS).half_width)


@functools.cache
def roller(length: float, profile: RollerProfile, nodes: int = 65) -> FiniteLineSolution:
    """Solve a roller with the load per length that all share."""
    with quiet("film-resolution"):
        return solve_finite_line_contact(
            LOAD * length, length, RADIUS, SPEED, OIL, MODULUS, profile=profile, nodes=nodes
        )


LOGARITHMIC = RollerProfile.logarithmic(10e-3, LOAD, MODULUS, HALF_WIDTH)
STRAIGHT, CROWNED = RollerProfile.straight(), RollerProfile.crowned(1.0)


def test_middle_of_a_long_roller_is_the_infinite_line() -> None:
    contact = roller(10e-3, LOGARITHMIC)
    assert contact.central_film_extrapolated == pytest.approx(contact.line_central_film, rel=0.01)
    middle = contact.pressure[contact.y.size // 2].max()
    assert middle == pytest.approx(contact.hertz_pressure, rel=0.03)


def test_roller_balances_its_load_and_is_symmetric() -> None:
    contact = roller(10e-3, LOGARITHMIC)
    cell = np.diff(contact.x)[0] * np.diff(contact.y)[0]
    inside = contact.pressure[1:-1, 1:-1].sum() * cell
    assert inside + contact.outside_load == pytest.approx(contact.normal_force, rel=1e-4)
    assert contact.pressure.min() == 0.0
    np.testing.assert_allclose(contact.ridge_pressure, contact.ridge_pressure[::-1], rtol=0.02)


def test_shape_decides_how_the_ends_are_loaded() -> None:
    straight, even, crowned = (roller(10e-3, p) for p in (STRAIGHT, LOGARITHMIC, CROWNED))
    # Straight ends press in, the profile of Lundberg spares them, a crown leaves them unloaded.
    assert straight.edge_pressure_ratio > 1.7
    assert 1.0 < even.edge_pressure_ratio < 1.3
    assert crowned.edge_pressure_ratio < 0.6
    assert max(straight.end_film, even.end_film) < 0.2 * crowned.end_film
    assert "not enough" in straight.compare_with_line()
    assert not straight.line_is_enough
    # The load that the ends take is missing in the middle, and the other way round.
    middle = straight.y.size // 2
    assert straight.load_per_length[middle] < LOAD < crowned.load_per_length[crowned.y.size // 2]


def test_friction_of_a_roller_is_that_of_its_line() -> None:
    contact = roller(10e-3, LOGARITHMIC)
    friction = contact.friction(0.5)
    middle = contact.y.size // 2
    mean = friction.force / contact.length
    assert friction.force_per_width[middle] == pytest.approx(mean, rel=0.1)
    assert 0.01 < friction.coefficient < 0.1


def test_film_at_ends_that_the_grid_does_not_resolve_is_reported() -> None:
    with pytest.warns(ModelWarning, match="ends of the roller is thinner"):
        contact = solve_finite_line_contact(
            LOAD * 5e-3, 5e-3, RADIUS, SPEED, OIL, MODULUS, profile=STRAIGHT, nodes=65
        )
    assert contact.minimum_film == 0.0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"length": 0.2}, "length over half width"),
        ({"profile": "crowned"}, "argument profile"),
        ({"edge_radius": 0.0}, "edge_radius"),
        ({"nodes": 100}, "nodes = 100"),
        ({"normal_force": -1.0}, "normal_force"),
    ],
)
def test_values_out_of_range_are_refused(change: dict[str, object], message: str) -> None:
    values = {"normal_force": 2000.0, "length": 10e-3, "profile": STRAIGHT, **change}
    with pytest.raises(InputError, match=message):
        solve_finite_line_contact(
            equivalent_radius=RADIUS,
            entrainment_speed=SPEED,
            lubricant=OIL,
            effective_modulus=MODULUS,
            **values,
        )
