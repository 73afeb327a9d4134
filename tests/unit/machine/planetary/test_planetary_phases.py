"""Phases of the meshes of a planetary stage, and which modes their harmonics excite."""

import numpy as np
import pytest

from known_planetary import LIN_PARKER
from tribodyn.errors import InputError
from tribodyn.machine import mesh_phases, planetary_plane_model


@pytest.mark.parametrize(
    ("teeth", "planets", "printed"),
    [((17, 61), 3, "T T R T T R T T"), ((28, 62), 5, "P T T P R P T T")],
)
def test_printed_harmonics(teeth, planets, printed):
    phases = mesh_phases(sun_teeth=teeth[0], ring_teeth=teeth[1], planets=planets)
    assert " ".join(phases.excitation(i).types for i in range(1, 9)) == printed


@pytest.mark.parametrize(("sun", "ring", "planets"), [(24, 72, 4), (25, 71, 6), (20, 61, 9)])
def test_the_sums_of_phases_are_the_rule_of_whole_numbers(sun, ring, planets):
    phases = mesh_phases(sun_teeth=sun, ring_teeth=ring, planets=planets)
    for harmonic in range(1, 2 * planets):
        remainder = harmonic * sun % planets
        rule = "R" if remainder == 0 else "T" if remainder in (1, planets - 1) else "P"
        excitation = phases.excitation(harmonic)
        assert excitation.types == rule
        total = excitation.rotational + excitation.translational + excitation.planet
        assert total == pytest.approx(1.0)


def test_phases_are_lags_of_sun_and_ring():
    phases = mesh_phases(sun_teeth=17, ring_teeth=-61, planets=3, sun_to_ring=0.25)
    np.testing.assert_allclose(phases.sun, [0.0, 2 / 3, 1 / 3], atol=1e-12)
    np.testing.assert_allclose(phases.ring, [0.25, 11 / 12, 7 / 12], atol=1e-12)
    np.testing.assert_allclose(phases.sun_offset, [0.0, 1 / 3, 2 / 3], atol=1e-12)
    assert phases.ring_offset.max() < 1.0


def test_teeth_that_pass_a_planet_pass_the_next_one_later():
    """Positions of real teeth: tooth k of the sun reaches a planet where their angles agree."""
    angles = 2 * np.pi / 78 * np.array([0, 20, 39, 59])
    phases = mesh_phases(sun_teeth=17, ring_teeth=61, planets=4, angles=angles)
    step = 2 * np.pi / 17
    for angle, lag in zip(angles, phases.sun, strict=True):
        arrival = angle - step * np.arange(20)  # turn of the sun at which tooth k is there
        assert np.abs((arrival / step - lag + 0.5) % 1.0 - 0.5).max() < 1e-9
    # The ring turns backwards relative to the carrier, with as many mesh cycles per second.
    step = 2 * np.pi / 61
    for angle, lag in zip(angles, phases.ring, strict=True):
        arrival = step * np.arange(70) - angle
        assert np.abs((arrival / step - lag + 0.5) % 1.0 - 0.5).max() < 1e-9


def test_unequal_spacing_excites_several_types_at_once():
    angles = 2 * np.pi / 78 * np.array([0, 20, 39, 59])
    phases = mesh_phases(sun_teeth=17, ring_teeth=61, planets=4, angles=angles)
    # Opposite pairs, half a cycle apart: odd harmonics cancel in the rotation.
    assert [phases.excitation(i).types for i in (1, 2, 3, 4)] == ["T", "RP", "T", "RP"]
    uneven = mesh_phases(
        sun_teeth=17, ring_teeth=61, planets=4, angles=2 * np.pi / 78 * np.array([0, 19, 39, 60])
    )
    assert uneven.excitation(1).types == "RTP"
    rotation = abs(np.exp(2j * np.pi * uneven.sun).mean()) ** 2
    assert uneven.excitation(1).rotational == pytest.approx(rotation)


def test_planets_that_do_not_fit_have_no_phases():
    with pytest.raises(InputError, match=r"\(61 \+ 17\)/4 = 19.5 is not whole.*2, 3, 6 planets"):
        mesh_phases(sun_teeth=17, ring_teeth=61, planets=4)
    with pytest.raises(InputError, match=r"has the shape \(2,\) for 3 planets"):
        mesh_phases(sun_teeth=17, ring_teeth=61, planets=3, angles=[0.0, 2.0])
    with pytest.raises(InputError, match="harmonic"):
        mesh_phases(sun_teeth=17, ring_teeth=61, planets=3).excitation(0)


def test_contacts_of_the_model_take_phases_and_angles():
    varying = {"sun_mesh_stiffness": lambda x: 5e8 + 1e7 * np.cos(2 * np.pi * x)}
    phases = mesh_phases(
        sun_teeth=17, ring_teeth=61, planets=4, angles=2 * np.pi / 78 * np.array([0, 20, 39, 59])
    )
    stage = planetary_plane_model(planets=4, phases=phases, **{**LIN_PARKER, **varying})
    offsets = [contact.offset for contact in stage.contacts]
    np.testing.assert_allclose(offsets, [*phases.sun_offset, *phases.ring_offset])
    same = planetary_plane_model(planets=4, angles=phases.angles, **LIN_PARKER)
    np.testing.assert_array_equal(
        [contact.direction for contact in stage.contacts],
        [contact.direction for contact in same.contacts],
    )
    with pytest.raises(InputError, match=r"sun_mesh_stiffness is a function, and phases"):
        planetary_plane_model(planets=4, **{**LIN_PARKER, **varying})
    with pytest.raises(InputError, match="phases has 4 planets, and planets = 3"):
        planetary_plane_model(planets=3, phases=phases, **LIN_PARKER)
    with pytest.raises(InputError, match="angles differ from those of phases"):
        planetary_plane_model(planets=4, phases=phases, angles=[0.0, 1.5, 3.0, 4.5], **LIN_PARKER)
