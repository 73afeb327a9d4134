"""Stiffness and damping of the oil film against small vibrations, over the frequency.

The transient equations are linearized about the steady state, with the squeeze term as
``i omega``: one complex linear system a frequency, dense, on at most 512 intervals.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.ehl.steady.contact_problem import ContactProblem, DiscreteContact, SolvedContact
from tribodyn.ehl.steady.fallbacks import solve_problem
from tribodyn.ehl.stiffness.film_stiffness import InletChange, film_slopes, inlet_change
from tribodyn.errors import require_between, require_one_of, require_positive
from tribodyn.types import Array, ComplexArray

#: Intervals of the grid of the linearized equations.
_INTERVALS = 512
#: Frequency, in u_e/b, at which the damping limit for zero frequency is evaluated.
_SLOW = 1e-5


def frequency_response(
    solution: SolvedContact,
    frequencies: ArrayLike,
    length: float = 1.0,
    *,
    deflection: Literal["approach", "central"] = "approach",
) -> tuple[Array, Array]:
    """Stiffness and damping of the oil film against small vibrations."""
    values = np.asarray(frequencies, dtype=float)
    _, rate = _units(solution, length)
    slow = _SLOW / (2.0 * np.pi) * rate
    every = film_compliance(
        solution, np.append(values.reshape(-1), slow), length, deflection=deflection
    )
    inverse = (1.0 / every[:-1]).reshape(values.shape)
    limit = (1.0 / every[-1]).imag / (2.0 * np.pi * slow)
    is_static = values == 0.0
    damping = np.where(
        is_static, limit, inverse.imag / (2.0 * np.pi * np.where(is_static, 1.0, values))
    )
    return np.asarray(inverse.real)[()], np.asarray(damping)[()]


def film_compliance(
    solution: SolvedContact,
    frequencies: ArrayLike,
    length: float = 1.0,
    *,
    deflection: Literal["approach", "central"] = "approach",
) -> ComplexArray:
    """ComplexArray compliance of the oil film against a load ``w + dw exp(i omega t)``."""
    values = np.asarray(frequencies, dtype=float)
    require_between("frequencies", values, 0.0, 1e12, "Hz")
    require_positive("length", length, "m")
    require_one_of("deflection", deflection, ("approach", "central"))
    unit, rate = _units(solution, length)
    linear = _linearize(_on_coarse_grid(solution), inlet_change(solution))
    central, offset = linear.answer(0.0, None)
    at_rest = -film_slopes(solution).central / solution.film_unit
    result = np.empty(values.size, dtype=complex)
    for i, frequency in enumerate(values.reshape(-1)):
        film, rigid = linear.answer(2.0 * np.pi * frequency / rate, central)
        change = film - central if deflection == "central" else rigid - offset
        result[i] = at_rest - change
    return np.asarray(unit * result.reshape(values.shape), dtype=complex)[()]


def _units(solution: SolvedContact, length: float) -> tuple[float, float]:
    """Deflection over load at a unit change of film over ln(w), and ``u_e/b``."""
    load = 0.5 * np.pi * solution.hertz_pressure * solution.half_width
    return (solution.film_unit / (load * length), solution.entrainment_speed / solution.half_width)


@dataclass(frozen=True)
class _Linear:
    """Linearized equations: unknowns P_0, the free pressures and the offset."""

    steady: Array
    squeeze: Array
    film: Array
    inlet: InletChange

    def answer(self, omega: float, at_rest: complex | None) -> tuple[complex, complex]:
        """Change of central film and offset at a unit change of ln(w)."""
        inlet = self.inlet
        matrix = self.steady + 1j * omega * self.squeeze
        size = matrix.shape[0]
        right = np.zeros((size, 2))
        # First column: unit change of ln(w); second: of the film in the law of the inlet.
        right[0] = inlet.pressure, inlet.pressure_film
        right[-1] = 0.5 * np.pi - inlet.load, -inlet.load_film
        scale = np.abs(matrix).max(axis=1)
        direct, back = np.linalg.solve(matrix / scale[:, None], right / scale[:, None]).T
        change = direct
        if at_rest is not None:
            film, answer = self.film @ direct, self.film @ back
            change = direct + back * (film - at_rest) / (1.0 - answer)
        return complex(self.film @ change), complex(change[-1])


def _linearize(grid: DiscreteContact, inlet: InletChange) -> _Linear:
    from tribodyn.ehl._kernel.steady import linear_parts

    n, k, dx, start = grid.n, grid.free, grid.dx, float(grid.X[0])
    parts = linear_parts(n, start, dx, grid.lam, grid.oil, k, grid.P, grid.H)
    cH, cP, rho, drho, film, middle = parts
    film = film.T
    rows = np.arange(1, k + 1)
    steady, squeeze = np.zeros((2, k + 2, k + 2))
    for s in range(4):
        at = np.maximum(rows - 2 + s, 0)  # node -1 has coefficient zero
        steady[1:-1] += cH[rows, s, None] * film[at]
        inner = (rows - 2 + s >= 0) & (at <= k)
        steady[rows[inner], at[inner]] += cP[rows[inner], s]
    squeeze[1:-1] = dx * rho[rows, None] * film[rows]
    squeeze[rows, rows] += dx * (drho * grid.H)[rows]
    steady[0, 0] = 1.0
    steady[-1, : k + 1] = dx
    steady[-1, 0] = 0.5 * dx
    return _Linear(steady, squeeze, middle, inlet)


def _on_coarse_grid(solution: SolvedContact) -> DiscreteContact:
    """Steady state on a grid of at most 512 intervals."""
    grid = solution._grid
    if grid.n <= _INTERVALS:
        return grid
    X = np.linspace(grid.X[0], grid.X[-1], _INTERVALS + 1)
    problem = ContactProblem(
        nodes=_INTERVALS + 1,
        domain=(float(grid.X[0]), float(grid.X[-1])),
        lam=grid.lam,
        oil=grid.oil,
        film=float(np.interp(0.0, grid.X, grid.H)),
        load=grid.load,
        tail=grid.tail,
        moes_load=solution.moes_load,
        profile=np.interp(X, grid.X, grid.shape - 0.5 * grid.X**2),
        tolerance=1e-8,
        flux_tolerance=1e-7,
    )
    coarse = solve_problem(problem, "newton").outcome.grid
    assert coarse is not None  # a solved problem has its grid
    return coarse
