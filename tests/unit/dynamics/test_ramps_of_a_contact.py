"""A contact with ramps against one contact for each of them: forces, statics, motions, modes."""

from dataclasses import replace

import numpy as np
import pytest

from known_laws import constant_law, wavy_law
from tribodyn.dynamics import (
    Contact,
    LoadFriction,
    System,
    harmonic_balance,
    law_contact,
    law_contacts,
    natural_modes,
    simulate,
)
from tribodyn.dynamics.equations.compiled import sample_system
from tribodyn.dynamics.equations.motion import forces
from tribodyn.dynamics.equations.orbit_coordinates import static_start
from tribodyn.dynamics.equations.ramps import split_ramps
from tribodyn.errors import InputError

#: Position and velocity after which the back flanks touch too [m], [m/s].
START = ([3e-5, 0.0], [2.0, 0.0])


def machine(contacts, friction=False):
    """Two coordinates with a force law, and a second mesh on the same clock."""
    second = Contact(
        [0.2, 1.0], 4e8, damping=100.0, error=lambda p: 1e-6 * np.cos(2 * np.pi * p), cycles=2
    )
    bundle = tuple(range(len(contacts)))
    rub = [LoadFriction([0.1, -0.4], [0.05, 0.01], load=1500.0, contacts=bundle)]
    frictions = rub if friction else ()
    matrices = np.diag([0.2, 0.3]), 50.0 * np.eye(2), np.diag([1e6, 3e7])
    return System(*matrices, [2000.0, -300.0], [*contacts, second], frictions=frictions)


def base(**changes):
    push = lambda p: np.stack((0.02 * np.cos(2 * np.pi * p), 0.03 + 0 * p), axis=1)  # noqa: E731
    options = {"damping": 300.0, "gap": 2e-5, "events": (0.0, 0.25), "cycles": 3}
    return Contact([1.0, -0.5], 0.0, friction=push, **{**options, **changes})


def systems(friction=False, **changes):
    law = wavy_law(6)
    single = machine([law_contact(base(**changes), law)], friction)
    bundle = machine(law_contacts(base(**changes), law), friction)
    return single, bundle, len(bundle.contacts) - 1


@pytest.mark.parametrize("friction", [False, True])
def test_forces_and_statics_are_those_of_one_contact_for_each_ramp(friction):
    single, bundle, count = systems(friction)
    one, many = sample_system(single, 32), sample_system(bundle, 32)
    generator = np.random.default_rng(0)
    q = 3e-5 * generator.normal(size=(*one.nodes.phase.shape, 2))
    v = generator.normal(size=q.shape)
    a, b = (forces(s.system, s.nodes, 500.0, q, v) for s in (one, many))
    assert a.contact.min() < 0.0 < a.contact.max()
    assert a.contact[..., 0] == pytest.approx(b.contact[..., :count].sum(axis=-1), rel=1e-9)
    assert a.acceleration == pytest.approx(b.acceleration, rel=1e-9)
    assert static_start(one) == pytest.approx(static_start(many), rel=1e-9)


@pytest.mark.parametrize("frequency", [300.0, 1500.0])
def test_steady_motions_are_those_of_one_contact_for_each_ramp(frequency):
    single, bundle, count = systems(friction=True)
    one, many = (harmonic_balance(system, frequency, steps=128) for system in (single, bundle))
    assert one.converged
    assert many.converged
    assert one.position == pytest.approx(many.position, rel=1e-9, abs=1e-15)
    total = many.contact_force[:, :count].sum(axis=1)
    assert one.contact_force[:, 0] == pytest.approx(total, rel=1e-9)


def test_transients_through_the_backlash_are_those_of_one_contact_for_each_ramp():
    single, bundle, _ = systems()
    one, many = (simulate(s, 300.0, 5, START, steps=256, method="modal") for s in (single, bundle))
    assert one.deflection[:, 0].min() < -2e-5 < 2e-5 < one.deflection[:, 0].max()
    size = np.abs(many.position).max()
    assert one.position == pytest.approx(many.position, abs=1e-9 * size)


def test_modes_are_those_of_the_ramps_that_carry_at_rest():
    single, bundle, _ = systems()
    assert natural_modes(single).frequency == pytest.approx(natural_modes(bundle).frequency)


def test_ramps_of_numbers_are_split_into_contacts():
    law = constant_law([0.0, 1e-5], [2e8, 1e8])
    single = machine([replace(base(), stiffness=2e8, ramp_stiffness=[1e8], ramp_gap=[3e-5])])
    parts, bundle = split_ramps(single), machine(law_contacts(base(), law))
    assert [each.damping for each in parts.contacts] == [300.0, 0.0, 100.0]
    one, many = (sample_system(system, 16).nodes for system in (parts, bundle))
    assert one.gap == pytest.approx(many.gap, rel=1e-12)
    assert one.stiffness == pytest.approx(many.stiffness, rel=1e-12)
    friction = machine([single.contacts[0]], friction=True)
    assert split_ramps(friction).frictions[0].contacts == (0, 1)


def test_engines_without_ramps_and_wrong_ramps_are_refused():
    single, _, count = systems()
    with pytest.raises(InputError, match=f"contact 0 has a force law of {count - 1} ramps"):
        simulate(single, 300.0, 1, START, method="rk4")
    wrong = machine([base(ramp_stiffness=[1e8, 2e8], ramp_gap=[3e-5])])
    with pytest.raises(InputError, match="2 stiffnesses and 1 gaps"):
        harmonic_balance(wrong, 300.0)
    wrong = machine([base(ramp_stiffness=[-1e8], ramp_gap=[3e-5])])
    with pytest.raises(InputError, match="ramp_stiffness = -1e"):
        harmonic_balance(wrong, 300.0)


def test_directions_of_the_ramps_of_one_law_are_evaluated_once():
    """As many calls as for one ramp, and the rows of ramps with functions of their own."""
    calls = []

    def push(phase):
        calls.append(phase.size)
        return np.stack((0.02 * np.cos(2 * np.pi * phase), 0.03 + 0 * phase), axis=1)

    contacts = law_contacts(replace(base(), friction=push), wavy_law(6))
    rows = sample_system(machine(contacts), 32).nodes
    together = len(calls)
    alone = [replace(c, friction=lambda p, c=c: c.friction(p)) for c in contacts]
    expected = sample_system(machine(alone), 32).nodes
    np.testing.assert_array_equal(rows.force_direction, expected.force_direction)
    assert together * len(contacts) == len(calls) - together > together
