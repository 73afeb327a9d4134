"""Elastic ring with a held bore: closed forms, radial elements, limits."""

from __future__ import annotations

import importlib

import numpy as np
import pytest

from tribodyn.errors import InputError
from tribodyn.gear import Material
from tribodyn.stiffness import wind_up_compliance
from tribodyn.stiffness.teeth.analytic import ring_compliance

INNER, OUTER = 0.015, 0.034


def test_torsion_is_the_wind_up_of_the_body(steel):
    ring = ring_compliance(INNER, OUTER, steel, 2)
    base = 0.032
    stress = base / (2.0 * np.pi * OUTER**2)
    along_line = ring.torsion * stress / OUTER * base
    assert along_line == pytest.approx(
        wind_up_compliance(base, OUTER, INNER, 1.0, steel), rel=1e-12
    )


def test_even_tension_is_the_thick_ring_of_lame(steel):
    a, b, nu, modulus = INNER, OUTER, steel.poissons_ratio, steel.youngs_modulus

    def displacement(radius, inside, outside):
        even = (1.0 - nu) * (inside * a**2 - outside * b**2) * radius
        hole = (1.0 + nu) * (inside - outside) * a**2 * b**2 / radius
        return (even + hole) / (modulus * (b**2 - a**2))

    # The pressure in the bore that keeps it from moving, under a tension of one outside.
    reaction = -displacement(a, 0.0, -1.0) / displacement(a, 1.0, 0.0)
    expected = displacement(b, reaction, -1.0)
    assert ring_compliance(a, b, steel, 1).expansion == pytest.approx(expected, rel=1e-12)


def radial_elements(waves: int, elements: int, material: Material) -> np.ndarray:
    """The same compliance from quadratic elements along the radius."""
    nu = material.poissons_ratio
    law = np.array([[1.0, nu, 0.0], [nu, 1.0, 0.0], [0.0, 0.0, 0.5 * (1.0 - nu)]])
    law *= material.youngs_modulus / (1.0 - nu**2)
    r = np.linspace(INNER, OUTER, 2 * elements + 1)
    stiffness = np.zeros((2 * r.size, 2 * r.size))
    points, weights = np.polynomial.legendre.leggauss(4)
    for first in range(0, 2 * elements, 2):
        half = 0.5 * (r[first + 2] - r[first])
        rows = np.arange(2 * first, 2 * first + 6)
        for x, weight in zip(points, weights, strict=True):
            radius = r[first + 1] + half * x
            shape = np.array([0.5 * x * (x - 1.0), 1.0 - x**2, 0.5 * x * (x + 1.0)])
            slope = np.array([x - 0.5, -2.0 * x, x + 0.5]) / half
            strain = np.zeros((3, 6))
            strain[0, 0::2] = slope
            strain[1, 0::2], strain[1, 1::2] = shape / radius, waves * shape / radius
            strain[2, 0::2], strain[2, 1::2] = -waves * shape / radius, slope - shape / radius
            stiffness[np.ix_(rows, rows)] += weight * half * radius * strain.T @ law @ strain
    load = np.zeros((2 * r.size, 2))
    load[-2, 0] = load[-1, 1] = OUTER
    return np.linalg.solve(stiffness[2:, 2:], load[2:])[-2:]


@pytest.mark.parametrize("waves", [1, 2, 5, 17])
def test_waves_agree_with_radial_elements_that_converge_to_them(steel, waves):
    exact = ring_compliance(INNER, OUTER, steel, 20).waves[waves - 1]
    errors = [
        np.abs(radial_elements(waves, elements, steel) / exact - 1.0).max()
        for elements in (16, 32, 64)
    ]
    assert errors[-1] < 1e-5
    orders = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert orders == pytest.approx(4.0, abs=0.4)


def test_short_waves_are_those_of_a_half_plane(steel):
    waves = 4000
    compliance = ring_compliance(INNER, OUTER, steel, waves).waves[-1] * waves / OUTER
    nu = steel.poissons_ratio
    # Wave of pull and shear on a half plane, plane stress. The surface moves away from a pull.
    half_plane = np.array([[2.0, 1.0 - nu], [1.0 - nu, 2.0]]) / steel.youngs_modulus
    assert compliance == pytest.approx(half_plane, rel=2e-3)


@pytest.mark.parametrize("ratio", [1e-3, 0.5, 0.95, 0.994])
def test_any_ring_gives_finite_positive_definite_compliances(steel, ratio):
    ring = ring_compliance(ratio * OUTER, OUTER, steel, 3000)
    assert np.all(np.linalg.eigvalsh(ring.waves) > 0.0)
    assert ring.expansion > 0.0 < ring.torsion


def test_a_thin_ring_shears_and_stretches_like_a_layer(steel):
    thickness = 0.01
    ring = ring_compliance(1.0 - thickness, 1.0, steel, 2)
    assert ring.torsion == pytest.approx(thickness / steel.shear_modulus, rel=0.02)
    layer = steel.youngs_modulus / (1.0 - steel.poissons_ratio**2)
    assert ring.expansion == pytest.approx(thickness / layer, rel=0.02)


def test_compliance_goes_with_the_size_and_the_inverse_of_the_modulus(steel):
    ring = ring_compliance(INNER, OUTER, steel, 30)
    other = ring_compliance(2.0 * INNER, 2.0 * OUTER, Material(4.0 * steel.youngs_modulus), 30)
    assert other.waves == pytest.approx(0.5 * ring.waves, rel=1e-11)
    assert other.expansion == pytest.approx(0.5 * ring.expansion, rel=1e-12)


@pytest.mark.parametrize("inner", [0.0, 0.999 * OUTER, 1.2 * OUTER])
def test_a_body_that_is_no_ring_is_refused(steel, inner):
    with pytest.raises(InputError, match=r"smaller bore|greater than zero"):
        ring_compliance(inner, OUTER, steel, 3)


@pytest.mark.parametrize("ratio", [0.1, 0.6, 0.97])
def test_waves_that_do_not_reach_the_bore_are_continued_without_it(steel, ratio, monkeypatch):
    compliance = ring_compliance(ratio * OUTER, OUTER, steel, 1500)
    module = importlib.import_module("tribodyn.stiffness.teeth.analytic")
    monkeypatch.setattr(module, "_DECAYED", 1e9)
    all_felt = ring_compliance(ratio * OUTER, OUTER, steel, 1500)
    assert compliance.waves == pytest.approx(all_felt.waves, rel=2e-10)
