"""The response of a periodic motion, from the harmonics of its contact forces."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.dynamics.harmonic.newton import State, uncorrected
from tribodyn.dynamics.harmonic.phase_grid import polynomial_shares
from tribodyn.dynamics.harmonic.residual import ClockResidual
from tribodyn.dynamics.time.response import Response, build_response
from tribodyn.types import Array, ComplexArray, Index

#: Refinement of the samples between which the motion is interpolated, and points of a polynomial.
_REFINED, _POINTS = 4, 8
#: Terms of the exponential series of a pulse within its step, of which the last is below 1e-15.
_TERMS = 22


class _Jumps(NamedTuple):
    """Jumps of the force in a period."""

    steps: int  #: samples of the period
    step: Index  #: step of each jump (b,)
    fraction: Array  #: of that step, where it jumps (b,)
    force: Array  #: changes of the force on the closed structure (b, s)

    @classmethod
    def of(cls, state: State) -> _Jumps:
        """Jumps of a motion."""
        breaks, steps = state.breaks, len(state.y)
        moved = np.any(breaks.jump != 0.0, axis=1)
        step = breaks.step[moved].astype(np.int64) % steps
        return cls(steps, step, breaks.fraction[moved], breaks.jump[moved])

    def turns(self, count: int) -> ComplexArray:
        """Fourier coefficients 1, 2, ... of pulses at the jumps (count, s)."""
        if not self.step.size:
            return np.zeros((count, self.force.shape[1]), dtype=complex)
        # exp(-i angle fraction) about the middle of the step, as a series: one transform a term.
        angle = 2.0 * np.pi * np.arange(1, count + 1)[:, None] / self.steps
        total = np.zeros((count, self.force.shape[1]), dtype=complex)
        factor = np.exp(-0.5j * angle)
        values = self.force.copy()
        pulses = np.zeros((self.steps, self.force.shape[1]))
        for term in range(_TERMS):
            pulses[self.step] = 0.0
            np.add.at(pulses, self.step, values)
            total += factor * np.fft.rfft(pulses, axis=0)[1 : count + 1]
            factor = factor * (-1j * angle / (term + 1))
            values *= self.fraction[:, None] - 0.5
        return total

    def polynomials(self, phase: Array, power: int) -> Array:
        """Values at phases (p, s) of what follows the jumps: pulses integrated ``power`` times."""
        if not self.step.size:
            return np.zeros((phase.size, self.force.shape[1]))
        # Bernoulli polynomials of the phase since each jump, summed by the moments of the jumps;
        # those after the phase follow their jump of the last period: B(x + 1) - B(x) = n x^(n - 1).
        place = ((self.step + self.fraction) / self.steps - 1e-12) % 1.0
        order = np.argsort(place, kind="stable")
        place, force, x = place[order, None], self.force[order], phase[:, None] % 1.0
        passed = np.searchsorted(place[:, 0], x[:, 0], side="right")
        bernoulli = (1.0, x - 0.5, x * (x - 1.0) + 1.0 / 6.0, x * (x - 0.5) * (x - 1.0))
        total = np.zeros((phase.size, self.force.shape[1]))
        for degree in range(power + 1):
            moment = np.zeros((place.size + 1, force.shape[1]))
            np.cumsum((-place) ** degree / math.factorial(degree) * force, axis=0, out=moment[1:])
            remaining = power - degree
            total -= bernoulli[remaining] / math.factorial(remaining) * moment[-1]
            if remaining:
                ahead = moment[-1] - moment[passed]
                total -= x ** (remaining - 1) / math.factorial(remaining - 1) * ahead
        return total


def orbit_response(
    compiled: Compiled, residual: ClockResidual, state: State, **facts: Any
) -> Response:
    """Evaluate a motion at the ends and in the middle of the steps of a grid."""
    structure, jumps, steps = residual.structure, _Jumps.of(state), len(state.y)
    spectrum, pulses = _spectrum(state, jumps)
    force, torque = structure.balanced(spectrum, structure.contact_stiffness @ state.y.mean(axis=0))
    phase, shape = compiled.nodes.phase.reshape(-1), (1, compiled.grid.steps, 3, -1)
    into_motion = structure.push.T @ structure.coordinates.inverse
    amplitudes, jumped = structure.motion(residual.omega, force), []
    # Harmonics beyond those of the samples are those that jumps of the acceleration cause.
    for amplitude, power in zip(amplitudes, (3, 2), strict=True) if jumps.step.size else ():
        scale = residual.frequency ** (1.0 - power) * into_motion
        amplitude[1:-1] -= pulses / _orders(len(pulses)) ** power @ scale
        jumped.append(jumps.polynomials(phase, power) @ scale)
    motion = series(np.concatenate(amplitudes, axis=1), steps, phase)
    if jumped:
        motion += np.concatenate(jumped, axis=1)
    q, v = (np.ascontiguousarray(part).reshape(shape) for part in np.split(motion, 2, axis=1))
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


def starting_state(residual: ClockResidual, state: State) -> tuple[Array, Array]:
    """State of the closed structure (m,) when the clock starts, and the balancing torque (n,)."""
    structure = residual.structure
    closing = structure.contact_stiffness @ state.y.mean(axis=0)
    force, torque = structure.balanced(_spectrum(state, _Jumps.of(state))[0], closing)
    amplitudes = structure.respond(residual.omega, force)
    return amplitudes[0].real + 2.0 * amplitudes[1:].real.sum(axis=0), torque


def series(amplitudes: ComplexArray, steps: int, phase: Array) -> Array:
    """Fourier series with amplitudes (k, n) of a motion on ``steps`` samples, at any phases."""
    from scipy import fft
    from scipy.sparse import csr_matrix

    # On equal steps all phases are samples of the series.
    count = 2 * (phase.size // 3)
    if count < steps or np.abs(phase * count - np.rint(phase * count)).max() > 1e-7:
        count = _REFINED * steps
    fine = fft.irfft(amplitudes, count, axis=0, norm="forward")
    place = phase * count
    nearest = np.rint(place)
    if np.abs(place - nearest).max() < 1e-7:
        return np.asarray(fine[nearest.astype(np.int64) % count])
    points = np.floor(place).astype(np.int64)[:, None] + np.arange(_POINTS) - _POINTS // 2 + 1
    shares = polynomial_shares(place[:, None] - points).reshape(-1)
    ends, columns = np.arange(0, shares.size + 1, _POINTS), (points % count).reshape(-1)
    return np.asarray(csr_matrix((shares, columns, ends), (phase.size, count)) @ fine)
