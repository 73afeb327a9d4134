"""Film formulas against solved films: an FZG contact, the cases of Moes, and the asymptotes."""

from __future__ import annotations

import math

import numpy as np
import pytest

from references.film_cases import FZG, MODULUS, RADIUS, SPEED
from tribodyn.ehl import (
    FILM_MODELS,
    dowson_1968_minimum,
    dowson_toyoda_central,
    moes_central,
    moes_dimensionless_central,
    pan_hamrock_central,
    pan_hamrock_minimum,
)
from tribodyn.lubricant import from_library

#: Torque [N*m] -> load [N/m], central and minimum film [um], solved fully flooded.
SOLVED = {torque: (row[0], *row[3:]) for torque, row in FZG.items()}


def film(formula, load):
    oil = from_library("80W")
    alpha = oil.pressure_viscosity_coefficient
    return 1e6 * formula(load, RADIUS, SPEED, oil.dynamic_viscosity, alpha, MODULUS)


def test_loads_and_speed_follow_from_torque_and_geometry():
    base_radius, face_width, curvature = 50.7434e-3, 20e-3, 20.9552e-3
    for torque, (load, _, _) in SOLVED.items():
        assert torque / (base_radius * face_width) == pytest.approx(load, rel=1e-5)
    surface_speed = 1400 * math.pi / 30 * curvature
    assert (surface_speed + surface_speed) / 2 == pytest.approx(SPEED, rel=1e-4)


def deviation(formula, torque, column):
    load, *solved = SOLVED[torque]
    return film(formula, load) / solved[column] - 1


def test_dowson_minimum_is_within_two_percent_at_150_and_five_at_50():
    assert abs(deviation(dowson_1968_minimum, 150, 1)) < 0.02
    assert deviation(dowson_1968_minimum, 50, 1) == pytest.approx(0.047, abs=0.001)


def test_pan_hamrock_is_low():
    assert deviation(pan_hamrock_minimum, 150, 1) == pytest.approx(-0.074, abs=0.001)
    assert deviation(pan_hamrock_central, 150, 0) == pytest.approx(-0.102, abs=0.001)
    assert deviation(pan_hamrock_minimum, 50, 1) == pytest.approx(-0.037, abs=0.001)
    assert deviation(pan_hamrock_central, 50, 0) == pytest.approx(-0.030, abs=0.001)


def test_dowson_toyoda_is_fourteen_percent_high():
    for torque in SOLVED:
        assert deviation(dowson_toyoda_central, torque, 0) == pytest.approx(0.14, abs=0.004)


def test_moes_is_sixteen_percent_high_unless_divided_by_the_density_ratio():
    assert deviation(moes_central, 150, 0) == pytest.approx(0.157, abs=0.001)
    assert deviation(moes_central, 50, 0) == pytest.approx(0.123, abs=0.001)
    oil = from_library("80W")
    for torque, hertz_pressure in ((50, 0.4644e9), (150, 0.8043e9)):
        density_ratio = oil.density_at(hertz_pressure) / oil.density
        compressed = (1 + deviation(moes_central, torque, 0)) / density_ratio
        assert compressed == pytest.approx(1.0, abs=0.04)


@pytest.mark.parametrize("name", [name for name in FILM_MODELS.names() if name != "none"])
def test_a_flooded_film_falls_with_load_and_rises_with_speed(name):
    oil, loads, speeds = from_library("80W"), np.geomspace(5e4, 3e5, 5), np.geomspace(1, 10, 5)
    model = FILM_MODELS[name]
    for formula in filter(None, (model.central, model.minimum)):
        tail = (oil.dynamic_viscosity, oil.pressure_viscosity_coefficient, MODULUS)
        assert np.all(np.diff(formula(loads, RADIUS, SPEED, *tail)) < 0)
        assert np.all(np.diff(formula(1.5e5, RADIUS, speeds, *tail)) > 0)


@pytest.mark.parametrize(
    ("load", "material", "central", "tolerance"),
    [
        (20.0, 10.0, 0.100013, 0.05),  # solved for an incompressible oil
        (5.0, 5.0, 0.301073, 0.08),  # compressible, which thins the film
    ],
)
def test_moes_against_solved_films_in_his_numbers(load, material, central, tolerance):
    solved = central * 8.0 * load / math.pi  # from film in b^2/R to the film number of Moes
    assert moes_dimensionless_central(load, material) == pytest.approx(solved, rel=tolerance)


def test_moes_rigid_isoviscous_limit_is_three_over_load():
    assert moes_dimensionless_central(1e-5, 1e-3) == pytest.approx(3e5, rel=1e-4)
    # the same in SI: h = 2 * 3 eta0 u_e R / w, at a load that neither bends nor thickens
    rigid = moes_central(1e-3, 0.01, 1.0, 1e-3, 1e-12, 2e11)
    assert rigid == pytest.approx(6.0 * 1e-3 * 1.0 * 0.01 / 1e-3, rel=1e-3)


def test_moes_elastic_isoviscous_limit():
    load = 1e6
    assert moes_dimensionless_central(load, 1e-6) == pytest.approx(2.621 * load**-0.2, rel=1e-4)


def test_moes_rigid_piezoviscous_limit():
    # rigid: M small for the elastic branch, yet L large enough that 3/M stays below
    load, material = 0.05, 1e7
    expected = 1.287 * material ** (2 / 3)
    assert moes_dimensionless_central(load, material) == pytest.approx(expected, rel=0.02)


def test_moes_elastic_piezoviscous_limit():
    load, material = 1e5, 30.0
    expected = 1.311 * load**-0.125 * material**0.75
    assert moes_dimensionless_central(load, material) == pytest.approx(expected, rel=0.03)


def test_moes_joins_the_asymptotes_without_a_gap():
    load, material = np.meshgrid(np.geomspace(1e-3, 1e4, 60), np.geomspace(0.1, 50, 40))
    joined = moes_dimensionless_central(load, material)
    isoviscous = np.maximum(3 / load, 2.621 * load**-0.2)
    thickened = np.minimum(1.287 * material ** (2 / 3), 1.311 * load**-0.125 * material**0.75)
    lower = np.maximum(isoviscous, 2 ** (-2 / 7) * thickened)
    # two equal branches: 2^(3/7) of the isoviscous ones, 2^(1/s) with s >= 7/5 of both pairs
    assert np.all(joined >= lower * (1 - 1e-12))
    assert np.all(joined <= 2 ** (3 / 7 + 5 / 7) * np.maximum(isoviscous, thickened))
