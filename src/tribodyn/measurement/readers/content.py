"""What a reader finds in a file, and whether its times are evenly spaced."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
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
