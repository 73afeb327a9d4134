"""Natural modes against closed forms, and what must hold for every symmetric system."""

import math

import numpy as np
import pytest
from scipy.linalg import ldl

from known_systems import reference_system
from tribodyn.dynamics import Contact, System, law_contacts, natural_modes, torsional
from tribodyn.dynamics.linear.linear_system import linear_system
from tribodyn.errors import InputError
from tribodyn.mesh import MeshForceLaw, phase_grid


def chain(springs, masses, force=None, damping=None):
    """Masses in a row; the first spring holds the first mass to the ground, zero if it is free."""
    size = len(masses)
    stiffness = np.zeros((size, size))
    stiffness[0, 0] = springs[0]
    for i, spring in enumerate(springs[1:]):
        stiffness[i : i + 2, i : i + 2] += spring * np.array([[1.0, -1.0], [-1.0, 1.0]])
    damper = np.zeros((size, size)) if damping is None else damping
    return System(np.diag(masses), damper, stiffness, np.zeros(size) if force is None else force)


def test_two_discs_on_a_shaft():
    inertia, spring = (2e-3, 5e-3), 4e4
    modes = natural_modes(chain([0.0, spring], inertia))
    exact = math.sqrt(spring * (1.0 / inertia[0] + 1.0 / inertia[1])) / (2.0 * math.pi)
    assert modes.frequency[0] == 0.0
    assert modes.rigid == 1
    assert modes.frequency[1] == pytest.approx(exact, rel=1e-13)
    # the lighter disc moves more, against the other
    assert modes.shape[1, 0] / modes.shape[1, 1] == pytest.approx(-inertia[1] / inertia[0])


@pytest.mark.parametrize("free", [True, False])
def test_row_of_equal_masses(free):
    size, spring, mass = 7, 3e6, 0.4
    modes = natural_modes(chain([0.0 if free else spring, *[spring] * (size - 1)], [mass] * size))
    k = np.arange(size)
    angle = k * np.pi / (2 * size) if free else (2 * k + 1) * np.pi / (2 * (2 * size + 1))
    exact = 2.0 * np.sqrt(spring / mass) * np.sin(angle) / (2.0 * np.pi)
    np.testing.assert_allclose(modes.frequency, exact, rtol=1e-12, atol=1e-12)


def test_mesh_mode_of_the_torsional_pair():
    class Mesh:
        event_phases = (0.0, 0.3)

        @staticmethod
        def stiffness(phase):
            return np.where(phase < 0.3, 4e8, 3e8)

        @staticmethod
        def friction_sum(phase):
            return 0.0 * phase

        friction_moment_pinion = friction_moment_wheel = friction_sum

    inertia, radius = (5e-4, 1.3e-3), (0.03, 0.05)
    system = torsional(
        Mesh, moment_of_inertia=inertia, base_radius=radius, torque=(90.0, 150.0),
        mesh_damping=700.0, backlash=1e-4,
    )  # fmt: skip
    mass = inertia[0] * inertia[1] / (inertia[0] * radius[1] ** 2 + inertia[1] * radius[0] ** 2)
    for phase, stiffness in (("mean", 3.3e8), (0.0, 4e8), (0.1, 4e8), (0.3, 3e8), (0.999, 3e8)):
        modes = natural_modes(system, phase=phase)
        rate = math.sqrt(stiffness / mass)
        assert modes.frequency[1] == pytest.approx(rate / (2.0 * math.pi), rel=1e-12)
        assert modes.damping_ratio[1] == pytest.approx(700.0 / (2.0 * rate * mass), rel=1e-12)
        assert math.isnan(modes.damping_ratio[0])
        assert modes.contact_share.tolist() == pytest.approx([0.0, 1.0])


def test_first_mode_of_the_reference_pair_along_the_line_of_action():
    modes = natural_modes(reference_system(0.1))
    assert modes.frequency[1] == pytest.approx(5276.5, abs=0.05)
    assert modes.elements == ("pinion_x", "pinion_y", "wheel_x", "wheel_y", "contact 0")
    kinds = modes.strain_by_kind()
    np.testing.assert_allclose(kinds["mesh"] + kinds["support"], [0, 1, 1, 1, 1, 1], rtol=1e-9)
    assert not kinds["shaft"].any()


def test_modes_are_orthogonal_and_their_energies_add_up():
    system = reference_system()
    modes = natural_modes(system)
    mass, stiffness = modes.linear.mass, modes.linear.stiffness
    squares = (2.0 * np.pi * modes.frequency) ** 2
    np.testing.assert_allclose(modes.shape @ mass @ modes.shape.T, np.eye(6), atol=1e-10)
    spread = modes.shape @ stiffness @ modes.shape.T
    np.testing.assert_allclose(spread, np.diag(squares), atol=1e-9 * squares.max())
    np.testing.assert_allclose(modes.kinetic_share.sum(axis=1), 1.0, rtol=1e-12)
    np.testing.assert_allclose(modes.strain_share.sum(axis=1), [0.0, 1, 1, 1, 1, 1], rtol=1e-10)
    np.testing.assert_allclose(sum(modes.body_share().values()), 1.0, rtol=1e-12)
    assert modes.strain_share.min() == 0.0


def test_modes_across_a_contact_do_not_strain_it():
    """Bodies whose supports are tuned alike: of six modes all but one move across the contact."""
    random = np.random.default_rng(0)
    mass = np.diag(random.uniform(0.5, 3.0, 6))
    contact = Contact(random.normal(size=6), 3e8)
    for stiffness in 10.0 ** random.uniform(7.0, 9.0, 20):
        modes = natural_modes(System(mass, 0.0 * mass, stiffness * mass, np.zeros(6), [contact]))
        assert modes.contact_share.min() >= 0.0
        np.testing.assert_allclose(modes.contact_share[:5], 0.0, rtol=0, atol=1e-9)


def test_rayleigh_quotient_has_its_stationary_value_at_a_mode():
    modes = natural_modes(reference_system())
    mass, stiffness = modes.linear.mass, modes.linear.stiffness
    around = np.random.default_rng(1).normal(size=6)
    around /= math.sqrt(around @ mass @ around)

    def quotient(x):
        return (x @ stiffness @ x) / (x @ mass @ x)

    exact = quotient(modes.shape[1])
    changes = [quotient(modes.shape[1] + size * around) - exact for size in (1e-3, 1e-4)]
    assert changes[0] / changes[1] == pytest.approx(100.0, rel=0.1)


def test_sturm_count_of_modes_below_a_frequency():
    modes = natural_modes(reference_system())
    for hertz in (100.0, 6000.0, 9200.0, 9500.0, 11500.0, 20000.0):
        matrix = modes.linear.stiffness - (2.0 * np.pi * hertz) ** 2 * modes.linear.mass
        blocks = ldl(matrix)[1]
        below = int(np.count_nonzero(np.linalg.eigvalsh(blocks) < 0.0))
        assert below == int(np.count_nonzero(modes.frequency < hertz))


def test_complex_modes_of_one_mass():
    mass, spring, damper = 2.0, 5e4, 60.0
    modes = natural_modes(System([[mass]], [[damper]], [[spring]], [0.0]))
    rate, ratio = math.sqrt(spring / mass), damper / (2.0 * math.sqrt(spring * mass))
    swing = rate * complex(-ratio, math.sqrt(1.0 - ratio**2))
    assert modes.damping_ratio[0] == pytest.approx(ratio, rel=1e-12)
    assert sorted(modes.eigenvalues, key=lambda each: each.imag) == pytest.approx(
        [swing.conjugate(), swing], rel=1e-12
    )
    assert modes.damped_frequency == pytest.approx([swing.imag / (2.0 * math.pi)], rel=1e-12)
    heavy = natural_modes(System([[mass]], [[1000.0]], [[spring]], [0.0]))
    root = math.sqrt(1000.0**2 - 4.0 * mass * spring)
    exact = [(-1000.0 + sign * root) / (2.0 * mass) for sign in (1.0, -1.0)]
    assert heavy.eigenvalues.real == pytest.approx(exact, rel=1e-12)
    assert heavy.damped_frequency.size == 0


def test_complex_modes_solve_the_damped_problem():
    modes = natural_modes(reference_system(0.1), friction=True)
    linear = modes.linear
    damper = linear.damping + linear.friction_damping
    spring = linear.stiffness + linear.friction_stiffness
    for value, shape in zip(modes.eigenvalues, modes.complex_shape, strict=True):
        terms = (value**2 * linear.mass @ shape, value * damper @ shape, spring @ shape)
        assert np.abs(sum(terms)).max() <= 1e-10 * np.abs(spring).max()
    assert modes.eigenvalues.sum().real == pytest.approx(
        -np.trace(np.linalg.solve(linear.mass, damper)), rel=1e-12
    )
    assert modes.stable


def test_proportional_damping_leaves_the_shapes():
    springs, masses = [2e5, 3e5, 1e5], [1.0, 2.0, 0.5]
    stiffness = np.asarray(chain(springs, masses).stiffness)
    modes = natural_modes(chain(springs, masses, damping=1e-5 * stiffness))
    rate = 2.0 * np.pi * modes.frequency
    ratio = 0.5e-5 * rate
    np.testing.assert_allclose(modes.damping_ratio, ratio, rtol=1e-11)
    damped = rate * np.sqrt(1.0 - ratio**2) / (2.0 * np.pi)
    np.testing.assert_allclose(modes.damped_frequency, damped, rtol=1e-11)


def test_friction_couples_two_modes_into_flutter():
    # x'' + 4 x + 0.5 y = mu N, y'' + 0.5 x + y = -N, N = 2 y: modes meet at mu = 1/2
    def grows(friction):
        contact = Contact([0.0, 1.0], stiffness=2.0, friction=[-friction, 0.0])
        system = System(np.eye(2), np.zeros((2, 2)), [[4.0, 0.5], [0.5, 1.0]], [0, 1], [contact])
        return not natural_modes(system, friction=True).stable

    assert not grows(0.499)
    assert grows(0.501)
    assert not grows(-0.6)


@pytest.mark.parametrize(("force", "stiffness"), [(1000.0, 2e8), (5000.0, 3e8)])
def test_ramps_of_a_force_law_that_are_closed_at_rest_count(force, stiffness):
    places, ramps = np.tile([0.0, 1e-5], (17, 1)), np.tile([2e8, 1e8], (17, 1))
    law = MeshForceLaw(phase_grid((0.0,), 16), places, ramps)
    contacts = law_contacts(Contact([1.0], 0.0, gap=5e-5, damping=900.0), law)
    system = System([[2.0]], [[0.0]], [[0.0]], [force], contacts)
    linear = linear_system(system)
    assert linear.stiffness[0, 0] == pytest.approx(stiffness, rel=1e-9)
    assert linear.damping[0, 0] == pytest.approx(900.0)
    assert linear.bundle.tolist() == [0] * len(contacts)


def test_ramps_of_a_force_law_are_counted_at_each_phase():
    # The second ramp begins at 15 um in the first half and at 5 um in the second: at 2000 N the
    # first ramp alone is pressed by 10 um.
    second = Contact(
        [1.0], stiffness=1e8, gap=lambda p: np.where(p < 0.5, 15e-6, 5e-6), events=(0.0, 0.5)
    )
    first = Contact([1.0], stiffness=2e8, gap=0.0, events=(0.0, 0.5))
    system = System([[2.0]], [[0.0]], [[0.0]], [2000.0], [first, second])
    assert linear_system(system).stiffness[0, 0] == pytest.approx(2.5e8, rel=1e-12)
    assert linear_system(system, 0.2).stiffness[0, 0] == pytest.approx(2e8, rel=1e-12)
    assert linear_system(system, 0.5).stiffness[0, 0] == pytest.approx(3e8, rel=1e-12)


def solved_at_each_phase(system, contact, ramps, edge):
    """Mean stiffness of closed springs by a solution of all equations at each phase."""
    steps, total = 256, np.zeros(1 + len(ramps))
    phase = (np.arange(steps) + 0.5) / steps
    mass = 1.0 / np.sqrt(np.diag(system.mass))
    along, springs = np.asarray(contact.direction), np.array([contact.stiffness, *ramps])
    for at in phase:
        push, gap = along + contact.friction(np.array([at]))[0], np.array([0.0, *edge])
        error = contact.error(np.array([at]))[0]
        closed = np.ones(springs.size, dtype=bool)
        for _ in range(20):
            carried = np.where(closed, springs, 0.0)
            matrix = np.asarray(system.stiffness) + carried.sum() * np.outer(push, along)
            force = np.asarray(system.force) + (carried * (error + gap)).sum() * push
            scaled = matrix * np.outer(mass, mass)
            place = mass * (np.linalg.pinv(scaled, rcond=1e-12) @ (mass * force))
            closed = along @ place - error > gap
            closed[0] = True
        total += np.where(closed, springs, 0.0) / steps
    return total


@pytest.mark.parametrize("held", [True, False])
def test_springs_closed_at_rest_are_those_of_a_solution_at_each_phase(held):
    along, rub = np.array([1.0, -2.0, 0.0, 0.5]), np.array([0.05, 0.1, -0.2, 0.0])
    ramps, edge = [2.0, 1.5, 1.0], [0.05, 0.2, 0.4]
    contact = Contact(
        along,
        3.0,
        error=lambda phase: 0.3 * np.cos(2.0 * np.pi * phase),
        friction=lambda phase: np.sin(2.0 * np.pi * phase)[:, None] * rub,
        ramp_stiffness=ramps,
        ramp_gap=edge,
    )
    chained = chain([4.0 if held else 0.0, 6.0, 0.0, 5.0], [1.0, 2.0, 1.5, 3.0])
    system = System(
        chained.mass, chained.damping, chained.stiffness, [0.7, -0.9, 0.2, 0.1], [contact]
    )
    exact = solved_at_each_phase(system, contact, ramps, edge)
    assert len(set(exact[1:])) > 1  # some open and close
    # a spring changes between two of the sampled phases
    assert linear_system(system).spring == pytest.approx(exact, abs=2.0 * max(ramps) / 256)


def test_elements_can_be_prescribed():
    system = chain([2e5, 3e5], [1.0, 2.0])
    parts = {"ground": np.diag([2e5, 0.0]), "shaft": 3e5 * np.array([[1.0, -1.0], [-1.0, 1.0]])}
    prescribed, derived = natural_modes(system, elements=parts), natural_modes(system)
    assert prescribed.elements == ("ground", "shaft")
    assert derived.elements == ("q0", "q0 - q1")
    np.testing.assert_allclose(prescribed.strain_share, derived.strain_share, atol=1e-14)


def test_refusals():
    system = chain([2e5, 3e5], [1.0, 2.0])
    with pytest.raises(InputError, match="do not add up"):
        natural_modes(system, elements={"one": np.eye(2)})
    with pytest.raises(InputError, match="not symmetric"):
        natural_modes(System(np.eye(2), np.eye(2), [[1.0, 0.5], [0.0, 1.0]], [0.0, 0.0]))
    for phase in (1.0, -0.1, "middle"):
        with pytest.raises(InputError, match="phase"):
            natural_modes(system, phase=phase)
    with pytest.raises(InputError, match="statically unstable"):
        natural_modes(chain([-2e5, 3e5], [1.0, 2.0]))
    for mass in ([[1.0, 0.5], [0.0, 1.0]], [[1.0, 0.0], [0.0, -1.0]]):
        with pytest.raises(InputError, match="mass matrix"):
            natural_modes(System(mass, np.zeros((2, 2)), np.eye(2), [0.0, 0.0]))


def test_system_without_springs_has_rigid_modes_only():
    modes = natural_modes(System(np.eye(2), np.diag([3.0, 0.0]), np.zeros((2, 2)), [0.0, 0.0]))
    assert modes.frequency.tolist() == [0.0, 0.0]
    assert modes.elements == ()
    assert sorted(modes.eigenvalues.real) == pytest.approx([-3.0, 0.0, 0.0, 0.0])
    assert repr(modes) == "NaturalModes(2 coordinates, 2 rigid, no elastic mode)"


def test_result_as_a_dataset_and_in_one_line():
    modes = natural_modes(reference_system())
    data = modes.to_xarray()
    assert data.frequency.attrs["units"] == "Hz"
    assert data.strain_share.sel(element="contact 0").values.tolist() == (
        modes.strain_share[:, -1].tolist()
    )
    assert repr(modes) == "NaturalModes(6 coordinates, 1 rigid, first 5276.47 Hz)"


@pytest.mark.slow
def test_many_contacts_over_many_phases_take_little_memory() -> None:
    """No array has phases, contacts and two coordinates at once."""
    import tracemalloc

    from tribodyn.dynamics import Contact, LoadFriction, System
    from tribodyn.dynamics.linear.linear_system import linear_system

    size, count = 24, 16
    rows = np.random.default_rng(1).standard_normal((count, size))
    contacts = [
        Contact(row, lambda p: 1e8 * (1.2 + np.cos(2 * np.pi * p)), gap=1e-6, cycles=8)
        for row in rows
    ]
    rubbing = LoadFriction(
        direction=rows[0], coefficients=[0.05, 0.0, 0.0], load=1e3, contacts=range(count)
    )
    system = System(
        np.eye(size), np.zeros((size, size)), 1e8 * np.eye(size), 1e3 * rows.sum(axis=0),
        contacts, frictions=[rubbing],
    )  # fmt: skip
    tracemalloc.start()
    linear_system(system)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    phases = 256 * 8 * 3
    assert peak < 0.8 * 8 * phases * count * size**2
