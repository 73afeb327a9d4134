"""Hertz line contact against its own identities."""

import math

import numpy as np
import pytest

from tribodyn.contact import effective_modulus, hertz_line
from tribodyn.errors import InputError
from tribodyn.gear import Material

MODULUS = 230e9


def test_effective_modulus_of_like_bodies() -> None:
    steel = Material(210e9, 0.3)
    assert effective_modulus(steel, steel) == pytest.approx(210e9 / (1.0 - 0.09), rel=1e-15)


def test_effective_modulus_against_a_rigid_body_doubles() -> None:
    soft, rigid = Material(1e9, 0.4), Material(1e20, 0.0)
    single = 1e9 / (1.0 - 0.16)
    assert effective_modulus(soft, rigid) == pytest.approx(2.0 * single, rel=1e-8)
    assert effective_modulus(soft, rigid) == effective_modulus(rigid, soft)


def test_pressure_carries_the_load() -> None:
    """The half ellipse of pressure integrates to the load."""
    load = np.array([1e3, 1e5, 2e6])
    contact = hertz_line(load, np.array([[5e-3], [20e-3]]), MODULUS)
    assert contact.half_width.shape == (2, 3)
    carried = math.pi / 2.0 * contact.half_width * contact.maximum_pressure
    assert carried == pytest.approx(np.broadcast_to(load, (2, 3)), rel=1e-13)
    assert 2.0 * contact.half_width * contact.mean_pressure == pytest.approx(carried, rel=1e-13)


def test_pressure_follows_from_the_geometry_of_contact() -> None:
    """p = E' b / (4 R): the strain that flattens the parabola x^2 / (2 R)."""
    contact = hertz_line(1e5, 10e-3, MODULUS)
    expected = MODULUS * contact.half_width / (4.0 * 10e-3)
    assert contact.maximum_pressure == pytest.approx(expected, rel=1e-13)


def test_no_load_gives_no_contact() -> None:
    contact = hertz_line(0.0, 10e-3, MODULUS)
    assert contact.half_width == contact.maximum_pressure == contact.mean_pressure == 0.0


@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        ((-1.0, 1e-2, MODULUS), "load_per_width"),
        ((1.0, 0.0, MODULUS), "equivalent_radius"),
        ((1.0, 1e-2, math.nan), "effective_modulus"),
    ],
)
def test_wrong_values_are_refused(arguments: tuple[float, float, float], name: str) -> None:
    with pytest.raises(InputError, match=name):
        hertz_line(*arguments)
