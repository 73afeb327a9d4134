"""Time integration with exact linear steps, readable: matrix exponentials and a root finder.

The state of the structure with its contacts closed at mean stiffness obeys ``y' = A y + g(t)``.
Over a step ``g`` is the parabola through its values at the beginning, middle and end.
"""

import numpy as np
from scipy.linalg import expm
from scipy.optimize import brentq

from tribodyn.dynamics import System


class PlainMarch:
    """Integrate a system whose contacts have constant directions."""

    def __init__(self, system: System, frequency: float, steps: int) -> None:
        self.system, self.frequency = system, frequency
        self.cached_weights: dict[float, tuple[np.ndarray, ...]] = {}
        self.width = 1.0 / (steps * system.cycles)
        self.count = steps * system.cycles
        self.h = np.array([contact.direction for contact in system.contacts])
        phase = (np.arange(4096) + 0.5) / 4096
        self.contacts = system.clocked_contacts
        k = [np.mean(contact.stiffness(phase)) for contact in self.contacts]
        c = [contact.damping for contact in self.contacts]
        inverse = np.linalg.inv(system.mass)
        closed = [system.stiffness + self.h.T @ np.diag(k) @ self.h]
        closed += [system.damping + self.h.T @ np.diag(c) @ self.h]
        self.mean, self.inverse = (np.array(k), np.array(c)), inverse
        size = system.size
        self.matrix = np.block([
            [np.zeros((size, size)), np.eye(size)],
            [-inverse @ closed[0], -inverse @ closed[1]],
        ])  # fmt: skip

    def entries(self, number: int, tau: float) -> np.ndarray:
        """Stiffness, error and its rate of all contacts, on the parabola of a step."""
        at = (number + np.array([0.0, 0.5, 1.0])) * self.width
        weights = (1 - tau) * (1 - 2 * tau), 4 * tau * (1 - tau), tau * (2 * tau - 1)

        def rates(error) -> np.ndarray:
            return self.frequency * (error(at + 1e-5) - error(at - 1e-5)) / 2e-5

        rows = [(c.stiffness(at), c.error(at), rates(c.error)) for c in self.contacts]
        return np.einsum("jes,s->ej", np.array(rows), weights)

    def deflection(self, number: int, tau: float, y: np.ndarray) -> np.ndarray:
        return self.h @ y[: self.system.size] - self.entries(number, tau)[1]

    def push(self, number: int, tau: float, y: np.ndarray, side: np.ndarray) -> np.ndarray:
        """What the forces add to ``A y``."""
        size = self.system.size
        stiffness, error, rate = self.entries(number, tau)
        d, speed = self.h @ y[:size], self.h @ y[size:]
        force = np.array(self.system.force, dtype=float)
        for j, contact in enumerate(self.contacts):
            spring = stiffness[j] * (d[j] - error[j] - side[j] * contact.gap)
            acting = abs(side[j]) * (spring + contact.damping * (speed[j] - rate[j]))
            force += self.h[j] * (self.mean[0][j] * d[j] + self.mean[1][j] * speed[j] - acting)
        return np.concatenate((np.zeros(size), self.inverse @ force))

    def weights(self, width: float) -> tuple[np.ndarray, ...]:
        """Factors of the state and of 1, s and s^2/2 times a force, at the end of a step."""
        if width in self.cached_weights:
            return self.cached_weights[width]
        size, time = len(self.matrix), width / self.frequency
        chain = np.zeros((4 * size, 4 * size))
        chain[:size, :size] = self.matrix * time
        chain[:size, size : 2 * size] = time * np.eye(size)
        chain[size:-size, 2 * size :] = np.eye(2 * size)
        weights = tuple(np.split(expm(chain)[:size], 4, axis=1))
        self.cached_weights[width] = weights
        return weights

    def step(self, number: int, begin: float, end: float, y: np.ndarray, side: np.ndarray):
        """State at the end of a part of a step, from fraction to fraction, with fixed sides."""
        part, first = (end - begin) * self.width, self.push(number, begin, y, side)
        middle = last = y
        for _ in range(25):
            g = self.push(number, 0.5 * (begin + end), middle, side)
            bend = self.push(number, end, last, side)
            slope, bend = 4.0 * g - 3.0 * first - bend, 4.0 * (first - 2.0 * g + bend)
            pairs = zip(self.weights(0.5 * part), (y, first, 0.5 * slope, 0.25 * bend), strict=True)
            middle = sum(weight @ value for weight, value in pairs)
            pairs = zip(self.weights(part), (y, first, slope, bend), strict=True)
            last = sum(weight @ value for weight, value in pairs)
        return last

    def period(self, y: np.ndarray) -> tuple[np.ndarray, int]:
        """State after one period, and the changes of side."""
        gaps, changes = np.array([contact.gap for contact in self.contacts]), 0
        d = self.deflection(0, 0.0, y)
        side = np.where(d > gaps, 1.0, np.where(d < -gaps, -1.0, 0.0))
        side = np.where(gaps > 0.0, side, 1.0)

        def clearances(number, end, state):
            d = self.deflection(number, end, state)
            clear = np.where(side != 0.0, side * d - gaps, gaps - np.abs(d))
            return np.where(gaps > 0.0, clear, np.inf), d

        for number in range(self.count):
            tau = 0.0
            while tau < 1.0:
                state = self.step(number, tau, 1.0, y, side)
                if clearances(number, 1.0, state)[0].min() >= 0.0:
                    y, tau = state, 1.0
                    continue
                begin = tau
                tau = brentq(
                    lambda end, *now: clearances(
                        now[0], end, self.step(now[0], now[1], end, now[2], side)
                    )[0].min(),
                    begin + 1e-9, 1.0, (number, begin, y), xtol=1e-15,
                )  # fmt: skip
                y = self.step(number, begin, tau, y, side)
                clear, d = clearances(number, tau, y)
                which = int(np.argmin(clear))
                side[which] = 0.0 if side[which] else np.sign(d[which])
                changes += 1
        return y, changes
