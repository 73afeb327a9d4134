"""Natural modes with gyroscopic moments against closed forms."""

import numpy as np
import pytest

from tribodyn.dynamics import Contact, System, natural_modes


def tilting_disc(speed, *, stiffness=3e4, damping=0.0, polar=0.03, across=0.016):
    """A disc that tilts about y and z while it spins from y to z."""
    gyroscopic = polar * speed * np.array([[0.0, 1.0], [-1.0, 0.0]])
    return System(
        across * np.eye(2), damping * np.eye(2), stiffness * np.eye(2), np.zeros(2),
        names=["disc_theta_y", "disc_theta_z"], gyroscopic=gyroscopic,
    )  # fmt: skip


def test_whirl_of_a_tilting_disc():
    speed, polar, across, stiffness = 700.0, 0.03, 0.016, 3e4
    modes = natural_modes(tilting_disc(speed))
    half = 0.5 * polar * speed / across
    root = np.sqrt(half**2 + stiffness / across)
    exact = np.array([root - half, root + half]) / (2.0 * np.pi)
    np.testing.assert_allclose(modes.frequency, exact, rtol=1e-12)
    np.testing.assert_allclose(modes.damped_frequency, exact, rtol=1e-9)
    # theta_z over theta_y: the faster mode whirls from y towards z, with the spin
    np.testing.assert_allclose(modes.shape[:, 1] / modes.shape[:, 0], [1j, -1j], rtol=1e-9)
    np.testing.assert_allclose(across * (np.abs(modes.shape) ** 2).sum(axis=1), 1.0)
    np.testing.assert_allclose(modes.kinetic_share, 0.5)
    assert modes.stable


def test_damping_of_whirl_against_the_damped_eigenvalues():
    modes = natural_modes(tilting_disc(700.0, damping=1e-3))
    exact = -modes.eigenvalues.real / np.abs(modes.eigenvalues)
    np.testing.assert_allclose(modes.damping_ratio, exact[::2], rtol=1e-6)
    assert abs(modes.damping_ratio[0] / modes.damping_ratio[1] - 1.0) < 1e-6


def test_a_free_disc_precesses():
    """Without springs it keeps one rigid mode, and nutates with polar/across times its speed."""
    modes = natural_modes(tilting_disc(700.0, stiffness=0.0))
    assert modes.rigid == 1
    np.testing.assert_allclose(modes.frequency[-1], 0.03 / 0.016 * 700.0 / (2.0 * np.pi))


def test_without_speed_nothing_changes():
    still, at_rest = tilting_disc(0.0), natural_modes(tilting_disc(0.0))
    plain = natural_modes(System(still.mass, still.damping, still.stiffness, still.force))
    np.testing.assert_allclose(at_rest.frequency, plain.frequency, rtol=1e-14)
    np.testing.assert_allclose(at_rest.eigenvalues, plain.eigenvalues, rtol=1e-12)


def test_contacts_on_their_own_cycles():
    """Means of contacts whose directions are constant, over 51 and 23 cycles of the clock."""
    contacts = [
        Contact([1.0, -1.0, 0.0], lambda x: 4e8 * (1.0 + 0.3 * np.cos(2 * np.pi * x)),
                damping=lambda x: 900.0 * (1.0 + 0.5 * np.sin(2 * np.pi * x)), cycles=51),
        Contact([0.0, 1.0, -1.0], 6e8, cycles=23, offset=0.3),
    ]  # fmt: skip
    system = System(np.diag([1.0, 2.0, 3.0]), np.zeros((3, 3)), np.zeros((3, 3)), np.zeros(3),
                    contacts)  # fmt: skip
    linear = natural_modes(system).linear
    steps = np.array([[1.0, -1.0, 0.0], [0.0, 1.0, -1.0]])
    exact = 4e8 * np.outer(steps[0], steps[0]) + 6e8 * np.outer(steps[1], steps[1])
    np.testing.assert_allclose(linear.stiffness, exact, rtol=1e-9, atol=1.0)
    np.testing.assert_allclose(linear.damping, 900.0 * np.outer(steps[0], steps[0]), atol=1e-5)
    np.testing.assert_allclose(linear.direction, steps)


def test_directions_that_change_over_the_phase():
    turning = Contact(
        lambda x: np.stack((np.cos(2 * np.pi * x), np.sin(2 * np.pi * x)), axis=1), stiffness=3.0
    )
    system = System(np.eye(2), np.zeros((2, 2)), np.eye(2), np.zeros(2), [turning])
    linear = natural_modes(system).linear
    np.testing.assert_allclose(linear.stiffness, 2.5 * np.eye(2), atol=1e-9)
    assert linear.spring == pytest.approx([3.0])
