"""Newton's method for the line contact in plain NumPy: full matrices, the outlet by trial.

The readable twin of the compiled solver, and the rival that it is raced against: one grid, the
dense Jacobian of :mod:`plain.film`, the linear solver of NumPy.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from plain.film import PlainContact
from tribodyn.ehl.formulas.moes import moes_dimensionless_central
from tribodyn.errors import ComputationError, Problem
from tribodyn.types import Array


class PlainSolution(NamedTuple):
    """A solved contact."""

    P: Array
    H: Array
    offset: float  #: H0 in b^2/R
    free: int  #: last node of the film
    iterations: int  #: newton steps


def dry_start(contact: PlainContact) -> tuple[Array, float]:
    """Pressure and offset to begin with: the dry pressure behind an inlet wedge.

    Parameters
    ----------
    contact : PlainContact

    Returns
    -------
    tuple of array and float

    The wedge has the dry gap plus the film that Moes predicts, reduced until the oil bears it
    (Grubin 1949). Source: ``d = (|X| sqrt(X^2-1) - ln(|X| + sqrt(X^2-1)))/2`` is the dry gap.
    """
    X, slope = contact.X, contact.oil.initial_slope
    M = math.sqrt(3.0 * math.pi**2 / (8.0 * contact.speed_parameter))
    L = max(slope * math.sqrt(2.0 * math.pi / M), 1e-6)
    center = float(moes_dimensionless_central(M, L)) * math.pi / (8.0 * M)
    center /= float(contact.oil.density(np.ones(1))[0][0])
    wide = np.maximum(-X, 1.0)
    gap = 0.5 * (wide * np.sqrt(wide**2 - 1.0) - np.log(wide + np.sqrt(wide**2 - 1.0)))

    def reduced(film: float) -> Array:
        slopes = contact.speed_parameter * gap / (film + gap) ** 3
        return np.asarray(np.concatenate(([0.0], np.cumsum(slopes[1:] + slopes[:-1])))
                          * 0.5 * contact.width)  # fmt: skip

    wedge = reduced(center)
    if slope > 2.0:
        low, high = 0.05 * center, 20.0 * center
        for _ in range(20):
            center = math.sqrt(low * high)
            low, high = (center, high) if slope * reduced(center)[-1] > 0.97 else (low, center)
        wedge = -np.log(1.0 - np.minimum(slope * reduced(center), 0.985)) / slope
    inlet = np.where(X < -1.0, np.minimum(wedge, 0.5), np.maximum(-X - 0.5, 0.0))
    P = np.maximum(np.sqrt(np.maximum(1.0 - X**2, 0.0)), inlet)
    P[-1] = 0.0
    P *= contact.load / (contact.width * np.sum(P))
    P[0] = contact.inlet_pressure
    return P, center - float(np.min(contact.film(P, 0.0)[np.abs(X) < 0.9]))


def _newton_step(contact: PlainContact, P: Array, offset: float, free: int) -> tuple[Array, float]:
    """Newton's correction of the pressures 1 to ``free`` and of the offset, which fits the load."""
    H, width = contact.film(P, offset), contact.width
    by_pressure, by_offset = contact.jacobian(P, H)
    matrix = np.zeros((free + 1, free + 1))
    matrix[:-1, :-1] = by_pressure[:free, 1 : free + 1]
    matrix[:-1, -1] = by_offset[:free]
    matrix[-1, :-1] = width
    lack = contact.load - width * (np.sum(P) - 0.5 * P[0])
    right = np.append(-contact.residual(P, H)[:free], lack)
    largest = np.abs(matrix).max(axis=1)
    solved = np.linalg.solve(matrix / largest[:, None], right / largest)
    move = np.zeros_like(P)
    move[1 : free + 1] = solved[:-1]
    return move, float(solved[-1])


def _step_length(contact: PlainContact, move: Array, rise: float, H: Array) -> float:
    """Part of the correction that changes no pressure by more than 0.3 and keeps the gap open."""
    step = float(min(1.0, 0.3 / np.abs(move).max()))
    change = rise + contact.influence @ move
    while np.min(H + step * change) <= 0.3 * np.min(H) and step > 1e-4:
        step *= 0.5
    return step


class _Outlet:
    """The last node of the film, moved until the pressure is positive and the cavity gains."""

    def __init__(self, free: int, last: int) -> None:
        self.free, self.last = free, last
        self.growth = 1
        self.refused: set[int] = set()  # nodes from which one more node had negative pressure

    def follow(self, contact: PlainContact, P: Array, offset: float, change: float) -> bool:
        """Move the outlet, with the pressure beyond it; returns whether it stayed."""
        before = self.free
        late = before // 2 + np.flatnonzero(P[before // 2 : before + 1] < 0.0)
        if late.size:
            farthest = before - (self.last // 64 if change > 0.3 else self.last)
            self.free, self.growth = max(int(late[0]) - 1, farthest), 1
            P[self.free + 1 :] = 0.0
        elif change < 0.1 and before < self.last and before not in self.refused:
            if contact.residual(P, contact.film(P, offset))[before] < 0.0:
                if self.growth == 1:
                    self.refused.add(before)
                self.free = min(before + self.growth, self.last)
                self.growth = min(2 * self.growth, self.last // 16)
            else:
                self.growth = 1
        return self.free == before


def solve_plain(
    contact: PlainContact,
    start: tuple[Array, float] | None = None,
    *,
    tolerance: float = 1e-10,
    flux_tolerance: float = 1e-9,
) -> PlainSolution:
    """Solve the contact by Newton's method, the outlet by trial."""
    P, offset = dry_start(contact) if start is None else (start[0].copy(), start[1])
    outlet = _Outlet(int(np.flatnonzero(P)[-1]), contact.intervals - 1)
    for iteration in range(1, 201):
        H = contact.film(P, offset)
        move, rise = _newton_step(contact, P, offset, outlet.free)
        step = _step_length(contact, move, rise, H)
        P, offset = P + step * move, offset + step * rise
        change = float(np.abs(move).sum() / np.abs(P).sum())
        if not outlet.follow(contact, P, offset, change) or step < 1.0 or change > tolerance:
            continue
        H, free = contact.film(P, offset), outlet.free
        flux, gain = contact.flux(P, H)[: free + 1], contact.residual(P, H)[free:]
        if np.abs(flux / np.mean(flux) - 1.0).max() < flux_tolerance and gain.min() >= 0.0:
            return PlainSolution(P, H, offset, free, iteration)
    raise ComputationError(
        Problem(
            what=f"the plain solver stopped after {iteration} steps with a change of {change:.1e}",
            why="Newton's method from the dry pressure is not safe for every contact",
            remedy="Give a nearer start, or use solve_line_contact",
        )
    )
