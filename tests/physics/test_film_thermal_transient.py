"""The heated film over time: steady and cold limits, balance of heat, order, lag, surfaces."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import erf

from tribodyn import load_case, run
from tribodyn.contact import effective_modulus
from tribodyn.ehl import (
    BodyHeat,
    ThermalModel,
    solve_line_contact,
    solve_transient_line_contact,
)
from tribodyn.ehl.thermal.surface_history import SurfaceHistory
from tribodyn.errors import InputError
from tribodyn.lubricant import from_library
from tribodyn.mesh import moving_film

pytestmark = pytest.mark.filterwarnings("ignore:\\[film-resolution\\]")
OIL = from_library("80W")
LOAD, RADIUS, SPEED, MODULUS = 147802.0, 8e-3, 3.0722, 2.2e11
HALF_WIDTH = np.sqrt(8.0 * LOAD * RADIUS / (np.pi * MODULUS))
TRANSIT = HALF_WIDTH / SPEED


def solve(time, load=LOAD, ratio=1.0, speed=SPEED, nodes=129, thermal=None, **options):
    """The gear contact over time, at a slide-to-roll ratio or ratios."""
    slide = np.broadcast_to(0.5 * np.asarray(ratio) * speed, np.shape(time))
    model = ThermalModel("ree-eyring", tolerance=1e-4, nodes_across=9)
    return solve_transient_line_contact(
        time, load, RADIUS, speed, OIL, MODULUS, nodes=nodes,
        thermal=model if thermal is None else thermal,
        surface_speeds=(speed + slide, speed - slide), **options,
    )  # fmt: skip


@pytest.mark.slow
def test_constant_inputs_tend_to_the_steady_heated_film():
    """After a jump of load and sliding, on growing steps."""
    time = np.concatenate([[0.0], np.cumsum(0.05 * TRANSIT * 1.18 ** np.arange(24))])
    later = time > 0.0
    film = solve(
        time, np.where(later, LOAD, 0.7 * LOAD), np.where(later, 1.0, 0.3),
        keep_every=24, thermal=ThermalModel("ree-eyring", tolerance=1e-5, nodes_across=5),
    )  # fmt: skip
    steady = solve_line_contact(
        LOAD, RADIUS, SPEED, OIL, MODULUS, nodes=129, domain=film.domain, tolerance=1e-6,
        flux_tolerance=1e-5, thermal=film.thermal_model, sliding_speed=SPEED,
    )  # fmt: skip
    assert abs(film.traction[0] / steady.traction - 1.0) > 0.05
    assert film.central_film[-1] == pytest.approx(steady.central_film, rel=5e-4)
    assert film.minimum_film[-1] == pytest.approx(steady.minimum_film, rel=5e-4)
    assert film.traction[-1] == pytest.approx(steady.traction, rel=5e-4)
    assert film.body_heat[:, -1] == pytest.approx(steady.body_heat, rel=1e-3)
    cold, hot = OIL.temperature, steady.film_temperature.max() - OIL.temperature
    rise = steady.film_temperature - cold
    assert film.film_temperature[-1] - cold == pytest.approx(rise, abs=1e-2 * hot)
    rise = steady.surface_temperatures - cold
    assert film.surface_temperatures[-1] - cold == pytest.approx(rise, abs=1e-3 * hot)
    assert np.abs(film.heat_balance_error).max() < 1e-3


def test_heat_that_is_led_away_at_once_leaves_the_isothermal_film():
    time = np.linspace(0.0, 4.0 * TRANSIT, 21)
    load = LOAD * (1.0 - 0.3 * np.sin(np.pi * time / time[-1]) ** 2)
    cooled = ThermalModel(
        "newtonian", bodies=(BodyHeat(1e13, 1e12),) * 2, thermal_conductivity=1e12, nodes_across=9
    )
    film = solve(time, load, thermal=cooled)
    plain = solve_transient_line_contact(time, load, RADIUS, SPEED, OIL, MODULUS, nodes=129)
    assert film.central_film == pytest.approx(plain.central_film, rel=1e-4)
    assert film.minimum_film == pytest.approx(plain.minimum_film, rel=1e-4)
    assert np.abs(film.film_temperature - OIL.temperature).max() < 1e-3


def swinging(time, period):
    return 1.0 + 0.4 * np.sin(2.0 * np.pi * time / period)


def test_heat_is_made_led_away_or_stored_at_every_instant():
    """Storage counted anew, from the temperatures and the film."""
    period = 4.0 * TRANSIT
    time = np.linspace(0.0, period, 33)
    film = solve(time, LOAD * swinging(time, period), 1.0)
    made = film.shear_heat + film.compression_heat
    led = film.body_heat.sum(axis=0) + film.carried_heat
    largest = np.maximum(np.abs(film.shear_heat), np.abs(film.compression_heat))
    assert np.all(np.abs(made - led - film.stored_heat) < 1e-3 * largest)
    celsius, specific_gravity = OIL.temperature - 273.15, OIL.density / 1000.0
    capacity = (1630.0 + 3.4 * celsius) / np.sqrt(specific_gravity)
    pressed = 1.0 + 0.6e-9 * film.pressure / (1.0 + 1.7e-9 * film.pressure)
    warmer = film.film_temperature - OIL.temperature
    density = OIL.density * pressed[:, :, None] - 0.7 * warmer
    along = np.trapezoid(density * warmer, film.height, axis=2) * film.film
    wet = film.position[None, :] <= film.outlet.min()
    energy = capacity * np.trapezoid(np.where(wet, along, 0.0), film.position, axis=1)
    rate = np.gradient(energy, time, edge_order=2)
    middle = slice(3, -3)
    swing = np.ptp(film.stored_heat[middle])
    assert film.stored_heat[middle] == pytest.approx(rate[middle], abs=0.1 * swing)


def test_heat_lags_the_sliding_in_proportion_to_its_rate():
    model = ThermalModel("ree-eyring", tolerance=1e-5, nodes_across=5)
    lags = []
    for transits in (100.0, 400.0):
        period = transits * TRANSIT
        time = np.linspace(0.0, period, 17)
        film = solve(time, LOAD, swinging(time, period), keep_every=0, thermal=model)
        # The same sliding, once falling and once rising: the slower surface is still hot, the oil
        # thin and the film less.
        columns = film.highest_surface_temperatures[1], film.central_film, film.traction
        lags.append([column[8] - column[16] for column in columns])
    assert np.sign(lags).tolist() == [[1.0, -1.0, 1.0]] * 2
    fast, slow = np.array(lags)
    assert fast / slow == pytest.approx(4.0, rel=0.1)


@pytest.mark.slow
def test_second_order_in_time():
    model = ThermalModel("ree-eyring", tolerance=1e-6, nodes_across=5, passes=200)
    period = 8.0 * TRANSIT
    series = []
    for steps in (16, 32, 64):
        time = np.linspace(0.0, period, steps + 1)
        swing = np.sin(np.pi * time / period) ** 2
        film = solve(time, LOAD * (1.0 - 0.2 * swing), 1.0 - 0.3 * swing, thermal=model)
        columns = (film.central_film, film.traction, film.highest_surface_temperatures[1])
        series.append([column[:: steps // 4][1:] for column in columns])
    coarse, fine = np.diff(series, axis=0)
    ratio = np.linalg.norm(coarse, axis=1) / np.linalg.norm(fine, axis=1)
    assert np.all((ratio > 3.4) & (ratio < 4.6)), ratio


def test_surface_that_turns_around_under_a_jump_of_heat():
    """Against the integral over all earlier heat of the spread of a band, by plain quadrature."""
    body, interval, nodes, duration = BodyHeat(), 5e-6, 161, 4e-4
    at, band = np.arange(nodes), 20.0 * interval
    place = (at - 80) * interval
    source = (np.abs(place) < band + 0.1 * interval) * 1e8
    band += 0.5 * interval
    time = np.linspace(0.0, duration, 81)
    heat = np.interp(time, [0.0, time[40], time[41], duration], [1.0, 1.0, 3.0, 3.0])
    speed = 2.0 - 4.0 * time / duration
    surface = SurfaceHistory(
        at, np.arange(nodes + 1) - 0.5, interval, body, (duration / 80.0, 1.0), 8e-3
    )
    surface.heat = source.astype(float)
    for i in range(80):
        base, response = surface.begin(time[i + 1] - time[i], (speed[i], speed[i + 1]))
        rise = base + response @ (heat[i + 1] * source)
        surface.end(heat[i + 1] * source)
    # The root of the time since, so that a plain sum meets no pole.
    root = (np.arange(20000) + 0.5) / 20000.0 * np.sqrt(duration)
    then = duration - root**2
    moved = 2.0 * root**2 - 2.0 / duration * (duration**2 - then**2)
    wide = 2.0 * np.sqrt(body.diffusivity) * root
    spread = erf((place[:, None] - moved + band) / wide) - erf(
        (place[:, None] - moved - band) / wide
    )
    weight = np.interp(then, time, heat) * np.sqrt(duration) / 20000.0
    exact = 1e8 / body.thermal_contact_coefficient / np.sqrt(np.pi) * (spread @ weight)
    assert rise == pytest.approx(exact, abs=1e-3 * exact.max())


def test_exchange_of_the_surfaces_mirrors_a_film_under_one_that_turns():
    time = np.linspace(0.0, 15.0 * TRANSIT, 16)
    fast, turning = np.full(16, SPEED), SPEED * np.linspace(0.4, -0.4, 16)
    films = [
        solve_transient_line_contact(
            time, np.where(time < time[7], LOAD, 0.5 * LOAD), RADIUS, 0.5 * (fast + turning), OIL,
            MODULUS, nodes=129, surface_speeds=speeds, keep_every=15,
            thermal=ThermalModel("ree-eyring", nodes_across=5, tolerance=1e-5),
        )
        for speeds in ((fast, turning), (turning, fast))
    ]  # fmt: skip
    assert films[0].traction == pytest.approx(-films[1].traction, rel=1e-3)
    swapped = films[1].film_temperature[:, :, ::-1]
    assert films[0].film_temperature == pytest.approx(swapped, abs=0.1)
    for film in films:
        assert np.abs(film.heat_balance_error).max() < 1e-3
    # A surface that slows down stays longer under the heat.
    assert (
        films[0].highest_surface_temperatures[1, 6]
        > films[0].highest_surface_temperatures[1, 0] + 3.0
    )


def test_heated_film_of_a_tooth_pair_has_the_sliding_of_its_mesh():
    case = load_case("fzg-roughness").replace({"film.model": "moes"})
    mesh, oil, steel = run(case).mesh, case.lubricant_properties, case.material_properties
    film = moving_film(
        mesh, oil, steel, steps=60, nodes=129, keep_every=0,
        thermal=ThermalModel("ree-eyring", nodes_across=5),
    )  # fmt: skip
    # Tooth flanks roll at the pitch point; from there on that of the pinion is the faster one.
    sliding = film.surface_speeds[0] - film.surface_speeds[1]
    rolls = int(np.argmin(np.abs(sliding)))
    assert sliding[-1] > 0.0 > sliding[0]
    assert np.all(np.sign(film.traction[rolls + 2 :]) == 1.0)
    assert np.all(np.sign(film.traction[3 : rolls - 1]) == -1.0)
    assert np.abs(film.heat_balance_error).max() < 1e-3
    cooler, slower = film.highest_surface_temperatures[:, 50]
    assert slower > cooler + 2.0
    assert film.highest_film_temperature[rolls] < oil.temperature + 5.0
    i = 45
    steady = solve_line_contact(
        film.load_per_width[i], film.equivalent_radius[i], film.entrainment_speed[i], oil,
        effective_modulus(steel, steel), nodes=257, thermal=film.thermal_model,
        sliding_speed=sliding[i],
    )  # fmt: skip
    assert film.traction[i] == pytest.approx(steady.traction, rel=0.05)
    assert film.central_film[i] == pytest.approx(steady.central_film, rel=0.05)


def test_wrong_input_is_refused_with_the_remedy():
    time = np.linspace(0.0, TRANSIT, 5)
    with pytest.raises(InputError, match="thermal is of the type str"):
        solve(time, thermal="yes")
    with pytest.raises(InputError, match=r"surface speeds 1\.01 and -0\.99 m/s at instant 0"):
        solve(time, ratio=200.0, speed=0.01)
    bare = replace(OIL, thermal_conductivity=None)
    with pytest.raises(InputError, match="thermal_conductivity of the oil is not known"):
        solve_transient_line_contact(time, LOAD, RADIUS, SPEED, bare, MODULUS, thermal=True)
