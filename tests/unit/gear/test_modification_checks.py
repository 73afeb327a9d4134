"""Modifications that cannot be are refused, each with place, value and remedy."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest

from tribodyn.errors import InputError
from tribodyn.gear import FlankModification, ProfileMap, SpurGear, SpurPair, flank_ranges

Maker = Callable[..., SpurPair]
ONE = ((0.0,), (1e-6,))


@pytest.mark.parametrize(
    ("values", "says"),
    [
        ({"tip_relief": 20.0}, ("tip_relief = 2e+07 um", "from 0 to 500 um", "unit")),
        ({"tip_relief": -1e-6}, ("tip_relief = -1 um", "from 0 to 500 um")),
        ({"root_relief": math.nan}, ("root_relief = nan um", "finite")),
        ({"tip_relief_length": -4e-3}, ("tip_relief_length = -4 mm", "greater than zero")),
        ({"root_relief_length": 0.0}, ("root_relief_length = 0 mm", "greater than zero")),
        ({"tip_relief_shape": "cubic"}, ('tip_relief_shape = "cubic"', "linear, parabolic")),
        ({"crowning": 1e-3}, ("crowning = 1000 um", "from -500 to 500 um")),
        ({"profile_crowning": math.inf}, ("profile_crowning = inf um", "finite")),
        ({"lead_slope": "5 um"}, ("lead_slope = '5 um'", "from -500 to 500 um")),
        ({"run_out": 5e-3}, ("run_out = 5000 um", "from 0 to 1000 um")),
        ({"run_out_phase": math.nan}, ("run_out_phase = nan", "radians")),
        ({"wear_depth": (1e-6, -1e-6)}, ("wear_depth = -1 um", "from 0 to 500 um")),
        ({"wear_depth": -1e-6}, ("wear_depth = -1 um", "from 0 to 500 um")),
        (
            {"single_pitch_deviation": (1e-6,), "cumulative_pitch_deviation": (1e-6,)},
            ("both given", "Keep one"),
        ),
        (
            {"single_pitch_deviation": (1e-6, 2e-6)},
            ("sum to 3 um", "sum to zero", "Subtract their mean"),
        ),
    ],
)
def test_values_out_of_range_are_refused(values: dict[str, Any], says: tuple[str, ...]) -> None:
    with pytest.raises(InputError) as caught:
        FlankModification(**values)
    for part in (*says, f"argument {next(iter(values))}"):
        assert part in str(caught.value)


def test_all_faults_come_at_once() -> None:
    with pytest.raises(InputError) as caught:
        FlankModification(tip_relief=1.0, crowning=1.0, root_relief_shape="round")
    assert len(caught.value.problems) == 3


@pytest.mark.parametrize("name", ["single_pitch_deviation", "cumulative_pitch_deviation"])
def test_each_tooth_has_its_own_pitch(make_gear: Callable[..., SpurGear], name: str) -> None:
    with pytest.raises(InputError) as caught:
        make_gear(modification=FlankModification(**{name: (0.0,) * 19}))
    for part in (f"{name} has 19 entries", f"argument modification.{name}", "20 teeth"):
        assert part in str(caught.value)
    gear = make_gear(modification=FlankModification(**{name: (0.0,) * 20}))
    assert len(getattr(gear.modification, name)) == gear.teeth


def test_a_pair_names_the_gear(make_pair: Maker) -> None:
    with pytest.raises(InputError) as caught:
        make_pair(
            pinion_modification=FlankModification(cumulative_pitch_deviation=(0.0,) * 21),
            wheel_modification=FlankModification(single_pitch_deviation=(0.0,) * 20),
        )
    where = [str(problem.where) for problem in caught.value.problems]
    assert where == [
        "argument pinion_modification.cumulative_pitch_deviation",
        "argument wheel_modification.single_pitch_deviation",
    ]


@pytest.mark.parametrize("gear", ["pinion", "wheel"])
@pytest.mark.parametrize("end", ["tip_relief", "root_relief"])
def test_a_relief_is_no_longer_than_the_flank(make_pair: Maker, gear: str, end: str) -> None:
    length = flank_ranges(make_pair())[0].length
    fitting = FlankModification(**{f"{end}_length": length})  # type: ignore[arg-type]
    assert make_pair(**{f"{gear}_modification": fitting})
    too_long = FlankModification(**{f"{end}_length": 1.01 * length})  # type: ignore[arg-type]
    with pytest.raises(InputError) as caught:
        make_pair(**{f"{gear}_modification": too_long})
    for part in (
        f"{end}_length = {1.01e3 * length:.6g} mm of the {gear}",
        f"argument {gear}_modification.{end}_length",
        f"used flank of {1e3 * length:.6g} mm",
    ):
        assert part in str(caught.value)


def test_misalignment_has_a_limit(make_pair: Maker) -> None:
    with pytest.raises(InputError, match="misalignment = 5000 um"):
        make_pair(misalignment=5e-3)


def test_a_map_covers_the_used_flank(make_pair: Maker) -> None:
    pinion, wheel = flank_ranges(make_pair())
    covering = ProfileMap(tuple(wheel), (0.0,), ONE)
    assert make_pair(wheel_modification=FlankModification(profile_map=covering))
    short = ProfileMap((pinion.lowest, pinion.highest - 1e-3), (0.0,), ONE)
    with pytest.raises(InputError) as caught:
        make_pair(pinion_modification=FlankModification(profile_map=short))
    message = str(caught.value)
    for part in (
        "argument pinion_modification.profile_map",
        f"to {1e3 * pinion.highest - 1.0:.6g} mm",
        f"{1e3 * pinion.lowest:.6g} to {1e3 * pinion.highest:.6g} mm",
        f"{2e3 * make_pair().pinion.tip_radius:.6g} mm",
        "not extrapolated",
    ):
        assert part in message


def test_a_map_over_the_face_covers_it(make_pair: Maker) -> None:
    pinion, _ = flank_ranges(make_pair())
    rows = ((0.0, 0.0), (1e-6, 1e-6))
    narrow = ProfileMap(tuple(pinion), (-9e-3, 9e-3), rows)
    with pytest.raises(InputError, match=r"covers the face from -9 to 9 mm"):
        make_pair(pinion_modification=FlankModification(profile_map=narrow))
    wide = ProfileMap(tuple(pinion), (-10e-3, 10e-3), rows)
    pair = make_pair(pinion_modification=FlankModification(profile_map=wide))
    assert pair.has_lead_modification
