"""MAT files: vectors, matrices and structures of them, of every version."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from tribodyn.errors import InputError, Problem
from tribodyn.measurement.readers.content import Content, is_time
from tribodyn.types import Array

_RATES = {"fs", "sample_rate", "samplerate", "sampling_rate", "samplingrate", "rate"}
_STEPS = {"dt", "ts", "sample_time", "step"}


def content(path: Path) -> Content:
    """Channels of a MAT file."""
    with open(path, "rb") as file:
        head = file.read(128)
    if head.startswith(b"MATLAB 7.3"):
        from tribodyn.measurement.readers.binary import (
            hdf5,  # which reads plain arrays by this module
        )

        return hdf5(path)
    from scipy.io import loadmat
    from scipy.io.matlab import MatlabOpaque

    held = loadmat(path, squeeze_me=True, struct_as_record=True)
    named = {name: value for name, value in held.items() if not name.startswith("__")}
    if any(isinstance(value, MatlabOpaque) for value in held.values()) or "None" in named:
        raise InputError(
            Problem(
                "holds a table, timetable or other object of MATLAB",
                str(path),
                "MATLAB keeps how these are written to itself",
                'In MATLAB: s = table2struct(T, "ToScalar", true); save("s.mat", "-struct", "s")',
            )
        )
    return from_arrays(_flat(named), path)


def _flat(named: dict[str, Any], before: str = "", depth: int = 0) -> dict[str, Any]:
    """Structures as names with points."""
    found: dict[str, Any] = {}
    for name, value in named.items():
        fields = getattr(getattr(value, "dtype", None), "names", None)
        if fields and np.ndim(value) == 0 and depth < 8:
            inner = {each: value[each].item() for each in fields}
            found |= _flat(inner, f"{before}{name}.", depth + 1)
        else:
            found[before + name] = value
    return found


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
