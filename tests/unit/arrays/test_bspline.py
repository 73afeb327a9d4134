"""Cubic B-splines against those of SciPy."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import BSpline, make_interp_spline

from tribodyn.arrays.splines import (
    bspline_integrals,
    bspline_slopes,
    bspline_values,
    clamped_knots,
    interpolation_knots,
)

BREAKS = np.array([0.0, 0.4, 1.1, 1.2, 3.0])


@pytest.fixture
def knots() -> np.ndarray:
    return clamped_knots(BREAKS)


def reference(knots: np.ndarray, number: int) -> BSpline:
    return BSpline(knots, np.eye(knots.size - 4)[number], 3)


def test_values_slopes_and_integrals_of_each_spline(knots):
    places = np.array([0.0, 0.1, 0.4, 0.9, 1.15, 2.0, 3.0])
    edges = np.array([0.0, 0.25, 1.1, 1.17, 2.9])
    values, slopes = bspline_values(knots, places), bspline_slopes(knots, places)
    integrals = bspline_integrals(knots, edges)
    for number in range(knots.size - 4):
        spline = reference(knots, number)
        assert values[:, number] == pytest.approx(spline(places), abs=1e-14)
        assert slopes[:, number] == pytest.approx(spline.derivative()(places), abs=1e-13)
        whole = spline.antiderivative()
        assert integrals[:, number] == pytest.approx(np.diff(whole(edges)), abs=1e-14)
    assert values.sum(axis=1) == pytest.approx(1.0)


def test_interpolation_is_the_not_a_knot_spline():
    x = np.array([0.1, 0.5, 0.8, 1.7, 2.0, 2.2])
    y = np.cos(2.0 * x)
    knots = interpolation_knots(x)
    coefficients = np.linalg.solve(bspline_values(knots, x), y)
    between = np.linspace(0.1, 2.2, 23)
    expected = make_interp_spline(x, y)(between)
    assert bspline_values(knots, between) @ coefficients == pytest.approx(expected, abs=1e-13)
    with pytest.raises(ValueError, match="four places"):
        interpolation_knots(x[:3])
