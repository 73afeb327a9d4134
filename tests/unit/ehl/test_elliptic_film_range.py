"""Formulas for ellipses warn outside of their regime and their ratio of radii, and not inside."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from tribodyn.ehl import (
    hamrock_dowson_central,
    hamrock_dowson_minimum,
    nijenbanning_central,
    nijenbanning_dimensionless_central,
)
from tribodyn.errors import quiet

POWER_LAWS = (hamrock_dowson_minimum, hamrock_dowson_central)
VISCOSITY, COEFFICIENT, MODULUS, RADIUS = 0.05, 2.0e-8, 2.2e11, 0.015


def contact(load: float, material: float, ratio: float) -> tuple[float, ...]:
    """Arguments of a contact with the numbers M and L of Moes and a ratio of radii."""
    speed = 0.5 * (material / (COEFFICIENT * MODULUS)) ** 4 * MODULUS * RADIUS / VISCOSITY
    viscous = 2.0 * VISCOSITY * speed / (MODULUS * RADIUS)
    force = load * MODULUS * RADIUS**2 * viscous**0.75
    return force, RADIUS, RADIUS / ratio, speed, VISCOSITY, COEFFICIENT, MODULUS


def messages(formula: Callable[..., Any], *arguments: Any) -> list[str]:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        assert np.all(formula(*arguments) > 0.0)
    assert all(each.filename == __file__ for each in caught)
    return [str(each.message) for each in caught]


def slopes(load: float, material: float, ratio: float) -> tuple[float, float]:
    """Exponents of load and material number of the film that covers all regimes."""
    films = nijenbanning_dimensionless_central(
        load * np.array([1.001, 1.0, 1.001**-1]), material, ratio
    )
    thicker = nijenbanning_dimensionless_central(
        load, material * np.array([1.001, 1.001**-1]), ratio
    )
    step = 2.0 * np.log(1.001)
    return float(np.log(films[0] / films[2]) / step), float(np.log(thicker[0] / thicker[1]) / step)


@pytest.mark.parametrize("formula", POWER_LAWS)
@pytest.mark.parametrize("ratio", [1.0, 0.3, 0.03])
@pytest.mark.parametrize(
    ("load", "material", "exponents"),
    [
        (0.02, 2.0, (-2.0, 0.0)),  # rigid, isoviscous
        (3e4, 0.05, (-2.0 / 15.0, 0.0)),  # elastic, isoviscous
        (30.0, 2e4, (0.0, 2.0 / 3.0)),  # rigid, piezoviscous
        (1e3, 15.0, (-1.0 / 12.0, 0.75)),  # elastic, piezoviscous: theirs
    ],
)
def test_each_other_regime_warns(
    formula: Callable[..., Any],
    ratio: float,
    load: float,
    material: float,
    exponents: tuple[float, float],
) -> None:
    """The regime is that of the exponents of the film that joins all four."""
    assert slopes(load, material, ratio) == pytest.approx(exponents, abs=0.06)
    reported = messages(formula, *contact(load, material, ratio))
    if exponents == (-1.0 / 12.0, 0.75):
        assert not reported
        return
    assert len(reported) == 1
    for text in ("film-range", "1 of 1 contacts", f"M from {load:.3g}", "nijenbanning_central"):
        assert text in reported[0]
    assert not messages(nijenbanning_central, *contact(load, material, ratio))


def test_a_light_fast_point_contact_warns() -> None:
    """Its film is that of rigid bodies, thirty times the value of the formula."""
    light = (0.7649, 0.015, 0.015, 3.148, 0.05, 2.2e-8, 2.3077e11)
    for formula in POWER_LAWS:
        assert "film-range" in messages(formula, *light)[0]
        with quiet("film-range"):
            assert nijenbanning_central(*light) > 20.0 * formula(*light)


@pytest.mark.parametrize("formula", POWER_LAWS)
@pytest.mark.parametrize("number", [0, 1])
def test_the_warning_begins_at_the_limit_of_the_regime(
    formula: Callable[..., Any], number: int
) -> None:
    """On the way from the middle of the regime outwards it begins once and remains."""
    middle = np.array([1e3, 15.0])
    states = []
    for factor in np.geomspace(1.0, 1e-4, 40):
        place = middle.copy()
        place[number] *= factor
        states.append(bool(messages(formula, *contact(float(place[0]), float(place[1]), 0.5))))
    assert not states[0]
    assert states[-1]
    assert states == sorted(states)


def test_contacts_outside_are_counted() -> None:
    force = contact(1e3, 15.0, 0.5)[0] * np.array([1.0, 1e-5, 1e-6])
    reported = messages(hamrock_dowson_central, force, *contact(1e3, 15.0, 0.5)[1:])
    assert len(reported) == 1
    assert "2 of 3 contacts" in reported[0]


@pytest.mark.parametrize("formula", [*POWER_LAWS, nijenbanning_central])
def test_a_contact_that_is_longer_along_the_entrainment_warns(formula: Callable[..., Any]) -> None:
    assert not messages(formula, *contact(1e3, 15.0, 1.0))
    (message,) = messages(formula, *contact(1e3, 15.0, 4.0))
    assert "film-range" in message
    assert "4 times as large" in message
    assert "4 times" in messages(nijenbanning_dimensionless_central, 1e3, 15.0, [0.5, 4.0])[0]


@pytest.mark.parametrize("formula", POWER_LAWS)
def test_a_line_has_the_regime_of_a_long_ellipse(formula: Callable[..., Any]) -> None:
    heavy, light = contact(1e5, 15.0, 1e-3), contact(0.1, 15.0, 1e-3)
    assert not messages(formula, *heavy[:2], np.inf, *heavy[3:])
    assert messages(formula, *light[:2], np.inf, *light[3:])
