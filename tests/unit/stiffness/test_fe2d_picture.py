"""Displacements of the outline for a picture of the loaded gear."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tribodyn.errors import InputError
from tribodyn.gear import Material, SpurGear
from tribodyn.stiffness.fe2d import deformed_gear

STEEL = Material()


@pytest.fixture(scope="module")
def gear() -> SpurGear:
    return SpurGear(
        teeth=12,
        normal_module=3e-3,
        normal_pressure_angle=math.radians(20.0),
        profile_shift_coefficient=0.4,
        tip_diameter=43.8e-3,
        face_width=10e-3,
        bore_diameter=14e-3,
    )


def turned(vectors: np.ndarray, angle: float) -> np.ndarray:
    """Vectors turned anticlockwise."""
    cosine, sine = math.cos(angle), math.sin(angle)
    return np.array([[cosine, -sine], [sine, cosine]]) @ vectors


def test_outline_is_that_of_the_gear_in_order(gear):
    outline, displacement = deformed_gear(gear, STEEL, [(0, 7e-3, 1e5)])
    assert outline.shape == displacement.shape
    radius, angle = np.hypot(*outline), np.unwrap(np.arctan2(outline[1], outline[0]))
    assert radius.max() == pytest.approx(gear.tip_radius)
    assert radius.min() == pytest.approx(gear.root_radius)
    # three teeth, anticlockwise, the loaded one in the middle
    assert angle[-1] - angle[0] == pytest.approx(3.0 * 2.0 * math.pi / 12)
    assert 0.5 * (angle[0] + angle[-1]) == pytest.approx(0.5 * math.pi)
    assert np.hypot(*np.diff(outline)).max() < 0.3 * gear.normal_module
    assert (outline.shape[1] - 1) % 3 == 0


def test_ring_bends_where_it_is_loaded():
    ring = SpurGear(
        teeth=-40,
        normal_module=3e-3,
        normal_pressure_angle=math.radians(20.0),
        profile_shift_coefficient=0.0,
        tip_diameter=114e-3,
        face_width=10e-3,
    )
    # right flanks of tooth 0 and of its neighbour on the left, whose contact has a larger radius
    outline, moved = deformed_gear(ring, STEEL, [(0, 22e-3, 1e5), (1, 29e-3, 0.0)])
    assert np.hypot(*outline).min() == pytest.approx(ring.tip_radius)
    angle = np.unwrap(np.arctan2(outline[1], outline[0]))
    assert 0.5 * (angle[0] + angle[-1]) == pytest.approx(math.pi / 2.0 + math.pi / 40)
    assert np.hypot(*np.diff(outline)).max() < 0.3 * ring.normal_module
    largest = np.hypot(*moved).argmax()
    assert abs(math.atan2(outline[0, largest], outline[1, largest])) < math.pi / 40
    # pushed to the left, into its material
    assert moved[0, largest] < -1e-6
    with pytest.raises(InputError, match="flank"):
        deformed_gear(ring, STEEL, [(0, 8e-3, 1e5)])


def test_loaded_tooth_bends_away_from_its_load(gear):
    outline, moved = deformed_gear(gear, STEEL, [(0, 9e-3, 1e5)])
    top = (outline[1] > 0.999 * gear.tip_radius * math.cos(0.02)) & (abs(outline[0]) < 1e-3)
    assert np.all(moved[0, top] < -3e-6)
    largest = np.hypot(*moved).argmax()
    assert abs(math.atan2(outline[0, largest], outline[1, largest])) < math.pi / 12


def test_displacement_grows_with_the_load_and_falls_with_the_modulus(gear):
    _, moved = deformed_gear(gear, STEEL, [(0, 7e-3, 1e5)])
    _, more = deformed_gear(gear, STEEL, [(0, 7e-3, 3e5)])
    _, soft = deformed_gear(gear, Material(youngs_modulus=103e9), [(0, 7e-3, 1e5)])
    assert more == pytest.approx(3.0 * moved, rel=1e-9, abs=1e-18)
    assert soft == pytest.approx(2.0 * moved, rel=1e-9, abs=1e-18)


def test_loads_add_up_and_turn_with_their_tooth(gear):
    pitch = 2.0 * math.pi / 12
    outline, loaded = deformed_gear(gear, STEEL, [(0, 7e-3, 1e5), (1, 9e-3, 5e4)])
    first = deformed_gear(gear, STEEL, [(0, 7e-3, 1e5)])
    second = deformed_gear(gear, STEEL, [(0, 9e-3, 5e4)])
    # tooth 1 is the clockwise one; each alone shows three teeth of the four
    per_tooth = (first[0].shape[1] - 1) // 3
    alone = np.zeros_like(loaded)
    turned_back = turned(second[0], -pitch)
    assert turned_back == pytest.approx(outline[:, : turned_back.shape[1]], abs=1e-12)
    assert first[0] == pytest.approx(outline[:, -first[0].shape[1] :], abs=1e-12)
    alone[:, -first[0].shape[1] :] += first[1]
    alone[:, : turned_back.shape[1]] += turned(second[1], -pitch)
    shared = slice(per_tooth, 3 * per_tooth)
    assert loaded[:, shared] == pytest.approx(alone[:, shared], abs=1e-15)


def test_rim_differs_by_a_turn_of_the_body(gear):
    outline, bore = deformed_gear(gear, STEEL, [(0, 7e-3, 1e5)])
    _, rim = deformed_gear(gear, STEEL, [(0, 7e-3, 1e5)], reference="rim")
    gap = bore - rim
    around = (outline[0] * gap[1] - outline[1] * gap[0]) / np.hypot(*outline) ** 2
    assert around == pytest.approx(around[0], rel=1e-9)
    assert around[0] > 0.0
    assert (outline * gap).sum(axis=0) == pytest.approx(0.0, abs=1e-18)


def test_all_teeth_close_the_ring(gear):
    loads = [(tooth, 7e-3, 1e5) for tooth in range(12)]
    outline, moved = deformed_gear(gear, STEEL, loads)
    assert outline[:, 0] == pytest.approx(outline[:, -1], abs=1e-12)
    assert moved[:, 0] == pytest.approx(moved[:, -1], abs=1e-15)
    per_tooth = (outline.shape[1] - 1) // 12
    assert turned(moved[:, :per_tooth], 2.0 * math.pi / 12) == pytest.approx(
        moved[:, per_tooth : 2 * per_tooth], abs=1e-14
    )


def test_dent_does_not_hide_the_bending(gear):
    outline, moved = deformed_gear(gear, STEEL, [(0, 9.5e-3, 1e5)])
    jump = np.hypot(*np.diff(moved))
    assert jump.max() < 0.12 * np.hypot(*moved).max()
    assert outline.shape[1] > 300


@pytest.mark.parametrize("loads", [[], [(0, -1e-3, 1e5)], [(0, 0.1, 1e5)]])
def test_wrong_loads_are_refused(gear, loads):
    with pytest.raises(InputError, match="argument loads"):
        deformed_gear(gear, STEEL, loads)
