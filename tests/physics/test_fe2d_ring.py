"""The finite elements of a ring against closed forms, and against the ring assembled in full."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.sparse import coo_array, csc_array
from scipy.sparse.linalg import splu

from tribodyn.gear import SpurGear
from tribodyn.stiffness.fe2d.flank_load import flank_loads
from tribodyn.stiffness.fe2d.ring import (
    Ring,
    RingSolution,
    element_stiffness,
    plane_stress,
    quadratic_shapes,
    sector_stiffness,
)
from tribodyn.stiffness.fe2d.tooth_mesh import MeshSize, SectorMesh, grid_elements, tooth_mesh

NU = 0.3
INNER, OUTER = 1.0, 2.5
COARSE = MeshSize(flank=0.12, largest=0.3, growth=1.8, body_growth=0.6, body_ratio=0.4)


def annulus(sectors: int = 10, columns: int = 4, rows: int = 12) -> SectorMesh:
    """A ring without teeth, columns from right to left and rows from the outside in."""
    half = math.pi / sectors
    angle = np.linspace(half, -half, 2 * columns + 1)[:, None]
    radius = np.geomspace(OUTER, INNER, 2 * rows + 1)[None, :]
    points = np.stack([radius * np.sin(angle), radius * np.cos(angle)], axis=-1)
    grid = np.arange(points[..., 0].size).reshape(points.shape[:2])
    return SectorMesh(
        count=sectors,
        nodes=points.reshape(-1, 2),
        elements=grid_elements(grid),
        right_cut=grid[0, :-1],
        left_cut=grid[-1, :-1],
        fixed=grid[:, -1],
        tooth=grid[:, :3],
        flank_length=np.linspace(1.0, 0.0, 3),
        outline=grid[:, 0],
    )


def under_traction(mesh: SectorMesh, outward: float, around: float) -> np.ndarray:
    """Displacements (outward, anticlockwise) under tractions around the whole outer circle."""
    edges = np.stack([mesh.outline[i : mesh.outline.size - 2 + i : 2] for i in range(3)], axis=1)
    places, weights = np.polynomial.legendre.leggauss(4)
    values, slopes = quadratic_shapes(places)
    points = np.einsum("ga,eax->egx", values, mesh.nodes[edges])
    length = np.hypot(*np.moveaxis(np.einsum("ga,eax->egx", slopes, mesh.nodes[edges]), -1, 0))
    normal = points / np.hypot(*np.moveaxis(points, -1, 0))[..., None]
    traction = outward * normal + around * normal[..., ::-1] * [-1.0, 1.0]
    force = np.zeros((len(mesh.nodes), 2))
    np.add.at(force, edges, np.einsum("g,eg,ga,egx->eax", weights, length, values, traction))
    radial = mesh.nodes / np.hypot(*mesh.nodes.T)[:, None]
    turned = radial[:, ::-1] * [-1.0, 1.0]
    ring = Ring(mesh, plane_stress(1.0, NU))
    solution = ring.solve(force.reshape(-1, 1))
    moved = sum(ring.displacement(solution, k)[:, 0] for k in range(mesh.count))
    moved = moved.reshape(-1, 2)
    return np.stack([(moved * radial).sum(axis=1), (moved * turned).sum(axis=1)])


def test_thick_ring_under_pressure_is_that_of_lame():
    mesh = annulus()
    outward, around = under_traction(mesh, -1.0, 0.0)
    # u = A r + B / r, u = 0 inside, radial stress -1 outside
    system = np.array([[INNER, 1.0 / INNER], [1.0 / (1.0 - NU), -1.0 / (1.0 + NU) / OUTER**2]])
    linear, inverse = np.linalg.solve(system, [0.0, -1.0])
    radius = np.hypot(*mesh.nodes.T)
    exact = linear * radius + inverse / radius
    assert exact.min() < -0.9
    assert outward == pytest.approx(exact, abs=1e-5 * np.abs(exact).max())
    assert around == pytest.approx(0.0, abs=1e-9)


def test_ring_in_torsion_is_the_closed_form():
    mesh = annulus()
    outward, around = under_traction(mesh, 0.0, 1.0)
    shear = 0.5 / (1.0 + NU)
    radius = np.hypot(*mesh.nodes.T)
    exact = OUTER**2 / (2.0 * shear) * radius * (1.0 / INNER**2 - 1.0 / radius**2)
    assert around == pytest.approx(exact, abs=1e-5 * exact.max())
    assert outward == pytest.approx(0.0, abs=1e-9)


def test_error_in_torsion_falls_with_the_fourth_power_of_the_size():
    errors = []
    for refinement in (1, 2):
        mesh = annulus(columns=2 * refinement, rows=3 * refinement)
        around = under_traction(mesh, 0.0, 1.0)[1]
        radius = np.hypot(*mesh.nodes.T)
        exact = OUTER**2 * (1.0 + NU) * radius * (1.0 / INNER**2 - 1.0 / radius**2)
        errors.append(np.abs(around - exact).max())
    assert math.log2(errors[0] / errors[1]) > 3.5


@pytest.fixture(scope="module")
def small_gear() -> SpurGear:
    return SpurGear(
        teeth=9,
        normal_module=1.0,
        normal_pressure_angle=math.radians(20.0),
        profile_shift_coefficient=0.5,
        tip_diameter=11.6,
        face_width=1.0,
        bore_diameter=3.0,
    )


@pytest.fixture(scope="module")
def solved(small_gear) -> tuple[SectorMesh, Ring, np.ndarray, RingSolution]:
    mesh = tooth_mesh(small_gear, 1.5, COARSE)
    ring = Ring(mesh, plane_stress(1.0, NU))
    forces = flank_loads(small_gear, mesh, np.array([1.0, 1.9, 2.4])).forces
    return mesh, ring, forces, ring.solve(forces)


def chained(mesh: SectorMesh, copies: int, closed: bool) -> tuple[csc_array, np.ndarray]:
    """Stiffness of neighbouring sectors, freedoms polar on the cuts, and the freedoms of each."""
    matrix = sector_stiffness(mesh, plane_stress(1.0, NU)).tocoo()
    size = matrix.shape[0]
    number = np.arange(copies * size).reshape(copies, size)
    right, left = (
        (2 * cut[:, None] + np.arange(2)).ravel() for cut in (mesh.right_cut, mesh.left_cut)
    )
    for k in range(copies if closed else copies - 1):
        number[k, left] = number[(k + 1) % copies, right]
    rows, columns = number[:, matrix.row], number[:, matrix.col]
    data = np.tile(matrix.data, copies)
    stiffness_matrix = coo_array((data, (rows.ravel(), columns.ravel())), shape=(number.size,) * 2)
    return stiffness_matrix.tocsc(), number


def solved_in_full(mesh: SectorMesh, copies: int, closed: bool, forces: np.ndarray) -> np.ndarray:
    """Displacements of all copies under forces on the copy in the middle, shape (copies, ...)."""
    matrix, number = chained(mesh, copies, closed)
    fixed_dofs = number[:, (2 * mesh.fixed[:, None] + np.arange(2)).ravel()]
    free = np.setdiff1d(np.unique(number), fixed_dofs)
    load = np.zeros((number.size, forces.shape[1]))
    load[number[copies // 2]] = forces
    moved = np.zeros_like(load)
    moved[free] = splu(matrix[free][:, free].tocsc()).solve(load[free])
    return moved[number]


def test_the_harmonics_give_the_ring_assembled_in_full(solved):
    mesh, ring, forces, solution = solved
    full = solved_in_full(mesh, mesh.count, True, forces)
    middle = mesh.count // 2
    for sector in range(mesh.count):
        ours = ring.weighted_displacements(solution, forces, [sector])[0]
        theirs = full[(middle + sector) % mesh.count].T @ forces
        assert ours == pytest.approx(theirs, rel=1e-9), sector


@pytest.mark.parametrize("sector", [-1, 2])
def test_weights_give_the_displacements_of_a_sector(solved, sector):
    _, ring, forces, solution = solved
    moved = ring.displacement(solution, sector)
    assert moved.T @ forces == pytest.approx(
        ring.weighted_displacements(solution, forces, [sector])[0], rel=1e-10
    )


def test_neighbouring_sectors_move_together_at_their_cut(solved):
    mesh, ring, _, solution = solved
    turn = 2.0 * math.pi / mesh.count
    left = ring.displacement(solution, 0).reshape(-1, 2, 3)[mesh.left_cut]
    right = ring.displacement(solution, 1).reshape(-1, 2, 3)[mesh.right_cut]
    anticlockwise = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
    mate_nodes = mesh.nodes[mesh.right_cut] @ anticlockwise.T
    assert mate_nodes == pytest.approx(mesh.nodes[mesh.left_cut], abs=1e-12)
    assert np.einsum("xy,nyk->nxk", anticlockwise, right) == pytest.approx(left, abs=1e-10)


def test_work_of_the_load_is_the_energy_of_the_elements(solved):
    mesh, ring, forces, solution = solved
    matrices = element_stiffness(mesh.nodes[mesh.elements], plane_stress(1.0, NU))
    energy = 0.0
    for sector in range(mesh.count):
        moved = ring.displacement(solution, sector)[:, 0].reshape(-1, 2)[mesh.elements]
        moved = moved.reshape(len(mesh.elements), 18)
        energy += 0.5 * (moved * np.einsum("eij,ej->ei", matrices, moved)).sum()
    work = 0.5 * ring.weighted_displacements(solution, forces, [0])[0][0, 0]
    assert energy == pytest.approx(work, rel=1e-9)


def test_reciprocal_theorem(solved):
    _, ring, forces, solution = solved
    onward, back = (ring.weighted_displacements(solution, forces, [n])[0] for n in (2, -2))
    assert onward == pytest.approx(back.T, rel=1e-9)
    assert np.abs(onward - onward.T).max() > 1e-3 * np.abs(onward).max()


def test_mean_turn_inside_the_body_is_that_of_the_torque(small_gear):
    # The mean around a circle feels the torque alone: F r_b, whatever the tooth does with it.
    bore = 0.6
    mesh = tooth_mesh(small_gear, bore)
    ring = Ring(mesh, plane_stress(1.0, NU))
    solution = ring.solve(flank_loads(small_gear, mesh, np.array([1.5])).forces)
    radius = np.hypot(*mesh.nodes[mesh.right_cut].T)
    deep = radius < 0.35 * small_gear.root_radius
    mean = solution.cuts[:, 1::2, 0].mean(axis=0)
    torque, shear = small_gear.base_radius, 0.5 / (1.0 + NU)
    exact = torque / (4.0 * math.pi * shear) * radius * (1.0 / bore**2 - 1.0 / radius**2)
    assert deep.sum() >= 4
    assert mean[deep] == pytest.approx(exact[deep], abs=1e-4 * exact[deep].max())


def test_a_segment_of_three_teeth_is_no_gear(solved):
    # The mutation that the whole ring guards against.
    mesh, ring, forces, solution = solved
    segment = solved_in_full(mesh, 3, False, forces)
    self_compliance = np.diagonal(segment[1].T @ forces) / np.diagonal(
        ring.weighted_displacements(solution, forces, [0])[0]
    )
    cross = (segment[2].T @ forces) / ring.weighted_displacements(solution, forces, [1])[0]
    assert np.all(self_compliance > 1.05)
    assert np.all(cross > 1.5)
