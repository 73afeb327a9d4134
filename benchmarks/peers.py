"""Other solvers on the reference pair: SciPy's ``solve_ivp`` and, where it installs, numbalsoda.

Each solver is a function of pair, mesh cycles and tolerance; it returns the final displacements and
the number of evaluations of the right-hand side. Tolerances are absolute in scaled coordinates.
All restart at events, or else, where their name says so, run across them.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from peer_equations import (
    COUNTER,
    durations,
    entries,
    numba_rate,
    numpy_rate,
    position_of,
    scaled_start,
    table,
)
from reference_pair import Pair

__all__ = ["Solver", "numbalsoda_problem", "peers", "scipy_peers", "scipy_solver"]

Array = NDArray[np.float64]
#: Pair, mesh cycles, tolerance to final displacements [m] and evaluations.
Solver = Callable[[Pair, int, float], tuple[Array, float]]

#: Time since the piece began [s] and state to the rate of the state.
Rate = Callable[[float, Array], Array]

#: Small enough that the absolute tolerance decides.
_RELATIVE = 1e-13


def _numpy_rates(pair: Pair) -> list[Rate]:
    return [numpy_rate(e) for e in entries(pair)]


@cache
def _entry() -> Any:
    """The compiled right-hand side with a call that SciPy understands."""
    import numba as nb

    inner = numba_rate()

    @nb.njit
    def derivative(t: float, y: Any, row: Any) -> Any:
        out = np.empty(y.size)
        inner(t, y, out, row)
        return out

    return derivative


def _numba_rates(pair: Pair) -> list[Rate]:
    derivative = _entry()

    def with_row(row: Array) -> Rate:
        return lambda t, y: derivative(t, y, row)

    return [with_row(row) for row in table(pair)]


def scipy_solver(method: str, compiled: bool, *, restart: bool = True) -> Solver:
    """``solve_ivp`` with a method and a right-hand side in NumPy or Numba.

    Parameters
    ----------
    method : str
        Method of ``solve_ivp``.
    compiled : bool
        Whether the right-hand side is compiled.
    restart : bool
        Whether it restarts at every event of the mesh cycle.

    Returns
    -------
    Solver
    """
    from scipy.integrate import solve_ivp

    rates = _numba_rates if compiled else _numpy_rates

    def solve(pair: Pair, cycles: int, tolerance: float) -> tuple[Array, float]:
        parts, spans = rates(pair), durations(pair)
        y, evaluations = scaled_start(pair), 0
        if not restart:
            parts, spans, cycles = [_across(parts, spans)], np.array([cycles * spans.sum()]), 1
        for _ in range(cycles):
            for part, span in zip(parts, spans, strict=True):
                sol = solve_ivp(part, (0.0, span), y, method=method, rtol=_RELATIVE, atol=tolerance)
                y = sol.y[:, -1]
                evaluations += sol.nfev
        return position_of(y), evaluations

    return solve


def _across(parts: list[Rate], spans: Array) -> Rate:
    """One right-hand side for all time."""
    ends, period = np.cumsum(spans)[:-1].tolist(), float(spans.sum())
    begins = [0.0, *ends]

    def derivative(t: float, y: Array) -> Array:
        local = t % period
        i = bisect_right(ends, local)
        return parts[i](local - begins[i], y)

    return derivative


def numbalsoda_problem() -> str | None:
    """Why numbalsoda cannot take part, or None.

    Returns
    -------
    str or None
    """
    try:
        import numbalsoda  # type: ignore[import-untyped]  # noqa: F401
    except (ImportError, OSError) as error:
        return f"numbalsoda does not load here: {error}"
    return None


@cache
def _numbalsoda(method: str) -> Any:
    """Compiled loop over the pieces; one call to the solver for each."""
    import numba as nb
    import numbalsoda  # type: ignore[import-untyped]

    inner, solver = numba_rate(), getattr(numbalsoda, method)

    @nb.cfunc(numbalsoda.lsoda_sig)
    def derivative(t, y, out, row):  # type: ignore[no-untyped-def]  # given by its signature
        inner(t, nb.carray(y, (12,)), nb.carray(out, (12,)), nb.carray(row, (47,)))

    address = derivative.address

    @nb.njit
    def loop(address: int, y: Any, rows: Any, spans: Any, cycles: int, tolerance: float) -> Any:
        ends = np.zeros(2)
        for _ in range(cycles):
            for i in range(spans.size):
                ends[1] = spans[i]
                states, done = solver(
                    address, y, ends, data=rows[i], rtol=1e-13, atol=tolerance, mxstep=1000000
                )
                if not done:
                    return y * np.nan
                y = states[1].copy()
        return y

    return derivative, lambda *rest: loop(address, *rest)


def _numbalsoda_solver(method: str) -> Solver:
    def solve(pair: Pair, cycles: int, tolerance: float) -> tuple[Array, float]:
        rows = table(pair)
        _, loop = _numbalsoda(method)
        y = loop(scaled_start(pair), rows, durations(pair), cycles, tolerance)
        return position_of(y), float(rows[:, COUNTER].sum())

    return solve


def scipy_peers() -> dict[str, Solver]:
    """SciPy's solvers by name; those with a NumPy right-hand side come first.

    Returns
    -------
    dict of str to Solver
    """
    return {
        "SciPy RK45, NumPy": scipy_solver("RK45", compiled=False),
        "SciPy DOP853, NumPy": scipy_solver("DOP853", compiled=False),
        "SciPy RK45, Numba": scipy_solver("RK45", compiled=True),
        "SciPy RK45, Numba, across events": scipy_solver("RK45", compiled=True, restart=False),
        "SciPy DOP853, Numba": scipy_solver("DOP853", compiled=True),
    }


def peers() -> dict[str, Solver]:
    """All solvers that load here, by name.

    Returns
    -------
    dict of str to Solver
    """
    found = scipy_peers()
    if numbalsoda_problem() is None:
        found["numbalsoda LSODA"] = _numbalsoda_solver("lsoda")
        found["numbalsoda DOP853"] = _numbalsoda_solver("dop853")
    return found
