"""Every factor of a map does what the system with that factor does."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tribodyn.analysis import parameter_map
from tribodyn.dynamics import Contact, System, steady_state

TURN = 2.0 * np.pi
FACTORS = ("stiffness", "damping", "friction", "error", "gap", "force")


def oscillator(factor=None):
    """Two coordinates, so that friction has a direction of its own; near resonance it separates."""
    k, c, s, e, g, f = (1.3 if name == factor else 1.0 for name in FACTORS)
    contact = Contact(
        [1.0, 0.0],
        lambda p: k * (1.0 + 0.2 * np.cos(TURN * p)),
        damping=0.05 * c,
        gap=0.5 * g,
        error=lambda p: 0.1 * e * np.sin(TURN * p),
        friction=[0.0, 0.2 * s],
    )
    return System(
        np.eye(2), 0.1 * np.eye(2), [[0.0, 0.1], [0.1, 2.0]], [0.5 * f, 0.1 * f], [contact]
    )


@pytest.mark.parametrize("factor", FACTORS)
def test_a_factor_is_the_system_with_it(factor):
    over = ((f"{factor}_scale", [1.0, 1.3]), ("mesh_frequency", [0.5 / TURN, 0.85 / TURN]))
    map_result = parameter_map(oscillator(), over=over, signal="q0", steps=128)
    assert map_result.verdicts() == {"physical": 4}
    for i, changed in enumerate((None, factor)):
        for j, turns in enumerate((0.5, 0.85)):
            orbit = steady_state(oscillator(changed), turns / TURN, steps=512)
            x = orbit.fine.position[:, 0]
            spread = math.sqrt(orbit.fine.mean(x**2) - orbit.fine.mean(x) ** 2)
            assert map_result.rms[i, j] == pytest.approx(spread, rel=1e-4)
    # The factor is felt.
    assert np.abs(map_result.rms[1] / map_result.rms[0] - 1.0).max() > 5e-4
