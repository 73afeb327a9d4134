"""Contacts with their own mesh cycles in one period of the clock."""

import numpy as np
import pytest

from known_machines import CLOCK, PRINTED, two_mesh_system
from tribodyn.dynamics import (
    Contact,
    LoadFriction,
    System,
    natural_modes,
    simulate,
    simulate_ensemble,
    steady_state,
)
from tribodyn.errors import InputError


def pair(cycles=1, offset=0.0, *, lag=0.0, gyroscopic=None) -> System:
    """One contact with separation, friction of two kinds, and a jump at a third of the cycle."""

    def shifted(function):
        return lambda phase: function((phase + lag) % 1.0)

    clock = {"cycles": cycles, "offset": offset}
    events = tuple(sorted((event - lag) % 1.0 for event in (0.0, 1.0 / 3.0)))
    contact = Contact(
        direction=[1.0, 0.4],
        stiffness=shifted(lambda x: 9.0 + np.cos(2 * np.pi * x) + 1.5 * (x < 1.0 / 3.0)),
        damping=0.05,
        error=shifted(lambda x: 0.05 * np.sin(2 * np.pi * x)),
        gap=0.02,
        friction=shifted(lambda x: np.outer(np.sin(2 * np.pi * x), [0.02, -0.05])),
        events=events,
        **clock,
    )
    sliding = LoadFriction(
        [0.1, -0.1], shifted(lambda x: np.cos(2 * np.pi * x)[:, None] * [0.1, 0.02]), 1.0,
        events=events,
    )  # fmt: skip
    damping, stiffness = 0.1 * np.eye(2), np.diag([0.0, 3.0])
    return System(
        np.eye(2), damping, stiffness, [1.0, 0.0], [contact], frictions=[sliding],
        gyroscopic=gyroscopic,
    )  # fmt: skip


@pytest.mark.parametrize("cycles", [2, 5])
def test_several_cycles_in_a_period_are_the_motion_of_one_at_its_own_frequency(cycles):
    motion_of_mesh = steady_state(pair(), 0.3, steps=192)
    motion_of_period = steady_state(pair(cycles), 0.3 / cycles, steps=192)
    for name in ("position", "contact_force", "deflection"):
        expected = np.tile(getattr(motion_of_mesh, name), (cycles, 1))
        np.testing.assert_allclose(getattr(motion_of_period, name), expected, rtol=0, atol=2e-8)


def test_an_offset_is_a_mesh_that_begins_later_in_its_cycle():
    shifted, moved = pair(offset=0.25), pair(lag=0.25)
    left, right = (steady_state(each, 0.3, steps=192) for each in (shifted, moved))
    np.testing.assert_allclose(left.contact_force, right.contact_force, rtol=0, atol=1e-9)


def test_every_engine_follows_the_clock():
    start = ([0.2, 0.1], [0.0, 0.0])
    for method in ("rk4", "dormand-prince", "newmark"):
        motion_of_mesh = simulate(pair(), 0.3, 3, start, steps=384, method=method)
        motion_of_period = simulate(pair(3), 0.1, 1, start, steps=384, method=method)
        np.testing.assert_allclose(
            motion_of_period.position, motion_of_mesh.position, rtol=0, atol=2e-6
        )
    motion_of_mesh = simulate_ensemble(pair(), [0.3, 0.35], 3, start, steps=192)
    motion_of_period = simulate_ensemble(pair(3), [0.1, 0.35 / 3.0], 1, start, steps=192)
    np.testing.assert_allclose(
        motion_of_period.position, motion_of_mesh.position, rtol=0, atol=1e-9
    )


def test_two_meshes_of_a_gearbox_meet_the_printed_motion():
    motion = steady_state(two_mesh_system(), CLOCK, steps=256).fine
    for j, printed in enumerate(PRINTED):
        compression, force = 1e6 * motion.deflection[:, j], motion.contact_force[:, j]
        means = motion.mean(compression), motion.mean(force)
        rms = [
            np.sqrt(motion.mean((x - m) ** 2))
            for x, m in zip((compression, force), means, strict=True)
        ]
        computed = means[0], rms[0], means[1], rms[1], force.max(), force.min()
        np.testing.assert_allclose(computed, printed, rtol=1e-5)


def test_gyroscopic_moments_split_the_frequencies_of_a_disc():
    # x'' + g y' + k x = 0 and y'' - g x' + k y = 0 are solved by a whirl: omega^2 -+ g omega = k.
    disc = System(
        np.eye(2), np.zeros((2, 2)), 4.0 * np.eye(2), [0.0, 0.0],
        gyroscopic=[[0.0, 1.5], [-1.5, 0.0]],
    )  # fmt: skip
    fast = 0.5 * (1.5 + np.sqrt(1.5**2 + 16.0))
    # In its own whirl the position turns with the frequency, without changing its length.
    whirl = simulate(disc, fast / (2 * np.pi), 1, ([1.0, 0.0], [0.0, fast]), steps=256)
    angle = 2 * np.pi * whirl.phase
    expected = np.stack((np.cos(angle), np.sin(angle)), axis=1)
    np.testing.assert_allclose(whirl.position, expected, rtol=0, atol=5e-8)


def test_modes_at_a_phase_of_the_clock_are_those_at_the_phase_of_the_mesh():
    modes_of_mesh = natural_modes(pair(), phase=0.6)
    modes_of_clock = natural_modes(pair(4, 0.2), phase=0.1)
    np.testing.assert_allclose(modes_of_clock.frequency, modes_of_mesh.frequency, rtol=1e-9)


@pytest.mark.parametrize(
    ("arguments", "where"),
    [({"cycles": 0}, "cycles"), ({"cycles": 1.5}, "cycles"), ({"offset": 1.0}, "offset")],
)
def test_clock_of_a_contact_is_checked(arguments, where):
    with pytest.raises(InputError, match=where):
        Contact([1.0], 1.0, **arguments)


def test_friction_of_two_clocks_and_a_matrix_that_does_work_are_refused():
    contacts = [Contact([1.0], 1.0, cycles=2), Contact([1.0], 1.0)]
    rub = LoadFriction([1.0], 0.1, 1.0, contacts=(0, 1))
    with pytest.raises(InputError, match="different mesh cycles"):
        System([[1.0]], [[0.0]], [[0.0]], [0.0], contacts, frictions=[rub])
    with pytest.raises(InputError, match="is not skew"):
        System([[1.0]], [[0.0]], [[0.0]], [0.0], gyroscopic=[[1.0]])
