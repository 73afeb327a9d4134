"""Shafts of a recorded channel: their speeds, mean revolutions and condition indicators."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, TypeVar

import numpy as np

from tribodyn.errors import (
    Argument,
    ComputationError,
    InputError,
    Problem,
    TribodynError,
    require_positive,
)
from tribodyn.measurement.mesh_speed import mesh_speed
from tribodyn.measurement.recording import Recording, in_si
from tribodyn.measurement.tacho import angle_of_channel
from tribodyn.signals.condition_indicators import ConditionIndicators, condition_indicators
from tribodyn.signals.synchronous_average import SynchronousAverage, time_synchronous_average
from tribodyn.types import Array, Tree

T = TypeVar("T")

#: Share of the highest speed below which the shaft turns too slowly for a mean revolution.
_SLOW = 0.1
#: Mesh harmonics of an average.
_HARMONICS = 5
#: Indicators of gears, in the order of the figures.
_OF_GEARS = ("fm0", "fm4", "m6a", "m8a", "na4", "na4_star", "nb4", "energy_ratio",
             "sideband_index", "sideband_level_factor")  # fmt: skip
#: Names of the shafts: that of the tachometer and of --speed, and the one of its mate.
SHAFT, MATE = "shaft", "mate"


def mean_revolutions(
    values: Array,
    time: Array,
    unit: str,
    shaft: ShaftSpeed,
    teeth: Mapping[str, int],
    notes: list[Problem],
) -> Tree:
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
    parts: Tree,
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
        of_any_signal = ("crest_factor", "kurtosis")
        numbers |= {f"average_{name}": getattr(indicators, name) for name in of_any_signal}
        numbers |= {name: getattr(indicators, name) for name in _OF_GEARS}
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


#: Change of the speed over its mean from which it counts as changing.
_VARIES = 0.03
#: Mesh frequency of a recording in samples instead of seconds [Hz].
_USUAL = 500.0


@dataclass(frozen=True)
class ShaftSpeed:
    """Angle of the shaft at every sample and its source.

    Parameters
    ----------
    angle : (n,) array
        Angle, counted from ``zero`` [rad].
    source : str
        Where it comes from: a tachometer, the mesh lines of the recording, or a stated speed.
    mean, lowest, highest : float
        Speed over the whole record, and the range of its means over a revolution [rad/s].
    uncertainty : float
        Standard uncertainty of the mean speed [rad/s]; NaN where it is not known.
    steady : bool
        Whether the speed was stated, not measured: orders are right only if it was exactly that.
    zero : str
        Where the angle is zero: the first pulse of the tachometer, or the first sample.
    """

    angle: Array = field(repr=False)
    source: str
    mean: float
    lowest: float
    highest: float
    uncertainty: float = float("nan")
    steady: bool = False
    zero: str = "the first sample"

    @property
    def varies(self) -> bool:
        """Whether the speed changes by more than a few percent."""
        return self.highest - self.lowest > _VARIES * self.mean


def shaft_speed(
    recording: Recording,
    values: Array,
    source: tuple[str | None, int, float | None],
    teeth: tuple[int, ...],
    notes: list[Problem],
) -> ShaftSpeed | None:
    """Shaft angle from the best available source; None, with a note, if there is none."""
    tacho, pulses, speed = source
    rate = recording.sample_rate
    if tacho is not None:
        angle, _, method, zero = angle_of_channel(recording, tacho, pulses)
        return replace(_with_range(angle, rate, method), zero=zero)
    if speed is None:
        notes.append(
            Problem(
                "no orders, no mean revolution, no gear indicators",
                "",
                "The speed of the shaft is not known",
                "Name a tachometer channel and its pulses per revolution (--tacho NAME --pulses "
                'N), give the speed (--speed "1500 rpm"), or name a line, such as the mesh '
                '(--line "725 Hz")',
            )
        )
        return None
    require_positive("speed", speed, "rad/s")
    reason = "the teeth are not known, by whose mesh lines it could be measured"
    if teeth:
        shaft, reason = _from_mesh_lines(values, rate, speed, teeth, notes)
        if shaft is not None:
            return shaft
    notes.append(
        Problem(
            f"the speed is taken as exactly {speed * 30.0 / np.pi:.6g} rpm",
            "",
            f"{reason[:1].upper()}{reason[1:]}. Orders and mean revolutions of a shaft that turns "
            "a little faster or slower come out low",
            "Record a tachometer" if teeth else "Give the teeth (--teeth 29), or a tachometer",
        )
    )
    angle = np.asarray(speed / rate * np.arange(values.size), dtype=np.float64)
    return ShaftSpeed(angle, "stated, not measured", speed, speed, speed, steady=True)


def _from_mesh_lines(
    values: Array, rate: float, speed: float, teeth: tuple[int, ...], notes: list[Problem]
) -> tuple[ShaftSpeed | None, str]:
    """Speed by the mesh lines of the channel, or the reason why they do not show it."""
    frequency = teeth[0] * speed / (2.0 * np.pi)
    # How fast a speed may change is known in seconds: without a rate, assume a mesh frequency.
    seconds = frequency / _USUAL if rate == 1.0 else 1.0
    try:
        mesh = mesh_speed(values, rate / seconds, frequency / seconds, teeth=teeth)
    except InputError as error:
        return None, f"{error.problems[0].what}, too little to find mesh lines in"
    if not mesh.located:
        return None, mesh.method
    if mesh.rivals:
        others = " or ".join(f"{each * speed * 30.0 / np.pi:.5g}" for each in mesh.rivals)
        what = f"the shaft may turn at {others} rpm as well"
        why = "Lines as strong as those of the mesh stand there"
        notes.append(Problem(what, "", why, "Record a tachometer, or check the stated speed"))
    method = mesh.method if rate != 1.0 else mesh.method.partition(" in blocks")[0]
    shaft = _with_range(mesh.angle / teeth[0], rate, method)
    return replace(shaft, uncertainty=mesh.uncertainty * speed), ""


def _with_range(angle: Array, rate: float, source: str) -> ShaftSpeed:
    """Mean speed of the shaft, and the range of its means over a revolution."""
    turned = float(angle[-1] - angle[0])
    mean = turned * rate / (angle.size - 1)
    count = int(turned / (2.0 * np.pi))
    if count < 2:
        return ShaftSpeed(angle, source, mean, mean, mean)
    marks = angle[0] + 2.0 * np.pi * np.arange(count + 1)
    times = np.interp(marks, angle, np.arange(angle.size) / rate)
    speeds = 2.0 * np.pi / np.diff(times)
    return ShaftSpeed(angle, source, mean, float(speeds.min()), float(speeds.max()))
