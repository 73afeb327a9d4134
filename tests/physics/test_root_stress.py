"""Root stress by finite elements: notched plate, refinement, Y_F Y_S, neighbours, motion."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.linalg import spsolve

from known_hypoids import h1043
from known_ratings import helical_example, ring_example, spur_example
from tribodyn.errors import InputError
from tribodyn.gear import Material
from tribodyn.lubricant import Lubricant
from tribodyn.mesh import MeshTable, build
from tribodyn.rating import root_stress_by_elements
from tribodyn.rating.root_section import root_section, virtual_teeth
from tribodyn.stiffness.fe2d.picture import deformed_gear
from tribodyn.stiffness.fe2d.ring import element_stiffness, plane_stress
from tribodyn.stiffness.fe2d.root_stress import (
    at_places,
    computed_root_stress,
    root_stress,
    surface_stress,
    virtual_spur_gear,
)
from tribodyn.stiffness.fe2d.tooth_mesh import MeshSize, grid_elements
from tribodyn.stiffness.fe3d import SolidSize
from tribodyn.stiffness.fe3d.provider import gear_sector
from tribodyn.stiffness.fe3d.root_spread import SIZE, RootSpread, computed_spread
from tribodyn.stiffness.fe3d.sections import FaceSize

NU = 0.3
PAIRS = {"spur": spur_example, "helical": helical_example, "ring": ring_example}


def mesh_of(pair) -> MeshTable:
    return build(
        pair, material=Material(), stiffness_model="analytic", friction_law="none",
        lubricant=Lubricant(0.082, 880.0, 2.19e-8), composite_roughness=0.0,
        pinion_speed=100.0, pinion_torque=200.0, steps=64,
    )  # fmt: skip


def kirsch(nodes: np.ndarray) -> np.ndarray:
    """Displacements of an infinite plate with a hole of radius 1 under a tension of 1 along x."""
    r, t = np.hypot(*nodes.T), np.arctan2(nodes[:, 1], nodes[:, 0])
    kappa, shear = (3.0 - NU) / (1.0 + NU), 0.5 / (1.0 + NU)
    scale = 1.0 / (8.0 * shear)
    outward = scale * (
        r * (kappa - 1.0 + 2.0 * np.cos(2.0 * t))
        + 2.0 / r * (1.0 + (kappa + 1.0 - 1.0 / r**2) * np.cos(2.0 * t))
    )
    around = -scale * 2.0 * np.sin(2.0 * t) * (r + (kappa - 1.0 + 1.0 / r**2) / r)
    x = outward * np.cos(t) - around * np.sin(t)
    return np.stack([x, outward * np.sin(t) + around * np.cos(t)], axis=1)


@pytest.mark.parametrize(("per_quarter", "tolerance"), [(12, 0.01), (24, 0.002)])
def test_the_edge_of_a_hole_in_a_plate_has_three_times_the_tension(per_quarter, tolerance):
    angle = np.linspace(0.0, 0.5 * math.pi, 2 * per_quarter + 1)[:, None]
    radius = np.geomspace(1.0, 3.0, per_quarter + 1)[None, :]
    nodes = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1).reshape(-1, 2)
    grid = np.arange(len(nodes)).reshape(angle.size, -1)
    elements = grid_elements(grid[::-1])
    matrices = element_stiffness(nodes[elements], plane_stress(1.0, NU))
    freedoms = (2 * elements[:, :, None] + np.arange(2)).reshape(len(elements), 18)
    rows, columns = (np.broadcast_to(f, matrices.shape) for f in
                     (freedoms[:, :, None], freedoms[:, None, :]))  # fmt: skip
    matrix = coo_array((matrices.ravel(), (rows.ravel(), columns.ravel()))).tocsr()
    exact = kirsch(nodes).ravel()
    held = np.unique(np.concatenate([grid[0], grid[-1], grid[:, -1]]))
    fixed = (2 * held[:, None] + np.arange(2)).ravel()
    free = np.setdiff1d(np.arange(exact.size), fixed)
    moved = exact.copy()
    moved[free] = spsolve(matrix[free][:, free], -matrix[free][:, fixed] @ exact[fixed])
    stress, points = surface_stress(nodes, grid[:, 0], moved.reshape(-1, 2, 1))
    expected = 1.0 - 2.0 * np.cos(2.0 * np.arctan2(points[:, 1], points[:, 0]))
    assert np.abs(stress[:, 0] - expected).max() < 3.0 * tolerance
    assert stress.max() == pytest.approx(3.0, rel=0.02)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "gear"), [("spur", "pinion"), ("helical", "wheel"), ("ring", "wheel")]
)
def test_two_refinements_agree_and_stand_beside_the_form_factor(name, gear, record_property):
    pair = PAIRS[name]()
    part = getattr(pair, gear)
    spur = virtual_spur_gear(part, virtual_teeth(part))
    fillet = root_section(spur, None, 2019).fillet_radius
    units = [computed_root_stress(spur, fillet, refined) for refined in (1.0, 1.4)]
    radii = units[0].curvature_radius
    at = radii.min() + np.linspace(0.4, 0.9, 6) * np.ptp(radii)
    peaks = [at_places(unit, 0, at).max(axis=1) for unit in units]
    assert peaks[0] == pytest.approx(peaks[1], rel=0.01)
    ratio = root_stress_by_elements(pair, gear).ratio
    record_property("ratio", ratio)
    assert 0.88 < ratio < 1.15


@pytest.mark.parametrize("gear", [spur_example().pinion, ring_example().wheel])
def test_loads_of_neighbours_stretch_the_root_as_in_the_picture_of_the_ring(gear):
    """The outline of the deformed gear: another mesh, another way to the neighbour."""
    unit = computed_root_stress(gear, root_section(gear, None, 2019).fillet_radius, 0.5)
    at = float(unit.curvature_radius.min() + 0.6 * np.ptp(unit.curvature_radius))
    distance = gear.sign * np.hypot(*unit.position.T).max() * gear.normal_module
    if gear.is_ring:
        distance = -np.hypot(*unit.position.T).min() * gear.normal_module
    for neighbour in (-1, 1):
        outline, moved = deformed_gear(gear, Material(), [(0, at, 0.0), (neighbour, at, 1e6)])
        step, change = np.diff(outline, axis=1), np.diff(moved, axis=1)
        strain = (step * change).sum(axis=0) / (step**2).sum(axis=0)
        middle = 0.5 * (outline[:, 1:] + outline[:, :-1])
        angle, radius = np.arctan2(*middle), gear.sign * np.hypot(*middle)
        fillet = (angle > 0.0) & (angle < math.pi / abs(gear.teeth)) & (radius < distance)
        drawn = strain[fillet] * Material().youngs_modulus * gear.normal_module / 1e6
        computed = at_places(unit, neighbour, np.array(at))
        ours, theirs = (each[np.abs(each).argmax()] for each in (computed, drawn))
        assert ours == pytest.approx(theirs, rel=0.05)


def test_the_load_of_one_pair_bends_as_without_the_others():
    """Where one tooth pair carries all."""
    pair = spur_example()
    table = mesh_of(pair)
    root = root_stress_by_elements(pair, "pinion", table)
    single = table.load_share.max(axis=1) > 1.0 - 1e-9
    unit = root_stress(pair.pinion, root_section(pair.pinion, None, 2019).fillet_radius)
    radius = table.pinion_curvature_radius[single].max(axis=1)
    alone = at_places(unit, 0, radius).max(axis=1)
    alone *= table.total_normal_force / pair.common_face_width / pair.pinion.normal_module
    assert root.stress[single] == pytest.approx(alone, rel=1e-9)
    doubled = root.under_force(table.phase, np.full(table.phase.size, 2.0 * root.force))
    assert doubled == pytest.approx(2.0 * root.greatest, rel=1e-9)
    at_one_phase = np.where(np.arange(table.phase.size) == 40, root.force, 0.0)
    assert root.under_force(table.phase, at_one_phase) == pytest.approx(root.stress[40], rel=1e-6)


def test_a_hypoid_pair_is_refused_by_name():
    with pytest.raises(InputError, match="hypoid"):
        root_stress_by_elements(h1043(), "pinion")


@pytest.mark.parametrize("gear", ["pinion", "wheel"])
def test_slices_of_hardly_inclined_teeth_are_stressed_as_straight_ones(gear):
    """Normal section, virtual gear and slices against the transverse section of whole pairs."""
    straight, inclined = spur_example(), spur_example(helix_angle=2e-3)
    tables = [mesh_of(pair) for pair in (straight, inclined)]
    assert tables[0].face_position is None
    assert tables[1].face_position is not None
    whole, sliced = (
        root_stress_by_elements(pair, gear, table)
        for pair, table in zip((straight, inclined), tables, strict=True)
    )
    assert sliced.ratio == pytest.approx(whole.ratio, rel=1e-3)
    assert sliced.greatest == pytest.approx(whole.greatest, rel=0.03)


FINER = SolidSize(section=MeshSize(0.19, 0.19, 1.3, 0.7, 0.4, 3), face=FaceSize(0.3, 1.2))
#: Face width and slices of a load, over the module.
WIDTH, SLICES = 6.0, 18


def spread_of(pair, gear, size=SIZE) -> RootSpread:
    return computed_spread(gear_sector(getattr(pair, gear), NU, size))


def wide(**changes):
    return spur_example(pinion_face_width=27e-3, **changes)


@pytest.mark.parametrize("gear", ["pinion", "wheel"])
def test_an_even_load_stresses_a_straight_tooth_as_in_a_plane_section(gear):
    parts = spread_of(wide(), gear).between(SLICES, WIDTH)
    assert parts.sum(axis=2) == pytest.approx(1.0, abs=0.01)
    # a load in the middle bends the whole root as much as an even one; at an end it has one side
    assert parts.sum(axis=1)[:, 6:12] == pytest.approx(1.0, abs=0.06)
    assert np.all(parts[:, 0, 0] > 1.5 * parts[:, SLICES // 2, SLICES // 2])


@pytest.mark.slow
def test_the_ends_of_an_inclined_tooth_are_stressed_unlike():
    """Of loads near the root the end that lines of contact leave at the tip carries more."""
    inclined = wide(helix_angle=math.radians(15.0), center_distance=None)
    even = spread_of(inclined, "pinion").between(SLICES, WIDTH).sum(axis=2)
    assert even[:, 8:10] == pytest.approx(1.0, abs=0.03)
    assert np.all(even[:4, 1] > 1.05 * even[:4, -2])


@pytest.mark.slow
def test_finer_solid_elements_spread_an_oblique_load_alike():
    pair = wide(helix_angle=math.radians(15.0), center_distance=None)
    stresses = []
    for size in (SIZE, FINER):
        spread = spread_of(pair, "pinion", size)
        low, high = np.quantile(spread_of(pair, "pinion").curvature_radius, [0.25, 0.9])
        lines = [np.linspace(high, low, SLICES), np.full(SLICES, high)]
        loads = [np.ones(SLICES), (np.arange(SLICES) < 5) * 1.0]
        for radii, load in zip(lines, loads, strict=True):
            stresses.append(float((spread.at_radii(radii[None], WIDTH)[0] @ load).max()))
    assert stresses[:2] == pytest.approx(stresses[2:], rel=0.01)


def test_both_hands_are_stressed_alike():
    pairs = [helical_example(hand=hand) for hand in ("left", "right")]
    left, right = (root_stress_by_elements(pair, "wheel", mesh_of(pair)) for pair in pairs)
    assert left.greatest == pytest.approx(right.greatest, rel=1e-9)


@pytest.mark.slow
def test_rings_and_external_gears_of_many_teeth_have_the_ratio_of_a_rack():
    """The lower ratio of rings is that of their straighter teeth, not of their fillets or rims."""
    figures = {"wheel_profile_shift_coefficient": 0.0, "pinion_profile_shift_coefficient": 0.0}
    ring = ring_example(wheel_teeth=-300, wheel_tip_diameter=None, **figures)
    gear = ring_example(
        wheel_teeth=300, wheel_tip_diameter=None, wheel_bore_diameter=572e-3, **figures
    )
    ratios = [root_stress_by_elements(pair, "wheel").ratio for pair in (ring, gear)]
    assert ratios[0] == pytest.approx(ratios[1], rel=0.02)
    rims = [ring_example(wheel_rim_diameter=rim) for rim in (0.17, 0.3)]
    thin, thick = (root_stress_by_elements(pair, "wheel").ratio for pair in rims)
    assert thin == pytest.approx(thick, rel=0.01)


def test_a_rim_that_is_too_thin_is_named_as_such():
    with pytest.raises(InputError, match=r"the rim of 150 mm .* Give a larger rim"):
        root_stress_by_elements(ring_example(wheel_rim_diameter=0.15), "wheel")
