"""Hertz line contact against its own identities."""

import math

import numpy as np
import pytest
from scipy.special import ellipe, ellipkm1

from tribodyn.contact import effective_modulus, hertz_ellipse, hertz_line
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


def test_ellipse_has_published_dimensions():
    # A = 1/m and B = 16.3/m under 5 kN.
    ellipse = hertz_ellipse(5000.0, 0.5, 0.5 / 16.3, 2.2637e11)
    assert ellipse.first_semi_axis == pytest.approx(3.61194e-3, rel=2e-6)
    assert ellipse.second_semi_axis == pytest.approx(0.591478e-3, rel=2e-6)
    assert ellipse.maximum_pressure == pytest.approx(1.11746e9, rel=2e-6)
    assert ellipse.approach == pytest.approx(18.7486e-6, rel=3e-6)
    other = hertz_ellipse(5000.0, 0.5 / 16.3, 0.5, 2.2637e11)
    assert other.second_semi_axis == ellipse.first_semi_axis
    assert other.maximum_pressure == ellipse.maximum_pressure


def test_ellipse_of_equal_radii_is_the_circle_of_hertz():
    force, radius, reduced = np.array([10.0, 5000.0]), 0.02, 0.5 * MODULUS
    ellipse = hertz_ellipse(force, radius, radius, MODULUS)
    circle = np.cbrt(0.75 * force * radius / reduced)
    assert ellipse.first_semi_axis == pytest.approx(circle, rel=1e-12)
    assert ellipse.second_semi_axis == pytest.approx(circle, rel=1e-12)
    assert ellipse.approach == pytest.approx(circle**2 / radius, rel=1e-12)
    assert ellipse.maximum_pressure == pytest.approx(1.5 * force / (np.pi * circle**2), rel=1e-12)


def test_ellipses_solve_the_equations_with_elliptic_integrals():
    # Johnson, equations 4.28 to 4.30, with both integrals of SciPy.
    force, wide, narrow = 1000.0, np.geomspace(0.011, 1e3, 40), 0.01
    found = hertz_ellipse(force, wide, narrow, MODULUS)
    long, ratio = found.first_semi_axis, found.second_semi_axis / found.first_semi_axis
    first, second = ellipkm1(ratio**2), ellipe(1.0 - ratio**2)
    ratio_of_radii = (second / ratio**2 - first) / (first - second)
    np.testing.assert_allclose(ratio_of_radii, wide / narrow, rtol=1e-11)
    pressure = 1.5 * force / (np.pi * long * found.second_semi_axis)
    np.testing.assert_allclose(found.maximum_pressure, pressure, rtol=1e-14)
    approach = 2.0 * pressure * found.second_semi_axis * first / MODULUS
    np.testing.assert_allclose(found.approach, approach, rtol=1e-13)
    across = pressure / MODULUS * 2.0 * found.second_semi_axis / (1.0 - ratio**2)
    np.testing.assert_allclose(across * (first - second), 0.5 * long**2 / wide, rtol=1e-11)


def test_long_ellipse_has_the_pressure_of_a_line_in_its_middle():
    ellipse = hertz_ellipse(1000.0, 1e5, 0.01, MODULUS)
    # In the middle the load per length of a parabola is 3/4 of the force over the half axis.
    line = hertz_line(0.75 * 1000.0 / ellipse.first_semi_axis, 0.01, MODULUS)
    assert ellipse.maximum_pressure == pytest.approx(line.maximum_pressure, rel=1e-4)
    assert ellipse.second_semi_axis == pytest.approx(line.half_width, rel=1e-4)
    for wrong in ((0.0, 1.0, 1.0), (1.0, np.inf, 1.0), (1.0, 1.0, -1.0)):
        with pytest.raises(InputError):
            hertz_ellipse(*wrong, MODULUS)
