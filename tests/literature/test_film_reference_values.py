"""Solved films against another scheme: its figures (tests/references/film_cases.py) and itself.

Figures of single grids and of the domain of the source (mark ``regression``) are stored so that a
change is seen.
"""

from __future__ import annotations

from functools import cache
from itertools import pairwise

import pytest

from known_films import known_film, wetted
from references.film_cases import FZG, MODULUS, MOES, RADIUS, SPEED
from tribodyn.ehl import line_contact_groups, solve_line_contact, solve_line_contact_moes
from tribodyn.lubricant import Lubricant

ENGINES = ("newton", "multigrid")

OIL = Lubricant(0.082, 880.0, 2.19e-8)


@cache
def moes(name, nodes, method="newton", **tolerances):
    M, L, compressible, *_ = MOES[name]
    return solve_line_contact_moes(
        M, L, compressible=compressible, nodes=nodes, method=method, **tolerances
    )


@pytest.mark.parametrize("method", ENGINES)
@pytest.mark.parametrize("name", MOES)
def test_cases_of_moes_on_1025_nodes(name, method):
    *_, central, minimum, outlet = MOES[name]
    solution = moes(name, 1025, method)
    tolerance = 1e-3 if name == "M5 L5" else 4e-3
    assert solution.central_film == pytest.approx(central, rel=tolerance)
    assert solution.minimum_film == pytest.approx(minimum, rel=tolerance)
    assert solution.outlet == pytest.approx(outlet, abs=3e-3)


@pytest.mark.parametrize("method", ENGINES)
@pytest.mark.parametrize("name", MOES)
def test_extrapolated_central_film(name, method):
    central = MOES[name][3]
    solution = moes(name, 1025, method)
    assert solution.central_film_extrapolated == pytest.approx(central, rel=5e-4)
    error = abs(solution.central_film - central)
    assert error <= solution.central_film_error + 2e-5 * central <= 2.0 * error + 5e-5 * central


@pytest.mark.parametrize("name", MOES)
def test_fine_grid_reaches_the_printed_digits(name):
    *_, central, minimum, outlet = MOES[name]
    solution = moes(name, 8193)
    assert solution.central_film_extrapolated == pytest.approx(central, rel=3e-5)
    assert solution.minimum_film == pytest.approx(minimum, rel=4e-4)
    assert solution.outlet == pytest.approx(outlet, abs=5e-4)


@pytest.mark.regression
@pytest.mark.parametrize(
    ("nodes", "central"), [(257, 0.083989), (513, 0.084919), (1025, 0.085154), (2049, 0.085213)]
)
@pytest.mark.parametrize("method", ENGINES)
def test_uniform_grids_of_second_order(nodes, central, method):
    # the values differ by the discretisation alone, which the engines share
    solution = moes("M20 L10", nodes, method, tolerance=1e-7, flux_tolerance=1e-6)
    assert solution.central_film == pytest.approx(central, abs=1e-6)


@pytest.mark.parametrize("name", MOES)
def test_observed_order(name):
    films = [moes(name, nodes).central_film for nodes in (257, 513, 1025, 2049, 4097)]
    steps = [fine - coarse for coarse, fine in pairwise(films)]
    for coarse, fine in pairwise(steps):
        assert 3.5 < coarse / fine < 4.5


@pytest.mark.parametrize("method", ENGINES)
@pytest.mark.parametrize("torque", FZG)
def test_fzg_pair(torque, method):
    load, hertz, half_width, central, minimum = FZG[torque]
    solution = solve_line_contact(load, RADIUS, SPEED, OIL, MODULUS, method=method)
    assert solution.hertz_pressure == pytest.approx(hertz * 1e9, rel=2e-4)
    assert solution.half_width == pytest.approx(half_width * 1e-6, rel=2e-5)
    assert solution.central_film == pytest.approx(central * 1e-6, rel=5e-3)
    assert solution.minimum_film == pytest.approx(minimum * 1e-6, rel=1e-2)


def test_speed_is_half_the_sum_of_the_surface_speeds():
    load = FZG[150][0]
    right = solve_line_contact(load, RADIUS, SPEED, OIL, MODULUS, nodes=1025)
    sum_of_speeds = solve_line_contact(load, RADIUS, 2.0 * SPEED, OIL, MODULUS, nodes=1025)
    assert sum_of_speeds.central_film / right.central_film == pytest.approx(1.62, abs=0.03)


@pytest.mark.regression
@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
@pytest.mark.parametrize(("torque", "loss"), [(50, -0.32), (150, -0.14), (300, -0.07)])
def test_domain_of_the_source_starves_its_contacts(torque, loss):
    load = torque / (50.7434e-3 * 20e-3)
    flooded = solve_line_contact(load, RADIUS, SPEED, OIL, MODULUS, nodes=4097)
    starved = solve_line_contact(
        load, RADIUS, SPEED, OIL, MODULUS, nodes=4097, domain=(-2.5, 1.5), inlet="zero"
    )
    assert starved.central_film / flooded.central_film - 1.0 == pytest.approx(loss, abs=0.006)


@pytest.mark.slow
@pytest.mark.parametrize("torque", FZG)
def test_fzg_pair_with_an_inlet_of_a_hundred_half_widths(torque):
    """The flooded inlet condition against oil that is really there, by another scheme."""
    load, *_, central, minimum = FZG[torque]
    solution = solve_line_contact(load, RADIUS, SPEED, OIL, MODULUS, nodes=8193)
    groups = line_contact_groups(load, RADIUS, SPEED, 0.082, 2.19e-8, MODULUS)
    M, L = float(groups.moes_load), float(groups.moes_material)
    start = solve_line_contact_moes(
        M, L, pressure_viscosity_coefficient=2.19e-8, pressure_viscosity_index=OIL.roelands_index,
        domain="auto", inlet="flooded", nodes=16385,
    )  # fmt: skip
    reference = known_film(
        M, L, wetted(start), inlet=-100.0, alpha=2.19e-8, z=OIL.roelands_index, nodes=800
    )
    unit = 1e6 * solution.half_width**2 / RADIUS
    assert reference.central * unit == pytest.approx(central, rel=4e-4)
    assert reference.minimum * unit == pytest.approx(minimum, rel=1e-3)
    assert solution.central_film * 1e6 == pytest.approx(reference.central * unit, rel=1e-3)
    assert solution.minimum_film * 1e6 == pytest.approx(reference.minimum * unit, rel=1e-3)


@pytest.mark.regression
def test_height_of_the_spike_needs_a_fine_grid():
    """Truth 0.944 of the Hertz pressure; a uniform grid of 257 to 2049 nodes finds 0.63 to 0.81."""
    reference = known_film(20.0, 10.0, wetted(moes("M20 L10", 8193)), inlet=-4.5, nodes=700)
    position, height = reference.spike
    assert height == pytest.approx(0.944, abs=5e-3)
    solutions = [moes("M20 L10", nodes) for nodes in (257, 513, 1025, 2049, 4097, 8193)]
    heights = [solution.spike_pressure for solution in solutions]
    assert heights[0] == pytest.approx(0.63, abs=0.01)
    assert heights[3] == pytest.approx(0.81, abs=0.01)
    assert heights == sorted(heights)
    assert heights[-1] < height
    assert solutions[-1].spike_position == pytest.approx(position, abs=3e-3)
