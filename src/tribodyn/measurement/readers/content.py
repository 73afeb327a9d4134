"""What a reader finds in a file, what its arrays are, and whether times are evenly spaced."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from tribodyn.errors import InputError
from tribodyn.types import Array
from tribodyn.units import convert

#: Names of a column of times, and units that tell one.
_TIME = {"time", "t", "zeit", "times", "timestamp", "time stamp", "temps", "tid", "tempo"}
_UNITS = {"s": 1.0, "sec": 1.0, "seconds": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "ns": 1e-9,
          "min": 60.0}  # fmt: skip
#: Distance of a time from its even place, in steps: rounding of what was written is below it.
_UNEVEN = 0.3

#: Names of single numbers that tell the sampling rate, or the time between two samples.
_RATES = {"fs", "sample_rate", "samplerate", "sampling_rate", "samplingrate", "rate"}
_STEPS = {"dt", "ts", "sample_time", "step"}


@dataclass
class Content:
    """Channels of a file, their units, and how they were sampled as far as the file tells."""

    channels: dict[str, Array]
    units: dict[str, str] = field(default_factory=dict)
    rates: Mapping[str, float] = field(default_factory=dict)  #: of single channels [Hz]
    time: Array | None = None  #: [s]


def is_time(name: str, unit: str = "") -> bool:
    """Whether a column holds times, by its name or its unit."""
    plain = name.strip().lower()
    return plain in _TIME or (unit.strip() in _UNITS and plain.startswith(("time", "zeit", "t")))


def in_seconds(values: Array, unit: str) -> Array:
    """Times in seconds."""
    unit = unit.strip() or "s"
    return values * (_UNITS[unit] if unit in _UNITS else convert(1.0, unit, "s"))


def equal_steps(time: Array, path: Any) -> float:
    """Sampling rate of evenly spaced times [Hz]."""
    where = str(path)
    if time.size < 2 or not np.all(np.isfinite(time)) or not time[-1] > time[0]:
        raise InputError(
            "its times are not finite, do not rise, or are fewer than two",
            where=where,
            why="The sampling rate is read off them",
            remedy="Look at the column of times, or leave it out and give sample_rate",
        )
    step = (time[-1] - time[0]) / (time.size - 1)
    away = np.abs(time - (time[0] + step * np.arange(time.size))) / step
    if away.max() > _UNEVEN:
        gaps = np.diff(time)
        row = int(np.argmax(np.abs(gaps - np.median(gaps))))
        raise InputError(
            f"its times are not evenly spaced: a step of {gaps[row]:.6g} s at sample {row + 1}, "
            f"the others of {np.median(gaps):.6g} s",
            where=where,
            why="Spectra and orders need equal steps; samples are missing, or two parts are joined",
            remedy="Cut the record there, or fill the gap by interpolation",
        )
    return float(1.0 / step)


def from_arrays(named: dict[str, Any], path: Path, units: dict[str, str] | None = None) -> Content:
    """Channels, times and rate among arrays with names."""
    channels: dict[str, Array] = {}
    rates: list[float] = []
    time: Array | None = None
    for name, value in named.items():
        array, last = np.asarray(value), name.rsplit(".", 1)[-1].rsplit("/", 1)[-1].lower()
        if array.dtype.kind not in "biuf":
            continue
        array = array.astype(float).squeeze()
        if array.ndim == 0:
            rates += [float(array)] if last in _RATES else [1.0 / float(array)] * (last in _STEPS)
        elif array.ndim == 1 and is_time(last):
            time = array
        elif array.ndim == 1:
            channels[name] = array
        elif array.ndim == 2:
            tall = array if array.shape[0] >= array.shape[1] else array.T
            channels |= {f"{name} {1 + n}": column for n, column in enumerate(tall.T)}
    if not channels:
        raise InputError(
            "holds no vector of numbers",
            where=str(path),
            why=f"It holds {', '.join(map(str, named)) or 'nothing'}",
            remedy="Save each channel as a vector, and the rate as fs",
        )
    each = dict.fromkeys(channels, rates[0]) if rates and rates[0] > 0.0 else {}
    return Content(channels, units or {}, each, time)
