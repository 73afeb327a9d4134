"""Stiffness of the film: exact tangent, sums, series rule, limits."""

import numpy as np
import pytest

from tribodyn.ehl import LineContactSolution, solve_line_contact, solve_line_contact_moes
from tribodyn.ehl.film_stiffness import film_distance
from tribodyn.errors import InputError, ModelWarning
from tribodyn.lubricant import Lubricant

OIL = Lubricant(0.082, 880.0, 2.19e-8)
LENGTH, RADIUS, SPEED, MODULUS = 0.02, 8e-3, 3.0722, 2.2e11


def contact(load: float, nodes: int = 1025, speed: float = SPEED) -> LineContactSolution:
    return solve_line_contact(
        load, RADIUS, speed, OIL, MODULUS, nodes=nodes, tolerance=1e-8, flux_tolerance=1e-7
    )


def test_pitch_point_of_the_fzg_pair() -> None:
    """150 N m at 1400 rpm, 20 mm."""
    solution = contact(147802.0, 2049)
    assert solution.film_stiffness(LENGTH) == pytest.approx(2.51e10, rel=0.01)
    assert solution.film_stiffness(LENGTH, "secant") == pytest.approx(2.77e9, rel=0.005)


@pytest.mark.parametrize(
    ("load", "speed"), [(15e3, 3.0), (49267.5, SPEED), (147802.0, SPEED), (295604.0, SPEED)]
)
def test_tangent_equals_two_solutions(load: float, speed: float) -> None:
    more, less = (contact(load * factor, 1025, speed) for factor in (1.001, 0.999))
    difference = -0.002 * load * LENGTH / (more.central_film - less.central_film)
    tangent = contact(load, 1025, speed).film_stiffness(LENGTH)
    assert tangent == pytest.approx(difference, rel=0.01)


def test_tangent_of_the_dimensionless_contact() -> None:
    """The same grid at both loads: the tangent is the derivative of the discrete equations."""
    half = solve_line_contact_moes(5.0, 5.0, nodes=513).film_stiffness(0.5)
    stiffness = solve_line_contact_moes(5.0, 5.0, nodes=513).film_stiffness()
    fine = solve_line_contact_moes(5.0, 5.0, nodes=2049).film_stiffness()
    assert half == pytest.approx(0.5 * stiffness, rel=1e-12)
    assert stiffness == pytest.approx(fine, rel=2e-3)


def test_rigid_isoviscous_film_falls_as_one_over_the_load() -> None:
    """``h = 4.895 eta u R/w``, hence ``K = w/h`` for every load."""
    solution = solve_line_contact(
        2e3, RADIUS, 0.5, Lubricant(0.082, 880.0, 0.0), 1e13, nodes=1025, compressible=False
    )
    expected = 2e3 * LENGTH / solution.central_film
    assert solution.film_stiffness(LENGTH) == pytest.approx(expected, rel=0.02)


@pytest.mark.parametrize("kind", ["approach", "tangent"])
@pytest.mark.parametrize("load", [147802.0, 295604.0])
def test_series_rule_of_hertz_and_film(load: float, kind: str) -> None:
    """``1/K_total = 1/K_Hertz + 1/K_film``, the deflections counted from 10 mm."""
    depth = 10e-3
    approach = []
    for factor in (1.001, 0.999):
        solution = contact(load * factor)
        grid = solution._grid
        shift = np.log(depth / solution.half_width) / np.pi * grid.dx * grid.P.sum()
        approach.append(-(grid.H0 - shift) * solution.film_unit)
    total = (approach[0] - approach[1]) / (0.002 * load * LENGTH)
    solution = contact(load)
    # dry contact: dv(0)/dw = (4/(pi E')) ln(2 d/b)
    hertz = 4.0 / (np.pi * MODULUS * LENGTH) * np.log(2.0 * depth / solution.half_width)
    series = hertz + 1.0 / solution.film_stiffness(LENGTH, kind)
    assert total == pytest.approx(series, rel=3e-3)
    assert total > 1.01 * hertz


@pytest.mark.parametrize("moes_load", [0.3, 1.0, 3.0, 20.0, 100.0, 300.0])
@pytest.mark.parametrize("moes_viscosity", [0.0, 5.0, 20.0])
def test_the_bodies_come_nearer_under_every_load(moes_load: float, moes_viscosity: float) -> None:
    """Also where the central film hardly changes, or rises: at M = 1, L = 20 it does."""
    solution = solve_line_contact_moes(
        moes_load, moes_viscosity, nodes=4097, inlet="flooded", domain="auto"
    )
    stiffness = solution.film_stiffness(1.0, "approach")
    load_over_film = 0.5 * np.pi / solution.central_film
    assert stiffness > 0.5 * load_over_film
    assert stiffness < 40.0 * load_over_film


@pytest.mark.parametrize(("moes_load", "moes_viscosity"), [(0.3, 0.0), (5.0, 10.0), (20.0, 5.0)])
def test_stiffness_of_the_approach_is_its_slope(moes_load: float, moes_viscosity: float) -> None:
    """Two loads on the same bodies, at one speed of one oil: M moves, L stays."""
    step, distance = 0.04, []
    for change in (-step, step):
        solution = solve_line_contact_moes(
            moes_load * np.exp(change), moes_viscosity, nodes=4097, inlet="flooded",
            domain="auto", tolerance=1e-7, flux_tolerance=1e-6, compressible=False,
        )  # fmt: skip
        # b^2/R goes with the load
        distance.append(film_distance(solution) * np.exp(change))
    middle = solve_line_contact_moes(
        moes_load, moes_viscosity, nodes=4097, inlet="flooded", domain="auto", tolerance=1e-7,
        flux_tolerance=1e-6, compressible=False,
    )  # fmt: skip
    slope = (distance[1] - distance[0]) / (2.0 * step)
    # the tangent holds the node of the outlet, which costs a per cent or two
    assert middle.film_stiffness(1.0, "approach") == pytest.approx(-0.5 * np.pi / slope, rel=0.02)


def test_distance_of_a_rigid_and_of_a_hertzian_contact() -> None:
    """Rigid bodies: the film of Martin less the approach of Hertz; great loads: the film itself."""
    ratios = []
    for moes_load in (20.0, 100.0, 300.0):
        solution = solve_line_contact_moes(
            moes_load, 10.0, nodes=4097, inlet="flooded", domain="auto"
        )
        ratios.append(film_distance(solution) / solution.central_film - 1.0)
    assert np.all(np.diff(ratios) < 0.0)
    assert 0.0 < ratios[-1] < 0.07


def test_printed_sum_is_a_length_that_doubles_with_the_grid() -> None:
    coarse, fine = contact(147802.0, 513), contact(147802.0, 1025)
    with pytest.warns(ModelWarning, match="seed-film-stiffness"):
        printed_sum = coarse.film_stiffness(LENGTH, "seed")
    with pytest.warns(ModelWarning, match="doubles when the 1025 nodes"):
        other = fine.film_stiffness(LENGTH, "seed")
    assert other / printed_sum == pytest.approx(2.0, rel=0.02)
    secants = [item.film_stiffness(LENGTH, "secant") for item in (coarse, fine)]
    assert secants[1] / secants[0] == pytest.approx(1.0, rel=2e-3)


@pytest.mark.filterwarnings("ignore:\\[starved-inlet\\]:tribodyn.errors.ModelWarning")
def test_starved_film_that_rises_with_the_load_is_reported() -> None:
    solution = solve_line_contact(
        49267.5, RADIUS, SPEED, OIL, MODULUS, nodes=513, domain=(-2.5, 1.5), inlet="zero"
    )
    # the first node is held in metres: with the load fixed to b, the film of the source rises
    wide = contact(49267.5, 513)
    assert solution.central_film < 0.75 * wide.central_film
    assert solution.film_stiffness(LENGTH) > 0.0


def test_refusals() -> None:
    solution = contact(147802.0, 257)
    with pytest.raises(InputError, match="length"):
        solution.film_stiffness(0.0)
    with pytest.raises(InputError, match="Known: approach, tangent, secant, seed"):
        solution.film_stiffness(1.0, "slope")
