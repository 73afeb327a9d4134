"""Static load sharing of planets with errors."""

import numpy as np
import pytest

from known_planetary import ALPHA, LIN_PARKER
from tribodyn.errors import InputError
from tribodyn.machine import load_shares, mesh_phases


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
