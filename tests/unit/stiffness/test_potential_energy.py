"""Pair stiffness by the energy method: load share, load dependence, symmetry, scaling."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tribodyn.contact import path_of_contact
from tribodyn.errors import InputError
from tribodyn.gear import Material, spur_pair
from tribodyn.stiffness import potential_energy_stiffness, single_pair_stiffness


def cycle(pair, points=50):
    phase = (np.arange(points) + 0.5) / points
    return path_of_contact(pair).pair_paths(phase)


def test_every_pair_deflects_equally_under_its_share(fzg, steel):
    pair, force = fzg(), 2660.0
    path, in_contact = cycle(pair)
    stiffness = potential_energy_stiffness(pair, steel, path, in_contact, force)
    share = stiffness / stiffness.sum(axis=1, keepdims=True)
    alone = np.zeros(path.shape)
    alone[in_contact] = single_pair_stiffness(
        pair, steel, path[in_contact], (force * share)[in_contact]
    )
    deflection = np.divide(force * share, alone, out=np.full(path.shape, np.nan), where=in_contact)
    common = force / stiffness.sum(axis=1)
    assert deflection[in_contact] == pytest.approx(
        np.broadcast_to(common[:, None], path.shape)[in_contact], rel=1e-11
    )


def test_one_pair_in_contact_is_the_single_pair(fzg, steel):
    pair = fzg()
    path, in_contact = cycle(pair)
    alone = in_contact.sum(axis=1) == 1
    stiffness = potential_energy_stiffness(pair, steel, path, in_contact, 2660.0)[alone, 0]
    assert stiffness == pytest.approx(single_pair_stiffness(pair, steel, path[alone, 0], 2660.0))


def test_equal_gears_are_symmetric_about_the_middle(steel):
    pair = spur_pair(
        pinion_teeth=28,
        wheel_teeth=28,
        normal_module=4e-3,
        normal_pressure_angle=math.radians(20.0),
        pinion_face_width=20e-3,
        pinion_bore_diameter=40e-3,
        wheel_bore_diameter=40e-3,
    )
    contact = path_of_contact(pair)
    path = np.linspace(contact.A, contact.E, 21)
    stiffness = single_pair_stiffness(pair, steel, path, 3000.0)
    assert stiffness == pytest.approx(stiffness[::-1], rel=1e-10)
    assert stiffness.argmax() == 10


def test_the_driving_gear_does_not_matter_to_a_pair_at_its_place(fzg, steel):
    path = np.linspace(0.0115, 0.028, 7)
    pinion, wheel = (
        single_pair_stiffness(fzg(driver=driver), steel, path, 2000.0)
        for driver in ("pinion", "wheel")
    )
    assert pinion == pytest.approx(wheel, rel=1e-14)


def test_stiffness_at_equal_load_per_width_grows_with_the_width(fzg, steel):
    path = np.linspace(0.0115, 0.028, 7)
    narrow = single_pair_stiffness(fzg(), steel, path, 2000.0)
    wide = single_pair_stiffness(fzg(pinion_face_width=40e-3), steel, path, 4000.0)
    assert wide == pytest.approx(2.0 * narrow, rel=1e-12)


def test_stiffness_at_equal_strain_scales_with_the_modulus(fzg):
    path = np.linspace(0.0115, 0.028, 7)
    stiffness = single_pair_stiffness(fzg(), Material(206e9), path, 2000.0)
    two = single_pair_stiffness(fzg(), Material(412e9), path, 4000.0)
    assert two == pytest.approx(2.0 * stiffness, rel=1e-12)


def test_more_load_stiffens_the_contact_slightly(fzg, steel):
    loads = np.array([500.0, 2000.0, 8000.0])
    stiffness = single_pair_stiffness(fzg(), steel, 0.0196, loads)
    assert np.all(np.diff(stiffness) > 0.0)
    # Four times the load takes ln(4) / 2 off the logarithm of each body: no more than that.
    step = 2 * 2 * (1 - 0.3**2) / (math.pi * 206e9 * 0.02) * math.log(4.0) / 2
    assert np.diff(1.0 / stiffness) == pytest.approx(np.full(2, -step), rel=1e-9)


def test_the_rim_is_stiffer_than_the_bore(fzg, steel):
    bore = single_pair_stiffness(fzg(), steel, 0.02, 2000.0, "bore")
    rim = single_pair_stiffness(fzg(), steel, 0.02, 2000.0, "rim")
    assert rim > 1.1 * bore


@pytest.mark.parametrize("force", [0.0, -5.0, np.nan])
def test_no_force_is_refused(force, fzg, steel):
    with pytest.raises(InputError, match="normal_force"):
        single_pair_stiffness(fzg(), steel, 0.02, force)


def test_a_gear_without_bore_needs_the_rim(fzg, steel):
    solid = fzg(pinion_bore_diameter=0.0)
    with pytest.raises(InputError, match="rim"):
        single_pair_stiffness(solid, steel, 0.02, 2000.0)
    assert single_pair_stiffness(solid, steel, 0.02, 2000.0, "rim") > 0.0


def test_a_place_off_the_line_of_action_is_refused(fzg, steel):
    with pytest.raises(InputError, match="curvature_radius"):
        single_pair_stiffness(fzg(), steel, -0.001, 2000.0)
