"""Mesh tables of coupled teeth: shares with tip corners, transmission error, force law, film."""

from __future__ import annotations

import sys
import warnings
from dataclasses import replace

import numpy as np
import pytest

from known_pairs import pair_of, standard, type_c
from tribodyn.gear import FlankModification, Material
from tribodyn.lubricant import Lubricant
from tribodyn.mesh import MeshTable, PhaseFunction, build, sharing
from tribodyn.mesh.build import mesh_table
from tribodyn.mesh.sharing import LARGEST_ERROR, LARGEST_GRADUAL_ERROR
from tribodyn.stiffness import loaded_contact

OIL = Lubricant(0.08, 880.0, 2e-8)


def relieved(pair, **change):
    modification = FlankModification(**change)
    return replace(pair, pinion=replace(pair.pinion, modification=modification))


PAIRS = {
    "A": pair_of(),
    "C": type_c(),
    "20/60": standard((20, 60), 20e-3),
    "wheel drives": pair_of(driver="wheel"),
    "relieved": relieved(pair_of(), tip_relief=15e-6, tip_relief_length=4e-3),
    "crowned": relieved(pair_of(), crowning=5e-6),
    "high contact": standard((30, 40), pinion_tip_diameter=129.2e-3, wheel_tip_diameter=169.2e-3),
}


def table(pair, **changes) -> MeshTable:
    arguments = {
        "material": Material(), "stiffness_model": "analytic", "lubricant": OIL,
        "friction_law": "constant", "friction_options": {"coefficient": 0.05},
        "composite_roughness": 0.0, "pinion_speed": 100.0, "pinion_torque": 90.0, "steps": 256,
    }  # fmt: skip
    return build(pair, **{**arguments, **changes})


@pytest.mark.parametrize("name", PAIRS)
def test_a_table_is_the_loaded_contact_at_its_knots(name):
    mesh = table(PAIRS[name])
    loaded = loaded_contact(PAIRS[name], 90.0, provider="analytic", phases=mesh.phase)
    assert mesh.static_transmission_error == pytest.approx(loaded.transmission_error, rel=1e-8)
    assert mesh.mesh_stiffness == pytest.approx(loaded.mesh_stiffness_secant, rel=1e-8)
    assert mesh.mesh_stiffness_tangent == pytest.approx(loaded.mesh_stiffness_tangent, rel=1e-6)
    total = mesh.load_share.sum(axis=1) + mesh.corner_share.sum(axis=1)
    assert total == pytest.approx(1.0, abs=1e-10)


def test_a_table_about_its_load_has_the_tangent_there_as_its_force_law(monkeypatch):
    pair = replace(pair_of(), misalignment=8e-6)
    settings = sharing.ToothContact(Material(), OIL, "analytic", composite_roughness=0.0)
    run = {"pinion_speed": 100.0, "pinion_torque": 90.0, "steps": 64}
    full = mesh_table(pair, settings, **run)
    monkeypatch.setattr(sharing, "force_ramps", None)  # the expensive fit is not called
    about_load = mesh_table(pair, settings, force_law="tangent", **run)
    law, error = about_load.force_law, about_load.static_transmission_error
    assert law.knot_deflection.shape[1] == 1 < full.force_law.knot_deflection.shape[1]
    rows = np.arange(error.size)
    place, slope = law.knot_deflection[rows, 0], law.knot_stiffness[rows, 0]
    assert slope * (error - place) == pytest.approx(full.total_normal_force, rel=1e-12)
    assert slope == pytest.approx(full.mesh_stiffness_tangent, rel=1e-12)
    for name in ("load_share", "stiffness", "static_transmission_error", "friction_sum"):
        assert np.array_equal(getattr(about_load, name), getattr(full, name))


def test_a_law_about_the_load_is_exact_there_and_close_around_it():
    pair = replace(pair_of(), misalignment=8e-6)
    settings = sharing.ToothContact(Material(), OIL, "analytic", composite_roughness=0.0)
    run = {"pinion_speed": 100.0, "pinion_torque": 90.0, "steps": 64}
    mesh = mesh_table(pair, settings, force_law="about-load", **run)
    fitted = mesh_table(pair, settings, **run).force_law
    law, load = mesh.force_law, mesh.total_normal_force
    assert law.knot_deflection.shape[1] == 10
    inside = mesh.phase[mesh.phase % 0.25 > 0.0]
    at_load = PhaseFunction(mesh.grid, mesh.static_transmission_error)(inside)
    assert law.force(inside, at_load) == pytest.approx(load, rel=1e-6)
    first = fitted.first_touch(inside)
    for part in np.linspace(0.4, 2.0, 9):
        deflection = first + part * (at_load - first)
        error = law.force(inside, deflection) - fitted.force(inside, deflection)
        assert np.abs(error).max() < (0.01 if 0.75 <= part <= 1.3 else 0.04) * load


def test_tip_corners_carry_on_where_the_path_ends():
    mesh = table(pair_of(), steps=2048)
    entering = mesh.load_share[0, 0]  # at A, just after the pair has entered
    before = mesh.corner_share[-1, 0]  # a mesh cycle later, just before the next one enters
    assert 0.3 < entering < 0.5
    assert before == pytest.approx(entering, rel=1e-6)
    assert mesh.corner_share[0, 0] == 0.0
    # Friction goes on with it: no jump where a pair enters.
    assert mesh.friction_sum[-1] == pytest.approx(mesh.friction_sum[0], rel=1e-6)


def test_without_tip_contact_pairs_on_the_path_carry_all():
    mesh = table(pair_of(), stiffness_options={"extended_contact": False})
    assert not mesh.corner_share.any()
    assert mesh.load_share.sum(axis=1) == pytest.approx(1.0, abs=1e-10)
    with_corners = table(pair_of())
    assert np.ptp(mesh.static_transmission_error) > np.ptp(with_corners.static_transmission_error)


@pytest.mark.slow
@pytest.mark.parametrize("name", PAIRS)
def test_the_force_law_is_the_loaded_contact_within_its_error(name):
    mesh, close = table(PAIRS[name], steps=1024), LARGEST_ERROR
    if name == "crowned":
        close = LARGEST_GRADUAL_ERROR
    law = mesh.force_law
    phase = (np.arange(97) + 0.37) / 97
    torque = np.array([15.0, 45.0, 90.0, 160.0, 260.0])
    loaded = loaded_contact(PAIRS[name], torque, provider="analytic", phases=phase)
    for error, force in zip(loaded.transmission_error, loaded.total_normal_force, strict=True):
        assert law.force(phase, error) == pytest.approx(force, rel=close)
        deflection = law.deflection(phase, np.full(phase.size, force))
        assert np.abs(deflection - error).max() < (0.1e-6 if name != "crowned" else 0.2e-6)
    # Nothing softens, nothing carries before the first touch, and the phase has no jump.
    assert np.all(mesh.ramp_stiffness >= 0.0)
    first = loaded.unloaded_transmission_error
    assert law.force(phase, first - 1e-8) == pytest.approx(0.0, abs=1e-6)
    ends = [law.force(edge, 12e-6) for edge in (0.0, 1.0 - 1e-9)]
    assert ends[0] == pytest.approx(ends[1], rel=close)
    inner = np.array(mesh.event_phases[1:])
    sides = [law.force(inner + side, np.full(inner.size, 12e-6)) for side in (-1e-9, 1e-9)]
    assert sides[0] == pytest.approx(sides[1], rel=close)


def test_springs_have_one_ramp():
    mesh = table(
        pair_of(), stiffness_model="rectangular", stiffness_options={"pair_stiffness": 2e8}
    )
    assert mesh.ramp_stiffness.shape[1] == 1
    assert mesh.ramp_stiffness[:, 0] == pytest.approx(mesh.mesh_stiffness, rel=1e-14)
    assert mesh.mesh_stiffness_tangent == pytest.approx(mesh.mesh_stiffness, rel=1e-12)
    assert mesh.maximum_single_pair_stiffness == pytest.approx(2e8, rel=1e-12)


def test_independent_pairs_have_a_law_of_their_own_when_asked():
    plain = table(pair_of(), stiffness_model="potential-energy")
    assert plain.ramp_stiffness.shape[1] == 1
    fitted = table(pair_of(), stiffness_model="potential-energy", force_law=True)
    assert fitted.ramp_stiffness.shape[1] > 3
    phase = np.linspace(0.02, 0.98, 33)
    half = loaded_contact(
        pair_of(), 45.0, provider="potential-energy", extended_contact=False, phases=phase
    )
    force_ = fitted.force_law.force(phase, half.transmission_error)
    assert force_ == pytest.approx(float(half.total_normal_force), rel=LARGEST_ERROR)


@pytest.mark.parametrize("name", ["A", "relieved"])
def test_a_film_in_series_with_coupled_pairs(name):
    film = {"film_model": "moes", "film_options": {"stiffness": "tangent"}}
    dry, wet = table(PAIRS[name]), table(PAIRS[name], **film)
    assert np.all(wet.static_transmission_error > dry.static_transmission_error)
    assert np.all(wet.mesh_stiffness < dry.mesh_stiffness)
    assert wet.tooth_stiffness == pytest.approx(dry.stiffness, rel=1e-12)
    touch = wet.in_contact & (wet.load_share > 1e-2)
    # One pair alone: its film in series with its teeth, by hand.
    alone = (wet.in_contact.sum(axis=1) == 1) & (wet.corner_share.sum(axis=1) == 0.0)
    each = wet.static_transmission_error[alone] - dry.static_transmission_error[alone]
    film_alone = wet.film_stiffness[alone].max(axis=1)
    assert each == pytest.approx(wet.total_normal_force / film_alone, rel=1e-6)
    assert np.all(wet.film_stiffness[touch] > 1e8)
    total = wet.load_share.sum(axis=1) + wet.corner_share.sum(axis=1)
    assert total == pytest.approx(1.0, abs=1e-8)


def test_a_pair_that_relief_separates_has_no_load_and_no_pressure():
    mesh = table(relieved(pair_of(), tip_relief=80e-6, tip_relief_length=5e-3))
    idle = mesh.in_contact & (mesh.load_share == 0.0)
    assert idle.any()
    assert not mesh.hertz_pressure[idle].any()
    assert not mesh.load_per_width[idle].any()
    assert np.all(np.isfinite(mesh.friction_sum))


def test_stored_and_read_again(tmp_path):
    mesh = table(relieved(pair_of(), tip_relief=10e-6), steps=64)
    mesh.save(tmp_path / "mesh.nc")
    again = MeshTable.load(tmp_path / "mesh.nc")
    for name in ("corner_share", "static_transmission_error", "ramp_stiffness", "ramp_deflection"):
        assert np.array_equal(getattr(again, name), getattr(mesh, name))
    assert again.maximum_single_pair_stiffness == mesh.maximum_single_pair_stiffness
    assert again.gear_pair == mesh.gear_pair
    assert mesh.to_xarray()["ramp_stiffness"].dims == ("knot", "ramp")


def test_harmonics_of_a_column():
    mesh = table(pair_of(), steps=2048)
    loaded = loaded_contact(pair_of(), 90.0, provider="analytic", phases=1024)
    assert mesh.harmonics("static_transmission_error", 4) == pytest.approx(
        loaded.transmission_error_harmonics(4), rel=1e-3
    )


def test_tables_at_all_speeds_share_the_teeth_and_nothing_that_changes(monkeypatch):
    """Teeth are loaded once for a study of the speed; its tables are those of their own."""
    pair = pair_of(
        pinion_profile_shift_coefficient=0.1,
        wheel_profile_shift_coefficient=0.2,
        center_distance=None,
    )
    loaded, problem_of = [], sharing.mesh_problem

    def counted(*args, **arguments):
        loaded.append(args)
        return problem_of(*args, **arguments)

    monkeypatch.setattr(sharing, "mesh_problem", counted)
    arguments = {"stiffness_model": "iso6336", "stiffness_options": {}}
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        tables = [table(pair, pinion_speed=speed, **arguments) for speed in (50.0, 100.0, 200.0)]
        tables[0].stiffness[:] = 0.0
        table(pair, pinion_torque=91.0, **arguments)
        assert len(loaded) == 2
        assert ["iso6336-range" in str(each.message) for each in caught] == 4 * [True]
        sys.modules["tribodyn.mesh.build"]._cached_teeth.cache_clear()
        assert tables[2] == table(pair, pinion_speed=200.0, **arguments)
        assert len(loaded) == 3
