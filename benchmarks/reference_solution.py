"""The final displacements of the linear reference pair, by two methods that share nothing.

One is a power series in time of order 30, summed by NumPy: between two events the equations are
linear with coefficients linear in time, so that each term follows exactly from the two before it.
The other is SciPy's Runge-Kutta scheme of order 8 at the tightest tolerance it takes.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from peer_equations import Entries, durations, entries, position_of, scaled_start
from peers import scipy_solver
from reference_pair import Pair, elastic

__all__ = ["AGREEMENT", "displacement_error", "reference", "series_solution", "solver_solution"]

Array = NDArray[np.float64]

#: Terms of the series, and largest time step in units of 1/RATE.
_ORDER, _STEP = 30, 0.5
#: Agreement that is asked of the two methods.
AGREEMENT = 1e-8


def _matrices(e: Entries) -> tuple[Array, Array, Array]:
    """Return ``A``, ``B``, ``b`` of ``y' = (A + t B) y + b``."""
    constant, slope = np.zeros((12, 12)), np.zeros((12, 12))
    pull = np.concatenate((e.stiffness * e.closing, e.damping * e.closing_rate))
    constant[:6, 6:] = e.rate * np.eye(6)
    constant[6:, :6] = -np.diag(e.spring)
    constant[6:, 6:] = -np.diag(e.damper)
    constant[6:] -= np.outer(e.push, pull)
    slope[6:] = -np.outer(e.push_slope, pull)
    return constant, slope, np.concatenate((np.zeros(6), e.load))


def _series_step(constant: Array, slope: Array, load: Array, y: Array, h: float) -> Array:
    """One step of ``h``: every term of the series, times its power of h, from the two before."""
    before, term = np.zeros_like(y), y
    total = y.copy()
    for k in range(_ORDER):
        rate = constant @ term + h * (slope @ before) + (load if k == 0 else 0.0)
        before, term = term, h / (k + 1) * rate
        total += term
    return total


def series_solution(pair: Pair, cycles: int) -> Array:
    """Final displacements by power series.

    Parameters
    ----------
    pair : Pair
        Without gap.
    cycles : int
        Mesh cycles.

    Returns
    -------
    (5,) array
        In m.
    """
    if pair.gap != 0.0:
        raise ValueError("the series needs linear equations: a pair without gap")
    y = scaled_start(pair)
    plan = []
    for e, span in zip(entries(pair), durations(pair), strict=True):
        count = int(np.ceil(span * e.rate / _STEP))
        plan.append((_matrices(e), span / count, count))
    for _ in range(cycles):
        for (constant, slope, load), h, count in plan:
            for i in range(count):
                y = _series_step(constant + i * h * slope, slope, load, y, h)
    return elastic(position_of(y))


def solver_solution(pair: Pair, cycles: int) -> Array:
    """Final displacements by SciPy's scheme of order 8 at a tolerance of 1e-12.

    Parameters
    ----------
    pair : Pair
    cycles : int
        Mesh cycles.

    Returns
    -------
    (5,) array
        In m.
    """
    return elastic(scipy_solver("DOP853", compiled=True)(pair, cycles, 1e-12)[0])


def displacement_error(displacement: Array, exact: Array) -> float:
    """Largest error over the largest displacement.

    Parameters
    ----------
    displacement, exact : (5,) array
        In m.

    Returns
    -------
    float
    """
    return float(np.max(np.abs(displacement - exact)) / np.max(np.abs(exact)))


def reference(pair: Pair, cycles: int) -> tuple[Array, float]:
    """Final displacements, and the disagreement of the two methods.

    Parameters
    ----------
    pair : Pair
    cycles : int
        Mesh cycles.

    Returns
    -------
    tuple of (5,) array and float

    Raises
    ------
    RuntimeError
        If the methods disagree by more than 1e-8.
    """
    exact = series_solution(pair, cycles)
    gap = displacement_error(solver_solution(pair, cycles), exact)
    if not gap <= AGREEMENT:
        raise RuntimeError(f"the two reference methods disagree by {gap:.1e}")
    return exact, gap
