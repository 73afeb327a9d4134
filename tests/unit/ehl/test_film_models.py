"""Film formulas: exponents, invariance, mean speed, refusals; film models by name."""

from __future__ import annotations

import inspect

import numpy as np
import pytest

from tribodyn.ehl import (
    FILM_MODELS,
    dowson_1968_minimum,
    dowson_toyoda_central,
    line_contact_groups,
    moes_central,
    pan_hamrock_central,
    pan_hamrock_minimum,
)
from tribodyn.errors import InputError, ModelWarning

ARGUMENTS = (
    "load_per_width",
    "equivalent_radius",
    "entrainment_speed",
    "dynamic_viscosity",
    "pressure_viscosity_coefficient",
    "effective_modulus",
)
CONTACT = dict(zip(ARGUMENTS, (147802.0, 8e-3, 3.0722, 0.082, 2.19e-8, 2.2e11), strict=True))
POWER_LAWS = {
    dowson_1968_minimum: (2.65, 0.7, 0.54, -0.13),
    dowson_toyoda_central: (3.06, 0.69, 0.56, -0.10),
    pan_hamrock_minimum: (1.714, 0.694, 0.568, -0.128),
    pan_hamrock_central: (2.922, 0.692, 0.470, -0.166),
}
FORMULAS = [*POWER_LAWS, moes_central]


def exponent(formula, name, factor=1.001):
    changed = {**CONTACT, name: CONTACT[name] * factor}
    return np.log(formula(**changed) / formula(**CONTACT)) / np.log(factor)


@pytest.mark.parametrize("formula", list(POWER_LAWS))
def test_exponents_follow_from_those_of_the_groups(formula):
    _, u, g, w = POWER_LAWS[formula]
    expected = {
        "load_per_width": w,
        "equivalent_radius": 1 - u - w,
        "entrainment_speed": u,
        "dynamic_viscosity": u,
        "pressure_viscosity_coefficient": g,
        "effective_modulus": g - u - w,
    }
    exponents = {name: exponent(formula, name) for name in ARGUMENTS}
    assert exponents == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize("formula", list(POWER_LAWS))
def test_factor_shows_where_all_groups_are_one(formula):
    # U = G = W = 1 lies far outside of the regime of the formula and says so
    with pytest.warns(ModelWarning, match="film-range"):
        film = formula(1.0, 1.0, 1.0, 1.0, 1.0, 1.0)
    assert film == pytest.approx(POWER_LAWS[formula][0], rel=1e-12)


def test_sum_of_the_surface_speeds_gives_the_classic_wrong_factor():
    # two surfaces of 3.0722 m/s: the mean is 3.0722 m/s, the sum would be 6.1444 m/s
    surface_speeds = np.array([3.0722, 3.0722])
    film = dowson_1968_minimum(**{**CONTACT, "entrainment_speed": surface_speeds.mean()})
    wrong = dowson_1968_minimum(**{**CONTACT, "entrainment_speed": surface_speeds.sum()})
    assert film == pytest.approx(0.8994e-6, rel=1e-4)
    assert wrong / film == pytest.approx(2.0**0.7, rel=1e-12)
    assert wrong / film == pytest.approx(1.62, abs=0.005)


@pytest.mark.parametrize("formula", FORMULAS)
def test_film_does_not_depend_on_the_units(formula):
    # a unit system with lengths in mm and forces in kN: the film is the same length
    length, force = 1e3, 1e-3
    pressure = force / length**2
    scaled = formula(
        CONTACT["load_per_width"] * force / length,
        CONTACT["equivalent_radius"] * length,
        CONTACT["entrainment_speed"] * length,
        CONTACT["dynamic_viscosity"] * pressure,
        CONTACT["pressure_viscosity_coefficient"] / pressure,
        CONTACT["effective_modulus"] * pressure,
    )
    assert scaled / length == pytest.approx(formula(**CONTACT), rel=1e-12)


@pytest.mark.parametrize("formula", FORMULAS)
def test_arrays_are_broadcast_and_equal_single_contacts(formula):
    speeds, loads = np.array([2.0, 3.0, 4.0]), np.array([[1e5], [2e5]])
    films = formula(**{**CONTACT, "entrainment_speed": speeds, "load_per_width": loads})
    assert films.shape == (2, 3)
    single = formula(**{**CONTACT, "entrainment_speed": 3.0, "load_per_width": 2e5})
    assert films[1, 1] == pytest.approx(single, rel=1e-14)


@pytest.mark.parametrize("formula", FORMULAS)
@pytest.mark.parametrize("name", ARGUMENTS)
@pytest.mark.parametrize("value", [0.0, -1.0, np.nan, np.inf])
def test_every_argument_must_be_positive(formula, name, value):
    with pytest.raises(InputError, match=name):
        formula(**{**CONTACT, name: value})


def test_one_unloaded_contact_among_many_is_named():
    loads = np.array([1e5, 0.0, 1e5])
    with pytest.raises(InputError, match="load_per_width = 0 N/m"):
        dowson_1968_minimum(**{**CONTACT, "load_per_width": loads})


@pytest.mark.parametrize("formula", list(POWER_LAWS))
@pytest.mark.parametrize(
    ("name", "factor"),
    [
        ("pressure_viscosity_coefficient", 1e-3),
        ("load_per_width", 1e-3),
        ("dynamic_viscosity", 1e4),
    ],
)
def test_one_warning_when_the_regime_is_left(formula, name, factor):
    value = CONTACT[name] * np.array([1.0, factor])
    with pytest.warns(ModelWarning, match=r"film-range.*1 of 2 contacts.*moes") as caught:
        formula(**{**CONTACT, name: value})
    assert len(caught) == 1
    assert caught[0].filename == __file__


def test_light_load_on_an_oil_that_thickens_strongly_is_rigid():
    # L = 40, where the isoviscous branches are far: only the rigid one can limit the film
    thickening = {**CONTACT, "pressure_viscosity_coefficient": 4.38e-8}
    assert dowson_1968_minimum(**{**thickening, "load_per_width": 49267.5}) > 0.0
    with pytest.warns(ModelWarning, match=r"M from 0\.276 to 0\.276"):
        film = dowson_1968_minimum(**{**thickening, "load_per_width": 8211.0})
    groups = line_contact_groups(**thickening)
    rigid_limit = 1.04970 * groups.moes_material ** (2 / 3) * groups.moes_film_unit
    assert film > 1.1 * rigid_limit


def test_moes_covers_all_regimes_silently():
    film = moes_central(**{**CONTACT, "load_per_width": np.array([1e-2, 1e2, 1e7])})
    assert np.all(np.diff(film) < 0.0)


def test_groups_of_moes_follow_from_those_of_dowson_and_higginson():
    groups = line_contact_groups(**CONTACT)
    u = 2 * CONTACT["dynamic_viscosity"] * CONTACT["entrainment_speed"]
    u /= CONTACT["effective_modulus"] * CONTACT["equivalent_radius"]
    w = CONTACT["load_per_width"] / (CONTACT["effective_modulus"] * CONTACT["equivalent_radius"])
    assert groups.moes_load == pytest.approx(w / u**0.5, rel=1e-14)
    assert groups.moes_material == pytest.approx(2.19e-8 * 2.2e11 * u**0.25, rel=1e-14)
    assert groups.moes_film_unit == pytest.approx(8e-3 * u**0.5, rel=1e-14)


def test_models_by_name():
    formulas = ["dowson-higginson", "pan-hamrock", "moes"]
    assert FILM_MODELS.names() == ["none", "newton", "multigrid", "thermal", *formulas]
    none, newton, multigrid, thermal, dowson, pan, moes = (
        FILM_MODELS[name] for name in FILM_MODELS
    )
    assert (newton.method, multigrid.method, moes.method) == ("newton", "multigrid", "")
    assert thermal.method == newton.method
    assert (none.central, none.minimum) == (None, None)
    formulas = [
        dowson_toyoda_central,
        dowson_1968_minimum,
        pan_hamrock_central,
        pan_hamrock_minimum,
        moes_central,
    ]
    films = [dowson.central, dowson.minimum, pan.central, pan.minimum, moes.central]
    assert films == [inspect.unwrap(formula) for formula in formulas]
    assert moes.minimum is None


def test_all_formulas_take_the_same_arguments():
    for name in FILM_MODELS:
        for formula in (FILM_MODELS[name].central, FILM_MODELS[name].minimum):
            if formula is not None:
                assert tuple(inspect.signature(formula).parameters) == ARGUMENTS


def test_misspelt_model_names_the_nearest():
    with pytest.raises(InputError, match='Did you mean "pan-hamrock"'):
        FILM_MODELS["pan-hamrok"]
