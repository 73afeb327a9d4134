"""The approximate inverse over several phases: exact for one varying mesh, few vectors for more."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn.dynamics import Contact, System
from tribodyn.dynamics.harmonic.meshwise_inverse import MeshwiseInverse
from tribodyn.dynamics.harmonic.newton import solve_linear
from tribodyn.dynamics.harmonic.phase_balance import _Search

FREQUENCIES = np.array([1000.0, 313.0])
JUMPS = (0.0, 0.6)


def square(high):
    """Stiffness with a jump at 0.6 of the mesh cycle."""

    return lambda x: np.where(np.asarray(x) % 1.0 < 0.6, high, 2e8)


def state_of(first, second, shape=(16, 12)):
    """Two meshes in a row with stiffnesses over a cycle, on a grid, at rest."""
    contacts = [
        Contact([1.0, 1.0, 0.0, 0.0], first, 300.0, 0.0, 0.0, cycles=(1, 0), events=JUMPS),
        Contact(
            [0.0, 0.0, 1.0, 1.0], second, 400.0, 0.0, 0.0, cycles=(0, 1), offset=0.3, events=JUMPS
        ),
    ]  # fmt: skip
    twist = np.array([0.0, 1.0, -1.4, 0.0])
    system = System(
        np.diag([1.0, 2.0, 1.5, 3.0]), 20.0 * np.outer(twist, twist), 4e7 * np.outer(twist, twist),
        [2000.0, 0.0, 0.0, -2800.0], contacts,
    )  # fmt: skip
    search = _Search.of(system, FREQUENCIES)
    residual = search.residual(shape)
    return residual, residual.at(np.tile(search.still, (residual.grid.size, 1)))


def motion(residual, state):
    """Motion of the lines that have a phase."""
    y = np.random.default_rng(2).normal(size=state.y.shape)
    lines = residual.grid.spectrum(y)
    lines[residual.grid.unpaired] = 0.0
    return residual.grid.values(lines)


@pytest.mark.parametrize("shape", [(16, 12), (12, 16), (10, 7)])
@pytest.mark.parametrize("number", [0, 1])
def test_it_inverts_what_varies_over_one_phase(number, shape):
    laws = [2e8, 2e8]
    laws[number] = lambda x: 2e8 * (1 + 0.4 * np.cos(2 * np.pi * x) + 0.2 * np.sin(4 * np.pi * x))
    residual, state = state_of(*laws, shape=shape)
    y = motion(residual, state)
    image = residual.derivative(state)(y)
    assert np.linalg.norm(image - y) > 0.1 * np.linalg.norm(y)
    np.testing.assert_allclose(MeshwiseInverse(residual, state)(image), y, atol=1e-9)


def test_few_vectors_solve_for_meshes_that_jump():
    residual, state = state_of(square(4e8), square(4.5e8))
    right = motion(residual, state)
    product, nearly = residual.derivative(state), MeshwiseInverse(residual, state)
    plain, many = solve_linear(product, right, 1e-8, 200)
    solved, few = solve_linear(lambda x: product(nearly(x)), right, 1e-8, 200)
    np.testing.assert_allclose(nearly(solved), plain, atol=1e-5 * np.abs(plain).max())
    assert few < 0.5 * many
