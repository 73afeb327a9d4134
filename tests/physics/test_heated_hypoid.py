"""Heated films of hypoid cells: solutions of single contacts, balance of heat, limits."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest

from known_hypoids import eased
from tribodyn.contact import effective_modulus
from tribodyn.ehl import FILM_MODELS, BodyHeat, ThermalModel
from tribodyn.gear import EaseOff, hypoid_blank, hypoid_flanks
from tribodyn.gear.hypoid.kinematics import cell_motion
from tribodyn.lubricant import from_library
from tribodyn.mesh import hypoid_loaded_contact
from tribodyn.mesh.film import film_table, sheared_film
from tribodyn.mesh.hypoid.film import cell_films
from tribodyn.mesh.hypoid.friction import friction_in_cells
from tribodyn.mesh.sharing import ToothContact

OIL = from_library("80W")
SPEED = 1500.0 * math.pi / 30.0
pytestmark = pytest.mark.filterwarnings("ignore:\\[(friction|film)-")


@cache
def of_1043():
    return hypoid_loaded_contact(eased(), 500.0, steps=16, cells=9)


def settings(loaded, model):
    return ToothContact(
        loaded.material, OIL, film_model=model, friction_law="ehl",
        film_options={"nodes": 257, "stiffness": "none"},
    )  # fmt: skip


def solved(loaded, model, speed=SPEED):
    cells = loaded.cells
    motion = cell_motion(cells.flanks.conjugate, cells.touch, cells.curvature, speed, "contact")
    return cell_films(loaded, motion, settings(loaded, model)), motion


@pytest.fixture
def coarse_tables(monkeypatch):
    """Low degree in place of the fourth, and the same places for heated and cold films."""
    monkeypatch.setattr(film_table, "_DEGREE", 2)
    monkeypatch.setattr(sheared_film, "_HEATED_LOAD", sheared_film._OF_LOAD)
    monkeypatch.setattr(sheared_film, "_LEAST_SHEARED", sheared_film._LEAST_HEATED)


@pytest.mark.slow
def test_a_heated_cell_has_film_friction_and_heat_of_its_line_contact(monkeypatch):
    monkeypatch.setattr(film_table, "_SAMPLES", 1.5)
    loaded = of_1043()
    films, motion = solved(loaded, "thermal")
    load = films.contact.load_per_width
    heavy = np.flatnonzero(load > 0.2 * load.max())
    chosen = heavy[np.linspace(0, heavy.size - 1, 24).astype(int)]
    radius, entrainment, sliding = (
        getattr(motion, name)[films.carries][chosen]
        for name in ("equivalent_radius", "entrainment_speed", "sliding_speed")
    )
    direct = FILM_MODELS["thermal"].films(
        load[chosen], radius, entrainment, OIL,
        effective_modulus(loaded.material, loaded.material), nodes=257, sliding_speed=sliding,
    )  # fmt: skip
    assert np.ptp(sliding / entrainment) > 0.2
    for name in ("central_film", "minimum_film"):
        deviation = np.abs(getattr(films.films, name)[chosen] / getattr(direct, name) - 1.0)
        assert deviation.max() < 0.02, name
        assert deviation.mean() < 5e-3, name
    coefficient = films.friction.coefficient[chosen]
    exact = np.array([each.friction_coefficient for each in direct.solutions])
    np.testing.assert_allclose(coefficient, exact, rtol=0.03, atol=1e-3)
    assert np.mean(coefficient / exact) == pytest.approx(1.0, abs=0.015)
    # The amount of the sliding, along the line too, makes the heat that oil and flanks take up;
    # rolling adds some.
    made = coefficient * load[chosen] * sliding
    solutions = direct.solutions
    traction = np.array([each.traction for each in solutions])
    assert np.sum(np.abs(traction) * sliding) == pytest.approx(np.sum(made), rel=0.015)
    shear = np.array([each.shear_heat for each in solutions])
    assert 1.0 < np.sum(shear) / np.sum(made) < 1.2
    assert np.abs([each.heat_balance_error for each in solutions]).max() < 1e-3


@pytest.mark.slow
def test_heat_that_is_led_away_at_once_leaves_the_isothermal_cells(coarse_tables, monkeypatch):
    loaded = of_1043()
    at_once = ThermalModel(
        "newtonian", bodies=(BodyHeat(1e13, 1e12),) * 2, thermal_conductivity=1e12
    )
    monkeypatch.setattr(ToothContact, "thermal_model", at_once)
    (hot, _), (cold, _) = (solved(loaded, model) for model in ("thermal", "newton"))
    for name in ("central_film", "minimum_film"):
        expected = getattr(cold.films, name)
        np.testing.assert_allclose(getattr(hot.films, name), expected, rtol=1e-3)
    np.testing.assert_allclose(hot.friction.coefficient, cold.friction.coefficient, rtol=3e-3)


@pytest.mark.slow
def test_a_small_offset_tends_to_the_heated_spiral_bevel_pair(coarse_tables):
    ease = EaseOff(lengthwise_crowning=20e-6, profile_crowning=8e-6)
    values = []
    for offset in (0.0, 1e-5):
        blank = hypoid_blank(14, 39, offset, 0.176893, 0.0254, math.radians(35.0), 0.1143)
        flanks = hypoid_flanks(blank, "drive", ease)
        loaded = hypoid_loaded_contact(flanks, 100.0, steps=16, cells=9)
        hot, cold = (
            friction_in_cells(loaded, SPEED, settings(loaded, model), "contact")
            for model in ("thermal", "newton")
        )
        films = [each.minimum_film[each.loaded.cell_force > 0.0] for each in (hot, cold)]
        values.append((hot.power.mean() / cold.power.mean(), np.nanmean(films[0] / films[1])))
    bevel, near = values
    # The blank of a small offset has a mean radius that differs by 0.2 %.
    assert near == pytest.approx(bevel, rel=5e-3)
    assert bevel[0] < 0.8
    assert 0.7 < bevel[1] < 0.99
