"""The map of the static transmission error: identities, hunting teeth, and what it refuses."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tribodyn.contact import path_of_contact
from tribodyn.errors import InputError
from tribodyn.gear import FlankModification
from tribodyn.stiffness import (
    loaded_contact,
    transmission_error_over_torque,
    with_tip_relief,
)
from tribodyn.stiffness.tip_relief import harris


@pytest.fixture(scope="module")
def pair(fzg):
    return fzg()


def test_map_is_the_loaded_contact_at_each_torque(pair):
    harris = transmission_error_over_torque(pair, [150.0, 60.0, 150.0], provider="analytic")
    assert harris.torque.tolist() == [60.0, 150.0]
    for row, torque in enumerate(harris.torque):
        single = loaded_contact(pair, torque, provider="analytic", phases=256)
        np.testing.assert_allclose(
            harris.transmission_error[row], single.transmission_error, rtol=1e-9
        )
        stiffness = single.mesh_stiffness_secant.mean(), single.mesh_stiffness_tangent.mean()
        assert harris.mean_mesh_stiffness_secant[row] == pytest.approx(stiffness[0], rel=1e-9)
        assert harris.mean_mesh_stiffness_tangent[row] == pytest.approx(stiffness[1], rel=1e-9)


def test_mean_is_force_over_stiffness_in_micrometres(pair):
    # 90 N*m over 33.83 mm is 2660 N; over 2.3e8 N/m that is 11.6 um
    harris = transmission_error_over_torque(pair, 90.0, provider="analytic")
    assert harris.mean_transmission_error[0] == pytest.approx(11.7e-6, rel=0.03)
    assert harris.peak_to_peak_transmission_error[0] == pytest.approx(5.2e-6, rel=0.06)


def test_harmonics_hold_the_whole_variance(pair):
    harris = transmission_error_over_torque(
        pair, [90.0], provider="analytic", phases=64, harmonics=31
    )
    wave = harris.transmission_error[0] - harris.mean_transmission_error[0]
    middle = abs(np.fft.rfft(wave)[32]) ** 2 / 64**2  # order 32 of 64 phases
    assert 0.5 * np.sum(harris.harmonics[0] ** 2) + middle == pytest.approx(np.var(wave), rel=1e-9)


def test_relief_makes_one_torque_the_quietest(pair):
    relieved = with_tip_relief(pair, 12e-6, 4.3e-3)
    torques = np.linspace(20.0, 300.0, 15)
    harris = transmission_error_over_torque(relieved, torques, provider="analytic")
    assert torques[0] < harris.quietest_torque < torques[-1]
    plain = transmission_error_over_torque(pair, torques, provider="analytic")
    assert plain.quietest_torque == torques[0]
    assert np.all(harris.mean_transmission_error > plain.mean_transmission_error)
    assert plain.unloaded_transmission_error.max() == 0.0


@pytest.mark.parametrize(("amount", "length"), [(0.0, 1e-3), (12e-6, 4.3e-3), (25e-6, 3e-3)])
def test_corners_of_the_curves_are_where_they_are(pair, amount, length):
    """A grid ten times as fine finds no value beyond the corners, and no other curve between."""
    relieved = with_tip_relief(pair, amount, length)
    torques = [60.0, 150.0]
    harris = transmission_error_over_torque(relieved, torques, provider="analytic")
    fine = transmission_error_over_torque(relieved, torques, provider="analytic", phases=2560)
    phase, error = harris.curves()
    assert np.all(np.diff(phase) >= 0.0)
    for row, exact in enumerate(fine.transmission_error):
        swing = np.ptp(exact)
        curve = np.interp(fine.phase, np.append(phase, 1.0), np.append(error[row], error[row, 0]))
        np.testing.assert_allclose(curve, exact, atol=2e-2 * swing, rtol=0)
        over = np.ptp(error[row]) / swing - 1.0
        assert -3e-4 < over < 2e-3  # the corners may lie beyond the fine phases
        even = np.append(harris.transmission_error[row], harris.transmission_error[row, 0])
        cut = np.interp(harris.corner_phase, np.append(harris.phase, 1.0), even)
        cut = np.abs(cut - harris.corner_transmission_error[row]).max()
        assert cut > 1e-3 * swing  # what even phases alone leave out


def test_corners_are_the_ends_of_the_path_and_of_the_reliefs(pair):
    relieved = with_tip_relief(pair, 12e-6, 4.3e-3)
    harris = transmission_error_over_torque(relieved, [60.0], provider="analytic")
    path = path_of_contact(relieved)
    wanted = [path.contact_ratio, 4.3e-3 / pair.base_pitch]
    wanted.append(path.contact_ratio - 4.3e-3 / pair.base_pitch)
    for age in wanted:
        assert np.min(np.abs(harris.corner_phase - age % 1.0)) < 1e-9


def test_teeth_that_differ_are_followed_over_the_hunting_period(fzg):
    steps = (3e-6, -3e-6) * 8
    pair = fzg(pinion_modification=FlankModification(single_pitch_deviation=steps))
    harris = transmission_error_over_torque(pair, [30.0, 60.0], provider="analytic", phases=16)
    assert harris.mesh_cycles == 48
    assert harris.transmission_error.shape == (2, 48 * 16)
    # every other tooth is offset: the second mesh cycle differs, and the third is like the first
    error = harris.transmission_error[0].reshape(48, 16)
    np.testing.assert_allclose(error[2], error[0], rtol=1e-9)
    assert np.max(np.abs(error[1] - error[0])) > 0.5e-6


def test_parts_that_fit_in_memory_give_the_same(pair, monkeypatch):
    torques = [30.0, 60.0, 90.0, 120.0, 150.0]
    at_once = transmission_error_over_torque(pair, torques, provider="analytic", phases=16)
    monkeypatch.setattr(harris, "_AT_ONCE", 100)
    parts = transmission_error_over_torque(pair, torques, provider="analytic", phases=16)
    np.testing.assert_allclose(parts.transmission_error, at_once.transmission_error, rtol=1e-9)
    assert parts.torque.tolist() == torques


def test_models_whose_stiffness_knows_the_load(pair):
    harris = transmission_error_over_torque(pair, [50.0, 200.0], provider="potential-energy")
    single = loaded_contact(pair, 200.0, provider="potential-energy", phases=256)
    np.testing.assert_allclose(harris.transmission_error[1], single.transmission_error, rtol=1e-9)


def test_data_set_and_line(pair):
    harris = transmission_error_over_torque(pair, [60.0, 120.0], provider="analytic", harmonics=4)
    data = harris.to_xarray()
    corners = data.sizes["corner"]
    assert dict(data.sizes) == {"torque": 2, "phase": 256, "order": 4, "corner": corners}
    assert data["harmonics"].attrs["units"] == "m"
    peak = data["transmission_error"].max("phase") - data["transmission_error"].min("phase")
    np.testing.assert_allclose(data["peak_to_peak_transmission_error"], peak)
    assert "2 torques from 60 to 120 N*m" in repr(harris)


@pytest.mark.parametrize(
    ("torque", "options", "message"),
    [
        ([90.0, -1.0], {}, "torque"),
        ([[90.0, 100.0]], {}, "shape"),
        ([], {}, "shape"),
        ([90.0], {"phases": 4}, "phases"),
        ([90.0], {"phases": 64, "harmonics": 32}, "1 to 31 harmonics"),
    ],
)
def test_invalid_map_arguments_are_refused(pair, torque, options, message):
    with pytest.raises(InputError, match=message):
        transmission_error_over_torque(pair, torque, provider="analytic", **options)


def test_wear_moves_the_map_up_and_stays_in_the_unloaded_error(pair):
    worn = replace(
        pair, pinion=replace(pair.pinion, modification=FlankModification(wear_depth=5e-6))
    )
    before, after = (
        transmission_error_over_torque(gears, [90.0], provider="analytic", phases=32)
        for gears in (pair, worn)
    )
    shift = after.transmission_error - before.transmission_error
    assert np.all(shift > 4e-6)
    assert after.unloaded_transmission_error.max() == pytest.approx(5e-6, rel=1e-6)


def test_work_that_multiplies_gets_fewer_phases(fzg):
    crowned = fzg(pinion_modification=FlankModification(crowning=4e-6))
    assert transmission_error_over_torque(crowned, 90.0, provider="analytic").phase.size == 64
