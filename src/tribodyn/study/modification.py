"""The ``[gears.pinion.modification]`` and ``[gears.wheel.modification]`` tables of a case."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tribodyn.study.fields import choice, file_path, number, numbers
from tribodyn.study.section import Section

if TYPE_CHECKING:
    from tribodyn.gear import FlankModification, ProfileMap


_GUARD = "guards against a wrong unit"
_MOST = 0.5e-3
_TURN = 6.283185307179586
_SHAPES = ("linear", "parabolic")


def _relief(of: str) -> Any:
    return number(0.0, 0.0, _MOST, _GUARD, of=of)


def _length(of: str) -> Any:
    return number(None, 0.0, 1.0, "no longer than the used flank", of=of, positive=True)


def _signed(of: str) -> Any:
    return number(0.0, -_MOST, _MOST, _GUARD, of=of)


def _pitches(of: str, meaning: str) -> Any:
    return numbers(-_MOST, _MOST, _GUARD, of=of, meaning=meaning)


class Modification(Section):
    """What the loaded flanks of a gear have that the involute has not."""

    tip_relief: float = _relief("tip_relief")
    tip_relief_length: float | None = _length("tip_relief_length")
    tip_relief_shape: str = choice("linear", _SHAPES, meaning="how the tip relief falls to zero")
    root_relief: float = _relief("root_relief")
    root_relief_length: float | None = _length("root_relief_length")
    root_relief_shape: str = choice("linear", _SHAPES, meaning="how the root relief falls to zero")
    profile_crowning: float = _signed("profile_crowning")
    profile_slope: float = _signed("profile_slope")
    crowning: float = _signed("crowning")
    lead_slope: float = _signed("lead_slope")
    single_pitch_deviation: tuple[float, ...] | None = _pitches(
        "single_pitch_deviation",
        "deviation of the pitch from the flank before, in the order of contact",
    )
    cumulative_pitch_deviation: tuple[float, ...] | None = _pitches(
        "cumulative_pitch_deviation",
        "by how much each flank stands further on, in the order of contact",
    )
    run_out: float = number(0.0, 0.0, 1e-3, _GUARD, of="run_out")
    run_out_phase: float = number(0.0, -_TURN, _TURN, "one turn", of="run_out_phase")
    wear_depth: tuple[float, ...] | None = numbers(
        0.0,
        _MOST,
        _GUARD,
        of="wear_depth",
        meaning="depth of wear: one value, or several from the lowest point to the tip",
    )
    profile_map: str | None = file_path(
        meaning="CSV file with the measured deviation of the flank", example='"flank.csv"'
    )
    profile_map_interpolation: str = choice(
        "linear", ("linear", "cubic"), meaning="how the map is read between its points"
    )


def flank_modification(data: Modification | None, chart: ProfileMap | None) -> FlankModification:
    """Build the modification of one gear."""
    from tribodyn.gear import FlankModification

    if data is None:
        return FlankModification()
    values = {name: getattr(data, name) for name, _ in data.specs()}
    del values["profile_map"], values["profile_map_interpolation"]
    lists = ("single_pitch_deviation", "cumulative_pitch_deviation", "wear_depth")
    values |= {name: values[name] or () for name in lists}
    return FlankModification(profile_map=chart, **values)
