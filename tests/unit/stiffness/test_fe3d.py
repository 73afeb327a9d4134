"""Gears with their face width: limits of plane models, a solid of bricks, reciprocity."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from tribodyn.arrays.splines import bspline_integrals, bspline_values, interpolation_knots
from tribodyn.errors import InputError
from tribodyn.gear import Material, SpurGear, cylindrical_pair, spur_pair
from tribodyn.stiffness import LoadedContact, loaded_contact
from tribodyn.stiffness.fe2d import MeshSize, fe2d_influence
from tribodyn.stiffness.fe2d.provider import unit_compliances
from tribodyn.stiffness.fe3d import SolidSize, fe3d_influence, provider
from tribodyn.stiffness.fe3d.provider import gear_sector
from tribodyn.stiffness.fe3d.ring import Ring, harmonic_weights, solved_harmonics
from tribodyn.stiffness.fe3d.sections import FaceSize
from tribodyn.stiffness.loaded import face_problem

MODULE = 4e-3
STEEL = Material()


def gear_of(
    teeth: int = 20,
    width: float = 4.0,
    bore: float = 8.0,
    shift: float = 0.2,
    helix: float = 0.0,
    rim: float | None = None,
) -> SpurGear:
    sign = math.copysign(1.0, teeth)
    tip = abs(teeth) / math.cos(helix) + sign * (2.0 + 2.0 * shift)
    return SpurGear(
        teeth=teeth,
        normal_module=MODULE,
        normal_pressure_angle=math.radians(20.0),
        profile_shift_coefficient=shift,
        tip_diameter=tip * MODULE,
        face_width=width * MODULE,
        bore_diameter=0.0 if teeth < 0 else bore * MODULE,
        rim_diameter=None if rim is None else rim * MODULE,
        helix_angle=helix,
    )


@pytest.fixture(scope="module")
def short():
    return fe3d_influence(gear_of(), STEEL, neighbours=2, cache=False)


def edges_of(influence, slices: int) -> np.ndarray:
    return np.linspace(-0.5, 0.5, slices + 1) * influence.face_width


def compliance(influence, radii, slices: int, sense: int = 1) -> np.ndarray:
    """Compliance of pairs with one radius each over the face, [p, k, q, l]."""
    places = np.repeat(np.asarray(radii, dtype=float)[None, :, None], slices, axis=2)
    count = len(radii) * slices
    out = np.zeros((1, count, count))
    influence.sliced(edges_of(influence, slices)).fill(out, places, sense)
    return out.reshape(len(radii), slices, len(radii), slices)


def test_even_load_on_a_short_face_is_the_plane_stress_figure(short):
    plane = fe2d_influence(gear_of(), STEEL, neighbours=2, cache=False)
    for share, near in ((0.3, 0.004), (0.6, 0.008), (0.9, 0.025)):
        low, high = plane.curvature_radius[[0, -1]]
        radius = low + share * (high - low)
        table = compliance(short, (radius, 0.9 * radius), 8).sum(axis=3).mean(axis=1)
        assert table[0, 0] == pytest.approx(plane.at(radius), rel=near)
        # loaded place first
        next_tooth = plane.between(radius, 0.9 * radius, 1)
        assert table[1, 0] == pytest.approx(next_tooth, rel=4e-3)
        back = compliance(short, (radius, 0.9 * radius), 8, -1).sum(axis=3).mean(axis=1)
        assert back[1, 0] == pytest.approx(plane.between(radius, 0.9 * radius, -1), rel=4e-3)


@pytest.mark.slow
def test_middle_of_a_long_face_is_in_plane_strain():
    gear, nu = gear_of(width=36.0), STEEL.poissons_ratio
    size = SolidSize(face=FaceSize(end=1.0, largest=4.0, growth=2.0))
    table = fe3d_influence(gear, STEEL, neighbours=1, cache=False, size=size)
    # plane strain is plane stress with other constants
    plane = unit_compliances(gear, nu / (1.0 - nu), 1)
    stress = unit_compliances(gear, nu, 1)
    node = 12
    radius = plane.curvature_radius[node]
    even = compliance(table, (radius,), 25).sum(axis=3)[0, :, 0] * STEEL.youngs_modulus
    strain = plane.self_compliance[node] * (1.0 - nu**2)
    assert even[12] == pytest.approx(strain, rel=0.01)
    assert abs(even[12] - strain) < 0.15 * abs(stress.self_compliance[node] - strain)


def test_even_load_on_a_ring_is_the_plane_stress_figure():
    ring = gear_of(teeth=-40, shift=0.0, width=3.0, rim=48.0)
    plane = fe2d_influence(ring, STEEL, neighbours=2, cache=False)
    solid = fe3d_influence(ring, STEEL, neighbours=2, cache=False)
    low, high = plane.curvature_radius[[0, -1]]
    # the tip has the smaller radius, and bends more
    assert plane.at(low) > 3.0 * plane.at(high)
    for share, near in ((0.2, 0.02), (0.5, 0.005), (0.7, 0.02)):
        radius = low + share * (high - low)
        pair = radius, 0.98 * radius
        at_load = compliance(solid, pair, 6).sum(axis=3).mean(axis=1)
        assert at_load[0, 0] == pytest.approx(plane.at(radius), rel=near)
        largest = plane.at(radius)
        for sense in (1, -1):
            table = compliance(solid, pair, 6, sense).sum(axis=3).mean(axis=1)
            expected = plane.between(*pair, sense)
            assert table[1, 0] == pytest.approx(expected, abs=4e-3 * largest)


def test_reciprocity_between_slices_of_any_width_and_teeth(short):
    edges = np.array([-8.0, -7.0, -5.0, -4.5, 1.0, 8.0]) * 1e-3
    radii = np.random.default_rng(3).uniform(8e-3, 16e-3, (2, 3, 5))
    out = np.zeros((2, 15, 15))
    short.sliced(edges).fill(out, radii, 1)
    widths = np.tile(np.diff(edges), 3)
    table = out / widths
    assert table == pytest.approx(table.transpose(0, 2, 1), rel=1e-12, abs=1e-20)
    # the same work in the other sense is that of the pairs counted backwards
    other = np.zeros((2, 15, 15))
    short.sliced(edges).fill(other, radii[:, ::-1], -1)
    turned = other.reshape(2, 3, 5, 3, 5)[:, ::-1, :, ::-1].reshape(out.shape)
    assert turned == pytest.approx(out, rel=1e-12)


def test_compiled_sum_is_that_of_the_splines(short):
    """The readable form of ``fill``: splines over the squared radius, means over slices."""
    edges = np.array([-8.0, -5.0, 0.0, 1.0, 7.0]) * 1e-3
    radii = np.random.default_rng(5).uniform(5e-3, 20e-3, (3, 2, 4))
    out = np.zeros((3, 8, 8))
    short.sliced(edges).fill(out, radii, -1)
    integrals = bspline_integrals(short.knots, edges + 8e-3)
    square = short.curvature_radius**2
    knots = interpolation_knots(square)
    inverse = np.linalg.inv(bspline_values(knots, square))
    at_radius = bspline_values(knots, radii.ravel() ** 2).reshape(3, 8, -1) @ inverse
    for displaced in range(8):
        for loaded in range(8):
            (i, k), (j, m) = divmod(loaded, 4), divmod(displaced, 4)
            # pair 0 lies on the side of the larger radii of pair 1
            table = short.self_compliance if i == j else short.cross_compliance[0]
            ends = (k, m) if i >= j else (m, k)
            places = (loaded, displaced) if i >= j else (displaced, loaded)
            first, second = (at_radius[:, place] for place in places)
            work = np.einsum("a,ijab,b->ij", integrals[ends[0]], table, integrals[ends[1]])
            expected = np.einsum("pi,ij,pj->p", first, work, second) / np.diff(edges)[m]
            assert out[:, displaced, loaded] == pytest.approx(expected, rel=1e-9)


def test_finer_slices_carry_the_same(short):
    coarse = compliance(short, (11e-3, 14e-3), 6)
    fine = compliance(short, (11e-3, 14e-3), 24).reshape(2, 6, 4, 2, 6, 4)
    # mean displacement of a slice under an even load on a slice, which is four narrow ones
    assert fine.sum(axis=5).mean(axis=2) == pytest.approx(coarse, rel=1e-10)
    # positive together with the compression of a contact of up to a quarter of the depth
    least = 2.0 * (1.0 - 0.3**2) / (math.pi * STEEL.youngs_modulus)
    assert np.linalg.eigvalsh(compliance(short, (12e-3,), 24)[0, :, 0])[0] > -least


def test_free_end_deflects_more_than_the_middle_under_its_load():
    table = compliance(fe3d_influence(gear_of(width=6.0), STEEL, cache=False), (14e-3,), 12)
    at_load = np.diagonal(table[0, :, 0])
    assert at_load[0] > 1.3 * at_load[6]
    assert at_load[::-1] == pytest.approx(at_load, rel=1e-6)
    # away from the load it fades
    assert table[0, 11, 0, 0] < 0.2 * at_load[0]


def test_other_face_first_is_the_mirror_image():
    gear = gear_of(width=3.0, helix=math.radians(20.0))
    helical = fe3d_influence(gear, STEEL, neighbours=1, cache=False)
    edges = np.array([-6.0, -4.0, 1.0, 5.0]) * 1e-3
    radii = np.array([[[9e-3, 12e-3, 15e-3]]])
    first, second = np.zeros((1, 3, 3)), np.zeros((1, 3, 3))
    helical.sliced(edges).fill(first, radii, 1)
    helical.sliced(-edges[::-1], rising=True).fill(second, radii[:, :, ::-1], 1)
    assert second[:, ::-1, ::-1] == pytest.approx(first, rel=1e-12)
    unlike = np.zeros((1, 3, 3))
    helical.sliced(edges, rising=True).fill(unlike, radii, 1)
    assert np.abs(unlike / first - 1.0).max() > 0.05


def test_harmonics_between_the_solved_ones_follow_from_them():
    sector = gear_sector(gear_of(teeth=60, width=2.0, bore=20.0, helix=0.3), 0.3, SolidSize())
    ring, sectors = Ring(sector), -np.arange(3)
    some = solved_harmonics(60)
    assert some.size < 20
    assert some[-1] == 30
    few = ring.flank_compliances(sectors, some)
    full = ring.flank_compliances(sectors, np.arange(31))
    assert few == pytest.approx(full, abs=2e-5 * np.abs(full[1]).max())


@pytest.mark.parametrize("count", [11, 12, 61, 200])
def test_weights_of_harmonics_sum_to_the_ring(count):
    harmonics = solved_harmonics(count)
    weights = harmonic_weights(count, harmonics, np.arange(3)).real
    # the same compliance in every harmonic is that of sectors that know nothing of one another
    assert weights.sum(axis=1) == pytest.approx([1.0, 0.0, 0.0], abs=1e-12)


def test_sector_that_is_free_moves_as_a_rigid_body():
    sector = gear_sector(gear_of(), 0.3, SolidSize())
    stiffness = sector.condensed()
    count = stiffness.shape[0] * stiffness.shape[1]
    values = np.linalg.eigvalsh(stiffness.reshape(count, count))
    assert np.abs(values[:6]).max() < 1e-12 * values[-1]
    assert values[6] > 1e-5 * values[-1]


def test_twisted_sector_turns_and_slides_freely_along_its_screw():
    sector = gear_sector(gear_of(helix=math.radians(25.0)), 0.3, SolidSize())
    stiffness = sector.condensed()
    face = stiffness.shape[1]
    nodes = np.concatenate(sector.border)
    radius = np.hypot(*sector.mesh.nodes[nodes].T)
    load = sector.load_direction(sector.flank_length)
    unit = load / np.linalg.norm(load, axis=1)[:, None]
    points = sector.mesh.nodes[sector.flank]
    still = np.zeros(radius.size)
    turn = np.stack([still, radius, still], axis=1).ravel()
    slide = np.stack([still, still, still + 1.0], axis=1).ravel()
    about = points[:, ::-1] * [-1.0, 1.0]
    motions = (
        np.concatenate([np.einsum("fx,fx->f", unit[:, :2], about), turn]),
        np.concatenate([unit[:, 2], slide]),
    )
    largest = np.abs(stiffness).max()
    for motion in motions:
        force = np.tensordot(stiffness.sum(axis=3), motion, (2, 0))
        assert np.abs(force).max() < 1e-10 * largest * face
    # the screw itself moves no point of the flank off its surface
    pitch = 1.0 / sector.twist
    assert motions[0][: unit.shape[0]] + pitch * motions[1][: unit.shape[0]] == pytest.approx(
        0.0, abs=1e-9
    )


def test_rim_as_reference_takes_off_the_mean_wind_up(short):
    gear = gear_of()
    rim = fe3d_influence(gear, STEEL, reference="rim", neighbours=2, cache=False)
    root, bore = gear.root_radius, 0.5 * gear.bore_diameter
    shear = STEEL.shear_modulus
    wind_up = gear.base_radius**2 / (4.0 * math.pi * shear) * (1.0 / bore**2 - 1.0 / root**2)
    difference = compliance(short, (12e-3, 15e-3), 4) - compliance(rim, (12e-3, 15e-3), 4)
    assert difference == pytest.approx(0.25 * wind_up, rel=1e-9)


def test_face_width_is_part_of_the_cached_name(tmp_path, monkeypatch):
    monkeypatch.setenv("TRIBODYN_CACHE_DIR", str(tmp_path))
    calls = []

    def stand_in(sector, neighbours, progress):
        calls.append(sector.width)
        return provider.UnitFaceCompliances(
            np.arange(1.0, 6.0), np.array([0.0, 0, 0, 0, 4, 4, 4, 4]), np.ones((2, 5, 5, 4, 4))
        )

    monkeypatch.setattr(provider, "unit_face_compliances", stand_in)
    for width in (4.0, 4.0, 5.0, 4.0):
        influence = fe3d_influence(gear_of(width=width), STEEL, neighbours=1)
    assert calls == pytest.approx([4.0, 5.0])
    assert influence.neighbours == 1
    next(tmp_path.rglob("*.npz")).write_bytes(b"no archive")
    for width in (4.0, 5.0):
        fe3d_influence(gear_of(width=width), STEEL, neighbours=1)
    assert len(calls) == 3


def test_what_does_not_fit_is_refused(short):
    with pytest.raises(InputError, match="neighbours = 0"):
        fe3d_influence(gear_of(), STEEL, neighbours=0)
    with pytest.raises(InputError, match="bore"):
        fe3d_influence(gear_of(bore=0.0), STEEL)
    with pytest.raises(InputError, match="face of 16 mm"):
        short.sliced(np.array([0.0, 9e-3]))
    with pytest.raises(InputError, match="edges"):
        short.sliced(np.array([4e-3, 2e-3]))
    slices = short.sliced(np.array([-8e-3, 0.0, 8e-3]))
    with pytest.raises(InputError, match="shape"):
        slices.fill(np.zeros((1, 4, 4)), np.full((1, 2, 3), 0.012), 1)
    with pytest.raises(InputError, match="sense = 0"):
        slices.fill(np.zeros((1, 2, 2)), np.full((1, 1, 2), 0.012), 0)
    with pytest.raises(InputError, match="FaceInfluence"):
        provider.FaceInfluence(
            short.curvature_radius[:-1], short.knots, short.self_compliance, short.cross_compliance
        )


def bricks(sector, breaks: np.ndarray):
    """Ring of 27-node bricks in space: nodes per layer of each sector, and a solver of loads."""
    from scipy.sparse import coo_array
    from scipy.sparse.linalg import splu

    from tribodyn.stiffness.fe2d.ring import quadratic_shapes

    mesh, count = sector.mesh, sector.count
    left = np.append(mesh.left_cut, mesh.fixed[-1])
    right = np.append(mesh.right_cut, mesh.fixed[0])
    interior = np.setdiff1d(np.arange(len(mesh.nodes)), left)
    number = np.empty((count, len(mesh.nodes)), dtype=int)
    number[:, interior] = np.arange(count * interior.size).reshape(count, -1)
    number[:, left] = np.roll(number, -1, axis=0)[:, right]
    layer = count * interior.size
    flat = np.empty(layer, dtype=complex)
    for tooth in range(count):
        turned = np.exp(2j * np.pi * tooth / count) * (mesh.nodes @ [1.0, 1.0j])
        flat[number[tooth]] = turned
    heights = np.empty(2 * breaks.size - 1)
    heights[::2], heights[1::2] = breaks, 0.5 * (breaks[1:] + breaks[:-1])
    planes = np.exp(1j * sector.twist * heights)[:, None] * flat
    space = np.stack(
        [planes.real, planes.imag, np.broadcast_to(heights[:, None], planes.shape)], axis=-1
    ).reshape(-1, 3)
    section = np.concatenate([number[tooth][mesh.elements] for tooth in range(count)])
    elements = np.concatenate(
        [
            np.concatenate([section + layer * (2 * row + step) for step in range(3)], axis=1)
            for row in range(breaks.size - 1)
        ]
    )
    points, weights = np.polynomial.legendre.leggauss(3)
    value, slope = quadratic_shapes(points)

    def product(over, first, second):
        return np.einsum("rz,pa,qb->rpqzab", over, first, second).reshape(27, 27)

    local = np.stack(
        [product(value, slope, value), product(value, value, slope), product(slope, value, value)],
        1,
    )
    weight = np.einsum("r,p,q->rpq", weights, weights, weights).ravel()
    rows, columns, entries = [], [], []
    for first in range(0, len(elements), 100):
        part = elements[first : first + 100]
        jacobian = np.einsum("gdn,enx->egdx", local, space[part])
        slopes = np.linalg.solve(jacobian, np.broadcast_to(local, (*jacobian.shape[:2], 3, 27)))
        strain = np.zeros((*slopes.shape[:2], 6, 27, 3))
        for row, pairs in enumerate(
            [[(0, 0)], [(1, 1)], [(2, 2)], [(1, 2), (2, 1)], [(0, 2), (2, 0)], [(0, 1), (1, 0)]]
        ):
            for axis, along in pairs:
                strain[:, :, row, :, axis] = slopes[:, :, along]
        root = np.sqrt(np.abs(np.linalg.det(jacobian)) * weight)[..., None, None]
        strain = strain.reshape(*slopes.shape[:2], 6, 81) * root
        stiffness = (np.swapaxes(strain, 2, 3) @ (sector.stress @ strain)).sum(axis=1)
        freedoms = (3 * part[:, :, None] + np.arange(3)).reshape(-1, 81)
        rows.append(np.broadcast_to(freedoms[:, :, None], stiffness.shape).ravel())
        columns.append(np.broadcast_to(freedoms[:, None, :], stiffness.shape).ravel())
        entries.append(stiffness.ravel())
    shape = (space.size, space.size)
    places = np.concatenate(rows), np.concatenate(columns)
    matrix = coo_array((np.concatenate(entries), places), shape=shape).tocsc()
    loose = np.ones((heights.size, layer, 3), dtype=bool)
    loose[:, number[:, mesh.fixed].ravel()] = False
    free = np.flatnonzero(loose)
    factors = splu(
        matrix[free][:, free],
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )

    def solve(load: np.ndarray) -> np.ndarray:
        moved = np.zeros(space.size)
        moved[free] = factors.solve(load.ravel()[free])
        return moved.reshape(load.shape)

    def flank_load(tooth: int, place: int, density) -> np.ndarray:
        """Nodal loads of a line load with a density over the face, as (layer, node, 3)."""
        load = np.zeros((heights.size, layer, 3))
        direction = sector.load_direction(sector.flank_length)[place]
        angle = sector.twist * heights + 2.0 * np.pi * tooth / count
        plane = np.exp(1j * angle) * (direction[:2] @ [1.0, 1.0j])
        for row in range(breaks.size - 1):
            share = np.array([1.0, 4.0, 1.0]) / 6.0 * (breaks[row + 1] - breaks[row])
            part = slice(2 * row, 2 * row + 3)
            share = share * density(heights[part])
            spot = load[part, number[tooth % count, sector.flank[place]]]
            spot += share[:, None] * np.stack(
                [plane[part].real, plane[part].imag, np.full(3, direction[2])], axis=1
            )
            load[part, number[tooth % count, sector.flank[place]]] = spot
        return load

    return solve, flank_load


def test_rings_below_the_root_are_the_meshed_body():
    gear = gear_of(teeth=14, width=2.0, bore=5.0, helix=0.35)
    section = MeshSize(0.3, 0.5, 1.6, 0.3, 0.2, 2)
    meshed = gear_sector(gear, 0.3, SolidSize(section, depth=10.0))
    on_rings = gear_sector(gear, 0.3, SolidSize(section))
    assert on_rings.on_ring
    assert not meshed.on_ring
    first, second = Ring(meshed), Ring(on_rings)
    for harmonic in (0, 1, 2, 7):
        expected = first.harmonic_compliance(harmonic)
        error = np.abs(second.harmonic_compliance(harmonic) - expected).max()
        assert error < 3e-3 * np.abs(expected).max()


HELICAL = {
    "external": {"teeth": 9, "bore": 5.8, "shift": 0.4},
    "ring": {"teeth": -24, "rim": 30.8, "shift": -0.3},
}


@pytest.mark.slow
@pytest.mark.parametrize("kind", HELICAL)
def test_all_teeth_are_those_of_bricks_in_space(kind):
    section = MeshSize(0.5, 0.9, 1.6, 0.9, 0.5, 1)
    gear = gear_of(width=3.0, helix=math.radians(20.0), **HELICAL[kind])
    sector = gear_sector(gear, 0.3, SolidSize(section=section))
    assert not sector.on_ring
    table = Ring(sector).flank_compliances(-np.arange(3), np.arange(sector.count // 2 + 1))
    solve, flank_load = bricks(sector, np.linspace(0.0, 3.0, 4 if kind == "external" else 3))
    # rigid body modes of the flank over the face: even, and linear; coefficients by Greville
    knots = sector.face.knots
    greville = (knots[1:-3] + knots[2:-2] + knots[3:-1]) / 3.0
    modes = {
        "even": (lambda z: 0.0 * z + 1.0, np.ones(greville.size)),
        "linear": (lambda z: z - 1.5, greville - 1.5),
    }
    mass = sector.face.mass
    for density, coefficients in modes.values():
        moved = solve(flank_load(0, 6, density))
        scale = np.vdot(flank_load(0, 4, density), moved)
        for tooth in range(3):
            for other, values in modes.values():
                expected = np.vdot(flank_load(-tooth, 4, other), moved)
                work = (mass @ values) @ table[tooth, 4, :, 6] @ (mass @ coefficients)
                assert work == pytest.approx(expected, rel=3e-2, abs=2e-3 * scale)


def loaded(phases=16, **changes):
    data = {
        "pinion_teeth": 19,
        "wheel_teeth": 31,
        "normal_module": MODULE,
        "normal_pressure_angle": math.radians(20.0),
        "helix_angle": math.radians(18.0),
        "pinion_face_width": 16e-3,
        "pinion_bore_diameter": 25e-3,
        "wheel_bore_diameter": 40e-3,
    }
    return loaded_contact(
        cylindrical_pair(**{**data, **changes}), 200.0, provider="fe3d", phases=phases, slices=10
    )


@pytest.fixture(scope="module")
def right_hand() -> LoadedContact:
    return loaded(hand="right")


def test_hand_mirrors_the_load_over_the_face(right_hand):
    left = loaded(hand="left")
    assert left.transmission_error == pytest.approx(right_hand.transmission_error, rel=1e-9)
    assert left.load_per_width[:, ::-1] == pytest.approx(
        right_hand.load_per_width, abs=1e-8 * right_hand.load_per_width.max()
    )
    assert not np.allclose(left.load_per_width, right_hand.load_per_width, rtol=1e-2)


def test_driving_wheel_goes_through_the_same_positions_backwards(right_hand):
    # what enters at one end of the path and the face leaves there when the other gear drives
    phase = (right_hand.gear_pair.total_contact_ratio - right_hand.phase) % 1.0
    back = loaded(phases=phase, hand="right", driver="wheel")
    assert back.transmission_error == pytest.approx(right_hand.transmission_error, rel=1e-6)


def test_spur_pair_agrees_with_the_plane_model():
    plane = loaded_contact(
        spur_pair(
            pinion_teeth=19,
            wheel_teeth=31,
            normal_module=MODULE,
            normal_pressure_angle=math.radians(20.0),
            pinion_face_width=16e-3,
            pinion_bore_diameter=25e-3,
            wheel_bore_diameter=40e-3,
        ),
        200.0,
        phases=16,
        extended_contact=False,
    )
    solid = loaded(helix_angle=0.0)
    assert solid.mean_transmission_error == pytest.approx(plane.mean_transmission_error, rel=0.02)
    assert np.ptp(solid.transmission_error) == pytest.approx(
        np.ptp(plane.transmission_error), rel=0.05
    )


@pytest.mark.slow
def test_printed_figures_of_bricks_that_couple_next_teeth(monkeypatch):
    # mean transmission error 16.4 um, peak to peak 1.32 um, greatest share .587; 3-D bricks
    pair = cylindrical_pair(
        pinion_teeth=27,
        wheel_teeth=51,
        normal_module=4.5e-3,
        normal_pressure_angle=math.radians(20.0),
        helix_angle=math.radians(21.0),
        pinion_profile_shift_coefficient=0.231415,
        wheel_profile_shift_coefficient=0.231415,
        center_distance=0.19,
        pinion_face_width=50e-3,
        pinion_bore_diameter=40e-3,
        wheel_bore_diameter=70e-3,
    )
    size = SolidSize(MeshSize(0.25, 0.7, 1.8, 1.0, 0.5, 1))
    gears = [
        fe3d_influence(gear, STEEL, neighbours=2, cache=False, size=size)
        for gear in pair.gears.values()
    ]

    def solved(neighbours: int) -> LoadedContact:
        tables = [
            replace(gear, cross_compliance=gear.cross_compliance[:neighbours]) for gear in gears
        ]
        monkeypatch.setattr(face_problem, "gear_influences", lambda *_: tables)
        return loaded_contact(pair, 600.0, provider="fe3d", phases=32, slices=24)

    next_teeth = solved(1)
    assert next_teeth.load_share.max() == pytest.approx(0.587, rel=0.01)
    assert next_teeth.mean_transmission_error == pytest.approx(16.4e-6, rel=0.04)
    assert np.ptp(next_teeth.transmission_error) == pytest.approx(1.32e-6, rel=0.06)
    # three pairs are in contact: the first and the third share the bodies too
    every_tooth = solved(2)
    assert every_tooth.load_share.max() == pytest.approx(0.627, rel=0.01)
    assert every_tooth.mean_transmission_error == pytest.approx(17.3e-6, rel=0.01)
    assert np.ptp(every_tooth.transmission_error) == pytest.approx(0.80e-6, rel=0.03)
