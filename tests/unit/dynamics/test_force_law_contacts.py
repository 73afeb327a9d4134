"""A force law as a bundle of contacts: against one contact, the readable kernel and statics."""

from dataclasses import replace

import numpy as np
import pytest

from known_laws import GRID, LOAD, constant_law, gear_pair, mesh_functions, total_force, wavy_law
from known_systems import BASE_RADIUS
from plain.runge_kutta import march_plain
from tribodyn.dynamics import (
    Contact,
    System,
    law_contacts,
    simulate,
    simulate_ensemble,
    steady_state,
    torsional,
)
from tribodyn.dynamics.equations.compiled import compile_for
from tribodyn.dynamics.equations.orbit_coordinates import static_start
from tribodyn.errors import InputError
from tribodyn.mesh import MeshForceLaw, PhaseFunction

FREQUENCY = 2400.0
WAVE = 1.0 + 0.3 * np.cos(2 * np.pi * GRID.phase)


def _body(contacts, force=2000.0, mass=0.2):
    """One mass against its contacts."""
    return System([[mass]], [[50.0]], [[0.0]], [force], contacts)


def _plain_contact(**change):
    options = {"stiffness": 0.0, "damping": 300.0, "gap": 2e-5, "events": (0.0, 0.25)}
    return Contact([1.0], **(options | change))


def _wavy_ramps(*shares):
    """A linear law with a stiffness that varies, cut into ramps that begin together."""
    stiffness = 2e8 * WAVE[:, None] * np.array(shares)
    return MeshForceLaw(GRID, np.zeros_like(stiffness), stiffness)


@pytest.mark.parametrize("shares", [(1.0,), (0.2, 0.5, 0.3), (0.4, 0.0, 0.6)])
@pytest.mark.parametrize("gap", [0.0, 2e-5])
def test_a_linear_law_is_one_contact(shares, gap):
    bundle = _body(law_contacts(_plain_contact(gap=gap), _wavy_ramps(*shares)))
    assert len(bundle.contacts) == np.count_nonzero(shares)
    plain = _body([_plain_contact(gap=gap, stiffness=lambda p: _wavy_ramps(1.0).ramps(p)[1][:, 0])])
    start = ([3e-5], [0.6])
    bundled, single = (
        simulate(system, FREQUENCY, 4, start, steps=256) for system in (bundle, plain)
    )
    if gap:
        assert bundled.deflection.min() < gap < bundled.deflection.max()
    tight = 1e-12 if len(shares) == 1 else 1e-7  # monotone curves over the phase
    size = np.abs(single.position).max()
    np.testing.assert_allclose(bundled.position, single.position, atol=tight * size)
    force = single.fine.contact_force[:, 0]
    np.testing.assert_allclose(total_force(bundled), force, atol=tight * 1e2 * np.abs(force).max())
    bundle_state, expected = (
        static_start(compile_for(each, FREQUENCY, 256)) for each in (bundle, plain)
    )
    np.testing.assert_allclose(bundle_state, expected, rtol=1e-9)


def test_one_ramp_of_a_gear_pair_is_its_plain_stiffness():
    ways = ("force-law", "stiffness")
    stiffness = PhaseFunction(GRID, 2e8 * WAVE)
    mesh = replace(mesh_functions(_wavy_ramps(1.0), friction=0.05), stiffness=stiffness)
    systems = [gear_pair(mesh, mesh_force=way) for way in ways]
    start = static_start(compile_for(systems[1], 240.0, 1024))
    for tolerance, motions in (
        (1e-12, [simulate(each, 240.0, 1, (start[:6], start[6:]), steps=1024) for each in systems]),
        (1e-10, [steady_state(each, 240.0, steps=1024) for each in systems]),
    ):
        new, old = motions
        np.testing.assert_allclose(new.fine.deflection, old.fine.deflection, rtol=tolerance)
        np.testing.assert_allclose(total_force(new), total_force(old), rtol=tolerance * 1e2)


def test_kernel_equals_plain_with_ramps_that_open_and_close():
    system = gear_pair(wavy_law(6), friction=0.05, backlash=1e-5)
    start = 2e-5 * np.random.default_rng(5).standard_normal(12)
    compiled = compile_for(system, FREQUENCY, 176)
    plain = march_plain(system, compiled.grid, compiled.nodes, FREQUENCY, 2, start)
    motion = simulate(system, FREQUENCY, 2, (start[:6], start[6:]), steps=176)
    scale = np.abs(plain).max(axis=0)
    states = np.hstack([motion.position, motion.velocity])
    assert np.abs((states - plain[:-1]) / scale).max() < 1e-11
    carrying = (motion.contact_force != 0.0).sum(axis=1)
    assert carrying.min() == 0
    assert carrying.max() >= 4


def test_lanes_of_an_ensemble_equal_single_runs():
    system = gear_pair(wavy_law(5), friction=0.05, backlash=1e-5)
    generator = np.random.default_rng(2)
    frequency = generator.uniform(600.0, 3000.0, 20)
    start = 2e-5 * generator.standard_normal((20, 6)), np.zeros((20, 6))
    ensemble = simulate_ensemble(system, frequency, 3, start, steps=2048, averaged=3)
    for lane in (0, 19):
        begin = (start[0][lane], start[1][lane])
        single = simulate(system, frequency[lane], 3, begin, steps=2048)
        end = single.fine.position[-1]
        np.testing.assert_allclose(ensemble.position[lane], end, atol=1e-12 * np.abs(end).max())
        mean = ensemble.contact_force.mean[lane].sum()
        fine = single.fine
        assert mean == pytest.approx(fine.mean(fine.contact_force.sum(axis=1)), rel=1e-9)


def test_all_damping_acts_while_the_lowest_ramp_is_closed():
    moved = constant_law([5e-6, 1e-6, 9e-6], [1e8, 1e8, 1e8])
    contacts = law_contacts(_plain_contact(), moved)
    assert [each.damping for each in contacts] == [300.0, 0.0, 0.0]
    # Just above the lowest knot: its own spring and the whole damper, nothing else.
    start = ([2e-5 + 3e-6], [0.5])
    motion = simulate(_body(contacts), FREQUENCY, 1, start, steps=256)
    assert motion.contact_force[0].sum() == pytest.approx(1e8 * 2e-6 + 300.0 * 0.5, rel=1e-9)


def test_damping_without_a_lowest_ramp():
    """Two pairs take turns in touching first: one more contact carries the damping."""
    wave = 2e-6 * np.cos(2 * np.pi * GRID.phase)
    law = MeshForceLaw(GRID, np.stack((wave, -wave), axis=1), np.full((GRID.phase.size, 2), 1e8))
    assert law.lowest is None
    contacts = law_contacts(_plain_contact(), law)
    assert [each.damping for each in contacts] == [300.0, 0.0, 0.0]
    motion = simulate(_body(contacts), FREQUENCY, 1, ([2e-5 - 1e-6], [0.5]), steps=256)
    # At phase 0 the second pair touches at -2 um, the first one not before +2 um.
    assert motion.contact_force[0].sum() == pytest.approx(1e8 * 1e-6 + 150.0, rel=1e-9)


@pytest.mark.parametrize("torque", [10.0, 90.0, 250.0])
def test_static_start_is_the_static_deflection(torque):
    law = constant_law([1e-6, 4e-6, 12e-6, 25e-6], [1e8, 5e7, 8e7, 6e7])
    system = gear_pair(law, model="torsional", torque=(torque, 1.5 * torque), backlash=4e-5)
    position = static_start(compile_for(system, 1e4, 64))[:2]
    deflection = position @ np.asarray(system.contacts[0].direction)
    expected = 20e-6 + law.deflection(0.0, torque / BASE_RADIUS[0])
    assert deflection == pytest.approx(float(expected), rel=1e-12)


def test_static_start_of_the_pair_on_its_supports_is_at_rest():
    law = constant_law([0.0, 4e-6, 12e-6, 25e-6], [1e8, 5e7, 8e7, 6e7])
    system = gear_pair(law)
    start = static_start(compile_for(system, 1e4, 256))
    motion = simulate(system, 1e4, 3, (start[:6], start[6:]), steps=256)
    np.testing.assert_allclose(total_force(motion), LOAD, rtol=1e-10)
    np.testing.assert_allclose(motion.position[-1], start[:6], rtol=1e-9, atol=1e-20)


def test_contacts_of_different_places_keep_their_start():
    """Only ramps of one law open in the search of the start, other contacts stay closed."""
    contacts = [Contact([1.0, 0.0], 2.0, gap=1.0), Contact([0.0, 1.0], 4.0, gap=0.5)]
    system = System(np.eye(2), np.zeros((2, 2)), np.zeros((2, 2)), [-1.0, 0.5], contacts)
    start = static_start(compile_for(system, 1.0, 16))
    np.testing.assert_allclose(start[:2], [0.5, 0.625], rtol=1e-12)


def test_back_flanks_carry_the_same_law():
    law = wavy_law(5)
    system = torsional(
        mesh_functions(law), moment_of_inertia=1e-3, base_radius=BASE_RADIUS, torque=0.0,
        mesh_damping=300.0, backlash=3e-5, mesh_force="force-law",
    )  # fmt: skip
    # Nothing but the mesh drives: a motion and its mirror image.
    start = np.array([2e-3, -1e-3]), np.array([0.3, -0.2])
    forward = simulate(system, FREQUENCY, 3, start, steps=256)
    back = simulate(system, FREQUENCY, 3, (-start[0], -start[1]), steps=256)
    assert total_force(forward).max() > 1000.0
    np.testing.assert_allclose(back.position, -forward.position, rtol=1e-12)
    np.testing.assert_allclose(total_force(back), -total_force(forward), rtol=1e-9, atol=1e-6)
    deflection = forward.fine.deflection[:, 0]
    inner = np.abs(deflection) < 15e-6
    assert not total_force(forward)[inner].any()


def test_an_error_is_subtracted_for_every_mesh_force():
    law, error = constant_law([0.0, 5e-6], [2e8, 1e8]), 7e-6
    for way in ("stiffness", "tangent", "force-law"):
        with_error, without = (
            gear_pair(law, model="torsional", mesh_force=way, error=e) for e in (error, 0.0)
        )
        places = [
            static_start(compile_for(system, 1e4, 64))[:2] @ system.contacts[0].direction
            for system in (with_error, without)
        ]
        assert places[0] - places[1] == pytest.approx(error, rel=1e-9), way
        # Counted from where the nominal flanks touch, all three give the static error.
        static = float(law.deflection(0.0, LOAD))
        assert places[1] - 5e-5 == pytest.approx(static, rel=1e-9), way


def test_step_limit_counts_all_ramps():
    stiff = gear_pair(constant_law([0.0], [3e8]))
    ramps = gear_pair(constant_law([0.0, 1e-5, 2e-5], [1e8, 1.5e8, 0.5e8]))
    numbers = [compile_for(system, 1e3, 128).step_number for system in (ramps, stiff)]
    assert numbers[0] == pytest.approx(numbers[1], rel=1e-12)
    with pytest.raises(InputError, match="omega_max"):
        compile_for(ramps, 1e2, 128)


@pytest.mark.parametrize(
    ("change", "part"),
    [
        ({"mesh_force": "linear"}, 'mesh_force = "linear"'),
        ({"backlash": 3e-6}, "backlash of at least about 4 um"),
    ],
)
def test_wrong_input_is_named(change, part):
    law = constant_law([-2e-6, 0.0], [1e8, 1e8])
    with pytest.raises(InputError) as caught:
        gear_pair(law, **change)
    assert part in str(caught.value)


@pytest.mark.parametrize("way", ["tangent", "force-law"])
def test_a_mesh_without_a_law_is_named(way):
    bare = replace(mesh_functions(constant_law([0.0], [1e8])), tangent_stiffness=None)
    bare = replace(bare, force_law=None)
    options = {"moment_of_inertia": 1e-3, "base_radius": BASE_RADIUS, "torque": 1.0}
    with pytest.raises(InputError, match="this mesh has no"):
        torsional(bare, mesh_force=way, **options)


def test_a_varying_gap_is_refused():
    with pytest.raises(InputError, match="gap is not a constant"):
        law_contacts(_plain_contact(gap=lambda phase: 1e-5 + 0 * phase), constant_law([0.0], [1e8]))


@pytest.mark.parametrize("rounding", [-2.54e-21, -1e-16])
def test_rounding_below_a_closed_gap_is_zero(rounding):
    start = ([3e-5], [0.6])
    gap = lambda phase: 2e-5 * (1.0 + np.cos(2.0 * np.pi * phase)) + rounding  # noqa: E731
    closed = lambda phase: np.maximum(gap(phase), 0.0)  # noqa: E731
    touching, exact = (
        simulate(
            _body([_plain_contact(stiffness=2e8, gap=each)]),
            FREQUENCY,
            2,
            ([3e-5], [0.6]),
            steps=64,
        )
        for each in (gap, closed)
    )
    np.testing.assert_allclose(touching.position, exact.position, rtol=1e-9, atol=1e-15)
    law = constant_law([0.0, 1e-5], [2e8, 1e8])
    early = MeshForceLaw(law.grid, law.knot_deflection + rounding, law.knot_stiffness)
    law_contacts(_plain_contact(gap=0.0), early)
    negative = _body([_plain_contact(stiffness=2e8, gap=lambda phase: 0 * phase - 1e-12)])
    with pytest.raises(InputError, match="gap = -1e-12 m"):
        simulate(negative, FREQUENCY, 1, start, steps=64)
