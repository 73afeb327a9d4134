"""Loaded tooth contact of real pairs: identities, limits and signs."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from known_pairs import pair_of, standard, type_c
from tribodyn.contact import path_of_contact
from tribodyn.errors import ComputationError, InputError
from tribodyn.gear import FlankModification, Material
from tribodyn.stiffness import MODELS, StiffnessModel, loaded_contact, single_pair_stiffness

PAIRS = {"A": pair_of(), "C": type_c(), "20/60": standard((20, 60), 20e-3)}


def relieved(pair, **modification):
    change = FlankModification(**modification)
    return replace(pair, pinion=replace(pair.pinion, modification=change))


@pytest.mark.parametrize("name", PAIRS)
def test_forces_balance_and_are_shared(name):
    mesh = loaded_contact(PAIRS[name], [20.0, 200.0], provider="analytic")
    assert mesh.normal_force.min() >= 0.0
    assert mesh.load_share.sum(axis=-1) == pytest.approx(1.0, abs=1e-10)
    assert np.all(mesh.mesh_stiffness_tangent > mesh.mesh_stiffness_secant)


@pytest.mark.parametrize("name", PAIRS)
def test_with_tip_contact_everything_is_continuous_in_phase(name):
    def jump(phases, extended):
        mesh = loaded_contact(
            PAIRS[name], 100.0, provider="analytic", phases=phases, extended_contact=extended
        )
        error = mesh.transmission_error
        return float(np.abs(np.diff(error, append=error[0])).max() / error.mean())

    # The steps fall with their number where nothing jumps.
    assert jump(1024, True) < 0.3 * jump(256, True)
    assert jump(1024, False) > 0.1
    assert jump(1024, False) > 0.8 * jump(256, False)


def test_tip_contact_softens_the_jump_and_the_error():
    mesh, cut = (
        loaded_contact(pair_of(), 90.0, provider="analytic", phases=512, extended_contact=extended)
        for extended in (True, False)
    )
    assert mesh.peak_to_peak_transmission_error < cut.peak_to_peak_transmission_error
    assert mesh.mean_transmission_error < cut.mean_transmission_error
    # Tip corners share the load outside of the path of contact only.
    outside = (mesh.gap > 0.0) & (mesh.normal_force > 0.0)
    assert outside.any()
    assert np.all(mesh.gap[mesh.normal_force > 0.0] < mesh.transmission_error.max())


def test_one_pair_alone_deflects_like_a_single_pair():
    pair = pair_of()
    mesh = loaded_contact(pair, 90.0, provider="potential-energy", extended_contact=False)
    alone = (mesh.normal_force > 0.0).sum(axis=1) == 1
    path = mesh.path[mesh.normal_force > 0.0]
    force = 90.0 / pair.pinion.base_radius
    every = single_pair_stiffness(pair, Material(), path, force)
    inverse = np.zeros(mesh.phase.size)
    inverse[np.nonzero(mesh.normal_force > 0.0)[0]] = every
    assert mesh.mesh_stiffness_secant[alone] == pytest.approx(inverse[alone], rel=1e-5)


def test_independent_pairs_share_as_the_model_itself_does():
    pair, force = pair_of(), 150.0 / pair_of().pinion.base_radius
    mesh = loaded_contact(pair, 150.0, provider="potential-energy", extended_contact=False)
    path, touching = path_of_contact(pair).pair_paths(mesh.phase)
    stiffness = MODELS["potential-energy"](pair, Material(), path, touching, mesh.phase, force)
    assert mesh.mesh_stiffness_secant == pytest.approx(stiffness.sum(axis=1), rel=1e-5)


@pytest.mark.parametrize("model", ["iso6336", "rectangular", "fourier"])
def test_models_of_the_literature_give_force_over_their_stiffness(model):
    pair = standard((30, 30))
    options = {"rectangular": {"pair_stiffness": 3e8}, "fourier": {"mean_stiffness": 3e8}}
    options_of_model = options.get(model, {})
    mesh = loaded_contact(pair, [50.0, 100.0], provider=model, options=options_of_model)
    path, touching = path_of_contact(pair).pair_paths(mesh.phase)
    for k, force in enumerate(mesh.total_normal_force):
        force_over_stiffness = MODELS[model](
            pair, Material(), path, touching, mesh.phase, force, **options_of_model
        )
        assert mesh.transmission_error[k] == pytest.approx(
            force / force_over_stiffness.sum(axis=1), rel=1e-9
        )


def test_either_driver_has_the_same_mesh_mirrored_in_time():
    pinion = loaded_contact(pair_of(), 90.0, provider="analytic", phases=256)
    wheel = loaded_contact(pair_of(driver="wheel"), 90.0, provider="analytic", phases=256)
    assert wheel.mean_transmission_error == pytest.approx(pinion.mean_transmission_error, rel=3e-3)
    assert wheel.peak_to_peak_transmission_error == pytest.approx(
        pinion.peak_to_peak_transmission_error, rel=0.02
    )
    assert wheel.transmission_error_harmonics(3) == pytest.approx(
        pinion.transmission_error_harmonics(3), rel=0.02
    )


def test_a_stiffer_material_and_a_wider_gear_deflect_less_in_proportion():
    pair = pair_of()
    base = loaded_contact(pair, 100.0, provider="analytic")
    # Twice the modulus under twice the load: the same deflection at any place.
    twice = loaded_contact(pair, 200.0, provider="analytic", material=Material(412e9))
    assert twice.transmission_error == pytest.approx(base.transmission_error, rel=1e-9)
    wide = loaded_contact(pair_of(pinion_face_width=40e-3), 200.0, provider="analytic")
    assert wide.transmission_error == pytest.approx(base.transmission_error, rel=1e-9)


def test_bodies_held_at_the_rim_are_stiffer():
    bore, rim = (
        loaded_contact(pair_of(), 90.0, provider="analytic", reference=where)
        for where in ("bore", "rim")
    )
    assert rim.mesh_stiffness_secant.mean() > 1.15 * bore.mesh_stiffness_secant.mean()
    assert (bore.reference, rim.reference) == ("bore", "rim")


def test_tip_relief_unloads_the_ends_of_the_path_only():
    pair = pair_of()
    length = (pair.transverse_contact_ratio - 1.0) * pair.base_pitch
    plain = loaded_contact(pair, 150.0, provider="analytic", phases=256)
    change = FlankModification(tip_relief=10e-6, tip_relief_length=length)
    relieved_pair = replace(
        pair,
        pinion=replace(pair.pinion, modification=change),
        wheel=replace(pair.wheel, modification=change),
    )
    mesh = loaded_contact(relieved_pair, 150.0, provider="analytic", phases=256)
    assert mesh.peak_to_peak_transmission_error < 0.75 * plain.peak_to_peak_transmission_error
    # Where one unrelieved pair carries alone nothing changes.
    single = (plain.normal_force > 0.0).sum(axis=1) == 1
    assert mesh.transmission_error[single] == pytest.approx(
        plain.transmission_error[single], rel=1e-9
    )
    # The pinion's tip is at E: the pair about to leave carries less.
    contact = path_of_contact(pair)
    leaving = plain.path > contact.E - 0.2 * (contact.E - contact.D)
    shed_load = plain.normal_force[leaving].sum() - mesh.normal_force[leaving].sum()
    assert shed_load > 0.3 * plain.normal_force[leaving].sum()


@pytest.mark.parametrize(("gear", "position"), [("pinion", -8e-6), ("wheel", 8e-6)])
def test_a_raised_flank_takes_load_and_lessens_the_error(gear, position):
    # A driving tooth before its place, or a driven one behind it, meets its mate too early.
    pair = pair_of()
    modified_gear = getattr(pair, gear)
    proud = FlankModification(
        cumulative_pitch_deviation=(position, *[0.0] * (modified_gear.teeth - 1))
    )
    mesh = loaded_contact(
        replace(pair, **{gear: replace(modified_gear, modification=proud)}),
        90.0,
        provider="analytic",
    )
    assert mesh.mesh_cycles == 48
    plain = loaded_contact(pair, 90.0, provider="analytic")
    change = mesh.transmission_error - np.tile(plain.transmission_error, 48)
    turns = 48 // modified_gear.teeth
    # Only while that tooth is in contact, over two or three mesh cycles in each of its turns.
    touched = np.abs(change.reshape(48, 64)).max(axis=1) > 1e-7
    assert touched.reshape(turns, modified_gear.teeth).sum(axis=1).tolist() in (
        [2] * turns,
        [3] * turns,
    )
    assert change.max() < 1e-9
    assert change.min() < -3e-6
    cycle = int(np.argmin(change)) // 64
    cycle_slice = slice(64 * cycle, 64 * (cycle + 1))
    assert mesh.load_share[cycle_slice].max() >= plain.load_share.max()


def test_run_out_lifts_the_whole_mesh_once_a_turn():
    pair = pair_of()
    eccentric = FlankModification(run_out=20e-6)
    mesh = loaded_contact(
        replace(pair, pinion=replace(pair.pinion, modification=eccentric)), 90.0,
        provider="analytic", phases=16,
    )  # fmt: skip
    plain = loaded_contact(pair, 90.0, provider="analytic", phases=16)
    change = mesh.transmission_error - np.tile(plain.transmission_error, 48)
    turn = np.abs(np.fft.rfft(change)) * 2.0 / change.size
    assert np.argmax(turn) == 3  # 48 mesh cycles are three turns of the pinion
    assert turn[3] == pytest.approx(10e-6, rel=1e-6)


def test_crowning_and_misalignment_move_the_load_over_the_face():
    pair = pair_of()
    crowned = loaded_contact(relieved(pair, crowning=10e-6), 90.0, provider="analytic", phases=16)
    assert crowned.load_per_width.shape == (16, 21, 4)
    over_face = crowned.load_per_width.sum(axis=(0, 2))
    assert over_face == pytest.approx(over_face[::-1], rel=1e-9)
    assert np.argmax(over_face) == 10
    tilted = replace(pair, misalignment=20e-6)
    over_face = loaded_contact(tilted, 90.0, provider="analytic", phases=16).load_per_width.sum(
        axis=(0, 2)
    )
    assert np.all(np.diff(over_face) <= 0.0) or np.all(np.diff(over_face) >= 0.0)
    assert over_face.max() > 1.5 * over_face.min()
    # Slices of a gear without lead modification change nothing.
    uncut, cut = (
        loaded_contact(pair, 90.0, provider="analytic", slices=slices) for slices in (1, 7)
    )
    assert cut.transmission_error == pytest.approx(uncut.transmission_error, rel=1e-10)


def test_a_film_in_series_adds_its_compliance_to_each_pair():
    pair = pair_of()
    plain, soft = (
        loaded_contact(
            pair, 90.0, provider="analytic", extended_contact=False, film_stiffness=stiffness
        )
        for stiffness in (None, 2e9)
    )
    single = (plain.normal_force > 0.0).sum(axis=1) == 1
    added = soft.transmission_error - plain.transmission_error
    assert added[single] == pytest.approx(90.0 / pair.pinion.base_radius / 2e9, rel=1e-9)
    assert np.all(added[~single] < 0.8 * added[single].mean())


def test_root_loads_are_the_force_at_its_lever():
    mesh = loaded_contact(pair_of(), 90.0, provider="analytic")
    loads, force = mesh.root_loads, mesh.normal_force
    size = np.hypot(loads.pinion_shear_force, loads.pinion_compressive_force)
    assert size == pytest.approx(force, rel=1e-12)
    carries = force > 0.0
    lever = loads.wheel_bending_moment[carries] / loads.wheel_shear_force[carries]
    gear = pair_of().wheel
    assert 0.0 < lever.min() < lever.max() < gear.tip_radius - gear.root_radius
    # The lever of the pinion grows towards its tip, that of the wheel falls.
    on_path = (mesh.gap == 0.0) & carries
    order = np.argsort(mesh.path[on_path])
    levers = [
        (moment[on_path] / shear[on_path])[order]
        for moment, shear in (
            (loads.pinion_bending_moment, loads.pinion_shear_force),
            (loads.wheel_bending_moment, loads.wheel_shear_force),
        )
    ]
    assert np.all(np.diff(levers[0]) > 0.0)
    assert np.all(np.diff(levers[1]) < 0.0)


def test_several_torques_are_the_single_ones_in_any_order():
    pair = pair_of()
    several = loaded_contact(pair, [200.0, 50.0], provider="analytic")
    single = loaded_contact(pair, 50.0, provider="analytic")
    assert several.transmission_error[1] == pytest.approx(single.transmission_error, rel=1e-11)
    assert several.transmission_error_harmonics(4).shape == (2, 4)


def test_a_data_set_carries_units(tmp_path):
    data = loaded_contact(pair_of(), [50.0, 90.0], provider="analytic").to_xarray()
    assert data["transmission_error"].dims == ("torque", "phase")
    assert data["transmission_error"].attrs["units"] == "m"
    assert data["normal_force"].attrs["units"] == "N"
    data.to_netcdf(tmp_path / "mesh.nc", engine="h5netcdf")


def test_wrong_arguments_are_named():
    pair = pair_of()
    with pytest.raises(InputError, match="torque"):
        loaded_contact(pair, -5.0, provider="analytic")
    with pytest.raises(InputError, match='Did you mean "fe2d"'):
        loaded_contact(pair, 5.0, provider="fe2")
    with pytest.raises(InputError, match="at least 8 phases"):
        loaded_contact(pair, 5.0, provider="analytic", phases=4)
    with pytest.raises(InputError, match="slices = 0"):
        loaded_contact(pair, 5.0, provider="analytic", slices=0)
    with pytest.raises(InputError, match='reference = "hub"'):
        loaded_contact(pair, 5.0, provider="analytic", reference="hub")
    with pytest.raises(InputError, match="evenly spaced"):
        loaded_contact(
            pair, 5.0, provider="analytic", phases=np.array([0.0, 0.1, 0.5])
        ).transmission_error_harmonics(1)
    with pytest.raises(InputError, match="less than half"):
        loaded_contact(pair, 5.0, provider="analytic", phases=8).transmission_error_harmonics(4)


@pytest.mark.parametrize("flaw", [np.nan, 0.0, -1e8])
def test_a_model_without_a_usable_stiffness_is_refused(flaw, monkeypatch):
    def poor(pair, material, path, in_contact, phase, normal_force, **options):
        stiffness = np.where(in_contact, 2e8, 0.0)
        stiffness[3, np.flatnonzero(in_contact[3])[0]] = flaw
        return stiffness

    monkeypatch.setitem(MODELS._items, "poor", StiffnessModel("poor", poor, {}))
    with pytest.raises(ComputationError, match='"poor" returned an unusable pair stiffness'):
        loaded_contact(pair_of(), 90.0, provider="poor")
