"""The vibrating film: slow limit, delay, trapped limit, and the transient solver."""

import numpy as np
import pytest

from tribodyn.ehl import (
    LineContactSolution,
    solve_line_contact,
    solve_line_contact_moes,
    solve_transient_line_contact,
)
from tribodyn.ehl.film_stiffness import film_compliance, frequency_response
from tribodyn.errors import InputError
from tribodyn.lubricant import Lubricant

OIL = Lubricant(0.082, 880.0, 2.19e-8)
LOAD, RADIUS, SPEED, MODULUS, LENGTH = 147802.0, 8e-3, 3.0722, 2.2e11, 0.02


@pytest.fixture(scope="module")
def solution() -> LineContactSolution:
    return solve_line_contact(
        LOAD, RADIUS, SPEED, OIL, MODULUS, nodes=513, tolerance=1e-9, flux_tolerance=1e-8
    )


def corner(solution: LineContactSolution) -> float:
    """Frequency ``u_e/2b``."""
    return 0.5 * solution.entrainment_speed / solution.half_width


@pytest.mark.parametrize("deflection", ["approach", "central"])
def test_slow_limit_is_the_tangent(solution: LineContactSolution, deflection: str) -> None:
    tangent = solution.film_stiffness(LENGTH)
    slow = corner(solution) * np.array([0.0, 1e-6, 1e-3])
    stiffness, damping = frequency_response(solution, slow, LENGTH, deflection=deflection)
    assert stiffness == pytest.approx(tangent, rel=1e-4)
    assert damping == pytest.approx(damping[0], rel=1e-3)
    # the film lags by about the time from the inlet to the centre, h = -w/K exp(-i omega b/u_e)
    delay = solution.half_width / SPEED
    assert 0.5 * tangent * delay < damping[0] < 6.0 * tangent * delay


def test_stiffness_falls_and_damping_is_positive_up_to_a_third_of_the_corner(
    solution: LineContactSolution,
) -> None:
    frequencies = corner(solution) * np.array([0.0, 0.03, 0.1, 0.2, 0.33])
    stiffness, damping = solution.frequency_response(frequencies, LENGTH)
    assert np.all(damping > 0.0)
    assert np.all(np.diff(stiffness) < 0.0)
    assert stiffness[1] > 0.9 * stiffness[0]
    half, _ = solution.frequency_response(frequencies, 0.5 * LENGTH)
    assert half == pytest.approx(0.5 * stiffness, rel=1e-12)


def test_compliance_dissipates_and_stays_bounded(solution: LineContactSolution) -> None:
    frequencies = corner(solution) * np.geomspace(1e-2, 0.4, 5)
    compliance = film_compliance(solution, frequencies, LENGTH)
    assert np.all(compliance.imag < 0.0)
    assert np.all(np.abs(compliance) < 2.0 / solution.film_stiffness(LENGTH))


def test_trapped_film_yields_by_its_volume_only(solution: LineContactSolution) -> None:
    """Far above the corner: compressible oil gives ``h (rho'/rho) dp_c/dw``, other oil nothing."""
    rigid = solve_line_contact(
        LOAD, RADIUS, SPEED, OIL, MODULUS, nodes=513, compressible=False, tolerance=1e-9
    )
    high = 300.0 * corner(solution)
    trapped, none = (
        film_compliance(item, high, LENGTH, deflection="central") for item in (solution, rigid)
    )
    pressure = np.interp(0.0, solution.position, solution.pressure)
    rise, bound = 0.6e-9, 1.7e-9
    density = 1.0 + rise * pressure / (1.0 + bound * pressure)
    slope = rise / (1.0 + bound * pressure) ** 2
    # dp_c/dw of the dry contact is p_h/2w; the film of the inlet takes a part of the load
    hertz = (
        solution.central_film * slope / density * solution.hertz_pressure / (2.0 * LOAD * LENGTH)
    )
    assert 0.5 * hertz < trapped.real < 1.2 * hertz
    assert abs(none) < 0.05 * trapped.real


def test_same_answer_without_units() -> None:
    """The dimensionless contact takes frequencies in u_e/b and answers in p_h R/b."""
    contact = solve_line_contact(LOAD, RADIUS, SPEED, OIL, MODULUS, nodes=257, tolerance=1e-9)
    plain = solve_line_contact_moes(
        contact.moes_load, contact.moes_viscosity, pressure_viscosity_index=OIL.roelands_index,
        pressure_viscosity_coefficient=OIL.pressure_viscosity_coefficient, nodes=257,
        domain=contact.domain, inlet="flooded", tolerance=1e-9,
    )  # fmt: skip
    values = np.array([0.0, 0.05, 0.2])
    unit = contact.hertz_pressure * contact.half_width / contact.film_unit
    rate = SPEED / contact.half_width
    stiffness, damping = contact.frequency_response(values * rate)
    other, less = plain.frequency_response(values)
    assert stiffness == pytest.approx(other * unit, rel=1e-5)
    assert damping == pytest.approx(less * unit / rate, rel=1e-5)


def test_a_finer_solution_is_answered_on_a_grid_of_513_nodes(
    solution: LineContactSolution,
) -> None:
    fine = solve_line_contact(LOAD, RADIUS, SPEED, OIL, MODULUS, nodes=2049)
    frequencies = corner(fine) * np.array([0.0, 0.1, 0.3])
    compliance = film_compliance(fine, frequencies)
    assert 1.0 / compliance[0].real == pytest.approx(fine.film_stiffness(), rel=1e-9)
    difference = np.abs(compliance - film_compliance(solution, frequencies))
    assert np.all(difference < 0.02 * np.abs(compliance[0]))


@pytest.mark.parametrize("ratio", [0.1, 0.3])
def test_linearized_film_is_that_of_the_transient(ratio: float) -> None:
    """A load that swings by a thousandth, after some transits, against the complex system."""
    domain = (-5.0, 1.75)
    solution = solve_line_contact(
        LOAD, RADIUS, SPEED, OIL, MODULUS, nodes=257, domain=domain, tolerance=1e-9,
        flux_tolerance=1e-9,
    )  # fmt: skip
    steps, periods = 96, 4
    responses = []
    for f in (0.02 * corner(solution), ratio * corner(solution)):
        time = np.arange(periods * steps + 1) / (steps * f)
        load = LOAD * (1.0 + 1e-3 * np.sin(2.0 * np.pi * f * time))
        contact = solve_transient_line_contact(
            time, load, RADIUS, SPEED, OIL, MODULUS, nodes=257, domain=domain, keep_every=0
        )
        wave = np.exp(-2j * np.pi * f * time[-steps:])
        force, film, approach = (
            np.mean(series[-steps:] * wave)
            for series in (contact.load_per_width, contact.central_film, contact.approach)
        )
        central, rigid = (
            film_compliance(solution, f, deflection=deflection)
            for deflection in ("central", "approach")
        )
        # the scale of the transient is that of the greatest load, half a thousandth wider
        assert -film / force == pytest.approx(central, rel=0.01)
        responses.append((approach / force, rigid))
    (slow, slow_rigid), (fast, fast_rigid) = responses
    assert fast - slow == pytest.approx(fast_rigid - slow_rigid, rel=0.01)


def test_refusals(solution: LineContactSolution) -> None:
    with pytest.raises(InputError, match="frequencies"):
        solution.frequency_response(-1.0)
    with pytest.raises(InputError, match="Known: approach, central"):
        film_compliance(solution, 1.0, deflection="mean")  # type: ignore[arg-type]
