"""Shares of teeth and oil film: transmission error and stiffness of a film in series."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import tribodyn as td
from tribodyn.mesh.build import _cycle
from tribodyn.mesh.film.loaded_contacts import FilmSprings
from tribodyn.mesh.sharing import ToothModel, teeth_of
from tribodyn.study.pipeline.tooth_contact import mesh_of

THICK, YIELDING = 1.0e-6, 2.0e10


@pytest.fixture(scope="module")
def case():
    return td.load_case("fzg-roughness").replace(
        {"stiffness.model": "analytic", "friction.law": "none", "film.model": "none"}
    )


def teeth(case, **relief):
    changed = case.replace(
        {f"gears.{g}.modification.{k}": v for g in ("pinion", "wheel") for k, v in relief.items()}
    )
    pair = changed.gear_pair
    cycle = _cycle(pair, 256)
    model = ToothModel(changed.material_properties, "analytic", (("extended_contact", True),))
    places = (cycle.grid.phase, cycle.path, cycle.in_contact)
    return cycle, teeth_of(
        cycle.contact, places, model, changed.pinion_torque / pair.pinion.base_radius
    )


@pytest.mark.parametrize("relief", [{}, {"tip_relief": "12 um", "tip_relief_length": "4 mm"}])
def test_a_rigid_film_of_even_thickness_is_an_offset_and_nothing_else(case, relief):
    """Films that do not yield hold all flanks apart: the gears lag by that distance less."""
    cycle, dry = teeth(case, **relief)
    rigid = np.full(cycle.in_contact.shape, 1e16)
    film = FilmSprings(rigid, np.full(cycle.in_contact.shape, THICK))
    alone, wet = dry.shared_load(), dry.shared_load(film)
    assert dry.film_offset(film) == pytest.approx(THICK, rel=1e-9)
    at_rest = wet.transmission_error - dry.film_offset(film)
    np.testing.assert_allclose(at_rest, alone.transmission_error - THICK, rtol=0, atol=1e-11)
    np.testing.assert_allclose(wet.stiffness, alone.stiffness, rtol=1e-4)
    np.testing.assert_allclose(wet.share, alone.share, atol=1e-5)


def test_a_film_that_yields_adds_its_compliance_and_not_its_thickness(case):
    """Where one pair carries alone ``1/K = 1/K_teeth + 1/K_film``, however thick the film is."""
    cycle, dry = teeth(case, tip_relief="60 um", tip_relief_length="4 mm")
    alone = dry.shared_load()
    single = (alone.share > 1.0 - 1e-9).any(axis=1)
    assert np.count_nonzero(single) > 50
    for thickness in (0.3e-6, 3.0e-6):
        lead = thickness + dry.normal_force / YIELDING
        shape = cycle.in_contact.shape
        wet = dry.shared_load(FilmSprings(np.full(shape, YIELDING), np.full(shape, lead)))
        rows = single & (wet.share > 1.0 - 1e-9).any(axis=1)
        assert np.count_nonzero(rows) > 50
        teeth_alone, together = (each.stiffness.sum(axis=1)[rows] for each in (alone, wet))
        np.testing.assert_allclose(1 / together, 1 / teeth_alone + 1 / YIELDING, rtol=1e-6)


def test_films_of_uneven_thickness_do_not_soften_the_mesh(case):
    """A thick film on a pair without load moves the zero of the table, not the deflection."""
    cycle, dry = teeth(case, tip_relief="60 um", tip_relief_length="4 mm")
    alone = dry.shared_load()
    lead = np.where(alone.share > 0.0, THICK, 40.0 * THICK)
    film = FilmSprings(np.full(cycle.in_contact.shape, 1e16), lead)
    wet = dry.shared_load(film)
    assert dry.film_offset(film) > 5.0 * THICK
    single = ((alone.share > 1.0 - 1e-9) & (wet.share > 1.0 - 1e-9)).any(axis=1)
    assert np.count_nonzero(single) > 50
    np.testing.assert_allclose(
        wet.stiffness.sum(axis=1)[single], alone.stiffness.sum(axis=1)[single], rtol=1e-4
    )
    at_rest = wet.transmission_error - dry.film_offset(film)
    np.testing.assert_allclose(
        at_rest[single], alone.transmission_error[single] - THICK, rtol=0, atol=1e-11
    )


def quiet(case):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", td.ModelWarning)
        return td.run(case)


@pytest.fixture(scope="module")
def wet():
    return quiet(
        td.load_case("fzg-roughness").replace(
            {
                "stiffness.model": "analytic",
                "friction.law": "none",
                "film.model": "newton",
                "film.nodes": 257,
                "film.positions": 8,
                "gears.pinion.modification.tip_relief": "12 um",
                "gears.wheel.modification.tip_relief": "12 um",
            }
        )
    )


@pytest.mark.slow
def test_a_solved_film_takes_its_thickness_off_the_transmission_error(wet):
    figures = wet.summary()
    name = "static_transmission_error"
    dry = quiet(wet.case.replace({"film.model": "none"})).summary()
    assert figures[f"mean_{name}_teeth"] == pytest.approx(dry[f"mean_{name}"], rel=1e-9)
    assert figures["mean_mesh_stiffness_teeth"] == pytest.approx(dry["mean_mesh_stiffness"])
    assert figures["contact_ratio_under_load"] == pytest.approx(dry["contact_ratio_under_load"])
    parts = figures[f"mean_{name}_teeth"] + figures[f"mean_{name}_film"]
    assert figures[f"mean_{name}"] == pytest.approx(parts, rel=1e-12)
    thickness = figures["central_film_pitch_point"]
    assert -1.5 * thickness < figures[f"mean_{name}_film"] < -0.7 * thickness
    compliance = (
        1.0 / figures["mean_mesh_stiffness_teeth"] + 1.0 / figures["mean_mesh_stiffness_film"]
    )
    assert figures["mean_mesh_stiffness"] == pytest.approx(1.0 / compliance, rel=0.01)
    assert figures["mean_mesh_stiffness"] < figures["mean_mesh_stiffness_teeth"]
    # without friction the running gears have the mean of the gears at rest
    assert figures["mean_dynamic_transmission_error"] == pytest.approx(
        figures[f"mean_{name}"], rel=0.01
    )


@pytest.mark.slow
def test_a_table_stores_teeth_and_film_separately(wet, tmp_path):
    wet.mesh.save(tmp_path / "mesh.nc")
    again = td.mesh.MeshTable.load(tmp_path / "mesh.nc")
    assert again.film_offset == wet.mesh.film_offset > 0.0
    for name in ("tooth_load_share", "tooth_corner_share", "tooth_transmission_error"):
        np.testing.assert_array_equal(getattr(again, name), getattr(wet.mesh, name))
    assert again.contact_ratio_under_load == wet.mesh.contact_ratio_under_load


def test_without_a_film_in_series_nothing_is_apart(case):
    mesh = mesh_of(case)
    assert mesh.film_offset == 0.0
    assert mesh.tooth_load_share is None
    assert mesh.film_mesh_stiffness is None
    np.testing.assert_array_equal(mesh.transmission_error_at_rest, mesh.static_transmission_error)
    np.testing.assert_array_equal(mesh.tooth_mesh_stiffness, mesh.mesh_stiffness)
