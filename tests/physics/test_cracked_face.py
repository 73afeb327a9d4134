"""Root cracks on a part of the face: limits, reciprocity, symmetry, and loads that move away."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from references.cracked_solid import COMPLIANCE, CRACK_END, FACE
from references.cracked_tooth import RADII
from references.gear_compliance import MODULUS, POISSON, outline_of
from tribodyn.arrays.splines import bspline_integrals
from tribodyn.errors import InputError
from tribodyn.faults import Crack, crack_compliance, crack_influence, turning_mesh
from tribodyn.gear import Material, SpurGear, SpurPair, cylindrical_pair
from tribodyn.stiffness.fe2d import MeshSize
from tribodyn.stiffness.fe3d import SolidSize
from tribodyn.stiffness.fe3d.sections import FaceSize
from tribodyn.stiffness.teeth.face_influence import FaceInfluence
from tribodyn.types import Array

STEEL = Material()
COARSE = SolidSize(MeshSize(0.4, 0.9, 2.2, 1.4, 0.9, 2), FaceSize(0.6, 2.0, 2.0), depth=1.5)


def pair_of(degrees: float = 0.0) -> SpurPair:
    return cylindrical_pair(
        pinion_teeth=16, wheel_teeth=24, normal_module=4.5e-3, pinion_face_width=0.014,
        normal_pressure_angle=math.radians(20.0), pinion_bore_diameter=0.03,
        wheel_bore_diameter=0.03, pinion_profile_shift_coefficient=0.18,
        wheel_profile_shift_coefficient=0.17, helix_angle=math.radians(degrees),
    )  # fmt: skip


def wheel(face_width: float, degrees: float = 0.0) -> SpurGear:
    return replace(pair_of(degrees).wheel, face_width=face_width)


def influence(gear: SpurGear, depth: float, *ends: float) -> FaceInfluence:
    return crack_influence(gear, STEEL, depth, (ends[0], ends[1]), size=COARSE)


def under_even_load(added: FaceInfluence) -> Array:
    """Mean displacement over the face per load per width [m^2/N]."""
    over_face = bspline_integrals(added.knots, np.array([0.0, added.face_width]))[0]
    mean = np.einsum("a,iiab,b->i", over_face, added.self_compliance, over_face)
    return np.asarray(mean / added.face_width)


@pytest.mark.slow
def test_a_crack_over_a_wide_face_is_that_of_plane_strain() -> None:
    gear = wheel(0.06)
    added = influence(gear, 2e-3, 0.0, 0.06)
    plane_stress = np.interp(added.curvature_radius, *crack_compliance(gear, STEEL, 2e-3))
    ratio = under_even_load(added) / plane_stress
    np.testing.assert_allclose(ratio, 1.0 - STEEL.poissons_ratio**2, rtol=0.02)


@pytest.mark.slow
def test_compliance_is_reciprocal_and_grows_with_the_crack() -> None:
    gear = wheel(0.014, 20.0)
    cracks = [(1e-3, 5e-3), (2e-3, 5e-3), (2e-3, 14e-3)]
    meshes = [influence(gear, depth, 0.0, length) for depth, length in cracks]
    for added in meshes:
        table = added.self_compliance
        np.testing.assert_allclose(table, table.transpose(1, 0, 3, 2), atol=1e-12 * table.max())
        flat = table.transpose(0, 2, 1, 3).reshape(table.shape[0] * table.shape[2], -1)
        assert np.linalg.eigvalsh(flat).min() > -1e-12 * np.abs(flat).max()
    sizes = np.array([under_even_load(added) for added in meshes])
    assert np.all(np.diff(sizes, axis=0) > 0.0)
    # under loads near the tip a third of the face adds less than a third: the sound part holds it
    assert np.all(sizes[1, 4:] < sizes[2, 4:] * 5.0 / 14.0)


def test_slices_of_a_crack_at_either_end_mirror_each_other() -> None:
    edges = np.linspace(-7e-3, 7e-3, 8)
    at_ends = [
        influence(wheel(0.014), 2e-3, *ends).sliced(edges).coefficients[0]
        for ends in ((0.0, 5e-3), (9e-3, 14e-3))
    ]
    np.testing.assert_allclose(at_ends[0], at_ends[1][::-1, ::-1], atol=1e-9 * at_ends[0].max())
    own = at_ends[0].sum(axis=(2, 3)).diagonal()
    assert own[0] > 3.0 * own[4] > 0.0  # where the crack is, the tooth is softer


@pytest.mark.slow
def test_crack_at_one_end_against_wedges() -> None:
    outline = outline_of("type C pinion")
    gear = SpurGear(
        teeth=outline.teeth, normal_module=1e-3 * outline.module, face_width=1e-3 * FACE[-1],
        normal_pressure_angle=math.radians(20.0), profile_shift_coefficient=outline.shift,
        tip_diameter=2e-3 * outline.tip_radius, bore_diameter=2e-3 * outline.bore_radius,
    )  # fmt: skip
    material = Material(youngs_modulus=1e6 * MODULUS, poissons_ratio=POISSON)
    added = crack_influence(
        gear, material, 2.5e-3, (0.0, 1e-3 * CRACK_END), root_tangent=math.radians(30.0)
    )
    radius = 1e-3 * np.array(RADII)
    computed = 1e12 * np.interp(radius, added.curvature_radius, under_even_load(added))
    np.testing.assert_allclose(computed, COMPLIANCE, rtol=0.04)


def test_what_a_crack_along_the_face_needs() -> None:
    short = Crack(tooth=4, depth=2e-3, face_length=5e-3, face_position=4.5e-3)
    with pytest.raises(InputError, match='"analytic" is a plane model'):
        turning_mesh(pair_of(), 90.0, [short], provider="analytic")
    with pytest.raises(InputError, match="cracked tooth is helical"):
        turning_mesh(pair_of(20.0), 90.0, [Crack(depth=1e-3)], provider="analytic")
    with pytest.raises(InputError, match=r"reaches 8 mm .* ends 7 mm"):
        turning_mesh(pair_of(), 90.0, [replace(short, face_position=5.5e-3)], provider="fe3d")
    with pytest.raises(InputError, match="Each of them is the length"):
        Crack(depth=1e-3, face_length=5e-3, face_share=0.5)


@pytest.mark.slow
@pytest.mark.parametrize("degrees", [0.0, 20.0])
def test_load_moves_from_the_cracked_part_of_the_face(degrees: float) -> None:
    pair = pair_of(degrees)
    crack = Crack(tooth=4, depth=2.5e-3, face_length=5e-3, face_position=4.5e-3)
    none = [replace(crack, depth=0.0), replace(crack, face_length=0.0, face_position=0.0)]
    cracks = [*none, crack, replace(crack, face_length=9e-3, face_position=2.5e-3)]
    meshes = [turning_mesh(pair, 90.0, [each], provider="fe3d", phases=16) for each in cracks]
    sound, short = meshes[0], meshes[2]
    np.testing.assert_array_equal(meshes[1].transmission_error, sound.transmission_error)
    for mesh in meshes:
        np.testing.assert_allclose(mesh.load_share.sum(axis=1), 1.0, rtol=1e-9)
    softer = [(mesh.transmission_error - sound.transmission_error).max() for mesh in meshes]
    assert softer[3] > softer[2] > 1e-8
    others = np.delete(short.face_load, [1, 2, 3, 4, 5], axis=0)  # mates share a cycle with tooth 4
    np.testing.assert_allclose(others, np.delete(sound.face_load, [1, 2, 3, 4, 5], 0), rtol=1e-3)
    change = (short.face_load / sound.face_load)[3]  # tooth 4
    assert change[-8:].max() < change[:8].min()
    assert change[:8].max() > change[-1] + 0.01
    # one event a turn of the pinion: lines at all its orders
    error = short.transmission_error[:-1] - sound.transmission_error[:-1]
    lines = np.abs(np.fft.rfft(error))
    assert lines[1:8].min() > 0.2 * lines[1:8].max()
