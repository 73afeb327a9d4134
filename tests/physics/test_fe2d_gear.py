"""Compliances of whole gears by finite elements: reference values, split, convergence, mutations.

Reference values: mesh-converged finite element ring, plane stress with a plane strain local term,
FZG type A, E 206 GPa, nu 0.3, bores 30 mm, face width 20 mm.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable

import numpy as np
import pytest

from known_pairs import pair_of
from tribodyn.contact import effective_modulus, hertz_line, path_of_contact
from tribodyn.errors import InputError
from tribodyn.gear import BasicRack, Material, SpurGear, SpurPair
from tribodyn.stiffness import GearInfluence, load_point, wind_up_compliance
from tribodyn.stiffness.fe2d import MeshSize, fe2d_influence
from tribodyn.stiffness.fe2d.flank_load import flank_loads, half_plane_displacement, remainder_loads
from tribodyn.stiffness.fe2d.provider import UnitCompliances, unit_compliances
from tribodyn.stiffness.fe2d.ring import Ring, plane_stress
from tribodyn.stiffness.fe2d.tooth_mesh import SectorMesh, tooth_mesh

STEEL = Material()
#: Radius of curvature of the pinion at the pitch point [m].
AT_C = 13.97e-3


def gear_of(teeth: int, module: float, shift: float, bore: float, **more: object) -> SpurGear:
    values = {
        "teeth": teeth,
        "normal_module": module,
        "normal_pressure_angle": math.radians(20.0),
        "profile_shift_coefficient": shift,
        "tip_diameter": module * (teeth + 2.0 + 2.0 * shift),
        "face_width": 0.02,
        "bore_diameter": bore,
    }
    return SpurGear(**{**values, **more})


SHARP = BasicRack(tip_radius_coefficient=0.0)
HIGH = BasicRack(addendum_coefficient=1.4, dedendum_coefficient=1.65, tip_radius_coefficient=0.2)
#: Gears far apart in teeth, bore, shift, fillet and rim.
GEARS: dict[str, Callable[[], SpurGear]] = {
    "type C pinion": lambda: gear_of(16, 4.5e-3, 0.182, 30e-3, tip_diameter=82.46e-3),
    "type C wheel": lambda: gear_of(24, 4.5e-3, 0.1715, 30e-3, tip_diameter=118.36e-3),
    "80 teeth, small bore": lambda: gear_of(80, 2e-3, 0.0, 30e-3),
    "80 teeth, thin rim": lambda: gear_of(80, 2e-3, 0.0, 152.6e-3),
    "undercut": lambda: gear_of(12, 3e-3, 0.0, 12e-3),
    "sharp rack": lambda: gear_of(30, 3e-3, 0.0, 30e-3, rack=SHARP),
    "high addendum": lambda: gear_of(45, 3e-3, 0.0, 60e-3, rack=HIGH, tip_diameter=143.4e-3),
}


@pytest.fixture(scope="module")
def pair() -> SpurPair:
    return pair_of()


@pytest.fixture(scope="module")
def influences(pair) -> tuple[GearInfluence, GearInfluence]:
    return tuple(fe2d_influence(g, STEEL, cache=False) for g in (pair.pinion, pair.wheel))


def test_compliances_at_the_pitch_point(pair, influences):
    pinion, wheel = influences
    assert float(pinion.at(AT_C)) == pytest.approx(1.4159e-11, rel=0.002)
    assert float(wheel.at(pair.line_of_action_length - AT_C)) == pytest.approx(8.0e-11, rel=0.002)
    base_pitch = pair.pinion.base_pitch
    onward = float(pinion.between(AT_C, AT_C + base_pitch, 1))
    assert onward == pytest.approx(8.320e-12, rel=0.002)
    # the tooth on the other side would be mistaken for it
    assert abs(float(pinion.between(AT_C, AT_C + base_pitch, -1)) / onward - 1.0) > 0.1


def local_compliance(pair: SpurPair, path: np.ndarray, load: float) -> np.ndarray:
    """Plane strain compression of both bodies over the load."""
    radii = path, pair.line_of_action_length - path
    equivalent = radii[0] * radii[1] / (radii[0] + radii[1])
    width = hertz_line(load, equivalent, effective_modulus(STEEL, STEEL)).half_width
    nu = STEEL.poissons_ratio
    factor = 2.0 * (1.0 - nu**2) / (math.pi * STEEL.youngs_modulus)
    depths = (load_point(g, r).depth for g, r in zip((pair.pinion, pair.wheel), radii, strict=True))
    return factor * sum(np.log(2.0 * h / width) - 0.5 * nu / (1.0 - nu) for h in depths)


def test_secant_stiffness_of_a_single_pair(pair, influences, record_property):
    contact = path_of_contact(pair)
    path = np.append(np.linspace(contact.A, contact.E, 301), contact.C)
    compliance = influences[0].at(path) + influences[1].at(pair.line_of_action_length - path)
    stiffness = 0.02 / (compliance + local_compliance(pair, path, 100e3))
    computed = {
        "A": stiffness[0],
        "C": stiffness[-1],
        "maximum": stiffness.max(),
        "E": stiffness[-2],
    }
    for place, expected in {"A": 1.449e8, "C": 1.709e8, "maximum": 2.039e8, "E": 1.590e8}.items():
        record_property(place, float(computed[place]))
        tolerance = 0.005 if place in "AE" else 0.001
        assert computed[place] == pytest.approx(expected, rel=tolerance), place


def lengthwise(gear: SpurGear, rho: np.ndarray, along: np.ndarray) -> np.ndarray:
    """Radii of curvature of the places that lie a length [modules] further along the flank."""
    return np.sqrt(rho**2 + 2.0 * gear.base_radius * gear.normal_module * along)


def patch_split(gear: SpurGear, size: MeshSize, rho: np.ndarray, half_width: float) -> np.ndarray:
    """Self compliance by brute force: a Hertzian patch on the elements less its local part."""
    mesh = tooth_mesh(gear, 0.5 * gear.bore_diameter, size)
    ring = Ring(mesh, plane_stress(1.0, 0.3))
    loads = flank_loads(gear, mesh, rho, half_width)
    mean = np.diagonal(ring.weighted_displacements(ring.solve(loads.forces), loads.forces, [0])[0])
    # Hertz: the middle lies 1/(2 pi E) deeper than the mean over the pressure
    middle = mean + 0.5 / math.pi
    return middle - 2.0 / math.pi * (np.log(2.0 * loads.depth / half_width) - 0.5 * 0.3)


@pytest.mark.parametrize("half_width", [0.03, 0.06])
def test_brute_force_with_a_hertzian_patch_agrees(pair, influences, half_width):
    rho = np.array([AT_C, 20e-3])
    fine = MeshSize(flank=0.01, largest=0.12, growth=1.25)
    split = patch_split(pair.pinion, fine, rho, half_width) / STEEL.youngs_modulus
    assert split == pytest.approx(influences[0].at(rho), rel=7e-4)


def point_split(
    gear: SpurGear, mesh: SectorMesh, ring: Ring, rho: float, half_width: float
) -> float:
    """Self compliance under many point loads that together are a Hertzian patch."""
    count = 24
    turn = np.pi * np.arange(1, count + 1) / (count + 1)
    share = 2.0 / (count + 1) * np.sin(turn) ** 2
    offset = half_width * np.cos(turn)
    sources = flank_loads(gear, mesh, lengthwise(gear, np.full(count, rho), offset))
    middle = flank_loads(gear, mesh, np.array([rho]))
    depth = np.full(count, middle.depth[0])
    direction = np.broadcast_to(middle.direction, (count, 2))
    elasticity = plane_stress(1.0, 0.3)
    forces = remainder_loads(mesh, sources.place, direction, depth, elasticity)
    remainder = ring.weighted_displacements(ring.solve(forces), middle.forces, [0])[0][:, 0]
    half_plane = half_plane_displacement(middle.place - sources.place, direction, depth, 0.3)
    normal = half_plane @ middle.direction[0]
    # what the half plane does at the same distance on its straight edge is the local part
    straight = -2.0 / math.pi * (np.log(np.abs(offset) / depth) + 0.5 * 1.3)
    return float(share @ (remainder + normal - straight))


@pytest.mark.parametrize("rho", [12e-3, AT_C, 22e-3])
def test_split_does_not_depend_on_the_width_of_the_load(pair, rho):
    gear = pair.pinion
    mesh = tooth_mesh(gear, 0.5 * gear.bore_diameter)
    ring = Ring(mesh, plane_stress(1.0, 0.3))
    splits = [point_split(gear, mesh, ring, rho, width) for width in (0.01, 0.02, 0.04)]
    assert splits == pytest.approx([splits[0]] * 3, rel=1e-4)
    exact = float(fe2d_influence(gear, STEEL, cache=False).at(rho)) * STEEL.youngs_modulus
    assert splits[0] == pytest.approx(exact, rel=1e-4)


def test_flamant_meets_hertz_far_from_the_load():
    # depth 3 under the load: straight down, the zero of the displacement
    down = np.array([0.0, -1.0])
    at_depth = half_plane_displacement(np.array([0.0, -3.0]), down, np.array(3.0), 0.3)
    assert at_depth == pytest.approx([0.0, 0.0], abs=1e-15)
    nearer = half_plane_displacement(np.array([0.0, -1.5]), down, np.array(3.0), 0.3)
    assert nearer == pytest.approx([0.0, -2.0 / math.pi * math.log(2.0)], abs=1e-15)
    # on the edge all material moves towards the load by (1 - nu) / (2 E)
    displacement = half_plane_displacement(np.array([0.7, 0.0]), down, np.array(3.0), 0.3)
    assert displacement[0] == pytest.approx(-0.5 * 0.7)


@pytest.mark.slow
@pytest.mark.parametrize("name", GEARS)
def test_refined_mesh_changes_little(name, record_property):
    gear = GEARS[name]()
    coarse = unit_compliances(gear, 0.3, 2)
    fine = unit_compliances(gear, 0.3, 2, MeshSize().refined(1.6))
    error = np.abs(coarse.self_compliance / fine.self_compliance - 1.0).max()
    scale = np.abs(fine.cross_compliance).max(axis=(1, 2), keepdims=True)
    cross = np.abs((coarse.cross_compliance - fine.cross_compliance) / scale).max()
    record_property("self_change", float(error))
    record_property("cross_change", float(cross))
    assert error < 1e-3
    assert cross < 1e-3


def test_error_falls_as_the_mesh_is_refined(record_property):
    gear = GEARS["type C wheel"]()
    base = MeshSize(flank=0.1, largest=0.18, growth=1.7, body_growth=0.6, body_ratio=0.4)
    compliances = [unit_compliances(gear, 0.3, 1, base.refined(f)) for f in (1.0, 2.0, 4.0)]
    for part in ("self_compliance", "cross_compliance"):
        tables = [getattr(gear_compliance, part) for gear_compliance in compliances]
        steps = [np.abs(b - a).max() / np.abs(b).max() for a, b in itertools.pairwise(tables)]
        record_property(part, [float(step) for step in steps])
        assert steps[0] < 2e-3, part
        assert steps[1] < 0.3 * steps[0], part


def test_reciprocal_theorem_between_different_places(influences):
    # the tables hold both directions only by symmetry of the ring: see the neighbour the other way
    for influence in influences:
        rho = influence.curvature_radius
        onward = influence.between(rho[5], rho[15], 1)
        back = influence.between(rho[15], rho[5], -1)
        assert float(onward) == pytest.approx(float(back), rel=1e-12)
    gear = GEARS["type C pinion"]()
    mesh = tooth_mesh(gear, 0.5 * gear.bore_diameter)
    ring = Ring(mesh, plane_stress(1.0, 0.3))
    loads = flank_loads(gear, mesh, np.array([8e-3, 15e-3]))
    forces = remainder_loads(mesh, *loads[:3], plane_stress(1.0, 0.3))
    solution = ring.solve(forces)
    for n in (1, 2, 3):
        onward, back = (
            ring.weighted_displacements(solution, loads.forces, [k])[0] for k in (n, -n)
        )
        assert onward == pytest.approx(back.T, rel=1e-4)


def test_left_flank_mirrors_the_right_one():
    gear = GEARS["type C pinion"]()
    mesh = tooth_mesh(gear, 0.5 * gear.bore_diameter)
    ring = Ring(mesh, plane_stress(1.0, 0.3))
    right = flank_loads(gear, mesh, np.array([8e-3, 12e-3, 15e-3])).forces.reshape(-1, 2, 3)
    left = np.zeros_like(right)
    left[mesh.tooth[-1]] = right[mesh.tooth[0]] * np.array([-1.0, 1.0])[:, None]
    right, left = right.reshape(-1, 3), left.reshape(-1, 3)
    for n in (1, 2):
        ours = ring.weighted_displacements(ring.solve(right), right, [n])[0]
        mirrored = ring.weighted_displacements(ring.solve(left), left, [-n])[0]
        assert mirrored == pytest.approx(ours, rel=2e-4)
        assert (
            np.abs(ring.weighted_displacements(ring.solve(left), left, [n])[0] / ours - 1.0).max()
            > 0.01
        )


def test_compliance_falls_with_the_modulus(pair, influences):
    soft = fe2d_influence(pair.pinion, Material(youngs_modulus=70e9), cache=False)
    ratio = 206.0 / 70.0
    assert soft.self_compliance / influences[0].self_compliance == pytest.approx(ratio, rel=1e-9)
    assert soft.cross_compliance == pytest.approx(ratio * influences[0].cross_compliance, rel=1e-9)


def test_compliance_does_not_depend_on_the_size_of_the_gear():
    small, large = (gear_of(20, m, 0.2, 6.0 * m) for m in (1e-3, 1e-2))
    compliances = [unit_compliances(gear, 0.3, 1) for gear in (small, large)]
    assert compliances[0].self_compliance == pytest.approx(compliances[1].self_compliance, rel=1e-9)


def test_rim_is_the_bore_without_the_wind_up(pair, influences):
    gear = pair.pinion
    rim = fe2d_influence(gear, STEEL, reference="rim", cache=False)
    wind_up = wind_up_compliance(gear.base_radius, gear.root_radius, 15e-3, 1.0, STEEL)
    assert influences[0].self_compliance - rim.self_compliance == pytest.approx(wind_up)
    gap = influences[0].cross_compliance - rim.cross_compliance
    assert gap == pytest.approx(np.full_like(gap, wind_up))


def test_smaller_bore_winds_up_by_the_closed_form():
    # Equal loads on all teeth: the body turns as a ring in torsion, and nothing else changes.
    gear = gear_of(11, 3e-3, 0.3, 10e-3)
    wind_up = [summed(unit_compliances(gear, 0.3, 5, None, radius)) for radius in (4e-3, 2e-3)]
    turns = [
        wind_up_compliance(gear.base_radius, gear.root_radius, radius, 1.0, Material(1.0, 0.3))
        for radius in (4e-3, 2e-3)
    ]
    assert wind_up[1] - wind_up[0] == pytest.approx(11.0 * (turns[1] - turns[0]), rel=2e-3)


def summed(compliances: UnitCompliances) -> float:
    """Displacement of a tooth when all teeth carry a load in the middle of the flank."""
    middle = compliances.curvature_radius.size // 2
    return (
        compliances.self_compliance[middle]
        + 2.0 * compliances.cross_compliance[:, middle, middle].sum()
    )


def test_solid_gear_with_its_rim_as_reference():
    gear = gear_of(20, 3e-3, 0.0, 0.0)
    solid = fe2d_influence(gear, STEEL, reference="rim", cache=False)
    bored = gear_of(20, 3e-3, 0.0, 2.0 * gear.root_radius / 7.0)
    same = fe2d_influence(bored, STEEL, reference="rim", cache=False)
    assert solid.self_compliance == pytest.approx(same.self_compliance, rel=1e-9)
    with pytest.raises(InputError, match="rim"):
        fe2d_influence(gear, STEEL, cache=False)


def test_fixed_circle_of_a_solid_gear_only_shifts_the_body():
    # A body of infinite extent shifts by (1 + nu)(3 - nu) / (4 pi E) per doubling of the distance.
    gear = gear_of(40, 3e-3, 0.0, 0.0)
    rim = []
    for share in (7.0, 14.0, 28.0):
        fixed_radius = gear.root_radius / share
        turn = wind_up_compliance(
            gear.base_radius, gear.root_radius, fixed_radius, 1.0, Material(1.0, 0.3)
        )
        rim.append(unit_compliances(gear, 0.3, 1, None, fixed_radius).self_compliance[12] - turn)
    shift = 1.3 * 2.7 / (4.0 * math.pi) * math.log(2.0)
    assert np.diff(rim) == pytest.approx([shift, shift], rel=0.1)


def test_plane_strain_structure_would_show(pair, influences):
    # Plane strain is plane stress with other constants.
    nu = 0.3
    strain = unit_compliances(pair.pinion, nu / (1.0 - nu), 1)
    ratio = (1.0 - nu**2) * strain.self_compliance / STEEL.youngs_modulus
    stiffer = 1.0 - ratio / influences[0].self_compliance
    assert np.all(stiffer > 0.01)
    assert stiffer.mean() > 0.04


def test_missing_wind_up_would_show(pair, influences):
    rim = fe2d_influence(pair.pinion, STEEL, reference="rim", cache=False)
    assert np.all(rim.self_compliance < 0.98 * influences[0].self_compliance)


def test_tip_is_a_smooth_continuation(pair, influences):
    # with the length from the corner the compliance rises at a rate that hardly changes
    for gear, influence in zip((pair.pinion, pair.wheel), influences, strict=True):
        tip = influence.curvature_radius[-1]
        away = np.array([0.0, 0.03, 0.06, 0.09, 0.12])
        self_compliance = influence.at(lengthwise(gear, np.full(away.size, tip), -away))
        rise = -np.diff(self_compliance) / self_compliance[:-1]
        assert np.all((rise > 0.015) & (rise < 0.06))
        assert np.all(np.abs(np.diff(rise)) < 0.006)


def test_nodes_suffice_for_the_interpolation(pair, influences):
    gear = pair.wheel
    rho = influences[1].curvature_radius
    middles = 0.5 * (rho[1:-3] + rho[2:-2])
    mesh = tooth_mesh(gear, 0.5 * gear.bore_diameter)
    ring = Ring(mesh, plane_stress(1.0, 0.3))
    loads = flank_loads(gear, mesh, middles)
    solution = ring.solve(remainder_loads(mesh, *loads[:3], plane_stress(1.0, 0.3)))
    exact = (
        np.diagonal(ring.weighted_displacements(solution, loads.forces, [0])[0])
        / STEEL.youngs_modulus
    )
    assert influences[1].at(middles) == pytest.approx(exact, rel=3e-4)
    cross = ring.weighted_displacements(solution, loads.forces, [-1])[0] / STEEL.youngs_modulus
    cross_compliance = influences[1].between(middles[:, None], middles[None, :], 1)
    assert cross_compliance == pytest.approx(cross, rel=1e-4)
