"""The response of a periodic motion, from the harmonics of its contact forces."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import scipy.fft

from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.dynamics.harmonic.newton import Residual, State, force_spectrum
from tribodyn.dynamics.time.response import Response, build_response
from tribodyn.types import Array, ComplexArray

#: Refinement of the samples between which the motion is interpolated, and points of a polynomial.
_REFINED, _POINTS = 4, 8


def orbit_response(compiled: Compiled, residual: Residual, state: State, **facts: Any) -> Response:
    """Evaluate a motion at the ends and in the middle of the steps of a grid."""
    structure, spectrum = residual.structure, force_spectrum(state)
    mean = state.y.mean(axis=0)
    force, torque = structure.balanced(spectrum, mean)
    amplitudes = structure.motion(residual.omega, force)
    phase, steps = compiled.nodes.phase, compiled.grid.steps
    motion = [series(amplitude, len(state.y), phase.reshape(-1)) for amplitude in amplitudes]
    q, v = (values.reshape(1, steps, 3, -1) for values in motion)
    ends = np.concatenate((q[0, :, 0], v[0, :, 0]), axis=1)
    states = np.concatenate((ends, ends[:1]))
    number = structure.rate * float(compiled.grid.width.max()) / residual.frequency
    compiled = replace(compiled, step_number=number)
    facts |= {"period": 1, "engine": "harmonic-balance", "within": (q, v)}
    return build_response(compiled, residual.frequency, states, torque, **facts)


def starting_state(residual: Residual, state: State) -> tuple[Array, Array]:
    """State of the closed structure (m,) when the clock starts, and the balancing torque (n,)."""
    structure = residual.structure
    force, torque = structure.balanced(force_spectrum(state), state.y.mean(axis=0))
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
    fine = scipy.fft.irfft(padded, count, axis=0, norm="forward")
    place = phase * count
    near = np.rint(place)
    if np.abs(place - near).max() < 1e-7:
        return np.asarray(fine[near.astype(np.int64) % count])
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
