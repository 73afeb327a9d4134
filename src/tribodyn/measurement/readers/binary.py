"""WAV, UFF 58, TDMS, HDF5 and netCDF, each by the library that knows it best."""

from __future__ import annotations

import logging
import warnings
from pathlib import Path
from typing import Any

import numpy as np

from tribodyn.errors import InputError, Problem
from tribodyn.measurement.readers.content import (
    Content,
    equal_steps,
    from_arrays,
    in_seconds,
    is_time,
)
from tribodyn.stored import read_dataset
from tribodyn.types import Array

#: UFF 58: time histories among the kinds of function, and time among the abscissas.
_GENERAL, _HISTORY, _TIME = 0, 1, (17, 0)


def wav(path: Path) -> Content:
    """Channels of a WAV file; whole numbers over their full scale."""
    from scipy.io import wavfile

    with warnings.catch_warnings():
        warnings.simplefilter("error", wavfile.WavFileWarning)
        rate, samples = wavfile.read(path)
    values = samples.astype(float)
    if samples.dtype == np.uint8:
        values = (values - 128.0) / 128.0
    elif samples.dtype.kind == "i":
        values /= -float(np.iinfo(samples.dtype).min)
    columns = values[:, None] if values.ndim == 1 else values
    names = [f"channel {1 + n}" for n in range(columns.shape[1])]
    return Content(
        dict(zip(names, columns.T, strict=True)), rates=dict.fromkeys(names, float(rate))
    )


def uff(path: Path) -> Content:
    """Time histories of a universal file, dataset 58, of text or binary."""
    pyuff = _library("pyuff", path)
    sets = pyuff.UFF(str(path))
    kinds = list(sets.get_set_types())
    channels: dict[str, Array] = {}
    units: dict[str, str] = {}
    rates: dict[str, float] = {}
    left_out = []
    for index, kind in enumerate(kinds):
        if int(kind) != 58:
            continue
        held = sets.read_sets(index)
        data = np.asarray(held["data"])
        if held["func_type"] not in (_GENERAL, _HISTORY) or data.dtype.kind == "c":
            left_out.append(str(held["id1"]))
            continue
        if data.size != held["num_pts"]:
            what = f"holds {data.size} of {held['num_pts']} samples"
            raise InputError(
                what,
                where=str(path),
                why="The file is cut short",
                remedy="Save the recording again",
            )
        name = _uff_name(held, channels)
        channels[name] = data.astype(float)
        units[name] = _label(held["ordinate_axis_units_lab"])
        if held["abscissa_spacing"] != 1 or not held["abscissa_inc"] > 0.0:
            rates[name] = equal_steps(np.asarray(held["x"], dtype=float), path)
        else:
            rates[name] = 1.0 / float(held["abscissa_inc"])
    if not channels:
        found = (
            f"functions other than time histories: {', '.join(left_out)}"
            if left_out
            else (
                f"datasets {sorted({int(kind) for kind in kinds})}"
                if kinds
                else "no complete dataset"
            )
        )
        raise InputError(
            "holds no time history",
            where=str(path),
            why=f"It has {found}",
            remedy="Export the time histories as dataset 58, and look whether the file is whole",
        )
    return Content(channels, units, rates)


def _label(text: Any) -> str:
    plain = str(text or "").strip()
    return "" if plain.upper() == "NONE" else plain


def _uff_name(held: dict[str, Any], taken: dict[str, Array]) -> str:
    names = (held["id1"], held["rsp_ent_name"], held["ordinate_axis_lab"])
    name = next((_label(each) for each in names if _label(each)), "channel")
    return name if name not in taken else f"{name} ({1 + len(taken)})"


def tdms(path: Path) -> Content:
    """Channels of a TDMS file."""
    library = _library("nptdms", path)
    logging.getLogger("nptdms").addHandler(logging.NullHandler())  # what it says is told below
    channels: dict[str, Array] = {}
    units: dict[str, str] = {}
    rates: dict[str, float] = {}
    held = library.TdmsFile.read(path)
    status = getattr(held, "file_status", None)
    if status is not None and status.incomplete_final_segment:
        raise InputError(
            "its last segment is incomplete",
            where=str(path),
            why="The file is cut short, or was still being written",
            remedy="Save the recording again, once it has ended",
        )
    several = len(held.groups()) > 1
    for group in held.groups():
        for channel in group.channels():
            values = np.asarray(channel[:])
            if values.dtype.kind not in "biuf" or not values.size:
                continue
            name = f"{group.name}/{channel.name}" if several else channel.name
            channels[name] = values.astype(float)
            units[name] = str(channel.properties.get("unit_string", ""))
            if (step := float(channel.properties.get("wf_increment", 0.0))) > 0.0:
                rates[name] = 1.0 / step
    if not channels:
        raise InputError(
            "holds no channel of numbers",
            where=str(path),
            why="A recording is read by its channels of numbers",
            remedy="Look into the file with the program that wrote it",
        )
    first = next(iter(channels))
    time = None
    if first not in rates and len(channels) > 1 and is_time(first.rsplit("/", 1)[-1], units[first]):
        time = in_seconds(channels.pop(first), units.pop(first))
    return Content(channels, units, rates, time)


def hdf5(path: Path) -> Content:
    """Vectors of an HDF5 or netCDF file, with the attributes units and sample_rate."""
    import h5py

    if path.suffix.lower() == ".nc":  # with its checksum, where it has one
        data = read_dataset(path, str(path))
        arrays = {str(name): each.values for name, each in data.variables.items()}
        told = {
            str(name): str(each.attrs.get("units", "")) for name, each in data.variables.items()
        }
        return from_arrays(_with_rate(arrays, data.attrs), path, told)
    named: dict[str, Any] = {}
    units: dict[str, str] = {}
    with h5py.File(path, "r") as file:
        attributes = dict(file.attrs)

        def visit(name: str, found: Any) -> None:
            if isinstance(found, h5py.Dataset) and not name.startswith("#"):
                if found.attrs.get("MATLAB_class", b"") not in (b"", b"double", b"single"):
                    return
                named[name] = found[()]
                units[name] = _text(found.attrs.get("units", b""))

        file.visititems(visit)
    return from_arrays(_with_rate(named, attributes), path, units)


def _with_rate(named: dict[str, Any], attributes: Any) -> dict[str, Any]:
    """Arrays with the sampling rate among the attributes of the file, if it is there."""
    rates = (_number(attributes.get(key)) for key in ("sample_rate", "fs"))
    rate = next((each for each in rates if each), None)
    if rate is None:
        return named
    return {name: each for name, each in named.items() if name != "time"} | {"sample_rate": rate}


def _number(value: Any) -> float | None:
    array = np.asarray(value if value is not None else np.nan)
    if array.size != 1 or array.dtype.kind not in "biuf" or not np.isfinite(array).all():
        return None
    return float(array.reshape(-1)[0])


def _text(value: Any) -> str:
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else str(value)


def _library(name: str, path: Path) -> Any:
    import importlib

    try:
        return importlib.import_module(name)
    except ImportError:
        raise InputError(
            Problem(
                f"{name} is needed to read this file",
                str(path),
                "It is not installed",
                'Run: pip install "tribodyn[io]"',
            )
        ) from None
