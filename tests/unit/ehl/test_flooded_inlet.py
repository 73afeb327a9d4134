"""Pressure and load of the inlet before the grid, with their slopes."""

import numba as nb
import numpy as np
import pytest

from tribodyn.ehl._kernel.inlet import flooded_inlet as compiled
from tribodyn.ehl._kernel.inlet import inlet_slopes
from tribodyn.ehl.solver.grid import inlet_tail


@nb.njit
def flooded_inlet(start, film, lam, curvature, s):
    return compiled(start, film, lam, curvature, s)


def test_equals_the_inlet_of_the_steady_solver() -> None:
    pressure, load, *_ = flooded_inlet(-4.2, 0.07, 0.15, 1.0, 1.0)
    assert (pressure, load) == pytest.approx(inlet_tail(-4.2, 0.07, 0.15), rel=1e-12)


def test_another_scale_is_the_same_inlet() -> None:
    """Load and radius off the reference: the same integral in the units of that contact."""
    s, curvature, film, lam = 0.6, 1.7, 0.09, 0.15
    unit = curvature * s * s
    pressure, load, *_ = flooded_inlet(-4.2, film, lam, curvature, s)
    tail, own_load = inlet_tail(-4.2 / s, film / unit, lam * s / unit**2)
    assert pressure == pytest.approx(tail, rel=1e-10)
    assert load == pytest.approx(own_load * s, rel=1e-10)


def test_far_inlet_and_unloaded_contact() -> None:
    assert flooded_inlet(-100.0, 0.01, 0.3, 1.0, 1.0)[0] == pytest.approx(
        4.0 * 0.3 / (3.0 * 100.0**3), rel=2e-3
    )
    slight, unloaded = (flooded_inlet(-5.0, 0.1, 0.3, 1.0, s) for s in (1e-6, 0.0))
    assert slight[:4] == pytest.approx(unloaded[:4], rel=1e-9)


def test_slopes_are_the_derivatives() -> None:
    start, film, lam, curvature, s, step = -4.5, 0.3, 0.8, 1.3, 0.9, 1e-5
    inlet_ = flooded_inlet(start, film, lam, curvature, s)
    by_film = [flooded_inlet(start, film + d, lam, curvature, s) for d in (step, -step)]
    grown = [flooded_inlet(start, film, lam, curvature, s * np.exp(d)) for d in (step, -step)]
    for item in range(2):
        slope = (by_film[0][item] - by_film[1][item]) / (2.0 * step)
        assert inlet_[2 + item] == pytest.approx(slope, rel=1e-7)
        # ln(w) = 2 ln(s)
        slope = (grown[0][item] - grown[1][item]) / (4.0 * step)
        assert inlet_[4 + item] == pytest.approx(slope, rel=1e-6)


def test_slopes_in_python_are_those_of_the_kernel() -> None:
    slopes = inlet_slopes(-4.2, 0.07, 0.15)
    assert slopes == pytest.approx(flooded_inlet(-4.2, 0.07, 0.15, 1.0, 1.0)[2:], rel=1e-13)
