"""Plane model of a planetary stage: matrices, modes and their types."""

import numpy as np
import pytest

from known_planetary import ALPHA, FREQUENCIES, LIN_PARKER
from tribodyn.dynamics import System, natural_modes
from tribodyn.errors import InputError
from tribodyn.machine import planetary_modes, planetary_plane_model

NO_SUPPORTS = {
    "carrier_support": 0.0, "ring_support": 0.0, "sun_support": 0.0, "ring_torsional_support": 0.0,
}  # fmt: skip


@pytest.mark.parametrize("planets", [3, 4])
def test_printed_frequencies_with_their_types_and_multiplicities(planets):
    modes = planetary_modes(planetary_plane_model(planets=planets, **LIN_PARKER))
    times = {"rotational": 1, "translational": 2, "planet": planets - 3}
    for kind, printed in FREQUENCIES[planets].items():
        expected = np.repeat(printed, times[kind])
        np.testing.assert_allclose(modes.of_type(kind), expected, rtol=0, atol=0.0051)
    assert "mixed" not in modes.types


def test_five_planets_have_planet_modes_twice():
    modes = planetary_modes(planetary_plane_model(planets=5, **LIN_PARKER))
    planet = modes.of_type("planet")
    np.testing.assert_allclose(planet[0::2], planet[1::2], rtol=1e-9)
    # Modes of the planets alone do not depend on their number.
    printed = FREQUENCIES[4]["planet"]
    np.testing.assert_allclose(planet[0::2], printed, rtol=0, atol=0.0051)


def test_unequal_spacing_mixes_the_types():
    angles = 2 * np.pi / 78 * np.array([0, 19, 39, 60])
    modes = planetary_modes(planetary_plane_model(planets=4, angles=angles, **LIN_PARKER))
    assert modes.types.count("mixed") > 12
    np.testing.assert_allclose(modes.angles, angles, atol=1e-9)
    printed = FREQUENCIES[4]["translational"][0]
    assert modes.frequency[2] - modes.frequency[1] > 1.0  # the pair of translations has split
    assert modes.frequency[1] < printed < modes.frequency[2]


def test_modes_of_one_frequency_are_separated_by_their_type():
    modes = planetary_modes(planetary_plane_model(planets=5, **(LIN_PARKER | NO_SUPPORTS)))
    # Of 6 coordinates of each type 4 strain a pin radially or tangentially, or one of the meshes.
    assert sorted(modes.types[:6]) == ["rotational"] * 2 + ["translational"] * 4
    np.testing.assert_array_equal(modes.frequency[:6], 0.0)
    assert modes.frequency[6] > 100.0
    counts = {each: modes.types.count(each) for each in ("rotational", "translational", "planet")}
    assert counts == {"rotational": 6, "translational": 12, "planet": 6}
    mass = np.diag(planetary_plane_model(planets=5, **LIN_PARKER).mass)
    np.testing.assert_allclose((modes.shape * mass) @ modes.shape.T, np.eye(24), atol=1e-9)


def test_rigid_motions_and_the_ratio_of_the_stage_strain_nothing():
    """Base circles of a stage with two pressure angles; a wrong sign strains a mesh."""
    pins, sun_angle, ring_angle = 0.08, np.radians(24.0), np.radians(19.0)
    sun, planet = 0.03, 0.08 * np.cos(sun_angle) - 0.03
    ring = pins * np.cos(ring_angle) + planet
    data = LIN_PARKER | NO_SUPPORTS
    data |= {"sun_pressure_angle": sun_angle, "ring_pressure_angle": ring_angle}
    angles = np.array([0.3, 2.0, 4.4])
    stage = planetary_plane_model(planets=3, angles=angles, **data)
    stiffness = natural_modes(stage).linear.stiffness
    along_x, turning, running = (np.zeros(18) for _ in range(3))
    along_x[0::3] = 1.0
    turning[[2, 5, 8]] = pins, ring, sun
    turning[9::3], turning[10::3] = -pins * np.sin(angles), pins * np.cos(angles)
    turning[11::3] = planet
    running[8], running[5], running[11::3] = -1.0, 1.0, 1.0  # the carrier at rest
    for motion in (along_x, turning, running):
        assert np.abs(stiffness @ motion).max() < 1e-6 * np.abs(stiffness).max()


def test_load_is_that_of_every_mesh_and_balances():
    stage = planetary_plane_model(planets=3, force_per_planet=2000.0, **LIN_PARKER)
    free = np.linalg.pinv(natural_modes(stage).linear.stiffness, rcond=1e-13)
    position = free @ np.asarray(stage.force)
    forces = [5e8 * np.asarray(contact.direction) @ position for contact in stage.contacts]
    np.testing.assert_allclose(forces, 2000.0, rtol=1e-9)
    # The carrier takes twice the tangential force of every planet.
    assert stage.force[2] == pytest.approx(-3 * 2 * 2000.0 * np.cos(ALPHA))


def test_damping_ratio_is_that_of_every_mode():
    stage = planetary_plane_model(planets=4, damping_ratio=0.03, **LIN_PARKER)
    np.testing.assert_allclose(natural_modes(stage).damping_ratio[1:], 0.03, rtol=1e-9)


def test_frame_of_a_turning_carrier_shifts_frequencies_by_its_speed():
    """A body on an isotropic support vibrates at f0 +- n in a frame that turns with n."""
    loose = {"sun_mesh_stiffness": 1.0, "ring_mesh_stiffness": 1.0, "pin_stiffness": 1.0}
    loose |= {"planet_mass": 1e-9, "planet_inertia": 1e-9}
    stage = planetary_plane_model(
        planets=3, carrier_speed=2 * np.pi * 100.0, **{**LIN_PARKER, **loose}
    )
    frequencies = natural_modes(stage).frequency
    for mass in (5.43, 2.35, 0.40):
        at_rest = np.sqrt(1e8 / mass) / (2 * np.pi)
        for shifted in (at_rest - 100.0, at_rest + 100.0):
            assert np.abs(frequencies - shifted).min() < 1e-3


def test_planets_may_differ_from_each_other():
    data = LIN_PARKER | {"planet_mass": [0.66, 0.66, 0.70], "pin_stiffness": [1e8, 1e8, 1e8]}
    stage = planetary_plane_model(planets=3, **data)
    assert np.diag(np.asarray(stage.mass))[9::3].tolist() == [0.66, 0.66, 0.70]
    assert "mixed" in planetary_modes(stage).types


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"sun_mass": 0.0}, "sun_mass"),
        ({"carrier_support": -1.0}, "carrier_support"),
        ({"sun_pressure_angle": 24.6}, "sun_pressure_angle.*radians"),
        ({"planet_mass": [0.6, 0.6]}, r"planet_mass has the shape \(2,\), and there are 3 planets"),
        ({"sun_mesh_stiffness": [5e8, 5e8]}, "sun_mesh_stiffness has 2 entries"),
        ({"sun_mesh_stiffness": 0.0}, "sun_mesh_stiffness"),
        ({"planets": 0}, "planets"),
        ({"pin_errors": [30.0, 0.0, 0.0]}, "pin_errors.*30.*0.1 m"),
        ({"angles": [0.0, 120.0, 240.0]}, "angles.*120.*Give radians"),
        ({"force_per_planet": 1.0, "sun_torsional_support": 1.0, "carrier_torsional_support": 1.0},
         "no member is free to turn"),
    ],
)  # fmt: skip
def test_wrong_data_are_refused_by_name(changes, message):
    with pytest.raises(InputError, match=message):
        planetary_plane_model(**{"planets": 3, **LIN_PARKER, **changes})


def test_modes_are_exported_with_their_types():
    data = planetary_modes(planetary_plane_model(planets=3, **LIN_PARKER)).to_xarray()
    assert data.frequency.where(data.type == "rotational", drop=True).size == 6


def test_only_modes_of_a_plane_model_have_types():
    with pytest.raises(InputError, match="coordinates are q0"):
        planetary_modes(System([[1.0]], [[0.0]], [[1.0]], [0.0]))
