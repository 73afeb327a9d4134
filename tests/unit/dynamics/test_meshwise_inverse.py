"""The approximate inverse over several phases: exact for one varying mesh, few vectors for more."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tribodyn.dynamics import Contact, System
from tribodyn.dynamics.harmonic.newton import newton, solve_linear
from tribodyn.dynamics.harmonic.phase_balance import _Search
from tribodyn.dynamics.harmonic.phase_response import phase_response
from tribodyn.dynamics.harmonic.phase_rows import PhaseRows

FREQUENCIES = np.array([1000.0, 313.0])
JUMPS = (0.0, 0.6)


def square(high):
    """Stiffness with a jump at 0.6 of the mesh cycle."""

    return lambda x: np.where(np.asarray(x) % 1.0 < 0.6, high, 2e8)


def search_of(first, second):
    """Two meshes in a row with stiffnesses over a cycle."""
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
    return _Search.of(system, FREQUENCIES)


def search_motion(points):
    """Motion with smooth stiffnesses on grids of the meshes."""
    search = search_of(*(lambda x, a=a: 2e8 * (1 + a * np.cos(2 * np.pi * x)) for a in (0.2, 0.3)))
    residual = search.residual(points)
    solution = newton(residual, search.linear(residual), 1e-10)
    return phase_response(search.rows, residual, solution.state, points=(32, 32))


def state_of(first, second, shape=(16, 12)):
    """The two meshes on grids with the same points, at rest."""
    search = search_of(first, second)
    residual = search.residual((shape, shape))
    return residual, residual.at(search.still(residual))


def motion(residual):
    """Motion of the lines that have a phase."""
    random, parts = np.random.default_rng(2), []
    for part in residual.parts:
        lines = part.grid.spectrum(random.normal(size=(part.grid.size, part.loaded.shape[1])))
        lines[part.grid.unpaired] = 0.0
        parts.append(part.grid.values(lines))
    return residual.joined(parts)


@pytest.mark.parametrize("shape", [(16, 12), (12, 16), (10, 7)])
@pytest.mark.parametrize("number", [0, 1])
def test_it_inverts_what_varies_over_one_phase(number, shape):
    laws = [2e8, 2e8]
    laws[number] = lambda x: 2e8 * (1 + 0.4 * np.cos(2 * np.pi * x) + 0.2 * np.sin(4 * np.pi * x))
    residual, state = state_of(*laws, shape=shape)
    y = motion(residual)
    image = residual.derivative(state)(y)
    assert np.linalg.norm(image - y) > 0.1 * np.linalg.norm(y)
    inverse = residual.nearly(state)(image)
    np.testing.assert_allclose(
        residual.split(inverse)[number], residual.split(y)[number], atol=1e-9
    )


def test_few_vectors_solve_for_meshes_that_jump():
    residual, state = state_of(square(4e8), square(4.5e8))
    right = motion(residual)
    product, nearly = residual.derivative(state), residual.nearly(state)
    plain, many = solve_linear(product, right, 1e-8, 200)
    solved, few = solve_linear(lambda x: product(nearly(x)), right, 1e-8, 200)
    np.testing.assert_allclose(nearly(solved), plain, atol=1e-5 * np.abs(plain).max())
    assert few < 0.5 * many


def test_a_mesh_needs_few_points_over_the_phases_of_others():
    fine, few = (search_motion(points) for points in (((32, 32), (32, 32)), ((32, 8), (8, 32))))
    lines = fine.lines(), few.lines()
    for each in lines:
        assert each.frequency == pytest.approx(each.numbers @ FREQUENCIES, abs=1e-9)
    at = np.linspace(0.0, 0.05, 300)
    forces = [each.at(at).contact_force for each in (fine, few)]
    assert np.abs(forces[1] - forces[0]).max() < 1e-3 * np.ptp(forces[0])


def test_the_derivative_takes_over_what_the_inverse_has_moved():
    residual, state = state_of(square(4e8), square(4.5e8))
    right = motion(residual)
    product, nearly = residual.preconditioned(state)
    image = residual.derivative(state)(nearly(right))
    np.testing.assert_allclose(product(right), image, atol=1e-12 * np.abs(image).max())


def test_a_part_has_the_entries_of_a_system_with_its_contacts_alone():
    search = search_of(square(4e8), square(4.5e8))
    points = np.random.default_rng(3).random((40, 2))
    for part in search.parts:
        (number,) = part.members
        alone = replace(search.rows.system, contacts=[search.rows.system.contacts[number]])
        expected = PhaseRows.of(replace(alone, force=np.zeros(4)), FREQUENCIES)
        for name, values in expected.nodes(points)._asdict().items():
            np.testing.assert_array_equal(getattr(part.rows.nodes(points), name), values)
        for mine, other in zip(part.rows.meshes, expected.meshes, strict=True):
            np.testing.assert_array_equal(mine.jumps, other.jumps)
        weight = [rows.means.nodes.weight for rows in (part.rows, expected)]
        mean = [
            np.einsum("rs,rsj->j", share, rows.means.nodes.stiffness)
            for share, rows in zip(weight, (part.rows, expected), strict=True)
        ]
        np.testing.assert_allclose(mean[0], mean[1], rtol=1e-12)
