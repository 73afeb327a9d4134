"""Motions whose disturbances grow are warned of, on one clock and over phases (Mathieu)."""

from __future__ import annotations

import re
import warnings
from typing import Any

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
    named = grown(system, 1.0 / period)
    assert len(named) == grows
    for multiplier in named:
        assert multiplier == pytest.approx(expected, rel=1e-4)


def grown(system: System, frequency: Any) -> list[float]:
    """What the warnings about the motion of a system say."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        motion = harmonic_balance(system, frequency)
    assert motion.converged
    texts = [str(each.message) for each in caught if issubclass(each.category, ModelWarning)]
    named = [text for text in texts if "unstable-orbit" in text]
    return [float(re.findall(r"(\S+), limit", text)[0]) for text in named]


def two_meshes(cycles: Any, depth: float) -> System:
    """Two bodies on a shaft, each on a mesh whose stiffness varies."""
    meshes = [
        Contact(row, lambda phase, k=k, d=d: k * (1.0 + d * np.cos(2.0 * np.pi * phase)), cycles=of)
        for row, k, d, of in zip(
            [[1.0, 0.0], [0.6, 1.0]], [1.0, 2.3], [depth, 0.3], cycles, strict=True
        )
    ]
    shaft = 0.4 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    return System(np.eye(2), 2.0 * DAMPING * np.eye(2), shaft, [0.5, 0.3], meshes)


def mean_growth(system: System, frequencies: Any, cycles: int) -> float:
    """Mean logarithm of the growth per cycle of the first phase, by an independent integration."""
    rows = np.array([mesh.direction for mesh in system.contacts])

    def rate(time: float, state: np.ndarray) -> np.ndarray:
        x, v = np.split(state, 2)
        pairs = zip(system.contacts, time * np.array(frequencies), strict=True)
        force = rows.T @ (np.array([mesh.stiffness(phase) for mesh, phase in pairs]) * (rows @ x))
        return np.concatenate((v, -2.0 * DAMPING * v - system.stiffness @ x - force))

    times = np.arange(cycles + 1) / frequencies[0]
    start, options = np.array([1.0, 0.3, -0.2, 0.5]), {"rtol": 1e-9, "atol": 1e-30}
    path = solve_ivp(rate, times[[0, -1]], start, "DOP853", times, **options).y
    logs, place = np.diff(np.log(np.linalg.norm(path, axis=0))), np.arange(0.5, cycles) / cycles
    return float(np.average(logs, weights=np.exp(-1.0 / (place * (1.0 - place)))))


@pytest.mark.parametrize("depth", [0.3, 0.02])
def test_growth_over_phases_is_that_of_their_common_period(depth: float) -> None:
    first = 0.384  # twice a natural frequency
    whole = grown(two_meshes((24, 17), depth), first / 24)
    apart = grown(two_meshes(((1, 0), (0, 1)), depth), (first, first * 17 / 24))
    assert len(whole) == len(apart) == (depth > 0.1)
    for multiplier, growth in zip(whole, apart, strict=True):
        assert growth == pytest.approx(multiplier ** (1 / 24), rel=1e-4)


@pytest.mark.parametrize("ratio", [np.sqrt(0.5), 0.031 * np.pi])
def test_growth_over_phases_is_that_of_an_integration_over_time(ratio: float) -> None:
    system, frequencies = two_meshes(((1, 0), (0, 1)), 0.3), (0.384, 0.384 * ratio)
    (growth,) = grown(system, frequencies)
    assert np.log(growth) == pytest.approx(mean_growth(system, frequencies, 300), rel=3e-3)
