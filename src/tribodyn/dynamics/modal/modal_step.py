"""A step of time integration in modal coordinates, for compiled callers.

Each mode obeys ``z' = lambda z + b u`` with the forces ``u`` at the contacts, which are a parabola
over the step through its beginning, middle and end: the step is exact for this parabola, and the
forces at its middle and end follow from the motion of the contacts there by fixed-point iteration.

All entries of a node of the grid are one row: stiffnesses of the springs of every contact, its
damping, error, rate of the error, gaps of its springs, then directions of compression, their rates,
of push, then the load, the directions of frictions and their coefficients. The springs of a contact
are the first one and its ramps, as many as the contact with the most has; each has its side.
"""

from __future__ import annotations

import numba as nb
import numpy as np

from tribodyn.compiled.jit import INNER
from tribodyn.dynamics.modal.modal_tables import Buffers, Contacts, Modes, Weights
from tribodyn.types import Array, ComplexArray

#: Fixed-point iterations of a step.
_ITERATIONS = 60
#: Last change of the motion at the contacts over its size.
_FIXED = 1e-14


@nb.njit(**INNER)
def _exponentials(x: complex) -> tuple[complex, complex, complex, complex]:
    """``exp(x)`` and the integrals of ``exp((1 - s) x) s^k/k!`` for k = 0, 1, 2."""
    if abs(x) < 1.0:
        third = 1.0 / 6.0 + 0.0 * x
        term = third
        for k in range(4, 22 if abs(x) > 0.1 else 12):
            term *= x * (1.0 / k)
            third += term
        second = 0.5 + x * third
        first = 1.0 + x * second
        return 1.0 + x * first, first, second, third
    full_step = np.exp(x)
    first = (full_step - 1.0) / x
    second = (first - 1.0) / x
    return full_step, first, second, (second - 0.5) / x


@nb.njit(**INNER)
def fill_modes(values: ComplexArray, h: float, weights: Array) -> None:
    """Weights of modes and forces in the modes, of a step of ``h`` seconds."""
    for m in range(values.size):
        half, begin, middle, end = _exponentials(0.5 * h * values[m])
        weights[0, 0, 0, m], weights[0, 0, 1, m] = half.real, half.imag
        full = half * half
        weights[1, 0, 0, m], weights[1, 0, 1, m] = full.real, full.imag
        # Of the whole step by doubling that of its half.
        first = 0.5 * (half + 1.0) * begin
        second = 0.25 * ((half + 1.0) * middle + begin)
        third = 0.125 * ((half + 1.0) * end + middle + 0.5 * begin)
        for node, in_half, in_full in (
            (1, 0.5 * (begin - 1.5 * middle + end), first - 3.0 * second + 4.0 * third),
            (2, middle - end, 4.0 * second - 8.0 * third),
            (3, 0.5 * (end - 0.5 * middle), 4.0 * third - second),
        ):
            weights[0, node, 0, m], weights[0, node, 1, m] = h * in_half.real, h * in_half.imag
            weights[1, node, 0, m], weights[1, node, 1, m] = h * in_full.real, h * in_full.imag


@nb.njit(**INNER)
def fill_direct(modes: Modes, weights: Weights) -> None:
    """Weights of forces at the middle and end of a step in the motion there."""
    s, r2 = modes.input.shape[1], modes.output.shape[2]
    weights.direct[:] = 0.0
    for m in range(modes.values.size):
        for node in range(2):
            for i in range(s):
                b, c = modes.input[0, i, m], modes.input[1, i, m]
                for half in range(2):
                    real, imaginary = weights.modes[half, 2 + node, :, m]
                    x, y = b * real - c * imaginary, b * imaginary + c * real
                    for o in range(r2):
                        weights.direct[node * s + i, half * r2 + o] += (
                            modes.output[0, m, o] * x + modes.output[1, m, o] * y
                        )


@nb.njit(**INNER)
def law_at(
    modes: Modes, contacts: Contacts, row: Array, motion: Array, at: int, w: Buffers, node: int
) -> None:
    """Forces on the closed structure at a node, from the motion at ``at`` and its rate."""
    r, s = modes.mean.shape[0] // 2, modes.mean.shape[1]
    (count, springs), frictions = contacts.dead.shape, contacts.load.size
    damping = count * springs
    error, gap = damping + count, damping + 3 * count
    along = gap + count * springs
    slope = along + r * count
    push = slope + r * count
    load = push + s * count
    rub = load + s
    coefficients = rub + frictions * s
    terms = (row.size - coefficients) // max(frictions, 1)
    for i in range(s):
        w.u[node, i] = row[load + i]
    for o in range(2 * r):
        x = motion[at + o]
        for i in range(s):
            w.u[node, i] += modes.mean[o, i] * x
    for j in range(count):
        d, rate = -row[error + j], -row[error + count + j]
        for o in range(r):
            direction = row[along + j * r + o]
            d += direction * motion[at + o]
            rate += direction * motion[at + r + o] + row[slope + j * r + o] * motion[at + o]
        force = 0.0
        for k in range(springs):
            side = w.side[j, k]
            force += abs(side) * row[j * springs + k] * (d - side * row[gap + j * springs + k])
        if w.side[j, 0] != 0.0 or contacts.damped_in_gap[j] != 0.0:
            force += row[damping + j] * rate
        w.contact[j] = force
        w.deflection[node, j], w.rate[node, j] = d, rate
        for i in range(s):
            w.u[node, i] -= row[push + j * s + i] * force
    for f in range(frictions):
        carried = 0.0
        for j in range(count):
            carried += contacts.members[f, j] * w.contact[j]
        x = min(abs(carried) / contacts.load[f], contacts.limit[f])
        ratio = 0.0
        for k in range(terms - 1, -1, -1):
            ratio = ratio * x + row[coefficients + f * terms + k]
        for i in range(s):
            w.u[node, i] -= row[rub + f * s + i] * ratio * carried


@nb.njit(**INNER)
def interpolate(rows: Array, tau: float, out: Array) -> None:
    """Row at a fraction of a step, on the parabola through its three nodes."""
    left, right = (1.0 - tau) * (1.0 - 2.0 * tau), tau * (2.0 * tau - 1.0)
    middle = 4.0 * tau * (1.0 - tau)
    for i in range(out.size):
        out[i] = left * rows[0, i] + middle * rows[1, i] + right * rows[2, i]


@nb.njit(**INNER)
def _push_modes(modes: Modes, w: Buffers, node: int) -> None:
    """Forces at a node in the modes."""
    count = modes.values.size
    w.pushed[node] = 0.0
    for i in range(modes.input.shape[1]):
        force = w.u[node, i]
        for m in range(count):
            w.pushed[node, 0, m] += modes.input[0, i, m] * force
            w.pushed[node, 1, m] += modes.input[1, i, m] * force


@nb.njit(**INNER)
def _add(weights: Array, added: Array, out: Array) -> None:
    """Add weights (2, m) times modes (2, m), both complex."""
    for m in range(out.shape[1]):
        out[0, m] += weights[0, m] * added[0, m] - weights[1, m] * added[1, m]
        out[1, m] += weights[0, m] * added[1, m] + weights[1, m] * added[0, m]


@nb.njit(**INNER)
def _output(modes: Modes, z: Array, at: int, out: Array) -> None:
    """Motion and rate at the contacts, from ``at`` on."""
    width = modes.output.shape[2]
    for o in range(width):
        out[at + o] = 0.0
    for m in range(modes.values.size):
        real, imaginary = z[0, m], z[1, m]
        for o in range(width):
            out[at + o] += modes.output[0, m, o] * real + modes.output[1, m, o] * imaginary


@nb.njit(**INNER)
def _with_forces(modes: Modes, weights: Weights, w: Buffers, first: int) -> None:
    """Modes at the middle (unless ``first`` is 1) and end with the forces there."""
    _push_modes(modes, w, 1)
    _push_modes(modes, w, 2)
    for half in range(first, 2):
        w.moved[2 + half] = w.moved[half]
        _add(weights.modes[half, 2], w.pushed[1], w.moved[2 + half])
        _add(weights.modes[half, 3], w.pushed[2], w.moved[2 + half])


@nb.njit(**INNER)
def settle(modes: Modes, contacts: Contacts, weights: Weights, w: Buffers, scale: float) -> int:
    """Forces at the middle and end of a step with fixed sides; number of iterations, 0 for none."""
    s, r2 = modes.input.shape[1], modes.output.shape[2]
    _push_modes(modes, w, 0)
    for half in range(2):
        w.moved[half] = 0.0
        _add(weights.modes[half, 0], w.z, w.moved[half])
        _add(weights.modes[half, 1], w.pushed[0], w.moved[half])
        _output(modes, w.moved[half], half * r2, w.base)
    w.last[:] = np.inf
    for count in range(1, _ITERATIONS + 1):
        if weights.direct.shape[0]:
            w.motion[:] = w.base
            for node in range(2):
                for i in range(s):
                    force = w.u[1 + node, i]
                    for o in range(2 * r2):
                        w.motion[o] += weights.direct[node * s + i, o] * force
        else:
            _with_forces(modes, weights, w, 0)
            for half in range(2):
                _output(modes, w.moved[2 + half], half * r2, w.motion)
        change = 0.0
        for half in range(2):
            for o in range(half * r2, half * r2 + r2 // 2):
                change = max(change, abs(w.motion[o] - w.last[o]))
        w.last[:] = w.motion
        law_at(modes, contacts, w.rows[1], w.motion, 0, w, 1)
        law_at(modes, contacts, w.rows[2], w.motion, r2, w, 2)
        if change <= _FIXED * scale:
            return count
    return count if change <= 1e-11 * scale else 0


@nb.njit(**INNER)
def accept(modes: Modes, weights: Weights, w: Buffers, h: float, sums: Array) -> None:
    """Advance modes and integrals of the forces by a step."""
    _with_forces(modes, weights, w, 1)
    w.z[:] = w.moved[3]
    for i in range(w.u.shape[1]):
        sums[1, i] += h * sums[0, i] + h * h * (w.u[0, i] + 2.0 * w.u[1, i]) / 6.0
        sums[0, i] += h * (w.u[0, i] + 4.0 * w.u[1, i] + w.u[2, i]) / 6.0


@nb.njit(**INNER)
def begin_step(modes: Modes, contacts: Contacts, w: Buffers, start: Array) -> None:
    """Forces at the beginning of a step, repeated as a first guess at its other nodes."""
    law_at(modes, contacts, w.rows[0], start, 0, w, 0)
    w.u[1] = w.u[0]
    w.u[2] = w.u[0]


@nb.njit(**INNER)
def try_part(
    modes: Modes, contacts: Contacts, table: Array, begin: float, end: float, h: float,
    weights: Weights, w: Buffers, start: Array, scale: float,
) -> int:  # fmt: skip
    """Part of a step from fraction to fraction, ``h`` seconds long, with fixed sides."""
    fill_modes(modes.values, h, weights.modes)
    interpolate(table, begin, w.rows[0])
    interpolate(table, 0.5 * (begin + end), w.rows[1])
    interpolate(table, end, w.rows[2])
    begin_step(modes, contacts, w, start)
    return int(settle(modes, contacts, weights, w, scale))
