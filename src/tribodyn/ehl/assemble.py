"""From a verified state on the grid to the solution that a user holds."""

from __future__ import annotations

import math

import numpy as np

from tribodyn.ehl.attempts import Solved
from tribodyn.ehl.contact_case import ContactCase
from tribodyn.ehl.discrete import DiscreteContact
from tribodyn.ehl.domain import Domain, regime_name
from tribodyn.ehl.solution import LineContactSolution


def outlet_position(grid: DiscreteContact) -> float:
    """Where the pressure ends, between the nodes."""
    k = grid.free
    here, before = float(grid.P[k]), float(grid.P[k - 1])
    if not before > here > 0.0:
        return float(grid.X[min(k + 1, grid.n)])
    share = math.sqrt(here) / (math.sqrt(before) - math.sqrt(here))
    return float(min(grid.X[k] + share * grid.dx, grid.X[-1]))


def pressure_spike(grid: DiscreteContact) -> tuple[float, float] | None:
    """Highest pressure of the local maximum nearest to the outlet, and where it lies."""
    P = grid.P
    peaks = np.flatnonzero((P[1:-1] > P[:-2]) & (P[1:-1] >= P[2:])) + 1
    if peaks.size == 0:
        return None
    last = int(peaks[-1])
    if peaks.size == 1 and P[last] <= 1.0:
        return None
    return float(P[last]), float(grid.X[last])


def assemble(case: ContactCase, domain: Domain, solved: Solved) -> LineContactSolution:
    """Solution with its units and its errors."""
    grid, check, scales = solved.outcome.grid, solved.check, case.scales
    assert grid is not None  # a verified outcome has a grid
    films = solved.outcome.films
    thick = case.half_width**2 / case.equivalent_radius
    spike = pressure_spike(grid)
    error = None if len(films) < 2 else (films[-1] - films[-2]) / 3.0
    return LineContactSolution(
        position=grid.X * case.half_width,
        pressure=grid.P * case.hertz_pressure,
        film=grid.H * thick,
        central_film=films[-1] * thick,
        minimum_film=float(np.min(grid.H[: grid.free + 1])) * thick,
        hertz_pressure=case.hertz_pressure,
        half_width=case.half_width,
        outlet=outlet_position(grid) * case.half_width,
        spike_pressure=None if spike is None else spike[0] * case.hertz_pressure,
        spike_position=None if spike is None else spike[1] * case.half_width,
        flux_error=check.flux_error,
        load_error=check.load_error,
        cavity_residual=check.cavity_residual,
        iterations=solved.outcome.iterations,
        nodes=grid.n + 1,
        domain=(domain.start, domain.end),
        inlet=domain.inlet,
        method=solved.method,
        regime=regime_name(scales.moes_load, scales.moes_viscosity),
        central_film_error=None if error is None else abs(error) * thick,
        central_film_extrapolated=None if error is None else (films[-1] + error) * thick,
        attempts=solved.attempts,
        moes_load=scales.moes_load,
        moes_viscosity=scales.moes_viscosity,
        load_per_width=case.load_per_width,
        equivalent_radius=case.equivalent_radius,
        entrainment_speed=case.entrainment_speed,
        effective_modulus=case.effective_modulus,
        lubricant=case.lubricant,
        viscosity_law=scales.viscosity_law,
        compressible=case.compressible,
        _grid=grid,
    )
