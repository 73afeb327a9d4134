"""Friction of the solved film as a law: options, films by index, heat, refusals."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from tribodyn.ehl import FilmState, blok_flash_temperature, film_traction, inlet_heating_factor
from tribodyn.errors import InputError, ModelWarning
from tribodyn.friction import LAWS, TribologicalContact, ehl
from tribodyn.lubricant import Lubricant, from_library

HALF_WIDTH, PRESSURE, MODULUS = 1.2e-4, 0.8e9, 2.2e11
LOAD = 0.5 * np.pi * HALF_WIDTH * PRESSURE
OIL = from_library("80W")


def film_state(contacts=1, lubricant=OIL, thickness=(1e-6, 0.7e-6), **changes):
    """Two films: the Hertz pressure over flat gaps; contacts take them in turn."""
    x = np.linspace(-1.0, 1.0, 301) * HALF_WIDTH
    pressure = PRESSURE * np.sqrt(1.0 - (x / HALF_WIDTH) ** 2)
    values = {
        "position": np.vstack([x, x]),
        "pressure": np.vstack([pressure, pressure]),
        "film_thickness": np.array(thickness)[:, None] * np.ones(301),
        "lubricant": lubricant,
        "effective_modulus": MODULUS,
        "index": np.arange(contacts) % 2,
    }
    return FilmState(**{**values, **changes})


def contact(sliding=(0.5,), entrainment=2.0, **changes):
    speed = np.array(sliding, dtype=float)
    ones = np.ones(speed.shape)
    values = {
        "load_per_width": LOAD * ones,
        "hertz_pressure": PRESSURE * ones,
        "sliding_speed": speed,
        "entrainment_speed": entrainment * ones,
        "slide_to_roll_ratio": speed / entrainment,
        "equivalent_radius": 8e-3 * ones,
        "dynamic_viscosity": OIL.dynamic_viscosity,
        "composite_roughness": 0.0,
        "film": film_state(speed.size),
    }
    return TribologicalContact(**{**values, **changes})


def test_law_is_known_with_its_options():
    law = LAWS["ehl"]
    assert law.needs_film
    assert not LAWS["xu-2007"].needs_film
    assert dict(law.options) == {
        "shear_model": "ree-eyring",
        "eyring_stress": 5e6,
        # None: the shear model's own, and refused by a model that has no such number
        "limiting_stress": None,
        "limiting_stress_slope": None,
        "carreau_stress": None,
        "carreau_exponent": None,
        "yasuda_exponent": None,
        "inlet_heating": False,
        "flash_temperature": False,
        "rolling": False,
    }
    assert np.array_equal(law(contact()), ehl(contact()))


def test_coefficient_is_the_sliding_traction_over_the_load():
    state = contact((0.5, -0.5, 1.5))
    expected = np.abs(film_traction(state.film, state.sliding_speed).sliding) / LOAD
    assert ehl(state) == pytest.approx(expected, rel=1e-13)
    assert np.all(expected > 0.0)


def test_each_contact_has_its_own_film():
    thick, thin = ehl(contact((0.5, 0.5)))
    assert thin > thick
    # far above the Eyring stress the film counts by its logarithm only
    assert thin - thick == pytest.approx(5e6 * np.log(1.0 / 0.7) * 2 * HALF_WIDTH / LOAD, rel=0.2)


def test_shape_of_the_contacts_is_preserved():
    speed = np.array([[0.1, 0.5], [1.0, 2.0]])
    assert ehl(contact(speed, film=film_state(4))).shape == (2, 2)


@pytest.mark.parametrize("heated", [False, True])
def test_no_sliding_no_friction_but_that_of_rolling(heated):
    wedge = film_state(
        1, film_thickness=np.linspace(2e-6, 1e-6, 301) * np.ones((2, 1)), index=np.array([0])
    )
    state = contact((0.0,), film=wedge)
    options = {"flash_temperature": heated, "inlet_heating": heated}
    assert ehl(state, **options)[0] == 0.0
    rolling = ehl(state, rolling=True, **options)[0]
    gap, pressure = wedge.film_thickness[0], wedge.pressure[0]
    by_hand = -0.5 * np.trapezoid(pressure, gap) / LOAD
    factor = 1.0
    if heated:
        factor = inlet_heating_factor(2.0, 0.0, PRESSURE, 0.082, 0.0533, 0.13, MODULUS)
    assert rolling == pytest.approx(factor * by_hand, rel=1e-9)
    assert rolling > 0.0


def test_rolling_adds_to_sliding():
    wedge = film_state(
        2, film_thickness=np.linspace(2e-6, 1e-6, 301) * np.ones((2, 1)), index=np.array([0, 1])
    )
    state = contact((0.5, -0.5), film=wedge)
    added = ehl(state, rolling=True) - ehl(state)
    assert added[0] == pytest.approx(added[1], rel=1e-9)
    assert added[0] > 0.0


def test_smaller_eyring_stress_less_friction():
    coefficients = [ehl(contact(), eyring_stress=stress)[0] for stress in (2e6, 5e6, 10e6)]
    assert np.all(np.diff(coefficients) > 0.0)


def test_friction_rises_with_sliding_and_falls_again_when_the_film_heats():
    speed = np.geomspace(1e-3, 3.0, 30)
    cold = ehl(contact(speed, film=film_state(30, index=np.zeros(30, int))))
    warm = ehl(contact(speed, film=film_state(30, index=np.zeros(30, int))), flash_temperature=True)
    assert np.all(np.diff(cold) > 0.0)
    assert np.all(warm <= cold)
    peak = int(np.argmax(warm))
    assert 5 < peak < 29
    assert np.all(np.diff(warm[: peak + 1]) > 0.0)
    assert np.all(np.diff(warm[peak:]) < 0.0)
    # slow sliding is proportional to the speed, then comes the logarithm
    slow = ehl(contact((1e-6, 2e-6), film=film_state(2, index=np.zeros(2, int))))
    assert slow[1] / slow[0] == pytest.approx(2.0, rel=1e-3)
    assert cold[-1] / cold[-8] < speed[-1] / speed[-8] / 3.0


def test_film_temperature_balances_the_heat_of_the_friction():
    state = contact((1.5,), entrainment=3.0)
    coefficient = ehl(state, flash_temperature=True)[0]
    heat = coefficient * LOAD * 1.5
    surface = blok_flash_temperature(heat, HALF_WIDTH, 3.75, 2.25, kind="mean")
    oil = heat / (2.0 * HALF_WIDTH) * 1e-6 / (12.0 * 0.13)
    traction = film_traction(state.film, 1.5, temperature_rise=surface + oil)
    assert traction.sliding[0] / LOAD == pytest.approx(coefficient, rel=1e-7)
    assert 5.0 < surface < 60.0
    assert 5.0 < oil < 60.0


def test_each_body_takes_up_heat_by_its_own_properties():
    # sqrt(k rho c) of steel 47 W/m/K, 7800 kg/m^3, 460 J/kg/K, and of a polyamide
    bodies = (np.sqrt(47.0 * 7800.0 * 460.0), np.sqrt(0.25 * 1140.0 * 1700.0))
    steel = ehl(contact((1.5,), entrainment=3.0), flash_temperature=True)[0]
    state = contact((1.5,), entrainment=3.0, bodies=bodies)
    coefficient = ehl(state, flash_temperature=True)[0]
    heat = coefficient * LOAD * 1.5
    surface = blok_flash_temperature(heat, HALF_WIDTH, 3.75, 2.25, *bodies, kind="mean")
    oil = heat / (2.0 * HALF_WIDTH) * 1e-6 / (12.0 * 0.13)
    traction = film_traction(state.film, 1.5, temperature_rise=surface + oil)
    assert traction.sliding[0] / LOAD == pytest.approx(coefficient, rel=1e-7)
    assert coefficient < 0.95 * steel
    # the slower body is the polymer: with the roles of both exchanged it is hotter or cooler
    back = contact((-1.5,), entrainment=3.0, bodies=bodies[::-1])
    assert ehl(back, flash_temperature=True)[0] == pytest.approx(coefficient, rel=1e-12)
    other = contact((1.5,), entrainment=3.0, bodies=bodies[::-1])
    assert ehl(other, flash_temperature=True)[0] != pytest.approx(coefficient, rel=1e-3)
    with pytest.raises(InputError, match="bodies"):
        contact((1.5,), bodies=(0.0, 1.0))


def test_heated_inlet_thins_the_film():
    state = contact((0.5,))
    factor = inlet_heating_factor(2.0, 0.25, PRESSURE, 0.082, 0.0533, 0.13, MODULUS)
    expected = film_traction(state.film, 0.5, film_factor=factor).sliding[0] / LOAD
    assert ehl(state, inlet_heating=True)[0] == pytest.approx(expected, rel=1e-12)
    assert ehl(state, inlet_heating=True)[0] > ehl(state)[0]


def test_newtonian_oil_under_pressure_is_warned_of():
    with pytest.warns(ModelWarning, match=r"friction coefficient up to .*ree-eyring") as caught:
        coefficient = ehl(contact(), shear_model="newtonian")
    assert caught[0].message.code == "friction-range"
    assert coefficient[0] > 1.0


def test_eyring_stress_of_a_solid_is_warned_of():
    with pytest.warns(ModelWarning, match="lower the stress from which the oil thins"):
        ehl(contact(), eyring_stress=50e6)


def test_unknown_shear_model_names_the_known_ones():
    with pytest.raises(InputError, match='Did you mean "ree-eyring"'):
        ehl(contact(), shear_model="eyring")


@pytest.mark.parametrize("stress", [0.0, -5e6, np.nan])
def test_eyring_stress_must_be_positive(stress):
    with pytest.raises(InputError, match="eyring_stress"):
        ehl(contact(), eyring_stress=stress)


def test_without_a_film_the_remedy_is_named():
    with pytest.raises(InputError, match=r'film is not known.*model = "newton"'):
        ehl(contact(film=None))


@pytest.mark.parametrize("option", ["inlet_heating", "flash_temperature"])
def test_everything_that_the_oil_lacks_is_named_at_once(option):
    bare = Lubricant(0.082, 880.0, 2.19e-8)
    with pytest.raises(InputError) as caught:
        ehl(contact(film=film_state(1, lubricant=bare)), **{option: True})
    named = {problem.where for problem in caught.value.problems}
    assert named == {
        "argument lubricant.temperature",
        "argument lubricant.temperature_viscosity_coefficient",
        "argument lubricant.thermal_conductivity",
    }
    assert ehl(contact(film=film_state(1, lubricant=bare)))[0] > 0.0


def test_number_of_films_and_of_contacts_must_agree():
    with pytest.raises(InputError, match="3 films for 1 contacts"):
        contact(film=film_state(3))


@pytest.mark.parametrize(
    ("changes", "match"),
    [
        ({"index": np.array([2])}, "whole numbers from 0 to 1"),
        ({"index": np.array([0.0])}, "whole numbers"),
        ({"film_thickness": np.zeros((2, 301))}, "film_thickness"),
        ({"film_thickness": np.ones((2, 300))}, "shapes"),
        ({"pressure": -np.ones((2, 301))}, "pressure"),
        ({"position": np.zeros((2, 301))}, "position step"),
        ({"effective_modulus": 0.0}, "effective_modulus"),
    ],
)
def test_invalid_film_states_are_refused(changes, match):
    with pytest.raises(InputError, match=match):
        film_state(1, **changes)


@dataclasses.dataclass(frozen=True)
class Solution:
    """What a film state reads of a solved contact."""

    position: np.ndarray
    pressure: np.ndarray
    film: np.ndarray
    nodes: int = 301
    lubricant: Lubricant | None = OIL
    viscosity_law: str = "roelands"
    effective_modulus: float = MODULUS
    log_mean_viscosity: np.ndarray | None = None


def solutions(**changes):
    state = film_state(2)
    rows = zip(state.position, state.pressure, state.film_thickness, strict=True)
    return [Solution(*row, **changes) for row in rows]


def test_films_come_from_solutions():
    state = FilmState.from_solutions(solutions(), [0, 1, 1])
    assert (state.films, state.size) == (2, 3)
    assert state.central_film == pytest.approx([1e-6, 0.7e-6])
    assert np.array_equal(
        film_traction(state, 0.5).sliding, film_traction(film_state(2), 0.5).sliding[[0, 1, 1]]
    )


@pytest.mark.parametrize(
    ("options", "match"),
    [
        ([], "no solution"),
        (solutions(lubricant=None), "numbers of Moes"),
        ([*solutions(), *solutions(nodes=513)], "nodes = 301 and nodes = 513"),
        ([*solutions(), *solutions(viscosity_law="barus")], "viscosity_law"),
    ],
)
def test_solutions_that_make_no_film_state_are_refused(options, match):
    with pytest.raises(InputError, match=match):
        FilmState.from_solutions(options)


def test_isoviscous_film_has_constant_viscosity():
    state = film_state(1, viscosity_law="isoviscous")
    assert np.allclose(np.exp(state.log_viscosity), OIL.dynamic_viscosity, rtol=1e-14)
