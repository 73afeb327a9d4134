"""Forces of Newmark's scheme: contacts, and friction that follows their load.

A row of the table holds for each contact stiffness, damping, error, its slope, gap, and three
directions: of the compression, of its change with the phase, of the force; then for each friction
its direction and coefficients; then the external force.
"""

from __future__ import annotations

from typing import Any

import numba as nb

from tribodyn.dynamics._engine.contact_forces import INNER
from tribodyn.dynamics._engine.lanes import least, load, store
from tribodyn.dynamics._engine.newmark_lanes import below, magnitude
from tribodyn.types import Array

#: Single slots of a lane; its factors begin at the third.
SINGLE = 9


@nb.njit(**INNER)
def slots(
    shape: tuple[int, int, int, int],
) -> tuple[int, int, int, int, int, int, int, int, int, int]:
    """Where a lane keeps what."""
    n, m, frictions, _ = shape
    side = 8 * n
    rub = side + 4 * m
    push = rub + 2 * frictions
    effect = push + (m + frictions) * n
    matrix = effect + 2 * m * (m + frictions)
    right = matrix + m * m
    return (
        side, side + m, side + 2 * m, side + 3 * m, rub, push, effect, matrix, right, right + m,
    )  # fmt: skip


@nb.njit(**INNER)
def row_length(shape: tuple[int, int, int, int]) -> int:
    """Length of a row: five numbers and three directions per contact, frictions, external force."""
    n, m, frictions, coefficients = shape
    return m * (5 + 3 * n) + frictions * (n + coefficients) + n


@nb.njit(**INNER)
def compression(lanes: Any, n: int, rows: Array, at: int, q: int, error: Any, w: Array) -> Any:
    """Compression of the contact whose row begins at ``at``, from the positions at slot ``q``."""
    d = error * (0.0 - rows[at + 2])
    for i in range(n):
        d = d + rows[at + 5 + i] * load(lanes, w, q + i)
    return d


@nb.njit(**INNER)
def rate_of(
    lanes: Any, n: int, rows: Array, at: int, q: int, beat: Any, error: Any, w: Array
) -> Any:
    """Find the rate of a compression, from positions at slot ``q`` and velocities at ``q + n``."""
    moved = error * (0.0 - rows[at + 3])
    along = error * 0.0
    for i in range(n):
        moved = moved + rows[at + 5 + n + i] * load(lanes, w, q + i)
        along = along + rows[at + 5 + i] * load(lanes, w, q + n + i)
    return along + beat * moved


@nb.njit(**INNER)
def contact_law(
    sign: Any, stiffness: Any, damping: Any, gap: Any, in_gap: float, d: Any, rate: Any
) -> tuple[Any, Any, Any]:
    """Force of a contact on side ``sign``, and its derivatives by compression and rate."""
    touch = sign * sign
    by_compression = stiffness * touch
    by_rate = damping * (touch + in_gap * (1.0 - touch))
    return by_compression * (d - gap * sign) + by_rate * rate, by_compression, by_rate


@nb.njit(**INNER)
def friction_law(
    rows: Array, at: int, count: int, scale: float, limit: float, carried: Any, zero: Any
) -> tuple[Any, Any]:
    """Friction of a load, and its derivative by the load; ``count`` coefficients from ``at``."""
    ratio = magnitude(carried) * scale
    x = least(ratio, zero + limit)
    value, slope = zero, zero
    for back in range(count):
        slope = slope * x + value
        value = value * x + rows[at + count - 1 - back]
    return carried * value, value + below(ratio, zero + limit) * (x * slope)


@nb.njit(**INNER)
def frictions_of(
    lanes: Any,
    shape: tuple[int, int, int, int],
    facts: Array,
    rows: Array,
    row: int,
    w: Array,
) -> None:
    """Every friction and its slope from the contact forces."""
    n, m, frictions, coefficients = shape
    _, forces, _, _, place, _, _, _, _, single = slots(shape)
    zero, scale = load(lanes, w, single + 2), load(lanes, w, single + 5)
    for f in range(frictions):
        own = m + f * (2 + m)
        carried = zero
        for j in range(m):
            carried = carried + facts[own + 2 + j] * load(lanes, w, forces + j)
        at = row + m * (5 + 3 * n) + f * (n + coefficients) + n
        force, slope = friction_law(
            rows, at, coefficients, facts[own], facts[own + 1], carried, zero
        )
        store(w, place + f, scale * force)
        store(w, place + frictions + f, scale * slope)
