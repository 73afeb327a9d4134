"""Mean revolutions of the shafts of a recorded channel, and their condition indicators."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeVar

import numpy as np

from tribodyn.errors import Argument, ComputationError, InputError, Problem, TribodynError
from tribodyn.measurement.recording import Recording, in_si
from tribodyn.measurement.shaft_speed import ShaftSpeed, shaft_speed
from tribodyn.signals.condition_indicators import ConditionIndicators, condition_indicators
from tribodyn.signals.synchronous_average import SynchronousAverage, time_synchronous_average
from tribodyn.types import Array

T = TypeVar("T")

#: Share of the highest speed below which the shaft turns too slowly for a mean revolution.
_SLOW = 0.1
#: Mesh harmonics of an average.
_HARMONICS = 5
#: Names of the shafts: that of the tachometer and of --speed, and the one of its mate.
SHAFT, MATE = "shaft", "mate"


def mean_revolutions(
    values: Array,
    time: Array,
    unit: str,
    shaft: ShaftSpeed,
    teeth: Mapping[str, int],
    notes: list[Problem],
) -> dict[str, Any]:
    """Mean revolution and condition indicators of each shaft whose teeth are known."""
    if SHAFT not in teeth:
        what = "no mean revolution, no gear indicators (FM0, FM4, NA4 and others)"
        why = "They need the number of teeth of the gear on the shaft"
        remedy = "Give it (--teeth 29, with its mate --teeth 29/67, or --case CASE)"
        notes.append(Problem(what, "", why, remedy))
        return {}
    turning = _turning(shaft.angle)
    if turning.stop - turning.start < shaft.angle.size:
        start, end = time[turning][[0, -1]]
        what = f"the mean revolution is that from {start:.4g} to {end:.4g} s"
        why = "Before or after it the shaft is at rest, or turns at less than a tenth of its speed"
        notes.append(Problem(what, "", why, ""))
    step = float(np.diff(shaft.angle[turning]).max())
    averages, indicators = {}, {}
    for name, count in teeth.items():
        ratio = teeth[SHAFT] / count
        resolved = int((0.9 * np.pi / (ratio * step) - 2.0) / count)
        part = "mean revolution" if name == SHAFT else f"mean revolution of the {name}"
        if resolved < 1:
            why = f"The mesh at order {count} is above what the sampling resolves"
            notes.append(Problem(f"no {part}", "", why, "Sample faster, or run slower"))
            continue
        try:
            averages[name] = time_synchronous_average(
                values[turning],
                time[turning],
                teeth=count,
                rotation=ratio * shaft.angle[turning],
                mesh_harmonics=min(resolved, _HARMONICS),
                unit=unit,
            )
            indicators[name] = condition_indicators(averages[name])
        except (InputError, ComputationError) as error:
            part = f"no {part}" if name not in averages else f"no indicators of the {part}"
            notes += [left_out(part, each) for each in error.problems]
    return {"averages": averages, "indicators": indicators}


def compare_with_earlier(
    parts: dict[str, Any],
    earlier: Sequence[tuple[Recording, str]],
    options: tuple[Any, ...],
    teeth: Mapping[str, int],
) -> None:
    """Replace the indicators by those that compare with earlier recordings of the channel."""
    before: dict[str, list[SynchronousAverage]] = {}
    for number, (each, channel) in enumerate(earlier, 1):
        notes: list[Problem] = []
        if channel not in each.channels:
            what, why = f"earlier recording {number} has no channel {channel}", "It is compared"
            raise InputError(what, Argument("earlier"), why, "Pass recordings of the same sensor")
        values, unit = in_si(each[channel], each.units[channel])
        shaft = shaft_speed(each, values, options[:3], options[3], notes)
        compared = (
            {} if shaft is None else mean_revolutions(values, each.time, unit, shaft, teeth, notes)
        )
        for name, average in compared.get("averages", {}).items():
            before.setdefault(name, []).append(average)
    for name, average in parts.get("averages", {}).items() if earlier else ():
        parts["indicators"][name] = condition_indicators(average, earlier=before.get(name, ()))


def _turning(angle: Array) -> slice:
    """Longest stretch of samples in which the shaft turns, and not too slowly."""
    steps = np.diff(angle)
    still = np.flatnonzero(steps <= _SLOW * steps.max())
    ends = np.concatenate(([-1], still, [angle.size - 1]))
    longest = int(np.argmax(np.diff(ends)))
    return slice(int(ends[longest]) + 1, int(ends[longest + 1]) + 1)


def average_figures(
    average: SynchronousAverage, indicators: ConditionIndicators | None, ending: str
) -> dict[str, float]:
    """Numbers of a mean revolution and its indicators, whose names end with ``ending``."""
    numbers = {
        "average_revolutions": float(average.revolutions),
        "average_peak_to_peak": float(np.ptp(average.signal)),
        "average_standard_error": float(np.sqrt(np.mean(average.scatter**2))),
        "residual_rms": float(np.std(average.residual())),
        "difference_rms": float(np.std(average.difference())),
    }
    if indicators is not None:
        numbers |= {
            "average_crest_factor": indicators.crest_factor,
            "average_kurtosis": indicators.kurtosis,
            "fm0": indicators.fm0,
            "fm4": indicators.fm4,
            "m6a": indicators.m6a,
            "m8a": indicators.m8a,
            "na4": indicators.na4,
            "na4_star": indicators.na4_star,
            "nb4": indicators.nb4,
            "energy_ratio": indicators.energy_ratio,
            "sideband_index": indicators.sideband_index,
            "sideband_level_factor": indicators.sideband_level_factor,
        }
    return {f"{name}{ending}": value for name, value in numbers.items() if np.isfinite(value)}


def left_out(part: str, problem: Problem) -> Problem:
    """The reason why a part of the analysis is missing."""
    reason = f"{problem.what[:1].upper()}{problem.what[1:]}. {problem.why}".rstrip(". ")
    return Problem(part, "", reason, problem.remedy)


def attempt(part: str, compute: Callable[[], T], notes: list[Problem]) -> T | None:
    """Result of one part of an analysis; None, with a note, where it fails: the rest goes on."""
    try:
        return compute()
    except TribodynError as error:
        notes += [left_out(f"no {part}", each) for each in error.problems]
    except Exception as error:
        why = f"This is a fault of tribodyn, not of the recording: {type(error).__name__}, {error}"
        notes.append(Problem(f"no {part}", "", why, "Please report it"))
    return None
