"""Traction of solved films: balance of forces and power, limits, convergence, signs."""

from __future__ import annotations

import numpy as np
import pytest

from plain.film import PlainContact, plain_oil
from plain.film_newton import solve_plain
from tribodyn.contact import hertz_line
from tribodyn.ehl import (
    FilmState,
    film_traction,
    newtonian_shear_stress,
    ree_eyring_shear_stress,
)
from tribodyn.lubricant import Lubricant

OIL = Lubricant(0.082, 880.0, 2.19e-8)
RADIUS, MODULUS, SPEED, LOAD = 8e-3, 2.2e11, 3.0722, 147802.0
GAUSS, WEIGHT = np.polynomial.legendre.leggauss(60)


def solved(intervals):
    hertz = hertz_line(LOAD, RADIUS, MODULUS)
    b, p_h = float(hertz.half_width), float(hertz.maximum_pressure)
    speed_parameter = 12.0 * OIL.dynamic_viscosity * SPEED * RADIUS**2 / (b**3 * p_h)
    oil = plain_oil("roelands", p_h, OIL.pressure_viscosity_coefficient, OIL.roelands_index)
    contact = PlainContact(intervals, (-4.5, 1.5), speed_parameter, oil)
    answer = solve_plain(contact)
    return FilmState(contact.X * b, answer.P * p_h, answer.H * b**2 / RADIUS, OIL, MODULUS)


@pytest.fixture(scope="module")
def contact():
    return solved(256)


def thick_oil(pressure=0.5e9):
    """A flat film under even pressure; the viscosity is then the same everywhere."""
    x = np.linspace(-1e-4, 1e-4, 11)
    return FilmState(x, np.full(11, pressure), np.full(11, 1e-6), OIL, MODULUS)


def across(stress, gradient, thickness, viscosity, eyring_stress):
    """Stress and shear rate at Gauss points across one film."""
    tau = stress[:, None] + 0.5 * thickness[:, None] * gradient[:, None] * GAUSS
    rate = eyring_stress / viscosity[:, None] * np.sinh(tau / eyring_stress)
    return tau, rate, 0.5 * thickness[:, None] * WEIGHT


@pytest.mark.parametrize("speed", [1.3, -0.4, 1e-4])
def test_shear_rate_over_the_film_is_the_sliding_speed(speed):
    gradient = np.array([0.0, 1e9, 4e12, -4e12, 2e13, 8e13])
    thickness, viscosity, eyring = np.full(6, 0.9e-6), np.full(6, 40.0), 5e6
    stress = ree_eyring_shear_stress(viscosity, speed, thickness, eyring, gradient)
    _, rate, weight = across(stress, gradient, thickness, viscosity, eyring)
    assert (rate * weight).sum(axis=1) == pytest.approx(speed, rel=1e-9)
    assert np.all(np.sign(stress) == np.sign(speed))


def test_large_eyring_stress_gives_the_newtonian_oil(contact):
    for speed in (0.01, 1.0):
        newtonian = film_traction(contact, speed, shear_model="newtonian")
        eyring = film_traction(contact, speed, eyring_stress=1e16)
        assert eyring.sliding == pytest.approx(newtonian.sliding, rel=1e-8)
        assert eyring.rolling == newtonian.rolling


@pytest.mark.parametrize("eyring_stress", [2e6, 5e6, 1e8])
def test_flat_film_under_even_pressure(eyring_stress):
    speed, pressure = 0.7, 0.5e9
    viscosity = OIL.viscosity(pressure)
    by_hand = eyring_stress * np.arcsinh(viscosity * speed / (eyring_stress * 1e-6)) / pressure
    traction = film_traction(thick_oil(pressure), speed, eyring_stress=eyring_stress)
    assert traction.sliding / (pressure * 2e-4) == pytest.approx(by_hand, rel=1e-12)
    assert traction.rolling == pytest.approx(1.5 * pressure * 1e-6)  # of the part cut off


def test_newtonian_flat_film_under_even_pressure():
    traction = film_traction(thick_oil(), 0.7, shear_model="newtonian")
    stress = newtonian_shear_stress(OIL.viscosity(0.5e9), 0.7, 1e-6)
    assert traction.sliding == pytest.approx(stress * 2e-4, rel=1e-12)


@pytest.mark.parametrize("shear_model", ["newtonian", "ree-eyring"])
def test_forces_on_both_surfaces_balance_the_push_of_the_pressure_on_the_wedge(
    contact, shear_model
):
    traction = film_traction(contact, 0.9, shear_model=shear_model)
    film, pressure = contact.film_thickness[0], contact.pressure[0]
    push = np.trapezoid(pressure, film)  # int p dh, and p = 0 at both ends
    forces = traction.on_surface_1 + traction.on_surface_2
    assert forces == pytest.approx(push, rel=1e-9)
    assert push < 0.0


def test_work_of_the_surfaces_and_of_the_pressure_is_the_heat_of_the_film(contact):
    speeds, eyring = (SPEED + 0.45, SPEED - 0.45), 5e6
    film, gradient = contact.interval_film[0], contact.pressure_gradient[0]
    viscosity, width = np.exp(contact.log_viscosity[0]), contact.interval_width[0]
    # stress in the direction of motion on planes that look to surface 2
    stress = -ree_eyring_shear_stress(viscosity, speeds[0] - speeds[1], film, eyring, gradient)
    tau, rate, weight = across(stress, gradient, film, viscosity, eyring)
    heat = ((tau * rate * weight).sum(axis=1) * width).sum()
    # int u dz by parts: mean speed times film, less the first moment of the shear rate
    z = 0.5 * film[:, None] * GAUSS
    flow = 0.5 * sum(speeds) * film - (z * rate * weight).sum(axis=1)
    pumped = (flow * gradient * width).sum()
    traction = film_traction(contact, speeds[0] - speeds[1], eyring_stress=eyring)
    worked = -float(traction.on_surface_1[0] * speeds[0] + traction.on_surface_2[0] * speeds[1])
    assert heat > 0.0
    assert worked - pumped == pytest.approx(heat, rel=1e-6)
    # without the work of the pressure the account does not close
    assert abs(worked - heat) > 1e-2 * heat


def test_friction_holds_the_faster_surface_back_and_drives_the_slower():
    film = thick_oil(0.3e9)
    forward, backward = film_traction(film, 0.5), film_traction(film, -0.5)
    assert forward.sliding[0] > 0.0
    assert backward.sliding[0] == -forward.sliding[0]
    assert forward.on_surface_1[0] < 0.0
    assert backward.on_surface_2[0] < 0.0


def test_pure_rolling_is_resisted_equally_on_both_surfaces(contact):
    traction = film_traction(contact, 0.0)
    assert traction.sliding[0] == 0.0
    assert traction.on_surface_1[0] == traction.on_surface_2[0] == -traction.rolling[0]
    assert 5e-4 < traction.rolling[0] / LOAD < 2e-3


def test_thick_oil_shears_with_the_logarithm_of_the_speed(contact):
    # each decade of speed adds tau_0 ln(10) where tau is far above tau_0
    film = thick_oil(0.8e9)
    traction = [film_traction(film, speed).sliding[0] for speed in (0.1, 1.0, 10.0)]
    assert np.diff(traction) == pytest.approx(5e6 * np.log(10.0) * 2e-4, rel=1e-3)
    # and slow sliding with the speed itself
    slow = [film_traction(contact, speed).sliding[0] for speed in (1e-9, 2e-9)]
    assert slow[1] / slow[0] == pytest.approx(2.0, rel=1e-6)


def test_oil_like_a_solid_does_not_overflow():
    # 2.5 GPa by Barus: viscosity 1e23 Pa*s
    x = np.linspace(-1e-4, 1e-4, 11)
    film = FilmState(x, np.full(11, 2.5e9), np.full(11, 1e-6), OIL, MODULUS, viscosity_law="barus")
    traction = film_traction(film, 1.0)
    log_rate = np.log(2.0 * 0.082 / 5.0) + 2.19e-8 * 2.5e9
    assert traction.sliding[0] == pytest.approx(5e6 * 2e-4 * log_rate, rel=1e-9)


def test_steep_pressure_does_not_overflow():
    x = np.linspace(0.0, 1e-6, 3)
    film = FilmState(x, np.array([1e9, 0.0, 0.0]), np.full(3, 1e-5), OIL, MODULUS)
    traction = film_traction(film, 1.0, eyring_stress=1e4)  # h dp/dx = 2e6 tau_0
    assert np.isfinite(traction.sliding[0])
    assert 0.0 <= traction.sliding[0] < film_traction(thick_oil(1e9), 1.0).sliding[0]


def test_parted_oil_carries_no_shear():
    x = np.linspace(-1e-4, 1e-4, 201)
    pressure = np.where(x < 0.0, 0.5e9, 0.0)
    film = FilmState(x, pressure, np.full(201, 1e-6), OIL, MODULUS)
    half = film_traction(film, 1e-3).sliding[0]
    assert half == pytest.approx(0.5 * film_traction(thick_oil(), 1e-3).sliding[0], rel=0.02)


def test_rolling_part_does_not_depend_on_where_a_flooded_inlet_is_cut():
    # isoviscous wedge h = h_c + x^2/2R up to its centre, where dp/dx = 0; the pressure from the
    # far inlet is known, so that a film cut anywhere starts with the right pressure
    eta, speed, centre = 0.05, 2.0, 1e-6
    far = -np.geomspace(1e-6, 0.4, 40001)[::-1]
    gap = centre + far**2 / (2.0 * RADIUS)
    slope = 12.0 * eta * speed * (gap - centre) / gap**3
    pressure = np.concatenate(([0.0], np.cumsum(np.diff(far) * 0.5 * (slope[1:] + slope[:-1]))))
    integral = 0.5 * np.sum(0.5 * (gap[1:] + gap[:-1]) * np.diff(pressure))
    oil = Lubricant(eta, 880.0, 0.0)
    for first in (-2e-3, -4e-3):
        beyond = far > first
        film = FilmState(far[beyond], pressure[beyond], gap[beyond], oil, MODULUS)
        rolling = film_traction(film, 0.0).rolling[0]
        cut = film.pressure[0, 0] * film.film_thickness[0, 0] * 1.5
        assert rolling == pytest.approx(integral, rel=2e-3)
        assert cut > 5e-3 * integral


def test_grid_converges(contact):
    films = [solved(128), contact, solved(512)]
    sliding, rolling = np.transpose(
        [(t.sliding[0], t.rolling[0]) for t in (film_traction(film, 1.0) for film in films)]
    )
    assert abs(sliding[2] - sliding[1]) < 0.01 * sliding[2]
    assert abs(rolling[2] - rolling[1]) < 0.4 * abs(rolling[1] - rolling[0])
    assert sliding[2] / LOAD == pytest.approx(0.0453, rel=0.01)


def test_contacts_share_films_by_index(contact):
    second = FilmState(
        contact.position, 0.8 * contact.pressure, 1.1 * contact.film_thickness, OIL, MODULUS
    )
    combined = FilmState(
        *(
            np.vstack([getattr(film_state, name) for film_state in (contact, second)])
            for name in ("position", "pressure", "film_thickness")
        ),
        OIL,
        MODULUS,
        index=np.array([1, 0, 1]),
    )
    speeds = np.array([0.5, 0.5, -2.0])
    traction = film_traction(combined, speeds)
    single = [
        film_traction(film, v) for film, v in zip((second, contact, second), speeds, strict=True)
    ]
    assert traction.sliding == pytest.approx(
        [film_state.sliding[0] for film_state in single], rel=1e-13
    )
    assert traction.rolling == pytest.approx(
        [film_state.rolling[0] for film_state in single], rel=1e-13
    )


def test_warm_film_is_the_cold_one_of_a_thinner_oil():
    # Barus: everything falls by exp(-beta dT)
    properties = {"temperature_viscosity_coefficient": 0.05, "thermal_conductivity": 0.13}
    x = np.linspace(-1e-4, 1e-4, 101)
    pressure = 0.4e9 * np.sqrt(1.0 - (x / 1.01e-4) ** 2)
    film, thin = (
        FilmState(
            x,
            pressure,
            np.full(101, 1e-6),
            Lubricant(viscosity, 880.0, 2.19e-8, temperature=313.15, **properties),
            MODULUS,
            viscosity_law="barus",
        )
        for viscosity in (0.082, 0.082 * np.exp(-0.05 * 20.0))
    )
    warm = film_traction(film, 0.5, temperature_rise=20.0)
    assert warm.sliding == pytest.approx(film_traction(thin, 0.5).sliding, rel=1e-12)
    assert warm.sliding[0] < 0.9 * film_traction(film, 0.5).sliding[0]


def test_thinner_film_shears_as_much_faster(contact):
    thin = film_traction(contact, 0.5, shear_model="newtonian", film_factor=0.8)
    assert thin.sliding == pytest.approx(
        film_traction(contact, 0.5 / 0.8, shear_model="newtonian").sliding, rel=1e-12
    )
    assert thin.rolling == pytest.approx(0.8 * film_traction(contact, 0.5).rolling, rel=1e-12)


def test_a_larger_contact_with_the_same_rates_and_pressures(contact):
    # ten times the lengths and the speed: shear rates and stresses stay
    large = FilmState(
        10.0 * contact.position, contact.pressure, 10.0 * contact.film_thickness, OIL, MODULUS
    )
    assert film_traction(large, 5.0).sliding == pytest.approx(
        10.0 * film_traction(contact, 0.5).sliding, rel=1e-12
    )
