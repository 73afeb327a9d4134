"""Stress below a line contact against printed maxima, and against the sum of point forces."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn.errors import InputError
from tribodyn.rating import line_contact_stress, subsurface_exposure
from tribodyn.rating.surface.subsurface import pressed_stress

X, Z = np.meshgrid(np.linspace(-1.5, 1.5, 1501), np.linspace(0.01, 2.0, 996))


@pytest.mark.parametrize(
    ("friction", "shear", "mises", "orthogonal"),
    [
        (0.0, (0.3003, 0.0, 0.786), (0.5575, 0.0, 0.704), (0.2500, 0.866, 0.500)),
        (0.1, (0.3048, 0.328, 0.739), (0.5654, 0.286, 0.669), (0.2806, 0.866, 0.452)),
    ],
)
def test_maxima_and_their_places(friction, shear, mises, orthogonal):
    stress = line_contact_stress(X, Z, friction)
    for field, (value, x, z) in (
        (stress.greatest_shear, shear), (stress.mises, mises), (abs(stress.shear), orthogonal)
    ):  # fmt: skip
        place = np.unravel_index(np.argmax(field), field.shape)
        assert field[place] == pytest.approx(value, abs=6e-5)
        assert abs(X[place]) == pytest.approx(x, abs=4e-3)
        assert Z[place] == pytest.approx(z, abs=4e-3)


def test_it_is_the_sum_of_point_forces():
    angle = (np.arange(200000) + 0.5) * np.pi / 200000
    source, force = np.cos(angle), np.sin(angle) ** 2 * np.pi / 200000
    for x, z, mu in ((0.3, 0.4, 0.2), (-1.2, 0.7, -0.1)):
        dx, square = x - source, ((x - source) ** 2 + z**2) ** 2
        radial = -2.0 / np.pi * (force * z + mu * force * dx) / square
        sums = [(radial * term).sum() for term in (dx**2, z**2, dx * z)]
        stress = line_contact_stress(x, z, mu)
        fields = [float(stress.along), float(stress.depthwise), float(stress.shear)]
        assert fields == pytest.approx(sums, abs=1e-8)


def test_yield_moves_to_the_surface_with_friction():
    depth = np.linspace(0.0, 1.0, 201)
    x = np.linspace(-1.0, 1.0, 401)
    below, at_surface = {}, {}
    for mu in (0.25, 0.30):
        mises = line_contact_stress(x[:, None], depth, mu).mises
        below[mu], at_surface[mu] = mises[:, 1:].max(), mises[:, 0].max()
    assert at_surface[0.25] < below[0.25]
    assert at_surface[0.30] > below[0.30]


@pytest.mark.parametrize("friction", [0.0, 0.1])
def test_a_solved_pressure_of_hertz_has_the_stress_of_the_closed_form(friction):
    """Strips of constant pressure: the error falls with the square root of their width cubed."""
    x, z = np.array([-0.8, 0.0, 0.3, 0.86, 1.5]), np.array([0.5, 0.786, 0.2, 0.5, 1.0])
    closed, differences = line_contact_stress(x, z, friction), []
    for count in (100, 400):
        place = (2.0 * np.arange(count) + 1.0) / count - 1.0
        strips = pressed_stress(x, z, place, np.sqrt(1.0 - place**2), friction)
        fields = closed.along, closed.depthwise, closed.shear
        pairs = zip(strips, fields, strict=True)
        differences.append(max(np.abs(ours - exact).max() for ours, exact in pairs))
    assert differences[0] < 5e-4
    assert differences[1] < 0.15 * differences[0]


def test_exposure_below_a_contact_without_residual_stress_is_that_of_hertz():
    depth, hard, wide = np.linspace(0.05e-3, 0.5e-3, 91), np.full(91, 600.0), 0.25e-3
    exposed = subsurface_exposure(depth, hard, pressure=1e9, width=wide)
    greatest, at = exposed.greatest
    assert greatest == pytest.approx(0.3003e9 / (0.4e6 * 600.0), rel=1e-3)
    assert at == pytest.approx(0.786 * wide, abs=5e-6)
    place = wide * ((2.0 * np.arange(200) + 1.0) / 200.0 - 1.0)
    pressure = 1e9 * np.sqrt(1.0 - (place / wide) ** 2)
    solved = subsurface_exposure(depth, hard, pressure=pressure, width=place)
    assert solved.exposure == pytest.approx(exposed.exposure, rel=2e-3)
    # under the middle of the contact compression along the surface lowers the difference
    compressed = subsurface_exposure(
        depth, hard, pressure=1e9, width=wide, residual_stress=np.full(91, -200e6)
    )
    assert compressed.greatest[0] < greatest
    tougher = subsurface_exposure(depth, hard, pressure=1e9, width=wide, material_factor=1.2)
    assert tougher.exposure == pytest.approx(exposed.exposure / 1.2)
    with pytest.raises(InputError, match="hardness"):
        subsurface_exposure(depth, 6.0 * hard, pressure=1e9, width=wide)
