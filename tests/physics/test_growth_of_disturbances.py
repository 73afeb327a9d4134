"""Motions by harmonic balance whose disturbances grow are warned of (Mathieu's equation)."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tribodyn.dynamics import Contact, System, harmonic_balance
from tribodyn.errors import ModelWarning

DAMPING = 0.01


def parametric(depth: float, bodies: int, link: float) -> System:
    """Bodies on a mesh whose stiffness varies twice per period of the first of them."""
    identity = np.eye(bodies)
    chain = link * (2.0 * identity - np.eye(bodies, k=1) - np.eye(bodies, k=-1))
    chain[0, 0] = link if bodies > 1 else 0.0
    mesh = Contact(identity[0], lambda phase: 1.0 + depth * np.cos(2.0 * np.pi * phase))
    return System(identity, 2.0 * DAMPING * identity, chain, 0.5 * identity[0], [mesh])


def largest_multiplier(system: System, depth: float, period: float) -> float:
    """By an independent integration of unit disturbances over one period."""
    bodies = system.size
    first = np.eye(bodies)[0]

    def rate(time: float, state: np.ndarray) -> np.ndarray:
        x, v = state.reshape(2, bodies, -1)
        mesh = (1.0 + depth * np.cos(2.0 * np.pi * time / period)) * np.outer(first, x[0])
        return np.concatenate((v, -2.0 * DAMPING * v - system.stiffness @ x - mesh)).ravel()

    start = np.eye(2 * bodies).ravel()
    end = solve_ivp(rate, (0.0, period), start, method="DOP853", rtol=1e-10, atol=1e-12).y[:, -1]
    return float(np.abs(np.linalg.eigvals(end.reshape(2 * bodies, -1))).max())


@pytest.mark.parametrize(
    ("bodies", "link", "depth", "grows"),
    [(1, 0.0, 0.2, True), (1, 0.0, 0.03, False), (30, 0.02, 0.2, True), (30, 30.0, 0.2, False)],
)
def test_a_motion_that_grows_is_named_with_its_multiplier(
    bodies: int, link: float, depth: float, grows: bool
) -> None:
    system = parametric(depth, bodies, link)
    stiffness = np.array(system.stiffness)
    stiffness[0, 0] += 1.0
    square, shape = np.linalg.eigh(stiffness)
    period = np.pi / np.sqrt(square[np.abs(shape[0]).argmax()])
    expected = largest_multiplier(system, depth, period)
    assert (expected > 1.02) == grows
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        motion = harmonic_balance(system, 1.0 / period)
    assert motion.converged
    texts = [str(each.message) for each in caught if issubclass(each.category, ModelWarning)]
    named = [text for text in texts if "unstable-orbit" in text]
    assert len(named) == grows
    for text in named:
        multiplier = float(text.split("multiplier ")[1].split(",")[0])
        assert multiplier == pytest.approx(expected, rel=1e-4)
