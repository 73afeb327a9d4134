"""Periodic response of the linearized contacts by time integration, as a preconditioner.

Each mode obeys ``z' = lambda z + b u`` with forces ``u`` that are linear between two samples and
follow from the motion at the contacts there. One pass over the period costs a time that is
proportional to the samples. A pass over the last part of the period settles the start before.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.arrays.linear_algebra import leading_eigenvalues
from tribodyn.compiled import source_digest
from tribodyn.compiled.cache import cached_njit
from tribodyn.dynamics.harmonic.newton import tangents
from tribodyn.errors import warn
from tribodyn.types import Array

_DIGEST = source_digest(__file__.rpartition("/")[0], ["tangent_march"])

if TYPE_CHECKING:
    from tribodyn.dynamics.harmonic.newton import State
    from tribodyn.dynamics.harmonic.residual import ClockResidual
    from tribodyn.dynamics.modal.closed_structure import ClosedStructure

#: Part of the start that is left when the motion is recorded.
_LEFT = 1e-4
#: Residual of the leading multiplier over its size, and of one that is as good as none.
_ACCURATE, _FORGOTTEN = 1e-4, 1e-6
_OPTIONS: dict[str, Any] = {
    "nogil": True, "fastmath": {"contract", "nsz", "reassoc"}, "error_model": "numpy",
}  # fmt: skip


class TangentMarch:
    """Integrate the linearized equations of a motion, one sample after the other."""

    # tangents (steps, s, 2 r): forces per motion and rate at the contacts; step: time of one [s]
    def __init__(self, structure: ClosedStructure, tangents: Array, step: float) -> None:
        assert structure.modes is not None
        values, right, left = structure.modes
        chosen = values.imag >= 0.0
        values, into = values[chosen], left[chosen] @ structure.input
        output = structure.output @ (right[:, chosen] * np.where(values.imag > 0.0, 2.0, 1.0))
        x = values * step
        decay = np.exp(x)
        small = np.abs(x) < 1e-3
        divisor = np.where(small, 1.0, x)
        first = np.where(small, 1.0 + x / 2.0 + x * x / 6.0, (decay - 1.0) / divisor)
        second = np.where(small, 0.5 + x / 6.0 + x * x / 24.0, (first - 1.0) / divisor)
        before, after = ((step * part)[:, None] * into for part in (first - second, second))
        signals = np.concatenate((output, output * values))
        pushed = decay[:, None] * after + before
        settling = math.log(1.0 / _LEFT) / max(structure.decay, 1e-300)
        self._lead = int(min(settling / step, len(tangents)))
        direct = np.ascontiguousarray((signals @ after).real)
        self._parts = (
            np.stack((decay.real, decay.imag)),
            np.ascontiguousarray(np.concatenate((signals.real, -signals.imag), axis=1)),
            np.ascontiguousarray(np.concatenate((pushed.real, pushed.imag)).T),
            direct,
        )
        self._tangents = with_own_motion(direct, np.ascontiguousarray(tangents))

    @classmethod
    def of(cls, residual: ClockResidual, state: State, fewest: int | None = None) -> TangentMarch:
        """Over a period, with means of tangents over steps if fewer suffice."""
        samples, steps = _tangents(residual, state), len(state.y)
        if fewest is not None:
            steps = next(n for n in range(min(fewest, steps), steps + 1) if steps % n == 0)
            samples = samples.reshape(steps, -1, *samples.shape[1:]).mean(axis=1)
        return cls(residual.structure, samples, 1.0 / (residual.frequency * steps))

    def __call__(self, motion: Array, rate: Array) -> Array:
        """Motion whose product with the derivative of the residual is nearly this one."""
        right, start = np.concatenate((motion, rate), axis=1), np.zeros(self._parts[0].size)
        march = march_tangent(*self._parts, self._tangents, right, start, self._lead)
        return np.asarray(motion + march)

    def moved(self, state: Array, steps: slice = slice(None)) -> Array:
        """Disturbance (m,) of the modes after some steps."""
        tangents, end = self._tangents[steps], np.array(state, dtype=float).ravel()
        nothing = np.zeros((len(tangents), tangents.shape[2]))
        march_tangent(*self._parts, tangents, nothing, end, 0)
        return end

    def leading_multiplier(self, limit: float = 0.0) -> float:
        """Size of the largest Floquet multiplier, roughly if it is far below a limit."""
        size = self._parts[0].size
        start = np.random.default_rng(0).standard_normal(size)
        values = leading_eigenvalues(self.moved, start, 1, _ACCURATE, _FORGOTTEN, limit)
        return float(abs(values[0]))


def _tangents(residual: ClockResidual, state: State) -> Array:
    """Forces per motion and rate at the contacts, at each sample (steps, s, 2 r)."""
    structure, breaks = residual.structure, state.breaks
    (s, r), steps = structure.contact_stiffness.shape, len(state.y)
    joined = np.empty((steps, s, 2 * r))
    joined[..., :r], joined[..., r:] = tangents(structure, state)
    if breaks.step.size:
        added = np.zeros((steps, s * r))
        breaks.scatter(added, breaks.tangent.reshape(-1, s * r))
        joined[..., :r] += added.reshape(steps, s, r)
    return joined


def warn_of_growth(what: str, size: float, limit: float) -> None:
    """Warn of a motion whose disturbances grow."""
    if size > limit:
        warn(
            "unstable-orbit",
            f"the motion is unstable: largest {what} {size:.6g}, limit 1. "
            "Try another start, or simulate over time",
            stacklevel=4,
        )


@cached_njit(_DIGEST, "the linearized equations of long periods", "ten seconds", **_OPTIONS)
def march_tangent(
    decay: Array, output: Array, push: Array, direct: Array, tangents: Array, right: Array,
    z: Array, lead: int,
) -> Array:  # fmt: skip
    """Motion at the contacts (steps, r), after ``lead`` samples; modes ``z`` go to the end."""
    # tangents: those of with_own_motion
    steps, wide = right.shape
    m, s, r = decay.shape[1], push.shape[0], wide // 2
    motion = np.zeros((steps, r))
    signal, force = np.empty(wide), np.empty(s)
    for step in range(steps - lead, 2 * steps):
        row = step % steps
        for o in range(wide):
            total = 0.0
            for i in range(2 * m):
                total += output[o, i] * z[i]
            signal[o] = total
        for j in range(s):
            total = 0.0
            for o in range(wide):
                total += tangents[row, j, o] * (signal[o] + right[row, o])
            force[j] = total
        for o in range(r):
            total = signal[o]
            for j in range(s):
                total += direct[o, j] * force[j]
            motion[row, o] = total
        for i in range(m):
            real, imaginary = z[i], z[m + i]
            z[i] = decay[0, i] * real - decay[1, i] * imaginary
            z[m + i] = decay[0, i] * imaginary + decay[1, i] * real
        for j in range(s):
            for i in range(2 * m):
                z[i] += push[j, i] * force[j]
    return motion


@cached_njit(_DIGEST, "the linearized equations of long periods", "ten seconds", **_OPTIONS)
def with_own_motion(direct: Array, tangents: Array) -> Array:
    """Forces (steps, s, 2 r) per motion and rate of which the forces of a step are no part yet."""
    steps, s, wide = tangents.shape
    closed, a = tangents.copy(), np.empty((wide, wide))
    for row in range(steps):
        for o in range(wide):
            for i in range(wide):
                total = 1.0 if o == i else 0.0
                for j in range(s):
                    total -= direct[o, j] * tangents[row, j, i]
                a[o, i] = total
        # Forces change motions within a step little: the matrix is near the unit matrix.
        for k in range(wide):
            for i in range(wide):
                if i != k:
                    factor = a[k, i] / a[k, k]
                    for o in range(k, wide):
                        a[o, i] -= factor * a[o, k]
                    for j in range(s):
                        closed[row, j, i] -= factor * closed[row, j, k]
        for k in range(wide):
            for j in range(s):
                closed[row, j, k] /= a[k, k]
    return closed
