"""Teeth and film in series over torque and speed: identities, order along the path, refusals."""

from __future__ import annotations

import numpy as np
import pytest

from known_pairs import pair_of
from tribodyn.errors import InputError
from tribodyn.gear import Material
from tribodyn.lubricant import Lubricant
from tribodyn.mesh import build, comprehensive_stiffness

OIL = Lubricant(0.082, 880.0, 2.19e-8)
TORQUES, SPEEDS = (50.0, 150.0), (60.0, 120.0, 240.0)


def gears(driver="pinion"):
    return pair_of(
        pinion_profile_shift_coefficient=0.8532,
        wheel_profile_shift_coefficient=-0.5,
        driver=driver,
    )


def study(driver="pinion", **options):
    arguments = {
        "material": Material(),
        "lubricant": OIL,
        "film_model": "moes",
        "pinion_torque": TORQUES,
        "pinion_speed": SPEEDS,
        "steps": 32,
    }
    return comprehensive_stiffness(gears(driver), **{**arguments, **options})


@pytest.fixture(scope="module")
def stiffness():
    return study()


def test_each_pair_is_a_series_of_teeth_and_film(stiffness):
    expected = 1.0 / (1.0 / stiffness.tooth_stiffness + 1.0 / stiffness.film_stiffness)
    np.testing.assert_allclose(stiffness.pair_stiffness, expected, rtol=1e-6)
    assert stiffness.pair_stiffness.shape == (2, 3, stiffness.path.size)
    assert np.all(stiffness.film_stiffness > 20.0 * stiffness.tooth_stiffness)


def test_mesh_is_the_sum_of_its_pairs(stiffness):
    # 32 intervals of the phase of one pair after another: the ends of the path included
    total = stiffness.pair_stiffness.sum(axis=2)
    np.testing.assert_allclose(stiffness.comprehensive_mesh_stiffness.sum(axis=2), total, rtol=1e-9)
    teeth = stiffness.tooth_stiffness.sum(axis=2)
    np.testing.assert_allclose(stiffness.tooth_mesh_stiffness.sum(axis=2), teeth, rtol=1e-9)
    film = stiffness.film_stiffness.sum(axis=2)
    np.testing.assert_allclose(stiffness.film_mesh_stiffness.sum(axis=2), film, rtol=1e-9)


def test_series_of_totals_is_stiffer_than_series_of_pairs(stiffness):
    """Equal only where both pairs have the same ratio of film to teeth."""
    assert np.all(
        stiffness.series_of_totals >= stiffness.comprehensive_mesh_stiffness * (1.0 - 1e-6)
    )
    np.testing.assert_allclose(
        stiffness.series_of_totals, stiffness.comprehensive_mesh_stiffness, rtol=5e-3
    )


def test_it_is_the_mesh_table_of_each_operating_point(stiffness):
    table = build(
        gears(), material=Material(), lubricant=OIL, friction_law="none", composite_roughness=0.0,
        film_model="moes", film_options={"stiffness": "tangent"}, pinion_speed=SPEEDS[2],
        pinion_torque=TORQUES[1], steps=32,
    )  # fmt: skip
    np.testing.assert_allclose(stiffness.comprehensive_mesh_stiffness[1, 2], table.mesh_stiffness)
    assert stiffness.mean_mesh_stiffness[1, 2] == pytest.approx(table.mean_mesh_stiffness, rel=1e-3)
    middle = stiffness.path.size // 2
    nearest = np.argmin(np.abs(table.path[:, 0] - stiffness.path[middle]))
    assert stiffness.film_stiffness[1, 2, middle] == table.film_stiffness[nearest, 0]


@pytest.mark.parametrize("driver", ["pinion", "wheel"])
def test_places_follow_the_pair_from_entry_to_exit(driver):
    result = study(driver, pinion_torque=100.0, pinion_speed=100.0)
    pair = result.gear_pair
    assert np.all(np.diff(result.roll_angle) >= -1e-12)
    assert np.ptp(result.path) == pytest.approx(pair.transverse_contact_ratio * pair.base_pitch)
    sense = 1.0 if driver == "pinion" else -1.0
    assert np.all(sense * np.diff(result.path) >= -1e-15)
    # one pair carries everything in the middle of the path, and less at both of its ends
    share = result.load_share[0, 0]
    assert share[share.size // 2] == 1.0
    assert max(share[0], share[-1]) < 0.8


def test_formula_film_stiffens_with_torque_and_softens_with_speed(stiffness):
    film = stiffness.film_mesh_stiffness.mean(axis=2)
    assert np.all(np.diff(film, axis=0) > 0.0)
    assert np.all(np.diff(film, axis=1) < 0.0)
    mean = stiffness.mean_mesh_stiffness
    assert np.all(np.diff(mean, axis=0) > 0.0)
    assert np.all(np.diff(mean, axis=1) < 0.0)
    assert np.all(mean < stiffness.mean_tooth_stiffness)
    assert np.all(stiffness.maximum_mesh_stiffness > mean)


def test_stiffness_of_teeth_does_not_know_the_speed(stiffness):
    teeth = stiffness.tooth_stiffness
    np.testing.assert_allclose(teeth, np.repeat(teeth[:, :1], 3, axis=1), rtol=1e-12)


def test_pairs_that_act_on_each_other_are_solved_with_their_films():
    dry, wet = (
        study(stiffness_model="analytic", pinion_torque=150.0, pinion_speed=100.0, **more)
        for more in ({}, {"lubricant": Lubricant(8.2, 880.0, 2.19e-8)})
    )
    assert np.all(wet.film_stiffness.mean() < 0.3 * dry.film_stiffness.mean())
    assert np.all(wet.mean_mesh_stiffness < dry.mean_mesh_stiffness)
    np.testing.assert_allclose(wet.mean_tooth_stiffness, dry.mean_tooth_stiffness, rtol=0.02)
    assert np.all(dry.mean_mesh_stiffness < dry.mean_tooth_stiffness)


def test_data_set_and_line(stiffness):
    data = stiffness.to_xarray()
    sizes = {"torque": 2, "speed": 3, "place": stiffness.path.size, "phase": stiffness.phase.size}
    assert dict(data.sizes) == sizes
    assert data["film_stiffness"].attrs["units"] == "N/m"
    assert "tangent, moes, potential-energy, 2 torques, 3 speeds" in repr(stiffness)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"film_model": "none"}, "no oil film"),
        ({"kind": "none"}, 'kind = "none"'),
        ({"kind": "secant"}, "none, tangent"),
        ({"pinion_torque": -1.0}, "pinion_torque"),
        ({"pinion_speed": [[100.0]]}, "shape"),
    ],
)
def test_models_without_this_stiffness_are_refused(options, message):
    with pytest.raises(InputError, match=message):
        study(**options)
