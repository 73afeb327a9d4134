"""The approximate inverse over phases is exact where a stiffness varies over one phase alone."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn.dynamics import Contact, System
from tribodyn.dynamics.equations.phases import read_frequencies
from tribodyn.dynamics.harmonic.meshwise_inverse import MeshwiseInverse
from tribodyn.dynamics.harmonic.newton import force_change
from tribodyn.dynamics.harmonic.phase_balance import _Search


def _jumping(phase):
    phase = np.asarray(phase) % 1.0
    return np.where((phase >= 0.2) & (phase < 0.65), 2.6e8, 1.6e8)


def _smooth(phase):
    return 2e8 * (1.0 + 0.3 * np.cos(2.0 * np.pi * np.asarray(phase)))


@pytest.mark.parametrize(("stiffness", "near"), [(_smooth, 1e-5), (_jumping, 1e-4)])
def test_stiffness_and_damping_over_one_phase_are_inverted(stiffness, near):
    """Two contacts on one grid, of which the second feels but does not vary."""
    first = Contact(
        [1.0, -1.0, 0.0], stiffness,
        lambda x: 2000.0 * (1.0 + 0.4 * np.sin(2.0 * np.pi * np.asarray(x))), cycles=(1, 0),
        events=(0.2, 0.65),
    )  # fmt: skip
    second = Contact([0.0, 1.0, -1.0], 2.4e8, 2000.0, cycles=(1, 0))
    other = Contact([1.0, 0.0, -1.0], 1e8, 500.0, lambda x: 1e-6 * np.cos(x), cycles=(0, 1))
    masses, ground = np.diag([8.0, 12.0, 3.0]), np.diag([0.0, 0.0, 2e8])
    contacts = [first, second, other]
    system = System(masses, np.diag([300.0] * 3), ground, [5e4, 0.0, 0.0], contacts)
    search = _Search.of(system, read_frequencies((200.0, 311.7), system.phases))
    residual = search.residual(((12, 6), (6, 12)))
    state, part = residual.at(search.linear(residual)), residual.parts[0]
    change, inverse = force_change(part, state.each[0]), MeshwiseInverse(part, state.each[0])
    y = np.random.default_rng(1).standard_normal((part.grid.size, 2))
    y = part.grid.values(np.where(part.grid.unpaired[:, None], 0.0, part.grid.spectrum(y)))
    lines = part.grid.spectrum(change(y))[..., None]
    product = y - part.grid.values((part.receptances @ lines)[..., 0])
    assert np.abs(product - y).max() > 0.1
    assert np.abs(inverse(product) - y).max() < near * np.abs(y).max()
