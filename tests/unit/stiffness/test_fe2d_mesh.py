"""The mesh of a tooth sector: on the exact outline, closed, not inside out; the patch test."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.sparse.linalg import spsolve

from tribodyn.errors import ComputationError, InputError
from tribodyn.gear import BasicRack, SpurGear, section_moments
from tribodyn.stiffness import load_point
from tribodyn.stiffness.fe2d.flank_load import flank_loads, nodal_weights
from tribodyn.stiffness.fe2d.ring import (
    element_stiffness,
    plane_stress,
    sector_stiffness,
    shape_gradients,
)
from tribodyn.stiffness.fe2d.tooth_mesh import MeshSize, SectorMesh, grid_elements, tooth_mesh


def gear_of(teeth: int, shift: float, bore: float, **more: object) -> SpurGear:
    values = {
        "teeth": teeth,
        "normal_module": 2e-3,
        "normal_pressure_angle": math.radians(20.0),
        "profile_shift_coefficient": shift,
        "tip_diameter": 2e-3 * (teeth + 2.0 + 2.0 * shift),
        "face_width": 0.01,
        "bore_diameter": bore * 2e-3,
    }
    return SpurGear(**{**values, **more})


ROUND = BasicRack(tip_radius_coefficient=0.3)
SHAPES = {
    "plain": (20, 0.0, 8.0, {}),
    "undercut": (9, 0.0, 3.0, {}),
    "thin rim": (40, 0.0, 37.0, {}),
    "many teeth": (200, 0.2, 60.0, {}),
    "pin hole": (25, 0.0, 0.4, {}),
    "sharp rack": (25, 0.0, 9.0, {"rack": BasicRack(tip_radius_coefficient=0.0)}),
    "full round": (25, 0.0, 9.0, {"rack": BasicRack(tip_radius_coefficient=0.4719)}),
    "steep flank": (25, 0.0, 9.0, {"normal_pressure_angle": math.radians(24.0), "rack": ROUND}),
    "narrow tip": (16, 0.8, 6.0, {"tip_diameter": 39.1e-3}),
}


@pytest.fixture(params=SHAPES)
def gear(request) -> SpurGear:
    teeth, shift, bore, more = SHAPES[request.param]
    return gear_of(teeth, shift, bore, **more)


@pytest.fixture
def mesh(gear) -> SectorMesh:
    return tooth_mesh(gear, 0.5 * gear.bore_diameter)


def areas(mesh: SectorMesh) -> np.ndarray:
    """Area of each element by its nine Gauss points."""
    slopes, weights = shape_gradients()
    jacobian = np.einsum("gdn,enx->egdx", slopes, mesh.nodes[mesh.elements])
    determinant = np.linalg.det(jacobian)
    assert determinant.min() > 0.0
    return determinant @ weights


def test_area_is_that_of_the_section(gear, mesh):
    section = section_moments(gear)[0] - 0.25 * math.pi * gear.bore_diameter**2
    area = mesh.count * areas(mesh).sum() * gear.normal_module**2
    assert area == pytest.approx(section, rel=3e-6)


def test_no_element_is_far_from_a_rectangle(mesh):
    # least sine of the corner angles
    corners = mesh.nodes[mesh.elements[:, [0, 6, 8, 2]]]
    sides = np.roll(corners, -1, axis=1) - corners
    before = np.roll(sides, 1, axis=1)
    cross = before[..., 0] * sides[..., 1] - before[..., 1] * sides[..., 0]
    sine = cross / np.hypot(*np.moveaxis(before, -1, 0)) / np.hypot(*np.moveaxis(sides, -1, 0))
    assert sine.min() > 0.3


def test_cuts_are_radii_that_meet_the_next_sector(gear, mesh):
    right, left = mesh.nodes[mesh.right_cut], mesh.nodes[mesh.left_cut]
    assert np.arctan2(*right.T) == pytest.approx(math.pi / gear.teeth, abs=1e-12)
    assert right * [-1.0, 1.0] == pytest.approx(left, abs=1e-12)
    on_bore = np.hypot(*mesh.nodes[mesh.fixed].T) * gear.normal_module
    assert on_bore == pytest.approx(0.5 * gear.bore_diameter, rel=1e-12)


def test_outline_lies_on_the_exact_curves(gear, mesh):
    points = mesh.nodes[mesh.outline] * gear.normal_module
    radius, angle = np.hypot(*points.T), np.abs(np.arctan2(*points.T))
    flank = (radius > gear.form_radius * (1.0 + 1e-9)) & (radius < gear.tip_radius * (1.0 - 1e-9))
    exact = [gear.half_tooth_angle(distance) for distance in radius[flank]]
    assert flank.sum() > 20
    assert angle[flank] == pytest.approx(exact, abs=1e-12)
    assert radius.max() == pytest.approx(gear.tip_radius, rel=1e-12)
    # the fillet is known by its parameter: every point is that of some angle of the normal
    normal = np.linspace(gear.form_normal_angle, 0.5 * math.pi, 20001)
    fillet = (radius < gear.form_radius * (1.0 - 1e-9)) & (radius > gear.root_radius * (1 + 1e-9))
    expected = np.interp(
        radius[fillet],
        gear.trochoid.radius(normal)[::-1],
        gear.trochoid.half_tooth_angle(normal)[::-1],
    )
    assert angle[fillet] == pytest.approx(expected, abs=2e-4)


def test_every_node_is_used_and_the_outline_is_in_order(mesh):
    assert np.unique(mesh.elements).size == len(mesh.nodes)
    steps = np.hypot(*np.diff(mesh.nodes[mesh.outline], axis=0).T)
    assert steps.min() > 0.0
    assert steps.max() < 0.15
    assert mesh.outline[0] == mesh.right_cut[0]
    assert mesh.outline[-1] == mesh.left_cut[0]


def test_linear_displacement_is_exact_on_the_mesh(gear, mesh):
    # patch test: constant strain, displacements given on the whole boundary
    gradient = np.array([[0.3, -0.7], [0.2, 0.9]])
    exact = mesh.nodes @ gradient.T
    plain = SectorMesh(**{**vars(mesh), "right_cut": mesh.fixed[:0], "left_cut": mesh.fixed[:0]})
    matrix = sector_stiffness(plain, plane_stress(1.0, 0.3)).tocsr()
    cuts = np.concatenate([mesh.right_cut, mesh.left_cut])
    boundary = np.unique(np.concatenate([mesh.outline, cuts, mesh.fixed]))
    boundary_dofs = (2 * boundary[:, None] + np.arange(2)).ravel()
    free = np.setdiff1d(np.arange(2 * len(mesh.nodes)), boundary_dofs)
    moved = exact.ravel().copy()
    load = -matrix[free][:, boundary_dofs] @ moved[boundary_dofs]
    moved[free] = spsolve(matrix[free][:, free].tocsc(), load)
    assert np.abs(moved - exact.ravel()).max() < 1e-10 * np.abs(exact).max()


def test_rigid_motion_costs_nothing_and_strain_does(mesh):
    nodes = mesh.nodes[mesh.elements]
    matrices = element_stiffness(nodes, plane_stress(1.0, 0.3))
    assert np.abs(matrices - matrices.transpose(0, 2, 1)).max() < 1e-12
    turned = np.stack([-nodes[..., 1], nodes[..., 0]], axis=-1)
    shifted = np.ones_like(nodes)
    for motion in (turned, shifted):
        force = np.einsum("eij,ej->ei", matrices, motion.reshape(-1, 18))
        assert np.abs(force).max() < 1e-10 * np.abs(motion).max()
    stretched = (nodes * [1.0, 0.0]).reshape(-1, 18)
    energy = 0.5 * (stretched * np.einsum("eij,ej->ei", matrices, stretched)).sum(axis=1)
    assert np.abs(energy / (0.5 / (1.0 - 0.09) * areas(mesh)) - 1.0).max() < 1e-9


def test_nodal_forces_have_the_load_and_its_moment(gear, mesh):
    tip = gear.roll_angle(gear.tip_radius) * gear.base_radius
    rho = tip * np.array([0.7, 0.85, 1.0])
    rho = rho[rho > gear.roll_angle(max(gear.form_radius, gear.base_radius)) * gear.base_radius]
    for width in (0.0, 0.05):
        forces = flank_loads(gear, mesh, rho, width).forces.reshape(-1, 2, rho.size)
        x, y = mesh.nodes.T
        moment = x @ forces[:, 1] - y @ forces[:, 0]
        # the line of the load is tangent to the base circle and turns the gear anticlockwise
        assert moment == pytest.approx(gear.base_radius / gear.normal_module, rel=1e-4)
        total = forces.sum(axis=0)
        assert np.hypot(*total) == pytest.approx(1.0, rel=1e-12)
        assert np.all(total[0] < 0.0)
        assert -total[1] == pytest.approx(np.sin(load_point(gear, rho).load_angle), rel=1e-9)


def test_hertzian_weights_have_the_spread_of_the_semi_ellipse():
    mesh = tooth_mesh(gear_of(25, 0.0, 9.0), 9e-3)
    middle = 0.5 * (mesh.flank_length[0] + mesh.flank_length[-1]) + 0.3
    weights = nodal_weights(mesh, np.array([middle]), np.array([0.2]))
    along = weights[mesh.tooth[0], 0]
    assert along.sum() == pytest.approx(1.0)
    assert along @ (mesh.flank_length - middle) == pytest.approx(0.0, abs=1e-6)
    assert along @ (mesh.flank_length - middle) ** 2 == pytest.approx(0.2**2 / 4.0, rel=1e-4)


@pytest.mark.parametrize("rim", [0.05, 0.099])
def test_hardly_any_rim_is_refused(rim):
    gear = gear_of(30, 0.0, 27.5 - 2.0 * rim)
    with pytest.raises(InputError, match=r"rim of .* mm.*smaller bore"):
        tooth_mesh(gear, 0.5 * gear.bore_diameter)


def test_thinnest_rim_is_accepted():
    gear = gear_of(30, 0.0, 27.5 - 2.0 * 0.101)
    assert areas(tooth_mesh(gear, 0.5 * gear.bore_diameter)).min() > 0.0


def test_finer_mesh_has_smaller_elements():
    gear = gear_of(20, 0.0, 8.0)
    coarse, fine = (tooth_mesh(gear, 8e-3, MeshSize().refined(f)) for f in (1.0, 2.0))
    assert 3.0 < len(fine.elements) / len(coarse.elements) < 5.0


def test_mirrored_mesh_is_refused():
    mesh = tooth_mesh(gear_of(20, 0.0, 8.0), 8e-3)
    mirrored = mesh.nodes[mesh.elements] * [-1.0, 1.0]
    with pytest.raises(ComputationError, match="inside out"):
        element_stiffness(mirrored, plane_stress(1.0, 0.3))


def test_grid_elements_are_in_order():
    grid = np.arange(15).reshape(5, 3)
    assert grid_elements(grid).tolist() == [list(range(9)), list(range(6, 15))]
