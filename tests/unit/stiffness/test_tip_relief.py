"""The best tip relief: against brute force over modified pairs, identities, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn.errors import InputError
from tribodyn.gear import FlankModification, default_relief_length
from tribodyn.stiffness import loaded_contact, optimize_tip_relief, with_tip_relief

TORQUES = (60.0, 90.0, 120.0)
FAST = {"provider": "analytic", "phases": 32, "grid": (9, 7)}


@pytest.fixture(scope="module")
def pair(fzg):
    return fzg()


@pytest.fixture(scope="module")
def best(pair):
    return optimize_tip_relief(pair, TORQUES, **FAST)


def peaks(pair, **options):
    mesh = loaded_contact(pair, TORQUES, provider="analytic", phases=32, **options)
    return mesh.peak_to_peak_transmission_error


def test_optimum_halves_the_error_of_this_pair(best):
    assert best.objective < 0.5 * best.objective_before
    # relief of the order of the deflection, over about the zone of two pairs
    assert 6e-6 < best.amount < 14e-6
    assert 3e-3 < best.length < 6e-3


def test_modified_pair_has_the_computed_errors(best):
    for gear in (best.modified_pair.pinion, best.modified_pair.wheel):
        assert gear.modification == FlankModification(
            tip_relief=best.amount, tip_relief_length=best.length
        )
    peaks_of_pair = peaks(best.modified_pair)
    np.testing.assert_allclose(peaks_of_pair, best.peak_to_peak_after, rtol=1e-9)
    assert peaks_of_pair.max() == pytest.approx(best.objective, rel=1e-9)


def test_no_point_of_the_map_is_better(best):
    assert best.objective <= best.map_objective.min()
    np.testing.assert_allclose(best.map_objective[0], best.objective_before, rtol=1e-12)
    row, column = 3, 2
    relieved = with_tip_relief(best.gear_pair, best.map_amount[row], best.map_length[column])
    assert peaks(relieved).max() == pytest.approx(best.map_objective[row, column], rel=1e-9)


def test_brute_force_over_modified_pairs_finds_nothing_better(pair, best):
    candidates = [
        (peaks(with_tip_relief(pair, amount, length)).max(), amount, length)
        for amount in np.linspace(4e-6, 16e-6, 13)
        for length in np.linspace(3.0e-3, 6.5e-3, 15)
    ]
    least, amount, length = min(candidates)
    assert best.objective <= least * (1.0 + 1e-9)
    assert best.objective == pytest.approx(least, rel=0.1)
    assert best.amount == pytest.approx(amount, abs=1.1e-6)
    assert best.length == pytest.approx(length, abs=0.5e-3)


def test_search_is_repeatable(pair, best):
    again = optimize_tip_relief(pair, TORQUES, **FAST)
    assert (again.amount, again.length) == (best.amount, best.length)


def test_one_gear_alone_helps_less_than_both(pair, best):
    for gears, other in (("pinion", "wheel"), ("wheel", "pinion")):
        optimum = optimize_tip_relief(pair, TORQUES, gears=gears, **FAST)
        assert best.objective < optimum.objective < best.objective_before
        assert getattr(optimum.modified_pair, other).modification == FlankModification()
        assert getattr(optimum.modified_pair, gears).modification.tip_relief == optimum.amount


def test_parabolic_relief_takes_more_at_the_tip(pair, best):
    optimum = optimize_tip_relief(pair, TORQUES, shape="parabolic", **FAST)
    assert optimum.amount > best.amount
    assert optimum.modified_pair.wheel.modification.tip_relief_shape == "parabolic"
    assert peaks(optimum.modified_pair).max() == pytest.approx(optimum.objective, rel=1e-9)


def test_weights_choose_the_torque_that_counts(pair):
    alone = optimize_tip_relief(pair, 120.0, amount=(0.0, 20e-6), **FAST)
    weighted = optimize_tip_relief(
        pair, TORQUES, objective="mean", weight=(0.0, 0.0, 2.0), amount=(0.0, 20e-6), **FAST
    )
    assert weighted.objective == pytest.approx(alone.objective, rel=1e-6)
    assert weighted.weight.tolist() == [0.0, 0.0, 1.0]
    assert weighted.peak_to_peak_after[2] == pytest.approx(weighted.objective, rel=1e-9)


def test_mean_is_the_mean(pair):
    optimum = optimize_tip_relief(pair, TORQUES, objective="mean", **FAST)
    assert optimum.objective == pytest.approx(optimum.peak_to_peak_after.mean(), rel=1e-9)
    assert optimum.objective_before == pytest.approx(optimum.peak_to_peak_before.mean(), rel=1e-9)


def test_the_error_between_the_phases_is_that_between_them(pair):
    """A coarse phase grid lets the search hide its peaks; the default must not."""
    optimum = optimize_tip_relief(pair, TORQUES, provider="analytic", grid=(9, 7))
    assert optimum.phase.size == 512
    fine = loaded_contact(optimum.modified_pair, TORQUES, provider="analytic", phases=4096)
    peak = fine.peak_to_peak_transmission_error.max()
    assert peak == pytest.approx(optimum.objective, rel=0.03)


def test_two_torques_are_a_range(pair):
    optimum = optimize_tip_relief(pair, (120.0, 60.0), **FAST)
    assert optimum.torque.tolist() == [60.0, 75.0, 90.0, 105.0, 120.0]


def test_earlier_relief_is_replaced_and_all_else_preserved(pair, best):
    modified = with_tip_relief(pair, 25e-6, 2e-3)
    optimum = optimize_tip_relief(modified, TORQUES, **FAST)
    assert (optimum.amount, optimum.length) == (best.amount, best.length)
    np.testing.assert_allclose(optimum.peak_to_peak_before, peaks(modified), rtol=1e-9)
    np.testing.assert_allclose(optimum.map_objective[0], best.objective_before, rtol=1e-12)


def test_other_modifications_are_preserved(fzg):
    crowned = fzg(pinion_modification=FlankModification(crowning=4e-6, root_relief=3e-6))
    optimum = optimize_tip_relief(crowned, 90.0, grid=(4, 3), provider="analytic", phases=16)
    modification = optimum.modified_pair.pinion.modification
    assert (modification.crowning, modification.root_relief) == (4e-6, 3e-6)
    assert modification.tip_relief == optimum.amount
    after = loaded_contact(optimum.modified_pair, 90.0, provider="analytic", phases=16)
    assert after.peak_to_peak_transmission_error == pytest.approx(optimum.objective, rel=1e-9)


def test_models_of_the_literature_are_searched_as_well(pair):
    optimum = optimize_tip_relief(
        pair, TORQUES, provider="potential-energy", phases=16, grid=(5, 4), amount=(0.0, 20e-6)
    )
    after = loaded_contact(optimum.modified_pair, TORQUES, provider="potential-energy", phases=16)
    np.testing.assert_allclose(
        optimum.peak_to_peak_after, after.peak_to_peak_transmission_error, rtol=1e-9
    )


def test_optimum_at_the_edge_is_reported(pair, best):
    assert not best.on_edge
    assert optimize_tip_relief(pair, TORQUES, amount=(0.0, 3e-6), **FAST).on_edge


def test_data_set_and_line(best):
    data = best.to_xarray()
    assert dict(data.sizes) == {"torque": 3, "phase": 32, "amount": 9, "length": 7}
    assert float(data["objective"].min()) >= data.attrs["best_objective"]
    assert f"{best.amount * 1e6:.4g} um over {best.length * 1e3:.4g} mm" in repr(best)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"length": (1e-3, 25e-3)}, "used flank"),
        ({"length": (0.0, 2e-3)}, "used flank"),
        ({"length": (3e-3, 2e-3)}, "increase"),
        ({"amount": (5e-6, 5e-6)}, "amount = 5 to 5 um"),
        ({"amount": (0.0, 5.0)}, "500 um"),
        ({"amount": (-1e-6, 5e-6)}, "amount"),
        ({"gears": "all"}, "both, pinion, wheel"),
        ({"shape": "round"}, "linear, parabolic"),
        ({"objective": "least"}, "largest, mean"),
        ({"grid": (1, 5)}, "two amounts"),
        ({"weight": (1.0, 2.0)}, "one weight for each torque"),
        ({"weight": (0.0, 0.0, 0.0)}, "not all zero"),
        ({"weight": (1.0, -1.0, 1.0)}, "none negative"),
    ],
)
def test_impossible_searches_are_refused(pair, options, message):
    with pytest.raises(InputError, match=message):
        optimize_tip_relief(pair, TORQUES, **{**FAST, **options})


def test_relief_longer_than_the_flank_is_refused(pair):
    with pytest.raises(InputError, match="tip_relief_length"):
        with_tip_relief(pair, 10e-6, 25e-3)


def test_relief_of_nothing_is_the_pair_as_it_was(pair):
    assert with_tip_relief(with_tip_relief(pair, 10e-6, 3e-3), 0.0, 3e-3) == pair
    length = default_relief_length(pair)
    named = with_tip_relief(pair, 10e-6, length)
    np.testing.assert_array_equal(peaks(named) < peaks(pair), True)
