"""The estimated errors of a film on stated nodes, against the finest grid there is."""

import warnings

import numpy as np
import pytest

import tribodyn as td
from tribodyn.ehl import solve_line_contact, solve_line_contact_moes, solve_line_contacts
from tribodyn.errors import ModelWarning
from tribodyn.lubricant import Lubricant

OIL = Lubricant(0.082, 880.0, 2.19e-8)
THIN = {"pressure_viscosity_index": 0.6, "pressure_viscosity_coefficient": 2e-8,
        "domain": "auto", "inlet": "flooded"}  # fmt: skip


def _solved(M, L, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        return solve_line_contact_moes(M, L, **({"domain": "auto", "inlet": "flooded"} | options))


def _figures(solution):
    return np.array([solution.central_film, solution.minimum_film])


def _errors(solution):
    return np.array([solution.central_film_error, solution.minimum_film_error])


def test_the_estimate_bounds_the_error(draws):
    """Random flooded contacts: within it in 19 of 20, and none above 2 % goes untold."""
    inside = count = 0
    for random in draws(8):
        count += 1
        M, L = 10.0 ** random.uniform(0.0, 2.9), random.uniform(0.0, 12.0)
        oil = {"pressure_viscosity_index": random.uniform(0.4, 0.7),
               "pressure_viscosity_coefficient": 10.0 ** random.uniform(-8.0, -7.6)}  # fmt: skip
        nodes = int(random.choice([65, 129, 257, 513, 1025]))
        coarse = _solved(M, L, nodes=nodes, method=str(random.choice(["newton", "multigrid"])),
                         **oil)  # fmt: skip
        fine = _figures(_solved(M, L, nodes=16385, **oil))
        true, estimate = np.abs(_figures(coarse) - fine), _errors(coarse)
        assert np.all(np.isfinite(estimate))
        inside += bool(np.all(true <= estimate + 2e-4 * fine))
        assert not np.any((true > 0.02 * _figures(coarse)) & (estimate < 0.02 * _figures(coarse)))
    assert inside >= 0.95 * count - 1.0


@pytest.mark.parametrize(
    ("M", "L", "nodes"), [(860.0, 9.0, 513), (860.0, 9.0, 2049), (399.8, 4.16, 513)]
)
def test_a_film_that_is_far_off_is_reported(M, L, nodes):
    with pytest.warns(ModelWarning, match=r"\[film-resolution\].*Use nodes = \"auto\""):
        coarse = solve_line_contact_moes(M, L, nodes=nodes, **THIN)
    fine = _figures(_solved(M, L, nodes=16385, **THIN))
    assert np.all(np.abs(_figures(coarse) - fine) <= _errors(coarse))


def test_raised_numbers_of_nodes_are_reported():
    with pytest.warns(ModelWarning, match=r"since 65 nodes gave no solution"):
        raised = solve_line_contact_moes(399.8, 4.16, nodes=65, **THIN)
    assert raised.nodes > 65


def test_a_resolved_film_gives_no_warning():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        solution = solve_line_contact(147802.0, 8e-3, 3.0722, OIL, 2.2e11, nodes=513)
    assert 0.0 < solution.central_film_error < 5e-3 * solution.central_film
    assert 0.0 < solution.pressure_error < 0.5 * solution.pressure.max()


def test_the_worst_of_many_contacts_is_reported():
    with pytest.warns(ModelWarning, match=r"film-resolution.* of 2 contacts .*contact \[1\]"):
        films = solve_line_contacts([147802.0, 9e5], 8e-3, [3.0722, 0.02], OIL, 2.2e11, nodes=257)
    assert films.central_film_error[1] > 0.02 * films.central_film[1]


def test_the_estimate_bounds_the_error_of_a_domain_that_begins_too_near(draws):
    """Random flooded contacts, of thick films too, against a domain four times as long."""
    for random in draws(6):
        M, L = 10.0 ** random.uniform(-1.3, 2.0), random.choice([0.0, random.uniform(0.5, 25.0)])
        law = random.choice(["roelands", "barus"]) if L else "isoviscous"
        options = {"viscosity_law": law, "compressible": random.random() < 0.5, "nodes": "auto"}
        chosen = _solved(M, L, **options)
        start, end = chosen.domain
        inlet = -max(3.0, random.uniform(0.3, 1.0) * abs(start))
        stated = _solved(M, L, **(options | {"domain": (inlet, end)}))
        far = _solved(M, L, film_tolerance=2e-5, **(options | {"domain": (4.0 * start, end)}))
        fine = _figures(far)
        assert chosen.central_film == pytest.approx(fine[0], rel=5e-4)
        for each in (chosen, stated):
            true = np.abs(_figures(each) - fine)
            assert np.all(true <= _errors(each) + 2e-4 * fine), (M, L, law, inlet)


@pytest.mark.parametrize("tolerance", [1e-3, 1e-4])
def test_automatic_grids_of_nearly_rigid_contacts_hold_their_tolerance(tolerance):
    """M = 1.04 with an isoviscous oil, and its neighbourhood, against a domain twice as long."""
    oil = Lubricant(11.27e-3, 880.0, 1e-9)
    for factor in (1.0, 0.7, 1.6):
        for law in ("isoviscous", "roelands"):
            contact = factor * 9378.0, 6.6548e-3, 2.44892, oil, 2.2e11
            options = {"viscosity_law": law, "compressible": False}
            film = solve_line_contact(*contact, film_tolerance=tolerance, **options)
            extent = 2.0 * film.domain[0], film.domain[1] + 1.0
            fine = solve_line_contact(*contact, nodes=8193, domain=extent, **options)
            exact = fine.central_film_extrapolated
            assert abs(film.central_film - exact) < tolerance * exact
            assert abs(film.central_film - exact) < film.central_film_error


@pytest.mark.slow
def test_the_film_of_a_case_warns_of_too_few_nodes():
    slow = td.load_case("fzg-film").replace(
        {"film.nodes": 129, "operation.speed": "20 rpm", "film.positions": 8}
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)  # such a slow pair has more to tell
        codes = [warning.code for warning in td.run(slow).warnings]
    assert "film-resolution" in codes
