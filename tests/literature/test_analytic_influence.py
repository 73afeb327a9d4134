"""Analytic and Weber influence against plane finite elements of whole gears.

Two references. FZG type A: converged figures, E 206 GPa, nu 0.3, bores 30 mm. Other gears: six-node
triangles on the outline of the whole gear, bore held, load spread as a Hertz pressure of half width
0.02 modules, whose local compression ``2/(pi E) (ln(2 h/a) - nu/2)`` is taken off; converged to
0.5 %, and 0.4 % from the figures of FZG type A.

The figures of the second are computed anew by tests/references/gear_compliance.py; those of the
first (mark ``regression``) are neither printed nor part of this repository.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from known_pairs import pair_of
from references.gear_compliance import TRIANGLES
from tribodyn.contact import effective_modulus, hertz_line, path_of_contact
from tribodyn.gear import Material, SpurGear, SpurPair
from tribodyn.stiffness import (
    GearInfluence,
    load_point,
    loaded_contact,
    weber_banaschek_compression,
)
from tribodyn.stiffness.teeth.analytic import analytic_influence
from tribodyn.stiffness.teeth.influence import weber_influence

WIDTH = 20e-3
#: One pair carrying 100 N/mm [N/m].
SINGLE = {"A": 1.449e8, "C": 1.709e8, "maximum": 2.039e8, "E": 1.590e8}


def named_gear(name: str | tuple[int, float, float]) -> SpurGear:
    if isinstance(name, tuple):
        teeth, bore, shift = name
        return SpurGear(
            teeth=teeth,
            normal_module=4e-3,
            normal_pressure_angle=math.radians(20.0),
            profile_shift_coefficient=shift,
            tip_diameter=(teeth + 2.0 + 2.0 * shift) * 4e-3,
            face_width=WIDTH,
            bore_diameter=bore * (teeth - 2.5 + 2.0 * shift) * 4e-3,
        )
    pair = pair_of()
    if "C" in name:
        pair = pair_of(
            pinion_profile_shift_coefficient=0.182,
            wheel_profile_shift_coefficient=0.1715,
            pinion_tip_diameter=82.46e-3,
            wheel_tip_diameter=118.36e-3,
        )
    return pair.pinion if "pinion" in name else pair.wheel


class Mesh:
    """Coupled compliances of a pair, for one or two contacts a base pitch apart."""

    def __init__(self, pair: SpurPair, pinion: GearInfluence, wheel: GearInfluence) -> None:
        self.pair, self.pinion, self.wheel = pair, pinion, wheel
        self.contact = path_of_contact(pair)

    def local(self, path: np.ndarray, load: np.ndarray) -> np.ndarray:
        """Compression of both flanks over the load per width [m^2/N]."""
        radius = self.contact.kinematics(path, 1.0).equivalent_radius
        modulus = effective_modulus(Material(), Material())
        half_width = np.asarray(hertz_line(load, radius, modulus).half_width)
        bodies = (
            (self.pair.pinion, path),
            (self.pair.wheel, self.pair.line_of_action_length - path),
        )
        return (
            sum(
                weber_banaschek_compression(load, half_width, load_point(*body).depth, Material())
                for body in bodies
            )
            / load
        )

    def single(self, path: np.ndarray, load: float) -> np.ndarray:
        """Secant stiffness [N/m] of one pair alone."""
        structure = self.pinion.at(path) + self.wheel.at(self.pair.line_of_action_length - path)
        return WIDTH / (structure + self.local(path, np.full(path.shape, load)))

    def double(self, path: np.ndarray, load: float) -> np.ndarray:
        """Secant stiffness [N/m] of the pairs at the path and a base pitch on, coupled."""
        places = np.stack([path, path + self.pair.base_pitch])
        mates = self.pair.line_of_action_length - places
        cross = self.pinion.between(*places, 1) + self.wheel.between(*mates, -1)
        self_part = self.pinion.at(places) + self.wheel.at(mates)
        shares = np.full(places.shape, 0.5 * load)
        for _ in range(60):
            first, second = self_part + self.local(places, shares)
            part = (second - cross) / (first + second - 2.0 * cross)
            shares = load * np.stack([part, 1.0 - part])
        return WIDTH * load / (first * shares[0] + cross * shares[1])


@pytest.fixture(scope="module")
def mesh() -> Mesh:
    pair = pair_of()
    return Mesh(pair, *(analytic_influence(gear, Material()) for gear in (pair.pinion, pair.wheel)))


@pytest.mark.regression
def test_compliances_at_the_pitch_point(mesh, record_property):
    pair, point = mesh.pair, float(mesh.contact.C)
    computed = np.array(
        [
            mesh.pinion.at(point),
            mesh.pinion.between(point, point + pair.base_pitch, 1),
            mesh.wheel.at(pair.line_of_action_length - point),
        ]
    )
    expected = np.array([1.4159e-11, 8.320e-12, 8.000e-11])
    record_property("deviation_percent", (100.0 * (computed / expected - 1.0)).tolist())
    assert computed == pytest.approx(expected, rel=0.045)


@pytest.mark.regression
def test_a_single_pair_within_six_percent_and_less_on_the_mean(mesh):
    path = np.linspace(mesh.contact.A, mesh.contact.E, 401)
    along = mesh.single(path, 100e3)
    at_pitch_point = mesh.single(np.array([mesh.contact.C]), 100e3)[0]
    stiffnesses = np.array([along[0], at_pitch_point, along.max(), along[-1]])
    deviation = stiffnesses / np.array(list(SINGLE.values())) - 1.0
    assert np.all(np.abs(deviation) < 0.055)
    assert -0.02 < np.median(deviation) < 0.02


@pytest.mark.regression
@pytest.mark.parametrize(
    ("torque", "secant", "tangent", "deflection", "swing"),
    [(90.0, 2.327e8, 2.419e8, 11.78, 5.19), (300.0, 2.435e8, 2.555e8, 37.45, 16.20)],
)
def test_loaded_contact_within_three_percent(mesh, torque, secant, tangent, deflection, swing):
    contact = loaded_contact(mesh.pair, torque, provider="analytic")
    assert contact.mesh_stiffness_secant.mean() == pytest.approx(secant, rel=0.02)
    assert contact.mesh_stiffness_tangent.mean() == pytest.approx(tangent, rel=0.02)
    error = contact.transmission_error * 1e6
    assert error.mean() == pytest.approx(deflection, rel=0.02)
    assert np.ptp(error) == pytest.approx(swing, rel=0.06)


@pytest.mark.regression
def test_sum_of_single_pairs_over_the_coupled_stiffness(mesh):
    middle = np.array([0.5 * (mesh.contact.A + mesh.contact.B)])
    load = 90.0 / mesh.pair.pinion.base_radius / WIDTH
    compliance = mesh.double(middle, load)
    alone = mesh.single(middle, 0.5 * load) + mesh.single(middle + mesh.pair.base_pitch, 0.5 * load)
    assert float(alone[0] / compliance[0]) == pytest.approx(1.210, abs=0.02)


@pytest.mark.parametrize("name", TRIANGLES, ids=str)
def test_other_gears_against_triangles(name, record_property):
    radii, self_expected, cross = (np.array(values) for values in TRIANGLES[name])
    rho = radii * 1e-3
    influence = analytic_influence(named_gear(name), Material())
    compliance = influence.at(rho) * 1e11
    record_property("self_percent", (100.0 * (compliance / self_expected - 1.0)).tolist())
    # Low on the flank the stub of a tooth is no beam.
    assert compliance == pytest.approx(self_expected, rel=0.09)
    assert compliance[1:] == pytest.approx(self_expected[1:], rel=0.04)
    cross_compliance = influence.between(rho, rho[::-1], 1) * 1e12
    record_property(
        "cross_percent_of_self", (10.0 * (cross_compliance - cross) / self_expected.mean()).tolist()
    )
    assert cross_compliance == pytest.approx(cross, abs=0.022 * 10.0 * self_expected.mean())


@pytest.mark.regression
def test_a_half_plane_is_far_too_stiff():
    # Known for seven pairs, bores held: 25 to 103 % on the mean over the path.
    changed = pair_of(
        pinion_profile_shift_coefficient=0.182, wheel_profile_shift_coefficient=0.1715
    )
    for pair in (pair_of(), changed):
        gears = pair.pinion, pair.wheel
        meshes = [
            Mesh(pair, *(make(gear, Material()) for gear in gears))
            for make in (weber_influence, analytic_influence)
        ]
        path = np.linspace(meshes[0].contact.A, meshes[0].contact.E, 101)
        stiff, close = (mesh.single(path, 100e3) for mesh in meshes)
        assert 0.25 < np.mean(stiff / close - 1.0) < 1.03
