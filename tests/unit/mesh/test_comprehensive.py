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
    given = {
        "material": Material(),
        "lubricant": OIL,
        "film_model": "moes",
        "pinion_torque": TORQUES,
        "pinion_speed": SPEEDS,
        "steps": 32,
    }
    return comprehensive_stiffness(gears(driver), **{**given, **options})


@pytest.fixture(scope="module")
def found():
    return study()


def test_each_pair_is_a_series_of_teeth_and_film(found):
    expected = 1.0 / (1.0 / found.tooth_stiffness + 1.0 / found.film_stiffness)
    np.testing.assert_allclose(found.pair_stiffness, expected, rtol=1e-6)
    assert found.pair_stiffness.shape == (2, 3, found.path.size)
    assert np.all(found.film_stiffness > 20.0 * found.tooth_stiffness)


def test_mesh_is_the_sum_of_its_pairs(found):
    # 32 intervals of the phase of one pair after another: the ends of the path included
    whole = found.pair_stiffness.sum(axis=2)
    np.testing.assert_allclose(found.comprehensive_mesh_stiffness.sum(axis=2), whole, rtol=1e-9)
    teeth = found.tooth_stiffness.sum(axis=2)
    np.testing.assert_allclose(found.tooth_mesh_stiffness.sum(axis=2), teeth, rtol=1e-9)
    film = found.film_stiffness.sum(axis=2)
    np.testing.assert_allclose(found.film_mesh_stiffness.sum(axis=2), film, rtol=1e-9)


def test_series_of_totals_is_stiffer_than_series_of_pairs(found):
    """Equal only where both pairs have the same ratio of film to teeth."""
    assert np.all(found.series_of_totals >= found.comprehensive_mesh_stiffness * (1.0 - 1e-6))
    np.testing.assert_allclose(
        found.series_of_totals, found.comprehensive_mesh_stiffness, rtol=5e-3
    )


def test_it_is_the_mesh_table_of_each_operating_point(found):
    table = build(
        gears(), material=Material(), lubricant=OIL, friction_law="none", composite_roughness=0.0,
        film_model="moes", film_options={"stiffness": "tangent"}, pinion_speed=SPEEDS[2],
        pinion_torque=TORQUES[1], steps=32,
    )  # fmt: skip
    np.testing.assert_allclose(found.comprehensive_mesh_stiffness[1, 2], table.mesh_stiffness)
    assert found.mean_mesh_stiffness[1, 2] == pytest.approx(table.mean_mesh_stiffness, rel=1e-3)
    middle = found.path.size // 2
    near = np.argmin(np.abs(table.path[:, 0] - found.path[middle]))
    assert found.film_stiffness[1, 2, middle] == table.film_stiffness[near, 0]


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


def test_formula_film_stiffens_with_torque_and_softens_with_speed(found):
    film = found.film_mesh_stiffness.mean(axis=2)
    assert np.all(np.diff(film, axis=0) > 0.0)
    assert np.all(np.diff(film, axis=1) < 0.0)
    mean = found.mean_mesh_stiffness
    assert np.all(np.diff(mean, axis=0) > 0.0)
    assert np.all(np.diff(mean, axis=1) < 0.0)
    assert np.all(mean < found.mean_tooth_stiffness)
    assert np.all(found.maximum_mesh_stiffness > mean)


def test_stiffness_of_teeth_does_not_know_the_speed(found):
    teeth = found.tooth_stiffness
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


def test_data_set_and_line(found):
    data = found.to_xarray()
    sizes = {"torque": 2, "speed": 3, "place": found.path.size, "phase": found.phase.size}
    assert dict(data.sizes) == sizes
    assert data["film_stiffness"].attrs["units"] == "N/m"
    assert "tangent, moes, potential-energy, 2 torques, 3 speeds" in repr(found)


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ({"film_model": "none"}, "no oil film"),
        ({"kind": "none"}, 'kind = "none"'),
        ({"kind": "secant"}, "none, tangent"),
        ({"pinion_torque": -1.0}, "pinion_torque"),
        ({"pinion_speed": [[100.0]]}, "shape"),
    ],
)
def test_what_has_no_such_stiffness_is_refused(options, told):
    with pytest.raises(InputError, match=told):
        study(**options)
