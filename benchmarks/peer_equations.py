"""The equations of the reference pair for other solvers: exact, piece by piece, well scaled.

Every solver gets the same favours. Displacements are in units of 10 um along the line of action,
speeds in units of 30000 of these per second, so that one absolute tolerance suits all components;
everything that can be multiplied beforehand is; and each piece between two events has its own entry
table, so that a solver that restarts there sees a smooth right-hand side.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from reference_pair import Pair, path, pieces, starting_state

__all__ = [
    "COUNTER",
    "Entries",
    "durations",
    "entries",
    "numba_rate",
    "numpy_rate",
    "position_of",
    "scaled_start",
    "table",
]

Array = NDArray[np.float64]

#: Unit of displacement along the line of action [m] and of its rate over it [1/s].
LENGTH, RATE = 1e-5, 3e4
#: Place in a table row where compiled right-hand sides count their evaluations.
COUNTER = 4


class Entries(NamedTuple):
    """Entries of one piece in scaled coordinates ``x`` and scaled speeds ``u``.

    ``x' = rate u`` and ``u' = load - spring x - damper u - (push + t push_slope) N`` with
    ``N = stiffness g(closing.x) + damping closing_rate.u``, t [s] since the piece began.
    """

    stiffness: float
    damping: float
    gap: float
    rate: float
    evaluations: float
    closing: Array
    closing_rate: Array
    load: Array
    spring: Array
    damper: Array
    push: Array
    push_slope: Array


def _scale() -> Array:
    gears = path().pair
    pinion, wheel = gears.pinion.base_radius, gears.wheel.base_radius
    return LENGTH / np.array([1.0, 1.0, pinion, 1.0, 1.0, wheel])


def entries(pair: Pair) -> list[Entries]:
    """Scaled entries of every piece of the mesh cycle.

    Parameters
    ----------
    pair : Pair

    Returns
    -------
    list of Entries
    """
    gears = path().pair
    x = _scale()
    mass = np.array([pair.mass, pair.mass, pair.moment_of_inertia]).T.reshape(-1)
    radius = np.array([gears.pinion.base_radius, gears.wheel.base_radius])
    direction = np.array([0.0, 1.0, radius[0], 0.0, -1.0, -radius[1]])
    supported = np.array([1.0, 1.0, 0.0, 1.0, 1.0, 0.0])
    torque = pair.torque * np.array([0.0, 0.0, 1.0, 0.0, 0.0, -1.5])
    inertia = mass * x * RATE
    return [
        Entries(
            stiffness=piece.stiffness,
            damping=pair.mesh_damping,
            gap=pair.gap,
            rate=RATE,
            evaluations=0.0,
            closing=direction * x,
            closing_rate=direction * x * RATE,
            load=torque / inertia,
            spring=pair.bearing_stiffness * supported * x / inertia,
            damper=pair.bearing_damping * supported * x * RATE / inertia,
            push=(direction + piece.friction) / inertia,
            push_slope=piece.friction_slope * pair.mesh_frequency / inertia,
        )
        for piece in pieces(pair)
    ]


def table(pair: Pair) -> Array:
    """The same as one row of numbers per piece.

    Parameters
    ----------
    pair : Pair

    Returns
    -------
    (pieces, 47) array
    """
    return np.array([np.concatenate([np.atleast_1d(part) for part in e]) for e in entries(pair)])


def durations(pair: Pair) -> Array:
    """Duration of every piece [s].

    Parameters
    ----------
    pair : Pair

    Returns
    -------
    (pieces,) array
    """
    return np.array([piece.end - piece.begin for piece in pieces(pair)]) / pair.mesh_frequency


def scaled_start(pair: Pair) -> Array:
    """Start in scaled coordinates.

    Parameters
    ----------
    pair : Pair

    Returns
    -------
    (12,) array
    """
    position, velocity = starting_state(pair)
    return np.concatenate((position / _scale(), velocity / (_scale() * RATE)))


def position_of(state: Array) -> Array:
    """Coordinates of a scaled state.

    Parameters
    ----------
    state : (12,) array

    Returns
    -------
    (6,) array
        In m or rad.
    """
    return np.asarray(state[:6] * _scale())


def numpy_rate(e: Entries) -> Callable[[float, Array], Array]:
    """Right-hand side of one piece in NumPy.

    Parameters
    ----------
    e : Entries

    Returns
    -------
    callable
        Takes time since the piece began [s] and state.
    """
    stiffness, damping, gap, rate, _, closing, closing_rate, *parts = e
    load, spring, damper, push, push_slope = parts

    def derivative(t: float, y: Array) -> Array:
        x, u = y[:6], y[6:]
        d = closing @ x
        force: Any = 0.0
        if gap == 0.0:
            force = stiffness * d + damping * (closing_rate @ u)
        elif abs(d) > gap:
            side = gap if d > gap else -gap
            force = stiffness * (d - side) + damping * (closing_rate @ u)
        turn = load - spring * x - damper * u - (push + t * push_slope) * force
        return np.concatenate((rate * u, turn))

    return derivative


@cache
def numba_rate() -> Any:
    """Right-hand side of one piece, compiled: ``(t, y, out, row)`` fills ``out``.

    Returns
    -------
    compiled function
        Takes time since the piece began [s], state, result and a row of the table.
    """
    import numba as nb

    @nb.njit(fastmath={"contract", "nsz"}, error_model="numpy")
    def derivative(t: float, y: Any, out: Any, row: Any) -> None:
        row[4] += 1.0
        d, speed = 0.0, 0.0
        for i in range(6):
            d += row[5 + i] * y[i]
            speed += row[11 + i] * y[6 + i]
        gap = row[2]
        if gap == 0.0:
            force = row[0] * d + row[1] * speed
        elif abs(d) <= gap:
            force = 0.0
        else:
            force = row[0] * (d - gap if d > gap else d + gap) + row[1] * speed
        for i in range(6):
            out[i] = row[3] * y[6 + i]
            own = row[17 + i] - row[23 + i] * y[i] - row[29 + i] * y[6 + i]
            out[6 + i] = own - (row[35 + i] + t * row[41 + i]) * force

    return derivative
