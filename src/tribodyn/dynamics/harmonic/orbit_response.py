"""The response of a periodic motion, from the harmonics of its contact forces."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.dynamics.harmonic.newton import Residual, State, uncorrected
from tribodyn.dynamics.time.response import Response, build_response
from tribodyn.types import Array, ComplexArray

#: Refinement of the samples between which the motion is interpolated, and points of a polynomial.
_REFINED, _POINTS = 4, 8
#: Jumps whose polynomials are evaluated together.
_CHUNK = 16


class _Jumps(NamedTuple):
    """Jumps of the force in a period."""

    phase: Array  #: (b,) [-]
    force: Array  #: changes of the force on the closed structure (b, s)

    @classmethod
    def of(cls, state: State) -> _Jumps:
        """Jumps of a motion."""
        breaks = state.breaks
        phase = (breaks.step + breaks.fraction) / len(state.y) % 1.0
        moved = np.any(breaks.jump != 0.0, axis=1)
        return cls(phase[moved], breaks.jump[moved])

    def turns(self, count: int) -> ComplexArray:
        """Fourier coefficients 1, 2, ... of pulses at the jumps (count, s)."""
        order = 2j * np.pi * np.arange(1, count + 1)
        total = np.zeros((count, self.force.shape[1]), dtype=complex)
        for first in range(0, self.phase.size, _CHUNK):
            part = slice(first, first + _CHUNK)
            total += np.exp(-np.multiply.outer(order, self.phase[part])) @ self.force[part]
        return total

    def polynomials(self, phase: Array, power: int) -> Array:
        """Values at phases (p, s) of what follows the jumps: pulses integrated ``power`` times."""
        total = np.zeros((phase.size, self.force.shape[1]))
        for first in range(0, self.phase.size, _CHUNK):
            part = slice(first, first + _CHUNK)
            x = np.subtract.outer(phase, self.phase[part] - 1e-12) % 1.0
            if power == 1:  # polynomials of Bernoulli
                values = 0.5 - x
            elif power == 2:
                values = -(x * (x - 1.0) + 1.0 / 6.0) / 2.0
            else:
                values = -x * (x - 0.5) * (x - 1.0) / 6.0
            total += values @ self.force[part]
        return total


def orbit_response(compiled: Compiled, residual: Residual, state: State, **facts: Any) -> Response:
    """Evaluate a motion at the ends and in the middle of the steps of a grid."""
    structure, jumps, steps = residual.structure, _Jumps.of(state), len(state.y)
    spectrum, pulses = _spectrum(state, jumps)
    force, torque = structure.balanced(spectrum, state.y.mean(axis=0))
    phase, shape = compiled.nodes.phase.reshape(-1), (1, compiled.grid.steps, 3, -1)
    into_motion = structure.push.T @ structure.coordinates.inverse
    motion = []
    # Harmonics beyond those of the samples are those that jumps of the acceleration cause.
    for amplitude, power in zip(structure.motion(residual.omega, force), (3, 2), strict=True):
        scale = residual.frequency ** (1.0 - power) * into_motion
        amplitude[1:-1] -= pulses / _orders(len(pulses)) ** power @ scale
        motion.append(series(amplitude, steps, phase) + jumps.polynomials(phase, power) @ scale)
    q, v = (values.reshape(shape) for values in motion)
    ends = np.concatenate((q[0, :, 0], v[0, :, 0]), axis=1)
    states = np.concatenate((ends, ends[:1]))
    number = structure.rate * float(compiled.grid.width.max()) / residual.frequency
    compiled = replace(compiled, step_number=number)
    facts |= {"period": 1, "engine": "harmonic-balance", "within": (q, v)}
    return build_response(compiled, residual.frequency, states, torque, **facts)


def _orders(count: int) -> ComplexArray:
    """Factors of a derivative by the clock for harmonics 1, 2, ... (count, 1)."""
    return np.asarray(2j * np.pi * np.arange(1, count + 1)[:, None], dtype=complex)


def _spectrum(state: State, jumps: _Jumps) -> tuple[ComplexArray, ComplexArray]:
    """Amplitudes (k, s) of the forces on the closed structure, and of pulses at the jumps."""
    steps = len(state.y)
    force = uncorrected(state) - jumps.polynomials(np.arange(steps) / steps, 1)
    spectrum = np.asarray(np.fft.rfft(force, axis=0, norm="forward"), dtype=complex)
    pulses = jumps.turns(len(spectrum) - 2)
    spectrum[1:-1] += pulses / _orders(len(pulses))
    spectrum[-1] = 0.0  # the highest harmonic has no phase
    return spectrum, pulses


def starting_state(residual: Residual, state: State) -> tuple[Array, Array]:
    """State of the closed structure (m,) when the clock starts, and the balancing torque (n,)."""
    structure = residual.structure
    force, torque = structure.balanced(_spectrum(state, _Jumps.of(state))[0], state.y.mean(axis=0))
    amplitudes = structure.respond(residual.omega, force)
    return amplitudes[0].real + 2.0 * amplitudes[1:].real.sum(axis=0), torque


def series(amplitudes: ComplexArray, steps: int, phase: Array) -> Array:
    """Fourier series with amplitudes (k, n) of a motion on ``steps`` samples, at any phases."""
    # On equal steps all phases are samples of the series.
    count = 2 * (phase.size // 3)
    if count < steps or np.abs(phase * count - np.rint(phase * count)).max() > 1e-7:
        count = _REFINED * steps
    padded = np.zeros((count // 2 + 1, amplitudes.shape[1]), dtype=complex)
    padded[: len(amplitudes)] = amplitudes
    fine = np.fft.irfft(padded, count, axis=0, norm="forward")
    place = phase * count
    nearest = np.rint(place)
    if np.abs(place - nearest).max() < 1e-7:
        return np.asarray(fine[nearest.astype(np.int64) % count])
    first = np.floor(place).astype(np.int64) - _POINTS // 2 + 1
    weights = _lagrange(place - first)
    result = np.zeros((phase.size, amplitudes.shape[1]))
    for point in range(_POINTS):
        result += weights[:, point, None] * fine[(first + point) % count]
    return result


def _lagrange(place: Array) -> Array:
    """Weights of the polynomial through points 0, 1, ... at places (p,), (p, points)."""
    points = np.arange(_POINTS)
    weights = np.ones((place.size, _POINTS))
    for point in points:
        for other in np.delete(points, point):
            weights[:, point] *= (place - other) / (point - other)
    return weights
