"""Solid teeth of hypoid gears: other elements, refinement, symmetry, and the spur gear as limit."""

import math
from itertools import permutations

import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.linalg import spsolve

from known_hypoids import eased, h1043
from tribodyn.gear import Material, SpurGear, hypoid_blank, hypoid_flanks
from tribodyn.stiffness import load_point
from tribodyn.stiffness.fe3d import BevelSize, fe3d_influence, hypoid_influence
from tribodyn.stiffness.fe3d.bevel import (
    FlankInfluence,
    UnitFlankCompliances,
    _below,
    unit_flank_compliances,
)
from tribodyn.stiffness.fe3d.bevel_sector import BevelSector, hexahedra_stiffness
from tribodyn.stiffness.fe3d.bevel_tooth import BevelTooth
from tribodyn.stiffness.fe3d.sections import elasticity

NU = 0.3
#: Twice the modulus of plane strain over pi, for a Young's modulus of one.
LINE = 2.0 * (1.0 - NU**2) / math.pi
COARSE = BevelSize(5, 4, 2, 2, 2)


@pytest.fixture(scope="module")
def flanks():
    return eased()


def sector_of(flanks, gear="wheel", size=COARSE):
    return BevelSector(BevelTooth(flanks, gear), NU, size)


def row_load(sector, share):
    """Nodal shares of a load even along the face at a share of the height from the tip."""
    stations, rows = sector.up.shape
    weights = np.ones(stations)
    weights[1::2], weights[2:-1:2] = 4.0, 2.0
    column = np.zeros(rows)
    column[int(share * (rows - 1))] = 1.0
    return (weights[:, None] / weights.sum() * column).ravel()


def line_length(sector, share):
    row = int(share * (sector.up.shape[1] - 1))
    points = sector.mesh[1].reshape(-1, 3)[sector.flank[:, row]]
    return np.linalg.norm(np.diff(points, axis=0), axis=1).sum()


def local(sector, half_width, share):
    """Mean compression under a Hertzian strip of length one, from the layer on."""
    layer = sector.layer[:, int(share * (sector.up.shape[1] - 1))].mean()
    return LINE * (math.log(2.0 * layer / half_width) - 0.5 * NU / (1.0 - NU) - 0.25)


def total_compliance(sector, compliance, half_width, share):
    load = row_load(sector, share)
    length = line_length(sector, share)
    return load @ compliance @ load + local(sector, half_width, share) / length


def clamped(sector):
    """Compliance of a sector whose cuts are held."""
    count = sector.flank.size
    table = np.linalg.inv(sector.condensed()[: 2 * count, 0, : 2 * count, 0])
    return _below(sector) @ table[count:, :count]


def tetrahedra(hexahedra):
    """Each hexahedron as six tetrahedra with ten of its nodes."""
    parts = []
    for order in permutations(range(3)):
        corners = [np.zeros(3, dtype=int)]
        for axis in order:
            corners.append(corners[-1] + 2 * np.eye(3, dtype=int)[axis])
        middles = [(corners[i] + corners[j]) // 2 for i in range(4) for j in range(i + 1, 4)]
        nodes = np.array(corners + middles) @ [9, 3, 1]
        parts.append(hexahedra[:, nodes])
    return np.concatenate(parts)


def tetrahedra_stiffness(corners, stress):
    """Stiffness of straight quadratic tetrahedra (e, 10, 3) from barycentric coordinates."""
    edges = corners[:, 1:4] - corners[:, :1]
    volume = np.abs(np.linalg.det(edges)) / 6.0
    slopes = np.linalg.inv(edges)  # columns: gradients of the last three coordinates
    slopes = np.concatenate([-slopes.sum(axis=2, keepdims=True), slopes], axis=2)
    total = 0.0
    for place in range(4):
        bary = np.full(4, 0.1381966011250105)
        bary[place] = 0.5854101966249685
        shape = np.zeros((10, 4))
        shape[range(4), range(4)] = 4.0 * bary - 1.0
        for k, (i, j) in enumerate(((0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3))):
            shape[4 + k, i], shape[4 + k, j] = 4.0 * bary[j], 4.0 * bary[i]
        gradient = np.einsum("na,exa->enx", shape, slopes)
        strain = np.zeros((len(corners), 6, 10, 3))
        for axis in range(3):
            strain[:, axis, :, axis] = gradient[..., axis]
        for row, (first, second) in enumerate(((1, 2), (0, 2), (0, 1)), start=3):
            strain[:, row, :, first] = gradient[..., second]
            strain[:, row, :, second] = gradient[..., first]
        strain = strain.reshape(len(corners), 6, 30)
        total = total + np.swapaxes(strain, 1, 2) @ (stress @ strain) * volume[:, None, None] / 4
    return total


@pytest.mark.slow
@pytest.mark.parametrize("gear", ["pinion", "wheel"])
def test_compliance_is_that_of_tetrahedra_under_a_strip_of_pressure(flanks, gear):
    # Own elements, assembly and loads; both cuts are held on both sides of the comparison.
    fine = sector_of(flanks, gear, BevelSize(6, 11, 3, 2, 2, layer=0.2))
    points, elements = fine.mesh[1].reshape(-1, 3), tetrahedra(fine.elements.reshape(-1, 27))
    matrix = tetrahedra_stiffness(points[elements], elasticity(NU))
    freedoms = (3 * elements[..., None] + np.arange(3)).reshape(len(elements), -1)
    rows = np.broadcast_to(freedoms[:, :, None], matrix.shape).ravel()
    columns = np.broadcast_to(freedoms[:, None, :], matrix.shape).ravel()
    held = np.concatenate([*fine.border, fine._at(fine.mesh[0].fixed).ravel()])
    free = np.setdiff1d(np.unique(elements), held)
    free = (3 * free[:, None] + np.arange(3)).ravel()
    size = 3 * len(points)
    full = coo_array((matrix.ravel(), (rows, columns)), shape=(size, size)).tocsc()
    middle, half_width = 8, 2.0 * np.linalg.norm(np.diff(points[fine.flank[3, 8:10]], axis=0))
    load = np.zeros(fine.flank.shape)
    heights = (np.arange(load.shape[1]) - middle) / 2.0
    profile = np.sqrt(np.maximum(1.0 - heights**2, 0.0))
    share = middle / (load.shape[1] - 1)
    along = row_load(fine, share).reshape(load.shape)[:, middle]
    load = along[:, None] * profile / profile.sum()
    forces = np.zeros((len(points), 3))
    forces[fine.flank] = load[..., None] * fine.normals
    moved = spsolve(full[free][:, free], forces.ravel()[free])
    expected = forces.ravel()[free] @ moved

    sector = sector_of(flanks, gear, BevelSize(6, 5, 2, 2, 2))
    below = clamped(sector)
    # The strip lies between two rows of this mesh.
    shares = np.array([0.3, 0.4])
    values = [total_compliance(sector, below, half_width, each) for each in shares]
    assert np.interp(share, shares, values) == pytest.approx(expected, rel=0.05)


@pytest.mark.slow
def test_compliance_is_symmetric_and_converges(flanks):
    sector = sector_of(flanks)
    stiffness = sector.condensed()[:, 0, :, 0]
    assert stiffness == pytest.approx(stiffness.T, abs=1e-12 * np.abs(stiffness).max())
    coarse = unit_flank_compliances(sector).compliance
    assert coarse[0] == pytest.approx(coarse[0].T, abs=1e-14 * coarse.max())
    finer = sector_of(flanks, size=BevelSize(6, 6, 3, 2, 2, layer=0.3))
    for share in (0.25, 0.5, 0.75):
        values = [
            total_compliance(each, table, 0.05, share)
            for each, table in ((sector, clamped(sector)), (finer, clamped(finer)))
        ]
        assert values[0] == pytest.approx(values[1], rel=0.03)
    # Neighbours move much less, and those behind as those ahead by reciprocity.
    load = row_load(sector, 0.5)
    unit = UnitFlankCompliances(sector.along, sector.up, sector.layer, coarse)
    influence = FlankInfluence(sector.tooth.cone, unit, 1.0, 1.0, 1.0)
    moved = [load @ influence.compliance(k) @ load for k in (-1, 0, 1, 9)]
    assert moved[0] == pytest.approx(moved[2], rel=1e-12)
    assert 0.0 < moved[0] < 0.2 * moved[1]
    assert moved[3] == 0.0


def test_elements_do_not_resist_rigid_motions_and_bear_a_plain_stretch(flanks):
    sector = sector_of(flanks)
    corners = sector.mesh[1].reshape(-1, 3)[sector.elements[:, ::9].reshape(-1, 27)]
    stiffness = hexahedra_stiffness(corners, elasticity(NU))
    turns = [np.cross(axis, corners) for axis in np.eye(3)]
    shifts = [np.broadcast_to(axis, corners.shape) for axis in np.eye(3)]
    for motion in (*turns, *shifts):
        forces = np.einsum("eij,ej->ei", stiffness, motion.reshape(len(corners), -1))
        assert np.abs(forces).max() < 1e-10 * np.abs(stiffness).max() * np.abs(motion).max()
    stretch = corners * [1.0, -NU, -NU]
    energy = np.einsum("ei,eij,ej->e", *(
        (stretch.reshape(len(corners), -1)), stiffness, stretch.reshape(len(corners), -1)
    ))  # fmt: skip
    volume = np.einsum("ei,eij,ej->e", *(
        (corners * [1.0, 0.0, 0.0]).reshape(len(corners), -1), stiffness,
        stretch.reshape(len(corners), -1),
    ))  # fmt: skip
    assert energy == pytest.approx(volume, rel=1e-10)  # uniaxial stress works along x alone


def test_teeth_are_those_of_the_blank(flanks):
    for gear in ("pinion", "wheel"):
        tooth = BevelTooth(flanks, gear)
        spiral = getattr(flanks.blank, f"mean_spiral_angle_{gear}")
        radius = tooth.cone.at(np.zeros(1), np.zeros(1))[0]
        angles = [fit(np.zeros(1), np.zeros(1)) for fit in tooth.fits]
        thickness = (angles[1] - angles[0]) * radius * math.cos(spiral)
        expected = getattr(flanks.blank, f"mean_normal_thickness_{gear}")
        assert thickness * flanks.blank.mean_normal_module == pytest.approx(expected, rel=1e-4)
        position, _ = flanks.points(gear)
        place = position @ np.array([0.0, 1.0, 0.0] if gear == "pinion" else [0.0, 0.0, 1.0])
        across = np.linalg.norm(position, axis=-1) ** 2 - place**2
        unit = flanks.blank.mean_normal_module
        apex = getattr(flanks.blank, f"pitch_apex_{gear}")
        places = tooth.cone.places(np.sqrt(across) / unit, (place + apex) / unit)
        fit = tooth.points(*places, tooth.fits[0](*places)) * unit
        gaps, steps = (np.linalg.norm(np.diff(each, axis=0), axis=-1) for each in (fit, position))
        assert gaps == pytest.approx(steps, rel=2e-4)


@pytest.mark.parametrize("gear", ["pinion", "wheel"])
def test_the_other_hand_is_the_mirror_image(flanks, gear):
    left, right = (sector_of(each, gear) for each in (flanks, eased(h1043(hand_pinion="right"))))
    assert right.mesh[1] == pytest.approx(left.mesh[1], abs=1e-9)
    assert right.tooth.sense == -left.tooth.sense


@pytest.mark.slow
def test_a_straight_tooth_of_a_slim_cone_is_as_stiff_as_that_of_a_spur_gear():
    module, teeth, width = 4e-3, 30, 24e-3
    blank = hypoid_blank(
        teeth, 300, 0.0, 300 * module, width, 0.0, 1.0, addendum_factor_wheel=0.5,
        wheel_generation="generated",
    )  # fmt: skip
    flanks = hypoid_flanks(blank, points=5)
    unit = blank.mean_normal_module
    size = BevelSize(8, 5, 3, 2, 3, fillet=0.38)  # that of the rack
    influence = hypoid_influence(flanks, "pinion", Material(), cache=False, size=size)
    sector = sector_of(flanks, "pinion", size)
    gear = SpurGear(
        teeth=teeth, normal_module=unit, normal_pressure_angle=math.radians(20.0),
        profile_shift_coefficient=0.0, tip_diameter=(teeth + 2.0) * unit, face_width=width,
        bore_diameter=(teeth - 2.5 - 5.4) * unit,
    )  # fmt: skip
    sliced = fe3d_influence(gear, Material()).sliced(np.linspace(-0.5, 0.5, 9) * width)
    for share in (0.2, 0.5, 0.8):
        row = int(share * (sector.up.shape[1] - 1))
        radius = sector.tooth.cone.at(0.0, sector.up[sector.up.shape[0] // 2, row])[0] * unit
        curvature = math.sqrt(radius**2 - gear.base_radius**2)
        load = row_load(sector, share)
        solid = load @ influence.compliance(0) @ load * Material().youngs_modulus * width
        # Both are without the compression between the surface and a depth, which differs.
        depth = sector.layer[:, row].mean()
        spur_depth = load_point(gear, curvature).depth / unit
        total = np.zeros((1, 8, 8))
        sliced.fill(total, np.full((1, 1, 8), curvature), 1)
        plane = total[0].mean() * 8 * Material().youngs_modulus
        assert solid + LINE * math.log(depth / spur_depth) == pytest.approx(plane, rel=0.035), share
