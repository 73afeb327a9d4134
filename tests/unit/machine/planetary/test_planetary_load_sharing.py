"""Static load sharing of planets with errors."""

import numpy as np
import pytest

from known_planetary import ALPHA, LIN_PARKER, motion_in_clearance, pins_of
from tribodyn.errors import InputError
from tribodyn.machine import load_shares, mesh_phases, planetary_plane_model


def shares(planets, sun_support, errors, **changes):
    """Shares of the planets of the stage of Lin and Parker."""
    data = {"force_per_planet": 3000.0, **LIN_PARKER, "sun_support": sun_support, **changes}
    return load_shares(planets=planets, pin_errors=errors, **data)


def test_printed_shares():
    four = shares(4, 1e3, [30e-6, 0.0, 0.0, 0.0])
    np.testing.assert_allclose(100 * (four.share - 1), [-12.3, 12.3, -12.3, 12.3], atol=0.05)
    assert four.load_factor == pytest.approx(1.123, abs=5e-4)
    stiff = shares(3, 1e12, [30e-6, 0.0, 0.0])
    np.testing.assert_allclose(100 * (stiff.share - 1), [-11.9, 6.0, 6.0], atol=0.05)


@pytest.mark.parametrize("support", ["sun_support", "ring_support"])
def test_three_planets_share_equally_with_a_floating_member(support):
    supports = {"sun_support": 1e8, support: 0.0}
    result = shares(3, errors=[400e-6, -150e-6, 70e-6], **supports)
    np.testing.assert_allclose(result.share, 1.0, rtol=0, atol=1e-9)
    np.testing.assert_allclose(result.force, 3000.0, rtol=1e-9)


def test_unequally_spaced_planets_of_a_floating_sun_have_the_shares_of_statics():
    """Three forces on the sun: equal moments are only possible with their resultant zero."""
    angles = 2 * np.pi / 78 * np.array([0, 25, 53])
    result = shares(3, 0.0, [100e-6, 0.0, 0.0], angles=angles)
    forces = np.stack([np.ones(3), np.sin(angles - ALPHA), np.cos(angles - ALPHA)])
    expected = np.linalg.solve(forces, [3.0, 0.0, 0.0])
    np.testing.assert_allclose(result.share, expected, atol=1e-9)


@pytest.mark.processor
def test_a_planet_that_is_far_behind_carries_alone_where_the_sun_is_held():
    result = shares(3, 1e12, [0.0, -2e-3, 0.0])
    np.testing.assert_allclose(result.force, [0.0, 9000.0, 0.0], atol=1e-6)
    assert result.unloaded == (1, 3)
    assert result.load_factor == pytest.approx(3.0)
    pair = shares(4, 0.0, [2e-3, 0.0, 0.0, 0.0])  # opposite planets of a floating sun
    np.testing.assert_allclose(pair.share, [0.0, 2.0, 0.0, 2.0], atol=1e-9)


def test_loads_are_in_balance_and_press_on_flanks():
    """Contact or gap of every planet, by compressions computed from the displacements."""
    result = shares(5, 1e8, [400e-6, 0.0, 60e-6, -20e-6, 0.0])
    assert result.unloaded == (1,)
    assert result.force.sum() == pytest.approx(5 * 3000.0)
    at = 2 * np.pi * np.arange(5) / 5 - ALPHA
    # The sun: force of its support against the forces of the meshes along their lines.
    mesh = (result.force @ np.sin(at), -(result.force @ np.cos(at)))
    np.testing.assert_allclose(1e8 * np.array(result.displacement["sun"]), mesh, rtol=1e-6)


def test_a_thick_tooth_is_a_pin_that_is_behind():
    thick = shares(4, 1e5, 0.0, thickness_errors=[10e-6, 0.0, -5e-6, 0.0])
    pins = -np.array([10e-6, 0.0, -5e-6, 0.0]) / (2 * np.cos(ALPHA))
    np.testing.assert_allclose(thick.share, shares(4, 1e5, pins).share, rtol=1e-9)
    assert thick.share[0] > 1.0


def test_backwards_a_pin_ahead_carries_more():
    forward = shares(3, 1e12, [30e-6, 0.0, 0.0])
    backward = shares(3, 1e12, [-30e-6, 0.0, 0.0], force_per_planet=-3000.0)
    np.testing.assert_allclose(backward.force, -forward.force, rtol=1e-9)
    np.testing.assert_allclose(backward.share, forward.share, rtol=1e-9)


def test_a_common_error_changes_no_share():
    result = shares(4, 1e8, 50e-6)
    np.testing.assert_allclose(result.share, 1.0, atol=1e-9)


def test_functions_of_the_phase_count_with_their_mean():
    phases = mesh_phases(sun_teeth=17, ring_teeth=61, planets=3)
    varying = {
        "sun_mesh_stiffness": lambda x: 5e8 + 1e8 * np.cos(2 * np.pi * x),
        "phases": phases,
    }
    result = shares(3, 1e12, [30e-6, 0.0, 0.0], **varying)
    constant = shares(3, 1e12, [30e-6, 0.0, 0.0])
    np.testing.assert_allclose(result.share, constant.share, rtol=1e-9)


def test_shares_without_a_load_are_refused():
    with pytest.raises(InputError, match="force_per_planet is 0"):
        shares(3, 1e8, 0.0, force_per_planet=0.0)


def test_unknown_and_missing_arguments_are_named():
    with pytest.raises(InputError, match=r'Did you mean "pin_errors"\?') as refused:
        load_shares(planets=3, pin_error=1e-6, force_per_planet=1.0, **LIN_PARKER)
    assert len(refused.value.problems) == 1
    with pytest.raises(InputError, match="planets is missing"):
        load_shares(force_per_planet=1.0, **LIN_PARKER)
    with pytest.raises(InputError, match=r"carrier_mass = \[1.0\]"):
        shares(3, 1e8, 0.0, carrier_mass=[1.0])
    phases = mesh_phases(sun_teeth=17, ring_teeth=61, planets=3)
    with pytest.raises(InputError, match="sun_mesh_stiffness"):
        shares(3, 1e8, 0.0, phases=phases, sun_mesh_stiffness=lambda phase: None)


def test_clearance_of_the_pins_softens_them_across_their_load():
    """Without clearance nothing changes; with it each pin gives F/(c + F/k) across its load."""
    data = {"force_per_planet": 3000.0, **LIN_PARKER}
    plain = planetary_plane_model(planets=4, **data)
    same = planetary_plane_model(planets=4, pin_clearance=0.0, **data)
    np.testing.assert_array_equal(same.stiffness, plain.stiffness)
    loose = planetary_plane_model(planets=4, pin_clearance=20e-6, **data)
    # Equal angles of pressure: the load of the pin is tangential, 2 F cos(alpha).
    load, planet = 2 * 3000.0 * np.cos(ALPHA), slice(9, 11)  # at angle 0: x is across the load
    across, along = np.diag(np.asarray(loose.stiffness)[planet, planet])
    assert along == pytest.approx(1e8, rel=1e-4)
    assert across == pytest.approx(load / (20e-6 + load / 1e8), rel=1e-4)
    shares_of = [
        load_shares(planets=4, pin_errors=[30e-6, 0, 0, 0], **{**data, "pin_clearance": c}).share
        for c in (0.0, 20e-6)
    ]
    np.testing.assert_allclose(shares_of[0], shares_of[1], atol=0.02)  # all pins move by the same
    with pytest.raises(InputError, match="pin_clearance without a load"):
        planetary_plane_model(planets=4, pin_clearance=20e-6, **LIN_PARKER)


@pytest.mark.parametrize("clearance", [1e-12, 40e-6])
def test_slow_motion_with_clearance_is_that_of_statics(clearance):
    phases = mesh_phases(sun_teeth=17, ring_teeth=61, planets=3)
    errors = [30e-6, 0.0, 0.0]
    data = {
        "planets": 3, "phases": phases, "force_per_planet": 3000.0, "pin_errors": errors,
        **LIN_PARKER, "sun_support": 1e12, "damping_ratio": 0.05, "pin_clearance": clearance,
    }  # fmt: skip
    system = planetary_plane_model(**data)
    motion = motion_in_clearance(system, data, 1.0, steps=32)
    force = motion.contact_force[0]
    expected = load_shares(**data)
    np.testing.assert_allclose(force[:3] / force[:3].mean(), expected.share, atol=5e-3)
    if clearance < 1e-9:
        np.testing.assert_allclose(force[:3], expected.force, rtol=1e-6)
    # Each planet is displaced by the clearance and the deflection of its pin.
    for law, sun, ring in zip(pins_of(data).supports(), force[:3], force[3:6], strict=True):
        displacement = law.displacement(motion.position[0])
        load = np.hypot((sun - ring) * np.sin(ALPHA), (sun + ring) * np.cos(ALPHA))
        assert np.hypot(*displacement) == pytest.approx(clearance + load / 1e8, rel=1e-5)
