"""The spline is that of SciPy, but for rounding."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from tribodyn.arrays.cubic import spline


@pytest.mark.parametrize("count", [4, 5, 40])
def test_values_are_those_of_scipy(count: int) -> None:
    rng = np.random.default_rng(2)
    x = 1e-3 * np.cumsum(rng.uniform(0.1, 1.0, count))
    y = 1e-11 * rng.uniform(1.0, 2.0, count)
    places = np.stack([rng.choice(x, 99), rng.uniform(x[0], x[-1], 99)])
    values, expected = spline(x, y)(places), CubicSpline(x, y)(places)
    np.testing.assert_allclose(values, expected, rtol=1e-11, atol=0.0)


def test_three_places_are_refused() -> None:
    with pytest.raises(ValueError, match="four places"):
        spline(np.arange(3.0), np.zeros(3))
