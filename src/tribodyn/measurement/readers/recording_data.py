"""Data that every reader returns, channels of named arrays, and rates of evenly spaced times."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from tribodyn.errors import InputError
from tribodyn.types import Array, Tree
from tribodyn.units import UnitProblemError, convert

#: Classes of MATLAB objects that hold channels; others, such as strings, are ignored.
_TABLES = ("table", "timetable", "")

#: Names and units of a time column.
_TIME = {"time", "t", "zeit", "times", "timestamp", "time stamp", "temps", "tid", "tempo"}
_UNITS = {"s": 1.0, "sec": 1.0, "seconds": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "μs": 1e-6,
          "ns": 1e-9, "min": 60.0}  # fmt: skip
#: SI units of the quantities that sensors measure.
MEASURED = ("m/s^2", "m/s", "m", "N", "N*m", "Pa", "rad", "rad/s", "K", "W", "A", "V")
#: Tolerated deviation of a time from even spacing, in steps; rounding of printed times is smaller.
_UNEVEN = 0.3

#: Names of scalars that hold the sampling rate, the time step or a unit; in lower case, without
#: blanks, underscores and hyphens.
_HEADER_RATES = {"fs", "samplerate", "samplingrate", "samplingfrequency", "samplefrequency",
                 "sampfreq", "samplingfreq", "samplefreq"}  # fmt: skip
_HEADER_STEPS = {"dt", "deltat", "sampletime", "samplingtime", "sampleperiod", "sampleinterval",
                 "samplinginterval", "wfincrement", "xinc", "xincrement"}  # fmt: skip
#: Names that mean this only where they are right at the channel.
_RATES, _STEPS = _HEADER_RATES | {"rate"}, _HEADER_STEPS | {"ts", "step"}
_LABELS = {"unit", "units", "unitstring"}
#: Names of the time of the first sample: a date, or seconds.
_STARTS = {"wfstarttime", "wfstartoffset", "starttime", "startoffset", "tstart", "xstart", "t0"}
#: End of the name of a structure that describes the channel or the group before it.
_HEADER = re.compile(r"(header|hdr|info|properties|settings|param\w*|meta\w*)$", re.IGNORECASE)
_ISO_DATE = re.compile(r"\d{4}-\d\d-\d\d([T ]\d\d:\d\d(:\d\d(\.\d{1,9})?)?)?")
_KINDS = {"c": "complex numbers", "O": "objects", "U": "text", "S": "text", "V": "records"}


@dataclass
class RecordingData:
    """Channels of a file with their units and, if the file has them, sampling rates and times."""

    channels: dict[str, Array]
    units: Mapping[str, str] = field(default_factory=dict)
    rates: Mapping[str, float] = field(default_factory=dict)  #: of single channels [Hz]
    times: Mapping[str, Array] = field(default_factory=dict)  #: of single channels [s]
    starts: Mapping[str, float] = field(default_factory=dict)  #: of channels without times [s]

    def start(self, name: str) -> float | None:
        """Time of the first sample of a channel on the axis of all; None if not known [s]."""
        return float(self.times[name][0]) if name in self.times else self.starts.get(name)


def is_time(name: str, unit: str = "") -> bool:
    """Whether a column holds times, by its name or its unit."""
    plain = name.strip().lower()
    starts = plain.startswith(("time", "zeit", "t"))
    return plain in _TIME or (unit.strip().lower() in _UNITS and starts)


def in_seconds(values: Array, unit: str, path: object) -> Array:
    """Times in seconds."""
    unit = unit.strip() or "s"
    if unit.lower() in _UNITS:
        return values * _UNITS[unit.lower()]
    try:
        return values * convert(1.0, unit, "s")
    except UnitProblemError as error:
        what, remedy = f'its times are in "{unit}"', "Write their unit as s, ms, us or min"
        raise InputError(what, str(path), str(error), remedy) from None


def rate_of(time: Array, path: object, sample_rate: float | None = None) -> float:
    """Sampling rate of evenly spaced times [Hz].

    If the times are rounded and consistent with ``sample_rate``, return ``sample_rate``.
    """
    where = str(path)
    if time.size < 2 or not np.all(np.isfinite(time)) or not time[-1] > time[0]:
        what = "its times are not finite, do not rise, or are fewer than two"
        remedy = "Check the time column, or remove it and pass sample_rate"
        raise InputError(what, where, "The sampling rate is computed from them", remedy)
    step, number = (time[-1] - time[0]) / (time.size - 1), np.arange(time.size)
    if np.abs(time - time[0] - step * number).max() <= _UNEVEN * step:
        return float(1.0 / step)
    gaps = np.diff(time)
    grain = float(gaps[gaps > 0.0].min())
    if (
        sample_rate is not None
        and np.abs(time - time[0] - number / sample_rate).max() <= 1.01 * grain
    ):
        return float(sample_rate)
    if gaps.min() == 0.0 and np.abs(gaps - step).max() <= 1.01 * grain:
        what = f"its times are rounded to {grain:.3g} s, so that adjacent times are equal"
        why = f"The rate is about {1.0 / step:.4g} Hz; its exact value cannot be recovered"
        raise InputError(what, where, why, "Export times with more digits, or pass sample_rate")
    row = int(np.argmax(np.abs(gaps - np.median(gaps))))
    raise InputError(
        f"its times are not evenly spaced: a step of {gaps[row]:.6g} s at sample {row + 1}, "
        f"the others of {np.median(gaps):.6g} s",
        where=where,
        why="Spectra and orders need equal steps; samples are missing or two recordings are joined",
        remedy="Split the recording at this sample, or fill the gap by interpolation",
    )


def is_metadata(name: str) -> bool:
    """Whether a scalar of this name is a sampling rate, a time step, a start or a unit."""
    return _plain(name) in _RATES | _STEPS | _STARTS | _LABELS


def text_of(value: object) -> str:
    """Text of an attribute that may be stored as bytes."""
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else str(value)


def from_arrays(named: Mapping[str, object], path: Path) -> RecordingData:
    """Extract the channels of values with names such as ``rig/acc`` and ``rig/acc/units``.

    A rate, time vector or unit applies to the channel, group or file that contains it; a rate in a
    header, a structure without channels, to the channels next to that header.
    """
    channels: dict[str, Array] = {}
    rates: dict[str, dict[str, float]] = {}
    labels: dict[str, str] = {}
    clocks: dict[str, tuple[str, Any]] = {}
    starts: dict[str, Tree] = {}
    left_out = []
    for name, value in named.items():
        scope, last = _split_name(name)
        array = np.asarray(value)
        array = array.squeeze() if array.ndim else array
        if array.ndim == 0 and is_metadata(last):
            if _plain(last) in _LABELS:
                labels[scope] = text_of(array.item())
            elif _plain(last) in _STARTS:
                starts.setdefault(scope, {})[last] = array
            elif number := _number(array):
                rate = number if _plain(last) in _RATES else 1.0 / number
                rates.setdefault(scope, {})[last] = rate
        elif array.dtype.kind == "M" and array.ndim == 1:
            clocks[scope] = name, array
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
        what = "holds no numeric vector"
        why = f"It holds {', '.join(left_out[:20]) or 'nothing'}"
        raise InputError(what, str(path), why, "Save each channel as a vector and the rate as fs")
    times = _times(clocks, labels, path)
    scopes = [_split_name(name)[0] for name in channels]
    alone = Counter(scopes)
    units = {
        name: labels.get(name) or (labels.get(scope, "") if alone[scope] == 1 else "")
        for name, scope in zip(channels, scopes, strict=True)
    }
    channel_times = {name: _nearest(name, times) for name in channels}
    channel_rates = {name: _nearest(name, rates) for name in channels}
    headers = _headers(rates, channels)
    for name, clock in channel_times.items():
        if clock is None and not channel_rates[name]:
            channel_rates[name] = _header_rates(name, headers, channels)
    what, remedy = "has different sampling rates for one channel", "Correct one of them in the file"
    differ = str(path), what, remedy
    return RecordingData(
        channels,
        units,
        {name: consistent_rate(each, *differ) for name, each in channel_rates.items() if each},
        {name: each for name, each in channel_times.items() if each is not None},
        _starts({name: each for name in channels if (each := _nearest(name, starts))}),
    )


def _plain(name: str) -> str:
    return re.sub(r"[ _-]", "", name.lower())


def _split_name(name: str) -> tuple[str, str]:
    """Split a name into the enclosing scope and the last part."""
    cut = max(name.rfind("."), name.rfind("/"))
    return name[: max(cut, 0)], name[cut + 1 :]


def _enclosing_scopes(name: str) -> Iterator[str]:
    yield name
    while name:
        name = _split_name(name)[0]
        yield name


def _nearest(name: str, by_scope: Mapping[str, object]) -> Any:
    """Value of the innermost scope around a channel: the channel, its groups, or the file."""
    return next((by_scope[scope] for scope in _enclosing_scopes(name) if scope in by_scope), None)


def _times(
    clocks: Mapping[str, tuple[str, Any]], labels: Mapping[str, str], path: Path
) -> dict[str, Array]:
    """Times of every scope, of dates those from the earliest on [s]."""
    first = min((array[0] for _, array in clocks.values() if array.dtype.kind == "M"), default=None)
    return {
        scope: (array - first) / np.timedelta64(1, "s")
        if array.dtype.kind == "M"
        else in_seconds(array, labels.get(name, ""), path)
        for scope, (name, array) in clocks.items()
    }


def _starts(values: Mapping[str, Mapping[str, object]]) -> dict[str, float]:
    """Times of the first samples: a date less the earliest, if any has one, and an offset [s]."""
    dates: Tree = {}
    offsets: dict[str, float] = {}
    for name, each in values.items():
        for value in each.values():
            date, number = _date(value), _real(value)
            if date is not None:
                dates[name] = date
            elif number is not None:
                offsets[name] = offsets.get(name, 0.0) + number
    if not dates:
        return offsets
    first = min(dates.values())
    return {
        name: float((date - first) / np.timedelta64(1, "s")) + offsets.get(name, 0.0)
        for name, date in dates.items()
    }


def _date(value: Any) -> Any:
    """Date of a scalar that may be text; None otherwise."""
    if value.dtype.kind == "M":
        return value[()]
    match = _ISO_DATE.match(text_of(value.item()))
    return np.datetime64(match[0]) if match else None


def _headers(
    rates: Mapping[str, Mapping[str, float]], channels: Mapping[str, Array]
) -> dict[str, dict[str, float]]:
    """Rates with unmistakable names in scopes that contain no channel."""
    enclosing = {scope for name in channels for scope in _enclosing_scopes(name)}
    sure = _HEADER_RATES | _HEADER_STEPS
    headers = {
        scope: {f"{scope}.{name}": rate for name, rate in each.items() if _plain(name) in sure}
        for scope, each in rates.items()
        if scope not in enclosing
    }
    return {scope: each for scope, each in headers.items() if each}


def _header_rates(
    channel: str, headers: Mapping[str, Mapping[str, float]], channels: Mapping[str, Array]
) -> dict[str, float] | None:
    """Rates of the headers whose names begin like the channel, or else of those of its scope."""
    stems = {name: _HEADER.sub("", name) for name in headers}
    for scope in _enclosing_scopes(_split_name(channel)[0]):
        within = (f"{scope}.", f"{scope}/") if scope else ""
        inside = [name for name in headers if name.startswith(within)]
        single = [name for name in inside if len(stems[name]) > len(scope) + 1]
        candidates = [name for name in single if channel.startswith(stems[name])]
        longest = max((len(stems[name]) for name in candidates), default=0)
        others = {name for name in single if any(each.startswith(stems[name]) for each in channels)}
        nearest = [name for name in candidates if len(stems[name]) == longest]
        chosen = nearest or [name for name in inside if name not in others]
        if chosen:
            return {k: v for name in chosen for k, v in headers[name].items()}
    return None


def header_rate(name: str, number: float, unit: str) -> float | None:
    """Sampling rate of a line in the header of a text file [Hz]; None for other lines."""
    plain = _plain(name)
    try:
        if plain in _HEADER_RATES:
            return number * convert(1.0, unit or "Hz", "Hz")
        if plain in _HEADER_STEPS:
            return 1.0 / (number * _UNITS.get((unit or "s").lower(), 0.0))
    except (UnitProblemError, ZeroDivisionError):
        return None
    return None


def consistent_rate(rates: Mapping[str, float], where: str, what: str, remedy: str) -> float:
    """Common value of several rates; raise InputError if they differ."""
    first = next(iter(rates.values()))
    if any(abs(rate - first) > 1e-5 * first for rate in rates.values()):
        rate_list = ", ".join(f"{name} {rate:.7g} Hz" for name, rate in rates.items())
        raise InputError(what, where, rate_list, remedy)
    return first


def _real(value: Any) -> float | None:
    """Finite number of a value that may be text; None otherwise."""
    try:
        number = float(text_of(value.item()))
    except (TypeError, ValueError):
        return None
    return number if np.isfinite(number) else None


def _number(value: object) -> float | None:
    """Positive number of a value that may be text; None otherwise."""
    number = _real(value)
    return number if number is not None and number > 0.0 else None


def refuse_table(kind: object, path: Path) -> None:
    """Raise InputError, with the workaround, for a MATLAB table or timetable; ignore others."""
    class_name = kind.decode("ascii", "replace") if isinstance(kind, bytes) else str(kind)
    if class_name not in _TABLES:
        return
    what = "holds a table, timetable or other object of MATLAB"
    remedy = 'In MATLAB: s = table2struct(T, "ToScalar", true); save("s.mat", "-struct", "s")'
    raise InputError(
        what, str(path), "The storage format of MATLAB objects is not documented", remedy
    )
