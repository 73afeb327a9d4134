"""The local compression of Weber and Banaschek."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn.contact import effective_modulus, hertz_line
from tribodyn.errors import ComputationError, InputError
from tribodyn.gear import Material
from tribodyn.stiffness import weber_banaschek_compression


def strain_of_a_half_space_under_hertz_pressure(load, half_width, depth, material):
    """Displacement between the surface and a depth, integrated from the stresses on the axis."""
    nu, z = material.poissons_ratio, np.linspace(0.0, depth, 400_001)
    s, peak = z / half_width, 2.0 * load / (np.pi * half_width)
    along = -peak / np.sqrt(1.0 + s**2)
    across = -peak * ((1.0 + 2.0 * s**2) / np.sqrt(1.0 + s**2) - 2.0 * s)
    modulus = material.youngs_modulus
    strain = (1.0 - nu**2) / modulus * (along - nu / (1.0 - nu) * across)
    return -np.trapezoid(strain, z)


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.45])
def test_it_is_the_strain_under_a_hertz_contact_integrated_over_the_depth(nu):
    material = Material(poissons_ratio=nu)
    load, half_width, depth = 1.3e5, 8e-5, 4e-3
    exact = strain_of_a_half_space_under_hertz_pressure(load, half_width, depth, material)
    compression = weber_banaschek_compression(load, half_width, depth, material)
    assert compression == pytest.approx(exact, rel=2e-4)


def test_it_grows_less_than_in_proportion_to_the_load():
    material = Material()
    load = np.array([1e5, 2e5])
    half_width = hertz_line(load, 8e-3, effective_modulus(material, material)).half_width
    single, two = weber_banaschek_compression(load, half_width, np.full(2, 4e-3), material)
    nu = material.poissons_ratio
    bracket = np.log(2 * 4e-3 / half_width[0]) - nu / (2 * (1 - nu))
    # Twice the load, root two of the width: the logarithm falls by ln(2) / 2.
    assert two / single == pytest.approx(2.0 * (bracket - 0.5 * np.log(2.0)) / bracket, rel=1e-12)


def test_the_thinnest_line_of_contact_is_compressed_by_its_logarithm():
    thin, thinner = (
        weber_banaschek_compression(1e5, a, 4e-3, Material()) for a in (1e-300, 1e-320)
    )
    nu = Material().poissons_ratio
    factor = 2.0 * 1e5 * (1.0 - nu**2) / (np.pi * Material().youngs_modulus)
    assert thinner - thin == pytest.approx(factor * 20.0 * np.log(10.0), rel=1e-4)


def test_a_contact_as_wide_as_the_tooth_is_refused():
    with pytest.raises(ComputationError, match="half width much smaller"):
        weber_banaschek_compression(1e8, 8e-3, 4e-3, Material())


@pytest.mark.parametrize("position", [0, 1, 2])
def test_arguments_must_be_positive(position):
    arguments = [1e5, 8e-5, 4e-3]
    arguments[position] = 0.0
    with pytest.raises(InputError, match="greater than zero"):
        weber_banaschek_compression(*arguments, Material())
