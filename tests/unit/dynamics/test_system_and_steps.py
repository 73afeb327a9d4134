"""Wrong systems, wrong steps, and the searches for an orbit."""

import numpy as np
import pytest

from known_systems import MESH_FREQUENCY, hysteresis_system, reference_system
from tribodyn.dynamics import Contact, System, simulate, simulate_ensemble, steady_state
from tribodyn.dynamics.equations.grid import build_grid
from tribodyn.errors import ComputationError, InputError, ModelWarning

ONE = Contact([1.0], stiffness=1.0)


def _plain(**change):
    parts = {
        "mass": [[1.0]], "damping": [[0.1]], "stiffness": [[1.0]], "force": [0.0],
        "contacts": [ONE],
    } | change  # fmt: skip
    return System(**parts)


@pytest.mark.parametrize(
    ("change", "part"),
    [
        ({"mass": [[0.0]]}, "coordinate 0 has no inertia"),
        ({"mass": [[1.0, 0.0]]}, "shape (1, 2)"),
        ({"damping": np.eye(2)}, "shape (2, 2), mass has (1, 1)"),
        ({"stiffness": [[np.nan]]}, "NaN"),
        ({"names": ("a", "b")}, "2 names for 1"),
        ({"balance": [1.0, 2.0]}, "balance"),
        ({"mass": np.ones((2, 2)), "damping": np.eye(2), "stiffness": np.eye(2)}, "singular"),
    ],
)
def test_wrong_systems(change, part):
    with pytest.raises(InputError, match=r".*") as caught:
        _plain(**change)
    assert part in str(caught.value)


def _nan_beyond_half(phase):
    return np.where(phase > 0.5, np.nan, 1.0)


@pytest.mark.parametrize(
    ("contact", "part"),
    [
        (Contact([1.0, 2.0], stiffness=1.0), "contacts[0].direction"),
        (Contact([1.0], stiffness=_nan_beyond_half), "NaN or infinite at the mesh phase 0.5"),
        (Contact([1.0], stiffness=1.0, gap=-1.0), "gap = -1 m"),
        (Contact([1.0], stiffness=lambda p: 1.0 if p < 0.5 else 2.0), "not a vectorized function"),
        (Contact([1.0], stiffness=lambda phase: np.ones((phase.size, 3))), "contacts[0].stiffness"),
    ],
)
def test_wrong_contacts(contact, part):
    with pytest.raises(InputError) as caught:
        steady_state(_plain(contacts=[contact]), 1.0, steps=64)
    assert part in str(caught.value)


def test_event_outside_the_cycle():
    with pytest.raises(InputError, match=r"events holds 1"):
        Contact([1.0], stiffness=1.0, events=(0.0, 1.0))


@pytest.mark.parametrize(
    ("call", "part"),
    [
        (lambda s: steady_state(s, 0.0), "mesh_frequency"),
        (lambda s: steady_state(s, 1.0, steps=1), "steps"),
        (lambda s: steady_state(s, 1.0, periods=0), "periods"),
        (lambda s: steady_state(s, 1.0, start=([1.0], [np.inf])), "start"),
        (lambda s: steady_state(s, 1.0, start=[1.0, 2.0, 3.0]), "start"),
        (lambda s: simulate(s, 1.0, 0, ([0.0], [0.0])), "cycles"),
        (lambda s: simulate_ensemble(s, [1.0], 1, ([0.0], [0.0]), averaged=2), "averaged"),
        (lambda s: simulate_ensemble(s, [1.0, 2.0], 1, ([0.0, 1.0, 2.0], [0.0])), "start"),
    ],
)
def test_wrong_arguments(call, part):
    with pytest.raises(InputError) as caught:
        call(_plain())
    assert part in str(caught.value)


def test_balance_needs_a_free_drive():
    with pytest.raises(InputError, match="balance does not drive any free motion"):
        steady_state(_plain(balance=[1.0]), 1.0)


def test_unstable_step_is_refused_with_the_number_that_is_needed():
    """omega_max*dt = 2.7 is the limit; the message names the steps, and they work."""
    system = reference_system(0.1)
    with pytest.raises(InputError, match=r"omega_max\*dt = 5") as caught:
        steady_state(system, MESH_FREQUENCY, steps=64)
    needed = int(str(caught.value).split("at least ")[1].split()[0])
    with pytest.warns(ModelWarning, match=r"step-size.*Use 256 steps"):
        orbit = steady_state(system, MESH_FREQUENCY, steps=needed)
    assert orbit.step_number <= 2.7
    assert orbit.step_error > 0.1


def test_limit_is_that_of_the_scheme():
    """An undamped oscillator at 2.69 stays bounded; the scheme itself is unstable above 2.83."""
    omega, steps = 100.0, 64
    system = System([[1.0]], [[0.0]], [[omega**2]], [0.0])
    frequency = omega / (2.69 * steps)
    motion = simulate(system, frequency, 50, ([1.0], [0.0]), steps=steps)
    assert motion.step_number == pytest.approx(2.69)
    assert np.abs(motion.position).max() <= 1.0 + 1e-12
    with pytest.raises(InputError, match="Runge-Kutta"):
        simulate(system, omega / (2.71 * steps), 50, ([1.0], [0.0]), steps=steps)


def test_divergence_is_reported():
    system = _plain(damping=[[-300.0]], stiffness=[[1.0]])
    with pytest.raises(ComputationError, match="grew beyond all bounds"):
        simulate(system, 1.0, 60, ([1.0], [0.0]), steps=256)


def test_a_free_body_has_no_orbit():
    with pytest.raises(InputError, match="Nothing vibrates"):
        steady_state(System([[1.0]], [[0.0]], [[0.0]], [1.0]), 1.0)


def test_an_unstable_orbit_is_reported():
    """Mathieu's equation in its first tongue: the orbit of the forced motion is unstable."""
    contact = Contact([1.0], stiffness=lambda phase: 1.0 + 0.5 * np.cos(2 * np.pi * phase))
    system = System([[1.0]], [[0.02]], [[0.0]], [1.0], [contact])
    with pytest.warns(ModelWarning, match="unstable-orbit"):
        motion = steady_state(system, 2.0 / (2 * np.pi))
    assert motion.converged
    assert not motion.stable
    assert abs(motion.floquet_multipliers[0]) > 1.2


def test_a_missed_tolerance_is_reported():
    with pytest.warns(ModelWarning, match="steady-state"):
        motion = steady_state(hysteresis_system(), 0.14, tolerance=1e-18)
    assert not motion.converged
    assert motion.error >= np.finfo(float).eps


def test_orbit_of_two_periods_holds_the_orbit_of_one_twice():
    single = steady_state(reference_system(0.1), MESH_FREQUENCY)
    two = steady_state(reference_system(0.1), MESH_FREQUENCY, periods=2)
    assert two.position.shape == (1024, 6)
    np.testing.assert_allclose(two.deflection[:512], two.deflection[512:], rtol=1e-9)
    np.testing.assert_allclose(two.deflection[:512], single.deflection, rtol=1e-9)
    assert two.time[-1] < two.duration == pytest.approx(2 / MESH_FREQUENCY)


def test_certified_error_bounds_the_distance_to_the_orbit():
    """Brute-force marching ends at the same orbit, within the error that is certified."""
    system = hysteresis_system()
    orbit = steady_state(system, 0.14, start=([2.2], [0.3]))
    motion = simulate(system, 0.14, 120, (orbit.position[0] + 0.01, orbit.velocity[0]), steps=512)
    assert abs(motion.position[-512, 0] - orbit.position[0, 0]) < 1e-9
    assert orbit.error < 1e-9


def test_orbit_starts_where_it_ends():
    orbit = steady_state(reference_system(0.1), MESH_FREQUENCY)
    fine = orbit.fine
    np.testing.assert_allclose(fine.position[0], fine.position[-1], atol=1e-15)
    assert orbit.phase[0] == 0.0
    assert orbit.time.shape == (512,)
    assert orbit.contact_force.shape == orbit.deflection.shape == (512, 1)


def test_entries_in_every_form():
    """A vector may be an array, a function of either orientation, or a list with functions."""
    ways = [
        lambda p: np.stack([1.0 + 0.1 * np.sin(2 * np.pi * p), 0.5 + 0 * p], axis=1),
        lambda p: np.stack([1.0 + 0.1 * np.sin(2 * np.pi * p), 0.5 + 0 * p]),
        [lambda p: 1.0 + 0.1 * np.sin(2 * np.pi * p), 0.5],
    ]
    ends = []
    for way in ways:
        contact = Contact(way, stiffness=20.0, damping=0.1)
        system = System(np.eye(2), 0.1 * np.eye(2), np.eye(2), [1.0, 0.0], contact)
        ends.append(steady_state(system, 0.3, steps=64).position)
    np.testing.assert_allclose(ends[0], ends[1], rtol=1e-12)
    np.testing.assert_allclose(ends[0], ends[2], rtol=1e-12)


def test_system_without_contacts_and_free_mass():
    motion = simulate(System([[2.0]], [[0.0]], [[0.0]], [4.0]), 1.0, 2, ([0.0], [0.0]), steps=16)
    np.testing.assert_allclose(motion.position[:, 0], motion.time**2, atol=1e-14)
    assert motion.contact_force.shape == (32, 0)


@pytest.mark.parametrize("steps", [8, 37, 512])
def test_grid_has_every_event_and_the_requested_steps(steps):
    events = (0.0, 0.1234, 0.1235, 0.9)
    grid = build_grid(events, steps)
    assert grid.steps == steps
    assert grid.width.sum() == pytest.approx(1.0, abs=1e-14)
    np.testing.assert_allclose(grid.left[grid.after_event], events, atol=1e-15)
    np.testing.assert_allclose(np.diff(grid.left), grid.width[:-1], atol=1e-15)


def test_reprs_are_one_line():
    system = reference_system(0.1)
    for item in (system, system.contacts[0], steady_state(system, MESH_FREQUENCY)):
        assert "\n" not in repr(item)
        assert len(repr(item)) < 160


def test_series_as_xarray_have_units():
    data = steady_state(reference_system(0.1), MESH_FREQUENCY).to_xarray()
    assert data.deflection.attrs["units"] == "m"
    assert data.sizes == {"time": 512, "coordinate": 6, "contact": 1}
    assert data.attrs["mesh_frequency"] == MESH_FREQUENCY
