"""The matrix of an orbit that keeps its contact, where Newton's method took it over."""

import numpy as np
import pytest

from tribodyn.dynamics import Contact, System, steady_state
from tribodyn.dynamics.equations.nodes import sampled
from tribodyn.dynamics.equations.step_limit import largest_rate, rate_on_grid


def _pressed(stiffness: object = 9.0) -> System:
    contact = Contact(
        [1.0],
        stiffness=stiffness,
        damping=0.4,
        gap=0.05,
        error=lambda phase: 0.02 * np.cos(2.0 * np.pi * phase),
    )
    return System([[1.0]], [[0.0]], [[0.0]], [1.0], [contact])


def test_multipliers_are_those_of_the_damped_spring() -> None:
    orbit = steady_state(_pressed(), 0.7, steps=512)
    root = -0.2 + 1j * np.sqrt(9.0 - 0.04)
    exact = np.exp(root / 0.7)
    assert orbit.converged
    assert orbit.contact_force.min() > 0.0
    multiplier = orbit.floquet_multipliers[np.argmax(orbit.floquet_multipliers.imag)]
    assert multiplier == pytest.approx(exact if exact.imag > 0 else np.conj(exact), abs=1e-6)


def test_rate_is_that_of_the_whole_grid() -> None:
    system = _pressed(lambda phase: 9.0 + 3.0 * np.cos(2.0 * np.pi * phase))
    assert rate_on_grid(system, 256) == largest_rate(system, sampled(system, 256)[1])
