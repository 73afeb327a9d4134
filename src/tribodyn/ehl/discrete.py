"""A line contact on its grid: what an engine is asked, and what it answers."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

__all__ = ["ContactProblem", "DiscreteContact", "Outcome"]

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class DiscreteContact:
    """Dimensionless state of a line contact on a uniform grid: ``X = x/b``, ``P = p/p_h``.

    Parameters
    ----------
    n : int
        Intervals.
    dx : float
        Width of an interval.
    X, P, H : (n + 1,) array
        Position, pressure and film ``H = h R/b^2``.
    H0 : float
        Rigid offset of the film.
    lam : float
        ``12 eta0 u_e R^2/(b^3 p_h)``.
    oil : (6,) array
        Law of viscosity and density, see :mod:`tribodyn.ehl.kernel.oil`.
    free : int
        Last node with pressure; the oil has parted beyond it.
    load : float
        Target of ``dx`` times the sum of P, the first node counted half.
    tail : float
        Pressure at the first node.
    shape : (n + 1,) array
        Gap of the undeformed bodies.
    """

    n: int
    dx: float
    X: Array = field(repr=False)
    P: Array = field(repr=False)
    H: Array = field(repr=False)
    H0: float
    lam: float
    oil: Array = field(repr=False)
    free: int
    load: float
    tail: float
    shape: Array = field(repr=False)


@dataclass(frozen=True, eq=False)
class ContactProblem:
    """A steady line contact, dimensionless, as an engine gets it.

    Parameters
    ----------
    nodes : int
        Nodes of the grid; the most of them where ``film_tolerance`` is positive.
    domain : (float, float)
        First and last position, in half widths.
    lam : float
        ``12 eta0 u_e R^2/(b^3 p_h)``.
    oil : (6,) array
        Law of viscosity and density, see :mod:`tribodyn.ehl.kernel.oil`.
    film : float
        Estimate of the central film ``H`` for the start.
    load : float
        Target of ``dx`` times the sum of P, the first node counted half.
    tail : float
        Pressure at the first node.
    moes_load : float
        Load number M of Moes: decides how fine the first grid is.
    profile : (nodes,) array, optional
        Heights added to the gap.
    tolerance : float
        Relative change of the pressure at convergence.
    flux_tolerance : float
        Relative deviation of the flux from its mean at convergence.
    film_tolerance : float
        Relative error of the central film at which the grid is fine enough; zero for all
        ``nodes``.
    levels : int, optional
        Grids of the multigrid engine.
    start : DiscreteContact, optional
        State to start from, on the same grid.
    coarsest : int, optional
        Least number of intervals of the first grid; by the load number where absent.
    """

    nodes: int
    domain: tuple[float, float]
    lam: float
    oil: Array = field(repr=False)
    film: float
    load: float
    tail: float
    moes_load: float
    profile: Array | None = field(default=None, repr=False)
    tolerance: float = 1e-4
    flux_tolerance: float = 1e-3
    film_tolerance: float = 0.0
    levels: int | None = None
    start: DiscreteContact | None = field(default=None, repr=False)
    coarsest: int | None = None


@dataclass(frozen=True, eq=False)
class Outcome:
    """Answer of an engine.

    Parameters
    ----------
    converged : bool
        Whether all criteria are met.
    grid : DiscreteContact, optional
        Solution on the finest grid; ``None`` where there is none.
    iterations : int
        Steps on the finest grid: Newton steps or multigrid cycles.
    films : tuple of float
        Central films of the grids, each half as fine as the next; the finest last.
    message : str
        Why it failed; empty when converged.
    """

    converged: bool
    grid: DiscreteContact | None = field(repr=False)
    iterations: int
    films: tuple[float, ...] = ()
    message: str = ""
