"""What a reader finds in a file, what its arrays are, and whether times are evenly spaced."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from tribodyn.errors import InputError
from tribodyn.types import Array
from tribodyn.units import UnitProblemError, convert

#: Objects that hold channels; other ones, such as strings, are left out.
_TABLES = ("table", "timetable", "")

#: Names of a column of times, and units that tell one.
_TIME = {"time", "t", "zeit", "times", "timestamp", "time stamp", "temps", "tid", "tempo"}
_UNITS = {"s": 1.0, "sec": 1.0, "seconds": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "μs": 1e-6,
          "ns": 1e-9, "min": 60.0}  # fmt: skip
#: What sensors measure, in SI.
MEASURED = ("m/s^2", "m/s", "m", "N", "N*m", "Pa", "rad", "rad/s", "K", "W", "A", "V")
#: Distance of a time from its even place, in steps: rounding of what was written is below it.
_UNEVEN = 0.3

#: Names of single values that tell the sampling rate, the time between two samples, or a unit;
#: in small letters, without blanks and strokes.
_RATES = {"fs", "samplerate", "samplingrate", "samplingfrequency", "samplefrequency", "rate"}
_STEPS = {"dt", "ts", "sampletime", "samplingtime", "sampleperiod", "step", "wfincrement"}
_LABELS = {"unit", "units", "unitstring"}
_KINDS = {"c": "complex numbers", "O": "objects", "U": "text", "S": "text", "V": "records"}


@dataclass
class Content:
    """Channels of a file, their units, and how they were sampled as far as the file tells."""

    channels: dict[str, Array]
    units: Mapping[str, str] = field(default_factory=dict)
    rates: Mapping[str, float] = field(default_factory=dict)  #: of single channels [Hz]
    times: Mapping[str, Array] = field(default_factory=dict)  #: of single channels [s]


def is_time(name: str, unit: str = "") -> bool:
    """Whether a column holds times, by its name or its unit."""
    plain = name.strip().lower()
    starts = plain.startswith(("time", "zeit", "t"))
    return plain in _TIME or (unit.strip().lower() in _UNITS and starts)


def in_seconds(values: Array, unit: str, path: Any) -> Array:
    """Times in seconds."""
    unit = unit.strip() or "s"
    if unit.lower() in _UNITS:
        return values * _UNITS[unit.lower()]
    try:
        return values * convert(1.0, unit, "s")
    except UnitProblemError as error:
        what, remedy = f'its times are in "{unit}"', "Write their unit as s, ms, us or min"
        raise InputError(what, str(path), str(error), remedy) from None


def rate_of(time: Array, path: Any, given: float | None = None) -> float:
    """Sampling rate of evenly spaced times [Hz]; the given one where rounded times agree to it."""
    where = str(path)
    if time.size < 2 or not np.all(np.isfinite(time)) or not time[-1] > time[0]:
        what = "its times are not finite, do not rise, or are fewer than two"
        remedy = "Look at the column of times, or leave it out and give sample_rate"
        raise InputError(what, where, "The sampling rate is read off them", remedy)
    step, number = (time[-1] - time[0]) / (time.size - 1), np.arange(time.size)
    if np.abs(time - time[0] - step * number).max() <= _UNEVEN * step:
        return float(1.0 / step)
    gaps = np.diff(time)
    grain = float(gaps[gaps > 0.0].min())
    if given is not None and np.abs(time - time[0] - number / given).max() <= 1.01 * grain:
        return float(given)
    if gaps.min() == 0.0 and np.abs(gaps - step).max() <= 1.01 * grain:
        what = f"its times are rounded to {grain:.3g} s, so that neighbours are equal"
        why = f"About {1.0 / step:.4g} samples lie in a second; the exact rate is lost"
        raise InputError(what, where, why, "Export times with more digits, or give sample_rate")
    row = int(np.argmax(np.abs(gaps - np.median(gaps))))
    raise InputError(
        f"its times are not evenly spaced: a step of {gaps[row]:.6g} s at sample {row + 1}, "
        f"the others of {np.median(gaps):.6g} s",
        where=where,
        why="Spectra and orders need equal steps; samples are missing, or two parts are joined",
        remedy="Cut the record there, or fill the gap by interpolation",
    )


def tells(name: str) -> bool:
    """Whether a single value of this name tells how something was sampled, or its unit."""
    return _plain(name) in _RATES | _STEPS | _LABELS


def text_of(value: Any) -> str:
    """Text of an attribute, which may be stored as bytes."""
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else str(value)


def from_arrays(named: Mapping[str, Any], path: Path) -> Content:
    """Channels among values with names such as ``rig/acc`` and ``rig/acc/units``.

    What tells a rate, times or a unit belongs to the channel, group or file in which it stands.
    """
    channels: dict[str, Array] = {}
    rates: dict[str, dict[str, float]] = {}
    labels: dict[str, str] = {}
    clocks: dict[str, tuple[str, Array]] = {}
    left_out = []
    for name, value in named.items():
        scope, last = _parted(name)
        array = np.asarray(value)
        array = array.squeeze() if array.ndim else array
        if array.ndim == 0 and tells(last):
            if _plain(last) in _LABELS:
                labels[scope] = text_of(array.item())
            elif number := _number(array):
                rate = number if _plain(last) in _RATES else 1.0 / number
                rates.setdefault(scope, {})[last] = rate
        elif array.dtype.kind == "M" and array.ndim == 1:
            clocks[scope] = name, (array - array[0]) / np.timedelta64(1, "s")
        elif array.dtype.kind not in "biuf" or array.ndim not in (1, 2) or not array.size:
            kind = _KINDS.get(array.dtype.kind, f"{array.ndim} dimensions")
            left_out.append(f"{name} ({'one value' if array.ndim == 0 else kind})")
        elif array.ndim == 1 and is_time(last):
            clocks[scope] = name, array.astype(float)
        elif array.ndim == 1:
            channels[name] = array.astype(float)
        else:
            tall = array if array.shape[0] >= array.shape[1] else array.T
            channels |= {f"{name} {1 + n}": each for n, each in enumerate(tall.T.astype(float))}
    if not channels:
        what = "holds no vector of numbers"
        why = f"It holds {', '.join(left_out[:20]) or 'nothing'}"
        raise InputError(what, str(path), why, "Save each channel as a vector, and the rate as fs")
    times = {at: in_seconds(v, labels.get(name, ""), path) for at, (name, v) in clocks.items()}
    alone = [_parted(name)[0] for name in channels]
    units = {
        name: labels.get(name) or (labels.get(scope, "") if alone.count(scope) == 1 else "")
        for name, scope in zip(channels, alone, strict=True)
    }
    found = {name: _nearest(name, rates) for name in channels}
    clock = {name: _nearest(name, times) for name in channels}
    return Content(
        channels,
        units,
        {name: _one(each, path) for name, each in found.items() if each},
        {name: each for name, each in clock.items() if each is not None},
    )


def _plain(name: str) -> str:
    return re.sub(r"[ _-]", "", name.lower())


def _parted(name: str) -> tuple[str, str]:
    """What a value stands in, and its own name."""
    cut = max(name.rfind("."), name.rfind("/"))
    return name[: max(cut, 0)], name[cut + 1 :]


def _around(name: str) -> Iterator[str]:
    yield name
    while name:
        name = _parted(name)[0]
        yield name


def _nearest(name: str, told: Mapping[str, Any]) -> Any:
    """What is told of a channel: by itself, by its group, or by the file."""
    return next((told[scope] for scope in _around(name) if scope in told), None)


def _one(rates: Mapping[str, float], path: Path) -> float:
    """The rate that several values tell alike."""
    first = next(iter(rates.values()))
    if any(abs(rate - first) > 1e-5 * first for rate in rates.values()):
        told = ", ".join(f"{name} {rate:.7g} Hz" for name, rate in rates.items())
        remedy = "Correct one of them in the file"
        raise InputError("tells different sampling rates", str(path), told, remedy)
    return first


def _number(value: Any) -> float | None:
    """A positive number, which may be written as text."""
    try:
        number = float(text_of(value.item()))
    except (TypeError, ValueError):
        return None
    return number if 0.0 < number < np.inf else None


def refuse_table(kind: Any, path: Path) -> None:
    """Tell what to do with a table or timetable of MATLAB; other objects hold no channel."""
    told = kind.decode("ascii", "replace") if isinstance(kind, bytes) else str(kind)
    if told not in _TABLES:
        return
    what = "holds a table, timetable or other object of MATLAB"
    remedy = 'In MATLAB: s = table2struct(T, "ToScalar", true); save("s.mat", "-struct", "s")'
    raise InputError(what, str(path), "MATLAB keeps how these are written to itself", remedy)
