"""The heated film: limits, balance of heat, closed solutions, order across the film."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from tribodyn import load_case, run
from tribodyn.ehl import (
    FILM_MODELS,
    BodyHeat,
    FilmState,
    ThermalModel,
    blok_flash_temperature,
    inlet_heating_factor,
    solve_line_contact,
)
from tribodyn.ehl.thermal.surface_history import surface_response
from tribodyn.ehl.traction.shear_models import carreau_shear_stress
from tribodyn.errors import InputError
from tribodyn.friction import TribologicalContact
from tribodyn.friction.ehl import ehl
from tribodyn.lubricant import Lubricant, from_library

OIL = from_library("80W")
SPEED = 3.0722
CONTACT = (147802.0, 8e-3, SPEED, OIL, 2.2e11)
MODULUS, ALPHA = 2.2e11, 2.19e-8
#: Bodies that take up any heat without getting warm.
LED_AWAY = (BodyHeat(1e13, 1e12),) * 2


@cache
def heated(ratio, shear="newtonian", across=17, nodes=513, tolerance=1e-4, **model):
    """The gear contact at a slide-to-roll ratio."""
    thermal = ThermalModel(shear, nodes_across=across, tolerance=tolerance, **model)
    return solve_line_contact(*CONTACT, nodes=nodes, thermal=thermal, sliding_speed=ratio * SPEED)


@cache
def cold():
    return solve_line_contact(*CONTACT, nodes=513)


def test_heat_that_is_led_away_at_once_leaves_the_isothermal_film():
    film = heated(1.0, bodies=LED_AWAY, thermal_conductivity=1e12)
    assert film.central_film == pytest.approx(cold().central_film, rel=1e-4)
    assert film.minimum_film == pytest.approx(cold().minimum_film, rel=1e-4)
    assert np.abs(film.film_temperature - OIL.temperature).max() < 1e-3


def test_film_that_stays_cold_has_the_stress_of_carreaus_law():
    numbers = {"carreau_exponent": 0.4, "yasuda_exponent": 1.5}
    thermal = ThermalModel("carreau", numbers, LED_AWAY, thermal_conductivity=1e12)
    film = solve_line_contact(*CONTACT, nodes=257, thermal=thermal, sliding_speed=0.5 * SPEED)
    viscosity = np.exp(film.log_mean_viscosity)
    law = carreau_shear_stress(viscosity, film.sliding_speed, film.film, **numbers)
    middle = np.abs(film.position) < 0.3 * film.half_width
    np.testing.assert_allclose(-film.shear_stress[middle], law[middle], rtol=1e-3)


def test_film_is_settled_within_the_tolerance():
    """Flow by pressure that lagged a pass behind left 0.7 % of the film."""
    usual, strict = (heated(1.0, "ree-eyring", tolerance=limit) for limit in (5e-4, 1e-5))
    assert usual.central_film == pytest.approx(strict.central_film, rel=1e-3)
    assert usual.traction == pytest.approx(strict.traction, rel=1e-3)
    assert usual.thermal_passes < 20


def test_sliding_and_rolling_that_make_no_heat_leave_the_isothermal_film():
    slow = (*CONTACT[:2], 0.01, *CONTACT[3:])
    plain = solve_line_contact(*slow, nodes=513)
    film = solve_line_contact(*slow, nodes=513, thermal=True, sliding_speed=1e-8)
    assert film.central_film == pytest.approx(plain.central_film, rel=1e-4)
    assert film.friction_coefficient < 1e-3


def rolling_power(film):
    """Power of the pressure against the flow, ``int (u_e h - q) dp``: what rolling costs."""
    mean = np.trapezoid(film.film_temperature, film.height, axis=1) - OIL.temperature
    density = film.density - 0.7 / OIL.density * mean
    carried = SPEED * density * film.film
    flux = carried[np.argmax(film.pressure)] * np.ones_like(carried)
    spare = (carried - flux) / density
    return float(np.sum(0.5 * (spare[1:] + spare[:-1]) * np.diff(film.pressure)))


@pytest.mark.parametrize("shear", ["newtonian", "ree-eyring"])
def test_heat_made_is_heat_led_away(shear):
    for ratio in (0.0, 0.5, 1.5):
        film = heated(ratio, shear)
        made = film.shear_heat + film.compression_heat
        away = film.body_heat.sum() + film.carried_heat
        assert away == pytest.approx(made, abs=1e-3 * film.shear_heat)
        sliding, rolling = film.traction * film.sliding_speed, rolling_power(film)
        assert film.shear_heat == pytest.approx(
            sliding + rolling, abs=0.01 * sliding + 0.1 * rolling
        )


@pytest.mark.parametrize(
    ("shear", "load", "speed", "ratio", "radius"),
    [
        # Oil that yields, that thins steeply, and that runs around in a thick inlet.
        ("bair-winer", 8.43e4, 0.853, 0.591, 6.1e-3),
        ("bair-winer", 1.54e5, 8.22, 0.024, 11.6e-3),
        ("bair-winer", 6.40e4, 16.0, 0.0, 11.3e-3),
        ("carreau-eyring", 6.31e4, 1.67, 0.214, 5.7e-3),
        ("ree-eyring", 3.12e4, 15.5, 0.00955, 17.5e-3),
    ],
)
def test_contacts_of_any_shear_settle_with_their_heat_in_balance(shear, load, speed, ratio, radius):
    contact = (load, radius, speed, OIL, MODULUS)
    film = solve_line_contact(
        *contact, nodes=257, thermal=ThermalModel(shear), sliding_speed=ratio * speed
    )
    assert abs(film.heat_balance_error) < 1e-3
    assert film.central_film < solve_line_contact(*contact, nodes=257).central_film
    # The limit of Bair and Winer, and Eyring's stress with thinning, bound the friction.
    assert film.friction_coefficient < 0.06


def test_more_sliding_makes_a_hotter_thinner_film():
    films = [heated(ratio) for ratio in (0.0, 0.5, 1.0, 1.5)]
    hottest = [film.film_temperature.max() for film in films]
    assert np.all(np.diff(hottest) > 5.0)
    assert np.all(np.diff([film.minimum_film for film in films]) < 0.0)
    assert np.all(np.diff([film.friction_coefficient for film in films[1:]]) < 0.0)
    # The slower surface stays longer in the contact and gets hotter.
    first, second = heated(1.0).surface_temperatures.max(axis=1)
    assert second > first + 5.0
    mirrored = heated(-1.0)
    assert mirrored.traction == pytest.approx(-heated(1.0).traction, rel=1e-3)
    assert mirrored.surface_temperatures[::-1].max(axis=1) == pytest.approx(
        [first, second], abs=0.1
    )


def test_temperatures_converge_with_the_square_of_the_nodes_across():
    values = np.array(
        [
            (film.central_film, film.traction, film.film_temperature.max() - OIL.temperature)
            for film in (heated(1.0, across=n, tolerance=1e-6) for n in (9, 17, 33))
        ]
    )
    coarse, fine = np.abs(np.diff(values, axis=0))
    assert np.all(coarse[1:] > 3.0 * fine[1:])
    assert np.all(np.abs(values[1] / values[2] - 1.0) < 0.02)


def test_slow_sheared_film_has_the_profile_of_plane_couette_flow():
    """Constant stress, heat conducted across: ``exp(b (T - T_s)) = 1 + Br/8`` in the middle."""
    oil = Lubricant(
        0.5, 880.0, 1.5e-8, temperature=313.15, temperature_viscosity_coefficient=0.04,
        thermal_conductivity=0.13,
    )  # fmt: skip
    contact = 6e4, 8e-3, 0.1, oil, MODULUS
    speed = 0.1
    film = solve_line_contact(
        *contact, nodes=513, viscosity_law="barus", sliding_speed=speed,
        thermal=ThermalModel(nodes_across=65),
    )  # fmt: skip
    at = int(np.argmin(np.abs(film.position)))
    walls = film.surface_temperatures[:, at]
    viscosity = 0.5 * math.exp(1.5e-8 * film.pressure[at] - 0.04 * (walls.mean() - 313.15))
    brinkman = viscosity * 0.04 * speed**2 / 0.13
    assert brinkman > 1.0
    rise = film.film_temperature[at, 32] - walls.mean()
    assert rise == pytest.approx(math.log1p(brinkman / 8.0) / 0.04, rel=0.03)
    root = math.sqrt(brinkman / 8.0)
    stress = viscosity * speed / film.film[at] * math.asinh(root) / (root * math.hypot(1.0, root))
    assert -film.shear_stress[at] == pytest.approx(stress, rel=0.02)


def test_surface_under_hertzian_heat_has_the_flash_temperature_of_blok():
    half_width, speed, nodes = 1e-4, 4.0, 801
    at, interval = np.arange(nodes), 3e-7
    heat = np.sqrt(np.maximum(1.0 - ((at - 400) * interval / half_width) ** 2, 0.0))
    edges, body = np.arange(nodes + 1) - 0.5, (47.0, (47.0 / 13.6e3) ** 2)
    response = surface_response(at, edges, interval, speed, *body)
    rise = response @ heat
    total = float(heat.sum() * interval)
    # Both bodies alike: each takes half of the heat.
    assert rise.max() == pytest.approx(
        blok_flash_temperature(2.0 * total, half_width, speed, speed), rel=0.01
    )
    backwards = surface_response(at, edges, interval, -speed, *body)
    np.testing.assert_allclose(backwards, response.T, rtol=1e-9, atol=1e-15)


def test_rolling_film_is_as_much_thinner_as_inlet_factors_say():
    """Gupta et al. (1992) 0.880 and Wilson and Sheu (1983) 0.896 at the loading 0.318."""
    loading = 0.082 * 0.0533 * SPEED**2 / 0.13
    gupta = inlet_heating_factor(SPEED, 0.0, cold().hertz_pressure, 0.082, 0.0533, 0.13, MODULUS)
    wilson = 1.0 / (1.0 + 0.241 * loading**0.64)
    factor = heated(0.0).central_film / cold().central_film
    assert factor == pytest.approx(gupta, abs=0.05)
    assert factor == pytest.approx(wilson, abs=0.03)


def test_wrong_input_is_refused_with_the_remedy():
    with pytest.raises(InputError, match=r"sliding_speed = 1 m/s without thermal.*thermal=True"):
        solve_line_contact(*CONTACT, sliding_speed=1.0)
    bare = replace(OIL, temperature_viscosity_coefficient=None)
    with pytest.raises(InputError, match="temperature_viscosity_coefficient of the oil"):
        solve_line_contact(*CONTACT[:3], bare, MODULUS, nodes=129, thermal=True)
    with pytest.raises(InputError, match="shear_model"):
        ThermalModel("honey")
    with pytest.raises(InputError, match="does not belong to shear_model"):
        ThermalModel("newtonian", {"carreau_stress": 5e6})
    with pytest.raises(InputError, match="thermal is of the type str"):
        solve_line_contact(*CONTACT, thermal="yes")


def test_friction_law_shears_the_heated_film_as_its_solution_does():
    film = heated(0.5, "ree-eyring")
    one = np.ones(1)
    contact = TribologicalContact(
        film.load_per_width * one, film.hertz_pressure * one, film.sliding_speed * one,
        SPEED * one, 0.5 * one, 8e-3 * one, 0.082, 0.0, FilmState.from_solutions([film]),
    )  # fmt: skip
    assert ehl(contact) == pytest.approx(film.friction_coefficient, rel=0.02)
    # One film at its inlet temperature has far more.
    assert ehl(replace(contact, film=FilmState.from_solutions([cold()]))) > 1.5 * ehl(contact)
    with pytest.raises(InputError, match="flash_temperature = true with a heated film"):
        ehl(contact, flash_temperature=True)


def test_films_of_a_batch_are_those_of_single_contacts():
    films = FILM_MODELS["thermal"].films(
        [147802.0, 147802.0], 8e-3, SPEED, OIL, MODULUS, sliding_speed=[0.0, 0.5 * SPEED]
    )
    single = heated(0.5, "ree-eyring", tolerance=5e-4)
    assert films.central_film[1] == pytest.approx(single.central_film, rel=1e-6)
    assert films.central_film[0] != films.central_film[1]
    with pytest.raises(InputError, match="sliding_speed is missing"):
        FILM_MODELS["thermal"].films(147802.0, 8e-3, SPEED, OIL, MODULUS)


@pytest.mark.filterwarnings("ignore:.*mixed-lubrication")
def test_case_with_heated_film_has_less_film_and_friction(short_case):
    cold_mesh, hot_mesh = (run(short_case(model)).mesh for model in ("newton", "thermal"))
    touching = hot_mesh.in_contact
    ratio = hot_mesh.minimum_film[touching] / cold_mesh.minimum_film[touching]
    sliding = np.abs(hot_mesh.sliding_speed[touching] / hot_mesh.entrainment_speed[touching])
    assert 0.4 < ratio.min() < 0.8
    assert np.all(ratio < 1.0)
    # The pitch point has the least heat.
    assert sliding[np.argmax(ratio)] < 0.3 < sliding[np.argmin(ratio)]
    hot, before = (mesh.friction_coefficient[touching] for mesh in (hot_mesh, cold_mesh))
    assert hot.mean() < 0.7 * before.mean()


#: Helical pairs of two gears, and of a gear in a ring.
HELICAL = {"gears.helix_angle": "10deg", "gears.center_distance": "92.95 mm"}
RING = {
    "gears.helix_angle": "12deg", "gears.center_distance": "79.7 mm", "gears.normal_module": "4 mm",
    "gears.pinion.teeth": 22, "gears.wheel.teeth": -61, "gears.wheel.bore_diameter": None,
    "gears.pinion.profile_shift_coefficient": 0.0, "gears.wheel.profile_shift_coefficient": 0.0,
    "gears.driver": "pinion", "operation.speed_of": "pinion", "stiffness.model": "iso6336",
    "stiffness.reference": None, "dynamics.backlash": None,
}  # fmt: skip


@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
@pytest.mark.slow
@pytest.mark.parametrize("changes", [HELICAL, RING], ids=["helical", "ring"])
def test_heated_slices_are_those_of_single_contacts(short_case, changes):
    case = short_case("thermal").replace(changes)
    mesh = run(case).mesh
    touching = mesh.in_contact
    names = "load_per_width", "equivalent_radius", "entrainment_speed", "sliding_speed"
    load, *motion, film, friction = (
        getattr(mesh, name)[touching] for name in (*names, "central_film", "friction_coefficient")
    )
    order = np.argsort(np.round(mesh.sliding_speed[touching], 9), kind="stable")
    chosen = order[np.linspace(0, order.size - 1, 400).astype(int)]
    chosen = chosen[load[chosen] > 0.3 * load.max()][::30]
    radius, speed, sliding = (values[chosen] for values in motion)
    direct = FILM_MODELS["thermal"].films(
        load[chosen], radius, speed, case.lubricant_properties, MODULUS, nodes=129,
        sliding_speed=sliding,
    )  # fmt: skip
    assert chosen.size > 8
    assert np.ptp(sliding / speed) > 0.9
    deviation = np.abs(film[chosen] / direct.central_film - 1.0)
    assert deviation.max() < 0.02
    assert np.median(deviation) < 3e-3
    # The law takes the mean viscosity across the film, the solution its distribution.
    expected = [each.friction_coefficient for each in direct.solutions]
    np.testing.assert_allclose(friction[chosen], expected, rtol=0.05)


@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
@pytest.mark.slow
def test_films_of_sun_and_ring_meshes_are_heated():
    few = {"friction.law": "ehl", "film.nodes": 65, "film.positions": 8, "film.stiffness": "none"}
    stage = load_case("planetary-stage").replace({"load_cases": None})
    hot, before = (
        run(stage.replace({**few, "film.model": model})).summary()
        for model in ("thermal", "newton")
    )
    ratios = {
        kind: np.array([hot[f"meshes.{mesh}.{n}"] / before[f"meshes.{mesh}.{n}"] for n in names])
        for kind, mesh in (("sun", "low_sun1"), ("ring", "low_ring1"))
        for names in [("mean_friction_coefficient", "minimum_film_thickness")]
    }
    # The flanks of planet and ring slide less, so that they make less heat.
    assert np.all(ratios["sun"] < ratios["ring"])
    assert np.all(ratios["ring"] < 1.0)
    assert hot["machine.efficiency"] > before["machine.efficiency"]


HEAT = {
    "lubricant.temperature_viscosity_coefficient": 0.05,
    "lubricant.thermal_conductivity": 0.13,
}


@pytest.fixture(scope="module")
def short_case():
    """The FZG case with few positions."""
    few = {"friction.law": "ehl", "film.positions": 8, "film.nodes": 129, "film.stiffness": "none"}
    case = load_case("fzg-film").replace({**few, **HEAT})
    return lambda model: case.replace({"film.model": model})


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"lubricant.thermal_conductivity": None}, "thermal_conductivity is missing"),
        ({"friction.flash_temperature": True}, "flash_temperature = true with a heated film"),
    ],
)
def test_case_says_what_a_heated_film_needs(changes, message):
    changes = {**HEAT, "film.model": "thermal", "friction.law": "ehl", **changes}
    with pytest.raises(InputError, match=message):
        load_case("fzg-film").replace({k: v for k, v in changes.items() if v is not None})
