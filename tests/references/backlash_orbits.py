"""Case H1, computed anew by SciPy: ``python tests/references/backlash_orbits.py``.

One degree of freedom, mass 1, damping 0.1, load 0.5, on a spring of stiffness ``1 + 0.2 cos(W t)``
behind a dead zone of half width 1: ``x'' + 0.1 x' + k(t) f(x) = 0.5`` with ``f = x - 1`` above 1,
``x + 1`` below -1 and 0 between. The orbit is a root of the map over one period. Integration is by
DOP853, stopped at every passage of an end of the dead zone; nothing of tribodyn is used.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.integrate import quad, solve_ivp
from scipy.optimize import root

#: Speed at which both motions are compared, and the root mean square of each about its mean.
SPEED = 0.88
LOW, HIGH = 0.310423, 0.667183
#: Magnitude of both multipliers of either motion: ``exp(-0.1 pi/W)``.
MULTIPLIER = 0.699773
#: Both motions exist between these speeds.
FIRST, LAST = 0.8344, 0.9069


@dataclass(frozen=True)
class Orbit:
    """One periodic motion: state at the beginning, and the figures compared."""

    start: np.ndarray
    rms: float
    least: float
    multipliers: np.ndarray


def _motion(t: float, state: np.ndarray, speed: float, side: int) -> list[float]:
    place, velocity = state
    stiffness = 1.0 + 0.2 * np.cos(speed * t)
    return [velocity, 0.5 - 0.1 * velocity - stiffness * (place - side) * abs(side)]


def _leave(end: float) -> Any:
    def event(t: float, state: np.ndarray, speed: float, side: int) -> float:
        return float(state[0] - end)

    event.terminal = True  # type: ignore[attr-defined]
    return event


_ENDS = (_leave(1.0), _leave(-1.0))


def pieces(start: np.ndarray, speed: float) -> list[Any]:
    """Solutions over one period between passages of the ends of the dead zone."""
    period, t, state = 2.0 * np.pi / speed, 0.0, np.asarray(start, dtype=float)
    side = 1 if state[0] > 1.0 else -1 if state[0] < -1.0 else 0
    phases = []
    while t < period:
        solved = solve_ivp(
            _motion, (t, period), state, "DOP853", args=(speed, side), events=_ENDS,
            dense_output=True, rtol=1e-12, atol=1e-13,
        )  # fmt: skip
        if solved.status == 1 and solved.t[-1] - t < 1e-10:  # it begins on the end that it leaves
            step = min(1e-3, period - t)
            solved = solve_ivp(
                _motion, (t, t + step), state, "DOP853", args=(speed, side), dense_output=True,
                rtol=1e-12, atol=1e-13,
            )  # fmt: skip
        phases.append(solved)
        t, state = solved.t[-1], solved.y[:, -1].copy()
        if solved.status == 1:
            end = 1.0 if abs(state[0] - 1.0) < abs(state[0] + 1.0) else -1.0
            outward = state[1] * end > 0.0
            side = int(end) if outward else 0
            state[0] = end
    return phases


def orbit(guess: tuple[float, float], speed: float = SPEED) -> Orbit:
    """Periodic motion near a guess."""

    def image(state: np.ndarray) -> np.ndarray:
        return np.asarray(pieces(state, speed)[-1].y[:, -1])

    state = np.asarray(guess, dtype=float)
    for _ in range(60):  # first towards a motion that attracts
        state = image(state)
    solved = root(lambda start: image(start) - start, state, tol=1e-11)
    parts = pieces(solved.x, speed)
    period = 2.0 * np.pi / speed

    def piece(part: Any, power: int) -> float:
        place = part.sol
        return float(
            quad(lambda t: place(t)[0] ** power, *part.t[[0, -1]], epsabs=1e-11, limit=200)[0]
        )

    def mean(power: int) -> float:
        return sum(piece(part, power) for part in parts) / period

    step = 1e-5
    columns = [
        (image(solved.x + step * unit) - image(solved.x - step * unit)) / (2.0 * step)
        for unit in np.eye(2)
    ]
    least = min(float(p.sol(np.linspace(p.t[0], p.t[-1], 400))[0].min()) for p in parts)
    rms = float(np.sqrt(mean(2) - mean(1) ** 2))
    return Orbit(solved.x, rms, least, np.linalg.eigvals(np.column_stack(columns)))


if __name__ == "__main__":
    for name, guess, expected in (("low", (1.5, 0.0), LOW), ("high", (2.2, 0.3), HIGH)):
        orbits = orbit(guess)
        print(f"{name}: rms {orbits.rms:.7f}, stated {expected}; least place {orbits.least:.4f}")
        print(f"  multipliers {np.abs(orbits.multipliers)}, stated {MULTIPLIER}")
