"""Eigenvectors do not depend on the basis or the signs in which a solver returns them."""

import numpy as np
import pytest
from scipy.fft import next_fast_len
from scipy.linalg import eigh
from scipy.stats import ortho_group, unitary_group

from tribodyn.arrays.linear_algebra import (
    fast_length,
    groups_of_equal,
    leading,
    leading_eigenvalues,
    modes_of,
    standard_rotation,
)
from tribodyn.dynamics import Contact, System, natural_modes
from tribodyn.machine import planetary_modes, planetary_plane_model


def test_equal_values_are_grouped_whatever_their_rounding():
    values = np.array([0.0, 1e-16, 2.0, 2.0 + 1e-11, 2.1, 2e3])
    assert [group.tolist() for group in groups_of_equal(values)] == [[0, 1], [2, 3], [4], [5]]


@pytest.mark.parametrize("mixed", [ortho_group, unitary_group])
def test_any_basis_gives_the_same_rows(mixed):
    values = np.array([1.0, 1.0, 1.0, 2.0, 3.0, 3.0])
    rows = mixed.rvs(9, random_state=1)[:6]
    rows[0, 3:5] = 0.5  # two columns of equal size
    expected = standard_rotation(values, rows) @ rows
    for seed in range(5):
        turn = np.zeros((6, 6), rows.dtype)
        for group in groups_of_equal(values):
            one = mixed.rvs(group.size, random_state=seed) if group.size > 1 else -np.eye(1)
            turn[np.ix_(group, group)] = one
        other = turn @ rows
        np.testing.assert_allclose(standard_rotation(values, other) @ other, expected, atol=1e-12)


def test_of_equal_entries_the_first_leads():
    rows = np.array([[0.5, -1.0, 1.0 + 1e-12], [0.0, 0.0, -2.0]])
    assert leading(rows).tolist() == [[-1.0], [-2.0]]


def test_modes_are_those_of_lapack_and_of_unit_mass():
    random = np.random.default_rng(3)
    roots = random.standard_normal((2, 12, 12))
    mass = roots[0] @ roots[0].T + np.eye(12)
    stiffness = roots[1, :, :9] @ roots[1, :, :9].T  # three free motions
    squares, shapes = modes_of(stiffness, mass)
    np.testing.assert_allclose(squares, eigh(stiffness, mass)[0], atol=1e-12 * squares[-1])
    np.testing.assert_allclose(shapes.T @ mass @ shapes, np.eye(12), atol=1e-12)
    strained = shapes.T @ stiffness @ shapes
    np.testing.assert_allclose(strained, np.diag(squares), atol=1e-11 * squares[-1])


@pytest.mark.parametrize("size", [3, 40])
def test_leading_eigenvalues_are_those_of_the_whole_matrix(size):
    random = np.random.default_rng(size)
    matrix = random.standard_normal((size, size)) / np.arange(1, size + 1)
    values = np.linalg.eigvals(matrix)
    expected = values[np.argsort(-np.abs(values), kind="stable")][:2]
    products = []

    def product(vector):
        products.append(vector)
        return matrix @ vector

    found = leading_eigenvalues(product, random.standard_normal(size), 2, 1e-9)
    np.testing.assert_allclose(np.abs(found), np.abs(expected), rtol=1e-8)
    assert len(products) <= min(size, 30)


def test_an_invariant_start_gives_its_eigenvalues():
    found = leading_eigenvalues(lambda vector: 2.0 * vector, np.ones(5), 1, 1e-9)
    np.testing.assert_allclose(found, 2.0)


def test_fast_lengths_are_those_of_scipy():
    lengths = range(1, 2000)
    assert [fast_length(n) for n in lengths] == [next_fast_len(n, real=True) for n in lengths]


def _polygon(order):
    """Three equal masses on equal springs, in some order: two modes have one frequency."""
    stiffness = 3.0 * np.eye(3) - 1.0
    eye = np.eye(3)[order]
    contact = Contact(eye.sum(axis=0), stiffness=0.5)
    return System(
        np.eye(3), np.zeros((3, 3)), eye @ stiffness @ eye.T + np.eye(3), np.zeros(3), [contact]
    )


def test_modes_of_a_symmetric_system_have_one_basis():
    expected = natural_modes(_polygon([0, 1, 2]))
    again = natural_modes(_polygon([2, 0, 1]))
    np.testing.assert_allclose(again.shape, expected.shape, atol=1e-9)
    assert np.all(expected.shape.max(axis=1) >= -expected.shape.min(axis=1) - 1e-9)


def test_modes_of_planets_do_not_depend_on_the_rounding_of_the_matrices():
    data = {f"{part}_mass": 2.0 for part in ("carrier", "ring", "sun", "planet")}
    data |= {f"{part}_inertia": 2.5 for part in ("carrier", "ring", "sun", "planet")}
    data |= {f"{part}_mesh_stiffness": 5e8 for part in ("sun", "ring")}
    data |= {f"{part}_support": 1e8 for part in ("carrier", "ring", "sun")}
    data |= {f"{part}_pressure_angle": np.radians(24.6) for part in ("sun", "ring")}
    data |= {"planets": 4, "pin_stiffness": 1e8, "ring_torsional_support": 1e9}
    for speed in (0.0, 30.0):
        stage = planetary_plane_model(**data, carrier_speed=speed)
        expected = planetary_modes(stage)
        noise = 1e-15 * np.random.default_rng(1).normal(size=(stage.size, stage.size))
        stiffness = np.asarray(stage.stiffness) * (1.0 + noise + noise.T)
        moved = planetary_modes(
            System(
                stage.mass, stage.damping, stiffness, stage.force, stage.contacts,
                names=stage.names, gyroscopic=stage.gyroscopic,
            )
        )  # fmt: skip
        assert moved.types == expected.types
        np.testing.assert_allclose(moved.shape, expected.shape, atol=1e-6)
