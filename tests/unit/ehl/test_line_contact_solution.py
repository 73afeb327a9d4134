"""The solution object, its units and warnings, nodes and start."""

from __future__ import annotations

import math
import warnings

import numpy as np
import pytest

from tribodyn.ehl import LineContactSolution, solve_line_contact, solve_line_contact_moes
from tribodyn.errors import ModelWarning
from tribodyn.lubricant import Lubricant

OIL = Lubricant(0.082, 880.0, 2.19e-8)
CONTACT = (147802.0, 8e-3, 3.0722, OIL, 2.2e11)


@pytest.fixture(scope="module")
def solution():
    return solve_line_contact(*CONTACT, nodes=513)


def test_si_form_is_the_dimensionless_one_in_units(solution):
    plain = solve_line_contact_moes(
        solution.moes_load, solution.moes_viscosity, pressure_viscosity_index=OIL.roelands_index,
        pressure_viscosity_coefficient=2.19e-8, domain="auto", inlet="flooded", nodes=513,
    )  # fmt: skip
    b, p, h = solution.half_width, solution.hertz_pressure, solution.film_unit
    assert b == pytest.approx(math.sqrt(8 * 147802.0 * 8e-3 / (math.pi * 2.2e11)))
    assert p == pytest.approx(math.sqrt(147802.0 * 2.2e11 / (2 * math.pi * 8e-3)))
    assert h == pytest.approx(b * b / 8e-3)
    assert solution.position == pytest.approx(plain.position * b, rel=1e-12)
    assert solution.pressure == pytest.approx(plain.pressure * p, rel=1e-9, abs=1e-9 * p)
    assert solution.film == pytest.approx(plain.film * h, rel=1e-10)
    assert solution.outlet == pytest.approx(plain.outlet * b, rel=1e-9)
    assert plain.film_unit == plain.half_width == plain.hertz_pressure == 1.0
    # the natural units of the dimensionless form belong together
    w, R, modulus = plain.load_per_width, plain.equivalent_radius, plain.effective_modulus
    assert math.sqrt(8 * w * R / (math.pi * modulus)) == pytest.approx(1.0)
    assert math.sqrt(w * modulus / (2 * math.pi * R)) == pytest.approx(1.0)


def test_load_film_and_outlet(solution):
    width = solution.position[1] - solution.position[0]
    inside = width * (solution.pressure.sum() - 0.5 * solution.pressure[0])
    # the tail before the domain carries the rest
    assert 0.98 < inside / 147802.0 < 1.0
    assert solution.film.min() == solution.minimum_film < solution.central_film
    assert solution.pressure[solution.position > solution.outlet].max() == 0.0
    # the outlet lies between the nodes, behind the last one with pressure
    assert solution.pressure[solution.position < solution.outlet - width].min() > 0.0
    assert 1.0 < solution.outlet / solution.half_width < solution.domain[1]
    assert solution.cavity_residual >= 0.0
    assert solution.load_error < 1e-8
    assert solution.flux_error < 1e-3
    assert (solution.method, solution.attempts) == ("newton", ())


def test_spike_is_the_maximum_next_to_the_outlet(solution):
    index = int(np.argmin(np.abs(solution.position - solution.spike_position)))
    assert solution.pressure[index] == solution.spike_pressure
    assert solution.pressure[index - 1] < solution.spike_pressure > solution.pressure[index + 1]
    later = solution.pressure[index:]
    assert np.all(np.diff(later) <= 0.0)


def test_no_spike_in_an_isoviscous_contact():
    light = solve_line_contact_moes(1.0, 0.0, domain="auto", inlet="flooded", nodes=257)
    assert light.spike_pressure is None
    assert light.spike_position is None


@pytest.mark.parametrize(
    ("M", "L", "regime"),
    [
        (0.5, 0.0, "rigid-isoviscous"),
        (50.0, 0.0, "elastic-isoviscous"),
        (2.0, 20.0, "rigid-piezoviscous"),
        (50.0, 10.0, "elastic-piezoviscous"),
    ],
)
def test_regime(M, L, regime):
    assert solve_line_contact_moes(
        M, L, domain="auto", inlet="flooded", nodes=257
    ).regime == regime  # fmt: skip


def test_viscosity_and_density_are_those_of_the_oil(solution):
    pressure = solution.pressure[::50]
    assert solution.viscosity[::50] * 0.082 == pytest.approx(OIL.viscosity(pressure), rel=1e-9)
    assert solution.density[::50] * 880.0 == pytest.approx(OIL.density_at(pressure), rel=1e-12)
    barus = solve_line_contact(*CONTACT, nodes=129, viscosity_law="barus", compressible=False)
    expected = np.exp(2.19e-8 * barus.pressure)
    assert barus.viscosity == pytest.approx(expected, rel=1e-9)
    assert np.all(barus.density == 1.0)


def test_isoviscous_by_law_or_by_coefficient():
    by_law = solve_line_contact(*CONTACT, nodes=257, viscosity_law="isoviscous")
    thin = Lubricant(0.082, 880.0, 0.0)
    by_oil = solve_line_contact(*CONTACT[:3], thin, 2.2e11, nodes=257)
    assert by_law.central_film == pytest.approx(by_oil.central_film, rel=1e-10)
    assert by_oil.viscosity_law == by_law.viscosity_law == "isoviscous"
    assert by_oil.moes_viscosity == 0.0


def test_repr_and_xarray(solution):
    text = repr(solution)
    assert "\n" not in text
    assert f"{solution.central_film * 1e6:.4f} um" in text
    table = solution.to_xarray()
    assert table.pressure.attrs["units"] == "Pa"
    assert table.attrs["central_film"] == solution.central_film
    assert table.sizes == {"position": 513}
    plain = solve_line_contact_moes(20, 10, nodes=129)
    assert " um" not in repr(plain)
    assert plain.to_xarray().film.attrs["units"] == ""


def test_automatic_nodes_stop_at_the_tolerance():
    coarse = solve_line_contact(*CONTACT, film_tolerance=5e-4)
    fine = solve_line_contact(*CONTACT, film_tolerance=5e-5)
    assert fine.nodes > coarse.nodes
    for solution, tolerance in ((coarse, 5e-4), (fine, 5e-5)):
        assert solution.central_film_error < tolerance * solution.central_film
        half = solve_line_contact(*CONTACT, nodes=(solution.nodes + 1) // 2, domain=solution.domain)
        assert half.central_film_error > tolerance * half.central_film
        step = solution.central_film - half.central_film
        cut = (
            2.0
            * (np.interp(0.0, solution._grid.X, solution._grid.H) / solution.domain[0] ** 2) ** 2
        )
        extrapolation_error = solution.central_film_error - cut * solution.central_film
        assert extrapolation_error == pytest.approx(abs(step) / 3.0, rel=0.02)
        assert solution.central_film_extrapolated == pytest.approx(
            solution.central_film + step / 3.0, rel=1e-5
        )


def test_automatic_nodes_say_when_they_do_not_suffice():
    with pytest.warns(ModelWarning, match=r"\[film-resolution\] With 16385 nodes"):
        solution = solve_line_contact_moes(
            500, 12, nodes="auto", film_tolerance=1e-5, pressure_viscosity_coefficient=3e-8
        )
    assert solution.nodes == 16385


def test_starved_inlet_is_reported_for_si_input():
    with pytest.warns(ModelWarning, match=r"\[starved-inlet\] The oil begins at X = -2.5"):
        starved = solve_line_contact(*CONTACT, domain=(-2.5, 1.5), inlet="zero", nodes=257)
    flooded = solve_line_contact(*CONTACT, nodes=257)
    assert starved.central_film < 0.9 * flooded.central_film
    assert starved.inlet == "zero"
    assert starved.pressure[0] == 0.0 < flooded.pressure[0]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        solve_line_contact_moes(20, 10, nodes=1025)


def test_domain_that_cuts_the_outlet_is_reported():
    with pytest.warns(ModelWarning, match="outlet-cut"):
        solve_line_contact(5e3, *CONTACT[1:], domain=(-40.0, 1.5), nodes=257)


def test_warm_start_gives_the_same_contact_in_fewer_products():
    cold = solve_line_contact(*CONTACT, nodes=513)
    other = solve_line_contact(1.01 * CONTACT[0], *CONTACT[1:], nodes=513)
    warm = solve_line_contact(*CONTACT, nodes=513, start=other)
    assert isinstance(warm, LineContactSolution)
    assert warm.central_film == pytest.approx(cold.central_film, rel=1e-5)
    assert warm.attempts == ()
    same = solve_line_contact(*CONTACT, nodes=513, start=cold)
    assert same.iterations <= 2
    # from another grid and domain
    coarse = solve_line_contact(*CONTACT, nodes=129, domain=(-6.0, 2.0))
    again = solve_line_contact(*CONTACT, nodes=1025, start=coarse)
    fine = solve_line_contact(*CONTACT, nodes=1025)
    assert again.central_film == pytest.approx(fine.central_film, rel=1e-5)


def test_a_poor_start_does_no_harm():
    far = solve_line_contact(2e3, 8e-3, 20.0, OIL, 2.2e11, nodes=129)
    solution = solve_line_contact(*CONTACT, nodes=129, start=far)
    cold = solve_line_contact(*CONTACT, nodes=129)
    assert solution.central_film == pytest.approx(cold.central_film, rel=1e-4)


def test_profile_is_added_to_the_gap(solution):
    raised = solve_line_contact(*CONTACT, nodes=513, profile=lambda x: np.full_like(x, 1e-7))
    # a constant height is only another offset
    assert raised.film == pytest.approx(solution.film, rel=1e-6)
    wavy = solve_line_contact(
        *CONTACT, nodes=513, profile=lambda x: 5e-8 * np.cos(2 * np.pi * x / 6e-5)
    )
    assert wavy.pressure.max() > 1.03 * solution.pressure.max()
    coarse = solve_line_contact(
        *CONTACT, film_tolerance=1e-2, profile=lambda x: 5e-8 * np.cos(2 * np.pi * x / 6e-5)
    )
    assert coarse.central_film == pytest.approx(wavy.central_film, rel=0.02)
