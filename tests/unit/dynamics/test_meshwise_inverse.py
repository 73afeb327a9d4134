"""The approximate inverse over phases is exact where a stiffness varies over one phase alone."""

from __future__ import annotations

import numpy as np

from tribodyn.dynamics import Contact, System
from tribodyn.dynamics.equations.phases import read_frequencies
from tribodyn.dynamics.harmonic.meshwise_inverse import MeshwiseInverse
from tribodyn.dynamics.harmonic.newton import force_change
from tribodyn.dynamics.harmonic.phase_balance import _Search


def test_stiffness_and_damping_over_one_phase_are_inverted_to_single_precision():
    """Two contacts on one grid, of which the second feels but does not vary."""
    first = Contact(
        [1.0, -1.0, 0.0], lambda x: 2e8 * (1.0 + 0.3 * np.cos(2.0 * np.pi * np.asarray(x))),
        lambda x: 2000.0 * (1.0 + 0.4 * np.sin(2.0 * np.pi * np.asarray(x))), cycles=(1, 0),
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
    lines = part.grid.spectrum(change(y))[..., None]
    product = y - part.grid.values((part.receptances @ lines)[..., 0])
    assert np.abs(product - y).max() > 0.1
    assert np.abs(inverse(product) - y).max() < 1e-5 * np.abs(y).max()
