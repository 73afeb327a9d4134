"""The spline is that of SciPy, but for rounding."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline, RectBivariateSpline

from tribodyn.arrays.splines import spline


@pytest.mark.parametrize("count", [4, 5, 40])
def test_values_are_those_of_scipy(count: int) -> None:
    rng = np.random.default_rng(2)
    x = 1e-3 * np.cumsum(rng.uniform(0.1, 1.0, count))
    y = 1e-11 * rng.uniform(1.0, 2.0, count)
    places = np.stack([rng.choice(x, 99), rng.uniform(x[0], x[-1], 99)])
    values, expected = spline(x, y)(places), CubicSpline(x, y)(places)
    np.testing.assert_allclose(values, expected, rtol=1e-11, atol=0.0)


def test_splines_in_two_directions_are_the_one_of_scipy() -> None:
    rng = np.random.default_rng(3)
    x, table = np.cumsum(rng.uniform(0.5, 1.0, 12)), rng.normal(size=(12, 12))
    first, second = rng.uniform(x[0], x[-1], (2, 99))
    weights = spline(x, np.eye(12))
    values = ((weights(first) @ table) * weights(second)).sum(axis=1)
    expected = RectBivariateSpline(x, x, table)(first, second, grid=False)
    np.testing.assert_allclose(values, expected, rtol=0.0, atol=1e-13)


def test_three_places_are_refused() -> None:
    with pytest.raises(ValueError, match="four places"):
        spline(np.arange(3.0), np.zeros(3))
