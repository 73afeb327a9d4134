"""Full multigrid of a two-dimensional contact: full approximation scheme, elastic film by FFT."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cache, lru_cache
from types import ModuleType
from typing import NamedTuple

import numpy as np

from tribodyn.types import Array, ComplexArray


@cache
def _kernels() -> ModuleType:
    """Import the compiled part, and Numba with it, where it is needed first."""
    from tribodyn.ehl._kernel import area_relaxation

    return area_relaxation


class Smoother(NamedTuple):
    """How a level is relaxed."""

    single: float  #: damping of single nodes
    dipole: float  #: damping of dipoles
    sweeps: int  #: before a correction by the coarser level
    v_cycles: int  #: cycles before W-cycles
    crossed: bool = False  #: lines along both axes in turn


#: Tried in this order; on cells that are long across the lines the first one comes last.
_SMOOTHERS = (Smoother(0.8, 0.65, 2, 4), Smoother(0.5, 0.5, 1, 0), Smoother(0.4, 0.3, 2, 4))
#: Tried before them where the entrainment is oblique.
_CROSSED = Smoother(0.9, 0.8, 2, 4, True)
#: Length of a cell over its width from which it is long, and to which lines along both axes serve.
_LONG_CELL, _EVEN_CELL = 2.0, 1.5
#: Slope of the entrainment from which it is oblique.
_OBLIQUE = 0.4
#: Mobility over the area of a cell below which a node changes as a dipole: Venner.
_SWITCH = 0.3
#: Largest change of a pressure in a sweep.
_LARGEST = 0.3
#: Cycles on the finest grid and on those before it; a change after some that shows divergence.
_MOST_CYCLES, _PASSING_CYCLES = 25, 3
_DIVERGED = (8, 0.02)
#: Change of the pressure at which a grid leads to the next one.
_PASSING = 2e-4
#: Greatest relative residual and relative load error at convergence.
_RESIDUAL, _LOAD = 1e-3, 3e-5
#: Pressure below which a node does not count in the residual: open gaps carry next to nothing.
_TRACE = 1e-5
#: Newton steps of the first solution on the coarsest grid, and of every cycle.
_FIRST_STEPS, _STEPS = 30, 4
#: Intervals of the coarsest grid: at most about as many nodes, and least intervals of a side.
_COARSEST, _NARROWEST = 300, 6


@lru_cache(maxsize=32)
def influence(nx: int, ny: int, hx: float, hy: float) -> tuple[Array, ComplexArray]:
    """Integral of 1/r over a cell at each distance (Love 1929), and the transform of its sum."""
    from scipy import fft

    x, y = (np.arange(nx + 2) - 0.5) * hx, (np.arange(ny + 2)[:, None] - 0.5) * hy
    corner = x * np.arcsinh(y / np.abs(x)) + y * np.arcsinh(x / np.abs(y))
    cells = corner[1:, 1:] - corner[1:, :-1] - corner[:-1, 1:] + corner[:-1, :-1]
    periodic = np.empty((2 * ny, 2 * nx))
    rows = np.concatenate((np.arange(ny + 1), np.arange(ny - 1, 0, -1)))
    columns = np.concatenate((np.arange(nx + 1), np.arange(nx - 1, 0, -1)))
    # The sources begin at node 1.
    periodic[:] = np.roll(cells[np.ix_(rows, columns)], (1, 1), (0, 1))
    return cells, fft.rfft2(periodic)


@dataclass(eq=False)
class Level:
    """One grid: fields of shape (ny + 1, nx + 1)."""

    nx: int
    ny: int
    hx: float
    hy: float
    gap: Array = field(repr=False)  #: gap of the undeformed bodies
    elasticity: float  #: film over the integral of P/r

    def __post_init__(self) -> None:
        """Allocate the fields."""
        shape = (self.ny + 1, self.nx + 1)
        self.P, self.H, self.f, self.extra, self.r, self.change = np.zeros((6, *shape))
        self.fields = np.zeros((4, *shape))
        cells, spectrum = influence(self.nx, self.ny, self.hx, self.hy)
        self.K, self.spectrum = self.elasticity * cells, self.elasticity * spectrum
        self.load, self.across = 0.0, False
        self.elastic, self.pressed = np.zeros(shape), np.zeros((self.ny - 1, self.nx - 1))

    def deflection(self) -> Array:
        """Elastic film of the pressure; it vanishes on the edges."""
        from scipy import fft

        inner = self.P[1:-1, 1:-1]
        if not np.array_equal(inner, self.pressed):
            self.pressed[:] = inner
            # Rows and columns that are zero, or are cut off, need no transform.
            waves = fft.fft(fft.rfft(inner, 2 * self.nx), 2 * self.ny, axis=0)
            waves *= self.spectrum
            rows = fft.ifft(waves, axis=0, overwrite_x=True)[: self.ny + 1]
            self.elastic = fft.irfft(rows, 2 * self.nx)[:, : self.nx + 1]
        return self.elastic

    def film(self, offset: float) -> None:
        """Film of the pressure."""
        np.add(self.gap, self.deflection(), out=self.H)
        self.H += self.extra
        self.H += offset

    def carried(self) -> float:
        """Integral of the pressure."""
        return float(self.P[1:-1, 1:-1].sum()) * self.hx * self.hy


@dataclass(frozen=True, eq=False)
class AreaProblem:
    """A steady contact: lengths in ``a``, pressures in ``p_h``, films in ``a^2/R``."""

    gap: Array = field(repr=False)  #: undeformed gap at the nodes (ny + 1, nx + 1)
    hx: float
    hy: float
    ux: float  #: direction of entrainment, not negative
    uy: float
    lam: float
    oil: Array = field(repr=False)
    elasticity: float
    load: float
    start: Array = field(repr=False)  #: dry pressure
    film: float  #: estimate of the central film
    center: tuple[int, int]  #: node of the central film
    tolerance: float = 1e-4  #: relative change of the pressure in the last cycle
    overlap: float = 0.0  #: allowed overlap of the bodies at ends that the grid does not resolve

    @property
    def oblique(self) -> bool:
        """Whether the oil crosses both axes, so that lines along each are swept in turn."""
        return self.uy > _OBLIQUE * self.ux and self.hy < _EVEN_CELL * self.hx


@dataclass(frozen=True, eq=False)
class Outcome:
    """Answer of the solver."""

    message: str  #: why it failed, or nothing
    pressure: Array = field(repr=False)
    film: Array = field(repr=False)
    offset: float  #: film less undeformed gap and elastic deflection
    central_film: float
    coarse_central_film: float  #: that of the grid half as fine
    load_error: float
    residual: float
    cycles: int

    @property
    def starved_grid(self) -> bool:
        """Whether the grid is too coarse for so thin a film: no smoother helps."""
        return "not positive" in self.message and self.cycles > 0 and self.residual < _RESIDUAL

    @property
    def converged(self) -> bool:
        """Whether all criteria are met."""
        return not self.message

    @property
    def film_error(self) -> float:
        """Estimated relative error of the central film by the grid."""
        return abs(self.central_film / self.coarse_central_film - 1.0) / 3.0


class Multigrid:
    """Levels of a problem and its cycles."""

    def __init__(self, problem: AreaProblem, smoother: Smoother) -> None:
        """Build the levels, the finest first."""
        p, self.smoother = problem, smoother
        self.problem = problem
        self.levels: list[Level] = []
        gap, hx, hy = p.gap, p.hx, p.hy
        while True:
            ny, nx = gap.shape[0] - 1, gap.shape[1] - 1
            self.levels.append(Level(nx, ny, hx, hy, gap, p.elasticity))
            if nx % 2 or ny % 2 or nx * ny <= _COARSEST or min(nx, ny) < 2 * _NARROWEST:
                break
            gap, hx, hy = np.ascontiguousarray(gap[::2, ::2]), 2 * hx, 2 * hy
        self.offset = 0.0

    def residual(self, level: Level) -> float:
        """Film, oil and residual of a level."""
        p = self.problem
        level.film(self.offset)
        return float(
            _kernels().residual(
                level.hx, level.hy, p.ux, p.uy, p.lam, p.oil, level.P, level.H, level.f,
                level.fields, level.r,
            )
        )  # fmt: skip

    def sweep(self, level: Level, count: int) -> None:
        """Relax a level."""
        p, s = self.problem, self.smoother
        damping = np.array([s.single, s.dipole, _LARGEST])
        for _ in range(count):
            self.residual(level)
            sizes = level.hx, level.hy, p.ux, p.uy
            fields = [level.K, level.P, level.H, level.fields, level.r, level.change]
            if level.across:
                sizes = level.hy, level.hx, p.uy, p.ux
                fields = [np.ascontiguousarray(np.swapaxes(each, -1, -2)) for each in fields]
            switch = _SWITCH * sizes[1] * min(sizes[:2])
            _kernels().relax(*sizes, switch, damping, *fields)
            if level.across:
                level.P[:] = fields[1].T
            level.across = s.crossed and not level.across

    def solve_coarsest(self, level: Level, steps: int) -> None:
        """Newton's method on the coarsest level, with the load."""
        p = self.problem
        n = (level.nx - 1) * (level.ny - 1)
        J, b = np.empty((n + 1, n + 1)), np.empty(n + 1)
        for _ in range(steps):
            self.residual(level)
            _kernels().dense_tangent(
                level.hx, level.hy, p.ux, p.uy, level.K, level.P, level.H, level.fields, level.r,
                J, b,
            )  # fmt: skip
            b[n] = (level.load - level.carried()) / (level.hx * level.hy)
            scale = np.abs(J.diagonal()[:n]).copy()
            J[:n] /= scale[:, None]
            b[:n] /= scale
            step = np.linalg.solve(J, b)
            factor = min(1.0, 0.3 / max(np.abs(step[:n]).max(), 1e-30))
            inner = level.P[1:-1, 1:-1]
            old, offset = inner.copy(), self.offset
            lowest = 0.3 * level.H.min()
            for _ in range(6):
                inner[:] = np.maximum(old + factor * step[:n].reshape(inner.shape), 0.0)
                self.offset = offset + factor * step[n]
                level.film(self.offset)
                if level.H.min() > lowest or lowest <= 0.0:
                    break
                factor *= 0.5
            if np.abs(step[:n]).max() < 1e-3 and factor == 1.0:
                break

    def cycle(self, k: int, gamma: int = 1) -> None:
        """One cycle from level ``k`` down (0 is the finest)."""
        fine = self.levels[k]
        if k == len(self.levels) - 1:
            self.solve_coarsest(fine, _STEPS)
            return
        self.sweep(fine, self.smoother.sweeps)
        for turn in range(gamma if k < len(self.levels) - 2 else 1):
            if turn:
                self.sweep(fine, 1)
            self.correct(k, gamma)
        self.sweep(fine, 1)

    def correct(self, k: int, gamma: int) -> None:
        """Coarse-grid correction of level ``k``."""
        fine, coarse = self.levels[k], self.levels[k + 1]
        self.residual(fine)
        r = np.where(fine.P > 0.0, fine.r, 0.0)
        # Film: the coarse one takes over what its own sum does not see.
        coarse.P[:] = fine.P[::2, ::2]
        before = coarse.P.copy()
        coarse.extra[:] = (fine.extra + fine.elastic)[::2, ::2] - coarse.deflection()
        coarse.f[:] = 0.0
        self.residual(coarse)  # leaves -L in r
        weighted = full_weighting(r)
        coarse.f[1:-1, 1:-1] = (weighted - coarse.r)[1:-1, 1:-1]
        coarse.load = coarse.carried() + fine.load - fine.carried()
        self.cycle(k + 1, gamma)
        correction = bilinear(coarse.P - before)
        fine.P[:] = np.where(fine.P > 0.0, np.maximum(fine.P + correction, 0.0), 0.0)

    def solve(self) -> Outcome:
        """Nested iteration from the coarsest level, then cycles on the finest."""
        p, last = self.problem, len(self.levels) - 1
        films: list[float] = []
        for k in range(last, -1, -1):
            level = self.levels[k]
            level.f[:], level.extra[:], level.load = 0.0, 0.0, p.load
            interior = None if k == last else bicubic(self.levels[k + 1].P)[1:-1, 1:-1]
            level.P[:] = p.start[:: 2**k, :: 2**k]
            if interior is None:
                level.P[1:-1, 1:-1] *= p.load / level.carried()
                level.film(0.0)
                inside = 0.3 * level.P.max() < level.P
                self.offset = p.film - level.H[inside].min()
                self.solve_coarsest(level, _FIRST_STEPS)
            else:
                level.P[1:-1, 1:-1] = np.maximum(interior, 0.0)
                level.P[1:-1, 1:-1] *= p.load / level.carried()
            outcome = self.iterate(k, films)
            films.append(outcome.central_film)
            if not np.isfinite(outcome.central_film):
                break
        return outcome

    def iterate(self, k: int, films: list[float]) -> Outcome:
        """Cycles on a level, few on those that only lead to the next one."""
        p, level = self.problem, self.levels[k]
        last = k == len(self.levels) - 1
        most = _PASSING_CYCLES if k else _MOST_CYCLES
        tolerance = p.tolerance if k == 0 else max(p.tolerance, _PASSING)
        # A single grid has no coarse one to start from: Newton's method has solved it.
        change, number, wrong, load_error = 0.0 if last else np.inf, 0, np.inf, np.inf
        for number in range(0 if last else 1, 1 if last else most + 1):
            if not last:
                old = level.P.copy()
                self.cycle(k, 1 if number <= self.smoother.v_cycles else 2)
                change = float(np.abs(level.P - old).sum() / level.P.sum())
            size = self.residual(level)
            r = np.where(level.P > _TRACE, level.r, 0.0)
            wrong = float(np.abs(r).mean()) / size
            load_error = abs(level.carried() / p.load - 1.0)
            solved = change < tolerance and wrong < _RESIDUAL and load_error < _LOAD
            diverged = number >= _DIVERGED[0] and change > _DIVERGED[1]
            if solved or diverged or not np.isfinite(change):
                break
        center = tuple(index >> k for index in p.center)
        thinnest = float(level.H.min())
        message = ""
        if not np.isfinite(thinnest) or thinnest <= -p.overlap * p.film:
            message = f"the film of the iterate is not positive ({thinnest:.2g})"
        elif not solved:
            message = (
                f"after {number} cycles the pressure changes by {change:.1e} (limit "
                f"{tolerance:.1e}), residual {wrong:.1e} ({_RESIDUAL:.0e}), load error "
                f"{load_error:.1e} ({_LOAD:.0e})"
            )
        central = float(level.H[center])
        return Outcome(
            message, level.P, level.H, self.offset, central,
            films[-1] if films else np.nan, load_error, wrong, number,
        )  # fmt: skip


def solve_area(problem: AreaProblem) -> Outcome:
    """Solve a contact by full multigrid; other smoothers where one does not converge."""
    smoothers = (_CROSSED, *_SMOOTHERS) if problem.oblique else _SMOOTHERS
    if problem.hy > _LONG_CELL * problem.hx:
        smoothers = (*_SMOOTHERS[1:], _SMOOTHERS[0])
    for smoother in smoothers:
        with np.errstate(all="ignore"):
            outcome = Multigrid(problem, smoother).solve()
        if outcome.converged or outcome.starved_grid:
            break
    return outcome


def full_weighting(r: Array) -> Array:
    """Mean of the residual about every second node."""
    rows = 0.25 * (r[1:-2:2] + r[3::2]) + 0.5 * r[2:-1:2]
    out = np.zeros(((r.shape[0] + 1) // 2, (r.shape[1] + 1) // 2))
    out[1:-1, 1:-1] = 0.25 * (rows[:, 1:-2:2] + rows[:, 3::2]) + 0.5 * rows[:, 2:-1:2]
    return out


def _along(v: Array, cubic: bool) -> Array:
    """Interpolate the first axis to twice as many intervals."""
    out = np.empty((2 * v.shape[0] - 1, v.shape[1]))
    out[::2] = v
    out[1::2] = 0.5 * (v[1:] + v[:-1])
    if cubic and v.shape[0] > 3:
        out[3:-3:2] = (9.0 * (v[1:-2] + v[2:-1]) - v[:-3] - v[3:]) / 16.0
    return out


def bilinear(v: Array) -> Array:
    """Interpolate linearly to twice as many intervals."""
    return _along(_along(v, False).T, False).T


def bicubic(v: Array) -> Array:
    """Interpolate by cubics to twice as many intervals."""
    return _along(_along(v, True).T, True).T
