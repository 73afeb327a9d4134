"""Newton's method for the motion at the contacts, with Krylov solutions of its equations.

Generalized minimal residuals solve for a step, preconditioned by an approximate inverse, so that a
few products with the derivative suffice.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribodyn.dynamics.modal.contact_equations import Breaks, Law
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.dynamics.harmonic.phase_contacts import Pieces
    from tribodyn.dynamics.harmonic.residual import Residual

#: Newton steps, halvings of a step, steps over which the residual may rise, and the residual over
#: the first one at which the method has diverged.
_LIMIT, _HALVINGS, _MEMORY, _DIVERGED = 40, 4, 3, 1e8
#: Damping is added where Newton's method does not converge: logarithm of one and its number of
#: units, the highest; the first, widest, and narrowest steps in which it is taken away, the last
#: also over the damping, and the factors of the next step after a motion and after none.
_HIGHEST, _STEP, _WIDEST, _NARROW, _WIDER, _LESS = 6.0, 1.0, 1.5, 0.04, 1.6, 0.4
#: Accuracy of the motions on the way, Newton steps to each, steps that halve the error, and most
#: products with the derivative.
_ROUGH, _TRIES, _QUICK, _BRIEF = 1e-3, 10, 4, 120
#: Accuracy of a linear solution, its largest number of vectors, and those after which it is on half
#: the way.
LINEAR, VECTORS, _HALFWAY = 1e-4, 120, 60
#: Products with the derivative that may be spent if nothing else is said, and from a motion that
#: may be near; steps in which the error halves there.
_FREELY, DIRECT, _PATIENCE = 10**6, 300, 8
#: Unknowns of a linear solution above which its vectors have single precision.
_SINGLE = 2**16


class State(NamedTuple):
    """A motion at the contacts with its forces and residual."""

    y: Array  #: (steps, r)
    rate: Array
    law: Law  #: at the samples, or at the points of the pieces, its tangent with their weights
    breaks: Breaks
    force: Array  #: components of the force on the closed structure (steps, s)
    residual: Array  #: (steps, r)
    pieces: Pieces | None = None  #: between whose breaks forces are integrated
    #: Stiffness for the mean of a change, of what nothing holds (s, r).
    mean_stiffness: Array | None = None
    parts: tuple[State, ...] = ()  #: of contacts on grids of their own

    @property
    def each(self) -> tuple[State, ...]:
        """States of the parts."""
        return self.parts or (self,)

    @property
    def size(self) -> float:
        """Largest distance of the motion at the contacts from zero."""
        return float(np.linalg.norm(self.y, axis=1).max(initial=0.0)) or 1.0


class Solution(NamedTuple):
    """Result of Newton's method."""

    state: State
    error: float  #: distance to the solution of the sampled equations, over the size [-]
    newton: int  #: steps of Newton's method
    krylov: int  #: products with the derivative


def tangents(closed: Any, state: State, times: int = 1) -> tuple[Array, Array]:
    """Changes of the force with the motion and its rate on the grid (p, s, r)."""
    # times: as of Pieces.gather
    law, pieces = state.law.tangent, state.pieces
    gather = None if pieces is None else partial(pieces.gather, times=times)
    stiffness, damping = law.mapped(gather) if gather else law.dense()
    return closed.contact_stiffness - stiffness, closed.contact_damping - damping


def force_change(part: Any, state: State) -> Callable[[Array], Array]:
    """Change of the force on the closed structure with the motion of a part on its grid."""
    pieces, tangent, breaks, closed = state.pieces, state.law.tangent, state.breaks, part.structure

    def change(motion: Array) -> Array:
        rate = part.rate(motion)
        if pieces is None:
            force = tangent.force(motion, rate)
        else:
            force = pieces.gather(tangent.force(pieces.sample(motion), pieces.sample(rate)))
        force += motion @ closed.contact_stiffness.T
        force += rate @ closed.contact_damping.T
        if breaks.step.size:
            jumps = np.einsum("bsr,br->bs", breaks.tangent, breaks.gather(motion))
            breaks.scatter(force, jumps)
        if state.mean_stiffness is not None:
            force -= state.mean_stiffness @ motion.mean(axis=0)
        return np.asarray(force)

    return change


def solve_linear(
    product: Callable[[Array], Array], right: Array, accuracy: float, limit: int = VECTORS
) -> tuple[Array, int]:
    """Solution and number of products. Source: Saad and Schultz (1986), SIAM SISC 7, 856."""
    size = float(np.linalg.norm(right))
    if size == 0.0:
        return np.zeros_like(right), 0
    basis = np.empty((limit + 1, right.size), np.float32 if right.size > _SINGLE else float)
    basis[0] = right.reshape(-1) / size
    upper, target, turns = np.zeros((limit, limit)), [size], np.zeros(0, dtype=complex)
    for count in range(1, limit + 1):
        vector = product(basis[count - 1].reshape(right.shape).astype(float, copy=False))
        vector = vector.reshape(-1).astype(basis.dtype, copy=False)
        column = np.zeros(count)
        for _ in range(2):  # twice is enough for orthogonality
            along = basis[:count] @ vector
            vector = vector - along @ basis[:count]
            column += along
        length = float(np.linalg.norm(vector))
        for row, turn in enumerate(turns):  # rotations that make the matrix triangular
            pair = column[row], column[row + 1]
            column[row] = turn.real * pair[0] + turn.imag * pair[1]
            column[row + 1] = turn.real * pair[1] - turn.imag * pair[0]
        radius = float(np.hypot(column[-1], length)) or 1.0
        turn = complex(column[-1], length) / radius
        turns, column[-1] = np.append(turns, turn), radius
        upper[:count, count - 1] = column
        target[-1:] = [turn.real * target[-1], -turn.imag * target[-1]]
        left = abs(target[-1]) / size
        late = count == _HALFWAY and left > accuracy**0.5
        if left <= accuracy or late or length <= 1e-14 * size:
            break
        basis[count] = vector / length
    weights = np.linalg.solve(upper[:count, :count], np.array(target[:count]))
    weights = weights.astype(basis.dtype, copy=False)
    return (weights @ basis[:count]).astype(float, copy=False).reshape(right.shape), count


def newton(
    residual: Residual, y: Array, tolerance: float, limit: int = _LIMIT, patience: int = _LIMIT,
    most: int = _FREELY,
) -> Solution:  # fmt: skip
    """Newton's method with a line search; it ends if the error halves in no ``patience`` steps."""
    # most: products with the derivative at which it ends too
    state, krylov, error = residual.at(y), 0, np.inf
    norms = [float(np.linalg.norm(state.residual))]
    best: tuple[float, Array] = (np.inf, state.y)  # a state takes memory
    halved = 0
    for count in range(limit + 1):
        with np.errstate(over="ignore", invalid="ignore"):  # a step that is not finite ends it
            step, products = residual.correction(state, residual.accuracy(norms), most - krylov)
            error = float(np.linalg.norm(step, axis=1).max(initial=0.0)) / state.size
        krylov += products
        if error < 0.5 * best[0]:
            halved = count
        if error < best[0]:
            best = error, state.y
        stuck = count == limit or count - halved >= patience or norms[-1] > _DIVERGED * norms[0]
        if error <= tolerance or stuck or krylov >= most or not np.isfinite(error):
            break
        state = _search(residual, state, step, max(norms[-_MEMORY:]))
        norms.append(float(np.linalg.norm(state.residual)))
    state = state if state.y is best[1] else residual.at(best[1])
    return Solution(state, best[0], count, krylov)


def solved(residual: Residual, y: Array, tolerance: float, most: int = DIRECT) -> Solution:
    """Newton's method from a motion that may be near; it gives up where it is not."""
    return newton(residual, y, 0.01 * tolerance, _LIMIT, _PATIENCE, min(most, DIRECT))


def released(
    residual: Residual, y: Array, unit: Array, tolerance: float, level: float, most: int
) -> tuple[Solution | None, float, Array, int]:
    """Solution by taking added damping away in steps, or none, and the least damping and motion."""
    # most: products that may be spent; the number of those that are left comes back
    motions: list[tuple[float, Array]] = []  # the last two levels and motions
    step, first = _STEP, y
    while True:
        residual.excess = np.expm1(level) * unit
        y = _ahead(motions, level) if motions else first
        if level == 0.0:
            trial = solved(residual, y, tolerance, most)
            if trial.error <= tolerance:
                return trial, level, trial.state.y, most - trial.krylov
        else:
            trial = newton(residual, y, _ROUGH, _TRIES, _QUICK, min(most, _BRIEF))
        most -= trial.krylov
        if level > 0.0 and trial.error <= _ROUGH:
            motions, step = [*motions[-1:], (level, trial.state.y)], min(_WIDER * step, _WIDEST)
        elif motions:
            step *= _LESS
        else:
            level *= 2.0
        least = motions[-1][0] if motions else level
        narrow = motions and step < _NARROW * max(1.0, 2.0 * least)
        if narrow or least > _HIGHEST or most <= 0:
            residual.excess = 0.0 * unit
            return None, least, motions[-1][1] if motions else first, most
        level = least if not motions else least - step if least > 1.3 * step else 0.0


def _ahead(motions: list[tuple[float, Array]], level: float) -> Array:
    """Motion with other damping, on the line through two."""
    (before, old), (last, new) = motions[0], motions[-1]
    return new + (new - old) * ((level - last) / ((last - before) or 1.0))


def _search(residual: Residual, state: State, step: Array, bound: float) -> State:
    """Part of a step after which the residual is small enough; the best if none is."""
    trials: list[tuple[float, State]] = []
    for halving in range(_HALVINGS + 1):
        trial = residual.at(state.y + 0.5**halving * step)
        norm = float(np.linalg.norm(trial.residual))
        if norm < bound:
            return trial
        trials.append((norm, trial))
    return min(trials, key=lambda pair: pair[0])[1]


def refined(y: Array, steps: int) -> Array:
    """A motion (steps, r) on more steps, with the same harmonics."""
    return np.asarray(np.fft.irfft(np.fft.rfft(y, axis=0), steps, axis=0) * (steps / len(y)))


def uncorrected(state: State) -> Array:
    """Forces on the closed structure (steps, s) without the corrections for their jumps."""
    force, breaks = state.force.copy(), state.breaks
    breaks.scatter(force, (breaks.fraction - 0.5)[:, None] * breaks.jump)
    return force
