"""The monotone cubic is that of SciPy, to the last bit."""

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

from tribodyn.arrays.splines import monotone_cubic


@pytest.mark.parametrize("shape", [(2,), (3,), (40,), (40, 3)])
def test_values_and_slopes_are_those_of_scipy(shape: tuple[int, ...]) -> None:
    rng = np.random.default_rng(1)
    x = np.cumsum(rng.uniform(0.1, 1.0, shape[0]))
    y = np.round(rng.normal(size=shape), 1) * 1e-200  # with levels and turns, and tiny
    places = np.stack([rng.choice(x, 99), rng.uniform(x[0] - 1.0, x[-1] + 1.0, 99)])
    expected = PchipInterpolator(x, y, axis=0)(places)
    assert monotone_cubic(x, y)(places).tolist() == expected.tolist()
    assert monotone_cubic(x, y)(x[1]).shape == shape[1:]


@pytest.mark.parametrize(("x", "y"), [([0.0], [1.0]), ([0, 0], [1, 2]), ([0, 1], [0, np.nan])])
def test_invalid_curves_are_refused(x: list[float], y: list[float]) -> None:
    with pytest.raises(ValueError, match="two places or more"):
        monotone_cubic(np.array(x), np.array(y))
