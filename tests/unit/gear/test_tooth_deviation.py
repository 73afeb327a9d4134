"""Deviations of pitch and run-out: which teeth meet, when they recur, and the signs."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from tribodyn.gear import (
    FlankModification,
    SpurPair,
    hunting_period,
    pitch_gap,
    run_out_gap,
    tooth_positions,
)

Maker = Callable[..., SpurPair]


def places(teeth: int, **proud: float) -> FlankModification:
    """Cumulative deviations: ``t3=5e-6`` sets that of tooth 3."""
    values = [proud.get(f"t{tooth}", 0.0) for tooth in range(teeth)]
    return FlankModification(cumulative_pitch_deviation=tuple(values))


@pytest.mark.parametrize(("driver", "sign"), [("pinion", 1.0), ("wheel", -1.0)])
def test_a_driving_flank_further_on_comes_late_a_driven_one_early(
    make_pair: Maker, driver: str, sign: float
) -> None:
    pinion = make_pair(pinion_modification=places(20, t3=5e-6), driver=driver)
    wheel = make_pair(wheel_modification=places(30, t3=5e-6), driver=driver)
    assert float(pitch_gap(pinion, 3)) == pytest.approx(sign * 5e-6, rel=1e-12)
    assert float(pitch_gap(wheel, 3)) == pytest.approx(-sign * 5e-6, rel=1e-12)
    assert pinion.has_pitch_deviation
    assert not pinion.has_profile_modification


def test_gears_with_equal_pitches_mesh_without_gap(make_pair: Maker) -> None:
    rng = np.random.default_rng(5)
    values = tuple(float(value) for value in 5e-6 * rng.standard_normal(20))
    same = FlankModification(cumulative_pitch_deviation=values)
    pair = make_pair(wheel_teeth=20, pinion_modification=same, wheel_modification=same)
    assert np.all(pitch_gap(pair, np.arange(-30, 30)) == 0.0)
    alone = make_pair(wheel_teeth=20, pinion_modification=same)
    assert pitch_gap(alone, np.arange(20)) == pytest.approx(values, rel=1e-12)


def test_older_pairs_are_those_of_earlier_cycles(make_pair: Maker) -> None:
    pair = make_pair(pinion_modification=places(20, t3=5e-6, t7=-2e-6))
    cycle = np.arange(40)[:, None]
    gap = pitch_gap(pair, cycle, np.array([0, 1, 2]))
    assert gap.shape == (40, 3)
    assert np.array_equal(gap[2:, 2], gap[:-2, 0])
    assert gap[4, 1] == pytest.approx(5e-6)
    assert gap[7, 0] == pytest.approx(-2e-6)


def test_it_recurs_after_the_hunting_period_and_not_before(make_pair: Maker) -> None:
    pair = make_pair(
        wheel_teeth=33, pinion_modification=places(20, t0=1e-6),
        wheel_modification=places(33, t0=-2e-6),
    )  # fmt: skip
    assert hunting_period(pair) == 660
    gap = pitch_gap(pair, np.arange(1320))
    assert np.array_equal(gap[:660], gap[660:])
    assert np.flatnonzero(gap[:660] > 2.5e-6).tolist() == [0]


def test_common_factors_shorten_the_hunting_period(make_pair: Maker) -> None:
    assert hunting_period(make_pair(pinion_teeth=20, wheel_teeth=30)) == 60
    assert hunting_period(make_pair(pinion_teeth=20, wheel_teeth=20)) == 20


def test_single_deviations_sum_to_places(make_pair: Maker) -> None:
    single = np.zeros(20)
    single[[0, 4, 9]] = [3e-6, 2e-6, -5e-6]
    modification = FlankModification(single_pitch_deviation=tuple(single))
    pair = make_pair(pinion_modification=modification)
    place = tooth_positions(pair.pinion)
    assert place[[0, 3, 4, 8, 9, 19]] == pytest.approx(
        [0.0, 0.0, 2e-6, 2e-6, -3e-6, -3e-6], abs=1e-18
    )
    around = np.append(place, place[0])
    assert np.diff(around)[-1] == pytest.approx(single[0])
    assert np.diff(around)[3] == pytest.approx(single[4])
    assert pitch_gap(pair, np.arange(20)) == pytest.approx(place, abs=1e-18)


def test_rounded_single_deviations_close_the_circle(make_pair: Maker) -> None:
    single = (0.4e-6,) + (0.0,) * 19
    pair = make_pair(pinion_modification=FlankModification(single_pitch_deviation=single))
    place = tooth_positions(pair.pinion)
    assert place[0] - place[-1] == pytest.approx(0.4e-6 * 19 / 20)


def test_run_out_turns_with_its_own_gear(make_pair: Maker) -> None:
    run_out = FlankModification(run_out=20e-6, run_out_phase=0.5 * math.pi)
    turn = np.array([0.0, 0.5 * math.pi, 1.5 * math.pi])
    pinion, wheel = make_pair(pinion_modification=run_out), make_pair(wheel_modification=run_out)
    assert run_out_gap(pinion, turn) == pytest.approx([0.0, -10e-6, 10e-6], abs=1e-18)
    assert run_out_gap(wheel, turn * wheel.ratio) == pytest.approx([0.0, -10e-6, 10e-6], abs=1e-18)
    combined = make_pair(pinion_modification=run_out, wheel_modification=run_out)
    total = run_out_gap(pinion, turn) + run_out_gap(wheel, turn)
    assert run_out_gap(combined, turn) == pytest.approx(total, abs=1e-20)
    assert combined.has_run_out
    assert combined.has_modification


def test_run_out_repeats_with_the_teeth(make_pair: Maker) -> None:
    modification = FlankModification(run_out=20e-6, run_out_phase=0.3)
    pair = make_pair(
        wheel_teeth=33, pinion_modification=modification, wheel_modification=modification
    )
    cycles = np.array([0.3, 1.7, 20.3])
    turn = 2.0 * math.pi / pair.pinion.teeth
    period = turn * hunting_period(pair)
    assert run_out_gap(pair, turn * cycles + period) == pytest.approx(
        run_out_gap(pair, turn * cycles), abs=1e-17
    )
    assert run_out_gap(pair, turn * cycles)[2] != pytest.approx(
        run_out_gap(pair, turn * cycles)[0], rel=1e-3
    )


def test_an_eccentric_toothing_touches_early_where_it_is_raised(make_pair: Maker) -> None:
    """The axis of the pinion's toothing moved towards the wheel along the line of action."""
    modification = FlankModification(run_out=30e-6)
    pair = make_pair(pinion_modification=modification)
    gap = run_out_gap(pair, np.linspace(0.0, 2.0 * math.pi, 361))
    assert int(np.argmin(gap)) in (0, 360)
    assert gap.min() == pytest.approx(-15e-6)
    assert gap.mean() == pytest.approx(0.0, abs=1e-7)
