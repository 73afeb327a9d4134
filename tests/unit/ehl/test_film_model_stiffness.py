"""Film models as the mesh asks them: options, stiffness of a formula, what is not known."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

from tribodyn.ehl import FILM_MODELS, moes_central, solve_line_contact_moes
from tribodyn.ehl.formulas.line import moes_load_exponent
from tribodyn.errors import InputError
from tribodyn.lubricant import Lubricant

OIL = Lubricant(0.082, 880.0, 2.19e-8)
LOAD, RADIUS, SPEED, MODULUS = 147802.0, 8e-3, 3.0722, 2.2e11
FORMULAS = ["dowson-higginson", "pan-hamrock", "moes"]


def films(name, load=LOAD, **more):
    return FILM_MODELS[name].films(load, RADIUS, SPEED, OIL, MODULUS, **more)


@pytest.mark.parametrize("name", FORMULAS)
def test_stiffness_of_a_formula_is_the_slope_of_load_over_film(name):
    length, step = 20e-3, 1e-5
    loads = LOAD * (1.0 + step * np.array([-1.0, 1.0]))
    low, high = films(name, loads).central_film
    slope = -length * np.diff(loads)[0] / (high - low)
    assert films(name, length=length).film_stiffness == pytest.approx(slope, rel=1e-8)
    # about a tenth power: softer than the teeth would be stiff, 1e10 N/m and more
    assert 1.4e10 < slope < 3.5e10


@pytest.mark.parametrize("load", [1e1, 1e3, 1e5, 1e7])
def test_exponent_of_moes_is_the_derivative_of_his_film(load):
    oil = (OIL.dynamic_viscosity, OIL.pressure_viscosity_coefficient, MODULUS)
    step = 1e-5
    low, high = (
        np.log(moes_central(load * np.exp(sign * step), RADIUS, SPEED, *oil))
        for sign in (-1.0, 1.0)
    )
    exponent = moes_load_exponent(load, RADIUS, SPEED, *oil)
    assert exponent == pytest.approx((high - low) / (2.0 * step), abs=1e-9)


def test_exponent_of_moes_reaches_the_rigid_limit():
    oil = (OIL.dynamic_viscosity, OIL.pressure_viscosity_coefficient, MODULUS)
    assert moes_load_exponent(1.0, RADIUS, SPEED, *oil) == pytest.approx(-1.0, abs=1e-6)


def test_stiffness_is_in_proportion_to_the_length():
    first, two = (films("moes", length=length).film_stiffness for length in (0.01, 0.02))
    assert two == pytest.approx(2.0 * first, rel=1e-14)
    with pytest.raises(InputError, match="length = 0"):
        films("moes", length=0.0)


def test_quantities_missing_in_a_formula_are_none():
    dowson, moes, none = (films(name) for name in ("dowson-higginson", "moes", "none"))
    assert dowson.minimum_film < dowson.central_film
    assert moes.minimum_film is None
    assert (dowson.film_pressure, dowson.solutions) == (None, ())
    assert (none.central_film, none.minimum_film, none.film_stiffness) == (None, None, None)


@pytest.mark.parametrize(
    ("name", "option", "says"),
    [
        ("moes", {"nodes": 513}, ("nodes", "stiffness", "moes")),
        ("newton", {"node": 513}, ('"node"', 'Did you mean "nodes"?')),
        ("moes", {"stiffness": "secant"}, ("secant", "none, tangent", '"newton"')),
        ("moes", {"stiffness": "approach"}, ("none, tangent", "not the approach of the bodies")),
        ("none", {"stiffness": "tangent"}, ('stiffness = "tangent"', '"none"')),
        ("newton", {"stiffness": "chord"}, ("chord", "approach, none, tangent, secant, seed")),
    ],
)
def test_foreign_options_are_refused(name, option, says):
    with pytest.raises(InputError) as refused:
        FILM_MODELS[name].complete(option)
    for part in says:
        assert part in str(refused.value)


def test_options_are_completed():
    assert FILM_MODELS["newton"].complete({"nodes": 257, "domain": None}) == {
        "stiffness": "approach",
        "nodes": 257,
        "positions": 30,
        "inlet": "flooded",
        "domain": None,
    }
    assert FILM_MODELS["moes"].complete({"stiffness": None}) == {"stiffness": "none"}


def test_an_approach_that_rises_with_the_load_is_reported():
    # On either side, at M 0.6 and 0.8, the distance falls with the load.
    for load, warns in ((0.6, False), (0.7, True), (0.8, False)):
        contact = solve_line_contact_moes(load, 25.0, domain="auto", inlet="flooded", nodes=513)
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            stiffness = contact.film_stiffness(kind="approach")
        assert (stiffness < 0.0) == warns
        assert (
            any("film keeps rises with the load" in str(each.message) for each in caught) == warns
        )
