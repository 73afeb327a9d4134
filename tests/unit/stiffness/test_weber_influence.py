"""Weber and Banaschek: the half plane under the tooth from its kernel, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn.errors import InputError
from tribodyn.gear import Material
from tribodyn.stiffness import load_point
from tribodyn.stiffness.teeth.influence import half_plane_compliance, weber_influence

WIDTH = 8e-3


def terms(material: Material) -> np.ndarray:
    """Coefficients of (u/s)^2, u/s and 1 without the load angle, and of its squared tangent."""
    heights = np.array([0.0, WIDTH, 2.0 * WIDTH])
    values = half_plane_compliance(0.0, heights, WIDTH, material)
    square = 0.5 * (values[2] - 2.0 * values[1] + values[0])
    tilted = half_plane_compliance(0.4, 0.0, WIDTH, material)
    tangent = (tilted / np.cos(0.4) ** 2 - values[0]) / np.tan(0.4) ** 2
    modulus = material.youngs_modulus / (1.0 - material.poissons_ratio**2)
    return modulus * np.array([square, values[1] - values[0] - square, values[0], tangent])


def test_rotation_is_that_of_linear_stress_on_a_half_plane(steel):
    # Stress 12 M x / s^3 on a half plane lifts it by -2 / (pi E') ln |x - y|; the work of the same
    # stress is M times the rotation. Both integrals over the foot, the inner one in closed form.
    points, weights = np.polynomial.legendre.leggauss(400)
    y = 0.5 * points

    def moment_of_logarithm(t):
        # Antiderivative over x of x ln|x - y| with t = x - y.
        return 0.5 * t**2 * np.log(np.abs(t)) - 0.25 * t**2 + y * (t * np.log(np.abs(t)) - t)

    inner = moment_of_logarithm(0.5 - y) - moment_of_logarithm(-0.5 - y)
    rotation = -2.0 / np.pi * 144.0 * 0.5 * weights @ (y * inner)
    assert terms(steel)[0] == pytest.approx(rotation, rel=1e-4)


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.45])
def test_the_moment_moves_the_foot_sideways_as_on_a_half_plane(nu):
    # A normal force moves the surface by (1 - 2 nu) / (2 (1 - nu)) / E' towards itself.
    x = (np.arange(400) + 0.5) / 400 - 0.5
    stress = 12.0 * x / 400
    towards = (1.0 - 2.0 * nu) / (2.0 * (1.0 - nu)) * np.sign(x[:, None] - x[None, :])
    sideways = abs((towards @ stress).mean())
    # Twice: the force turns the foot, the moment moves it.
    assert terms(Material(200e9, nu))[1] == pytest.approx(2.0 * sideways, rel=1e-4, abs=1e-9)


@pytest.mark.parametrize("nu", [0.2, 0.3])
def test_force_terms_lengthen_the_beam_equally(nu):
    # Shear and axial compression of a beam of the width of the foot that is longer by one piece.
    _, _, across, along = terms(Material(200e9, nu))
    shear_of_beam = 2.4 / (1.0 - nu)
    assert across / shear_of_beam == pytest.approx(along, rel=1e-9)


def test_weber_of_1949_is_near(steel):
    compliance_terms = terms(steel)
    assert compliance_terms == pytest.approx([5.2, 1.0, 1.4, 1.4 * 0.294], rel=0.15)


def test_structure_scales_with_the_modulus_and_knows_no_neighbours(fzg, steel):
    gear = fzg().pinion
    hard, soft = (weber_influence(gear, Material(modulus)) for modulus in (210e9, 70e9))
    assert soft.self_compliance == pytest.approx(3.0 * hard.self_compliance, rel=1e-11)
    assert hard.cross_compliance.shape == (0, 30, 30)
    assert float(hard.between(0.014, 0.02, 1)) == 0.0


def test_it_is_beam_and_half_plane_from_the_foot_to_the_axis(fzg, steel):
    # Against the sum by the trapezoidal rule for one load in the middle of the flank.
    from tribodyn.gear import half_tooth

    gear = fzg().wheel
    influence = weber_influence(gear, steel, nodes=40)
    rho = 0.0155
    load = load_point(gear, rho)
    height, thickness = half_tooth(gear, 4000)
    reach = float(load.axis_height)
    y = np.linspace(height[0], reach, 20_001)
    x = np.interp(y, height, thickness)
    nu = steel.poissons_ratio
    plane = (1.0 - nu**2) / steel.youngs_modulus * np.cos(load.load_angle) ** 2
    bending = 12.0 * np.trapezoid((reach - y) ** 2 / (2.0 * x) ** 3, y)
    direct = (2.4 / (1.0 - nu) + np.tan(load.load_angle) ** 2) * np.trapezoid(0.5 / x, y)
    foot = half_plane_compliance(load.load_angle, reach - height[0], 2.0 * thickness[0], steel)
    assert influence.at(rho) == pytest.approx(plane * (bending + direct) + foot, rel=1e-4)


def test_cubic_splines_between_the_nodes_are_enough(fzg, steel):
    for gear in (fzg().pinion, fzg().wheel):
        coarse, fine = (weber_influence(gear, steel, nodes=count) for count in (24, 150))
        rho = np.linspace(*coarse.curvature_radius[[0, -1]], 400)
        assert coarse.at(rho) == pytest.approx(fine.at(rho), rel=2e-4)


def test_there_is_no_bore_in_a_half_plane(fzg, steel):
    with pytest.raises(InputError, match=r'half plane[\s\S]*reference = "rim"'):
        weber_influence(fzg().pinion, steel, reference="bore")
    with pytest.raises(InputError, match='"bore" or "rim"'):
        weber_influence(fzg().pinion, steel, reference="hub")
