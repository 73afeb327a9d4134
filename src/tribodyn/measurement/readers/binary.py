"""WAV, UFF 58, TDMS, MAT, HDF5 and netCDF, each by the library that knows it best."""

from __future__ import annotations

import logging
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from tribodyn.errors import InputError
from tribodyn.interrupt import deferred
from tribodyn.measurement.readers.content import Content, from_arrays, rate_of, refuse_table, tells
from tribodyn.types import Array
from tribodyn.validated_files import read_dataset

#: UFF 58: time histories among the kinds of function, time among the abscissas; HDF5: deepest
#: group that is read.
_GENERAL, _HISTORY, _TIME, _DEEPEST = 0, 1, (0, 17), 8


def wav(path: Path) -> Content:
    """Channels of a WAV file; whole numbers over their full scale."""
    from scipy.io import wavfile

    with warnings.catch_warnings():
        # What a recorder adds to the samples is not needed; samples that are missing are told.
        warnings.simplefilter("error", wavfile.WavFileWarning)
        warnings.filterwarnings("ignore", r"Chunk \(non-data\)", wavfile.WavFileWarning)
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
    with open(path, "rb") as file:
        file.seek(-min(200, path.stat().st_size), 2)
        if not file.read().rstrip(b"\0\r\n\t ").endswith(b"-1"):
            why, remedy = "Its last dataset has no end", "Take it from the measuring system again"
            raise InputError("is cut short", str(path), why, remedy)
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
        over_time = held.get("abscissa_spec_data_type", 0) in _TIME
        if held["func_type"] not in (_GENERAL, _HISTORY) or data.dtype.kind == "c" or not over_time:
            left_out.append(str(held["id1"]))
            continue
        if data.size != held["num_pts"]:
            what = f"holds {data.size} of {held['num_pts']} samples"
            raise InputError(what, where=str(path), why="The file is cut short")
        name = _uff_name(held, channels)
        channels[name] = data.astype(float)
        units[name] = _label(held["ordinate_axis_units_lab"])
        if held["abscissa_spacing"] != 1 or not held["abscissa_inc"] > 0.0:
            rates[name] = rate_of(np.asarray(held["x"], dtype=float), path)
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
        remedy = "Export the time histories as dataset 58, and look whether the file is whole"
        raise InputError("holds no time history", str(path), f"It has {found}", remedy)
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
    held = library.TdmsFile.read(path)
    status = getattr(held, "file_status", None)
    if status is not None and status.incomplete_final_segment:
        what = "its last segment is incomplete"
        raise InputError(what, str(path), "The file is cut short, or was still being written")
    groups = held.groups()
    named: dict[str, Any] = _properties("", held)
    for group in groups:
        before = f"{group.name}/" if len(groups) > 1 else ""
        named |= _properties(before, group)
        for channel in group.channels():
            values = np.asarray(channel[:])
            if values.size:
                named[before + channel.name] = values
                named |= _properties(f"{before}{channel.name}/", channel)
    return from_arrays(named, path)


def _properties(before: str, holder: Any) -> dict[str, Any]:
    return {before + name: value for name, value in holder.properties.items() if tells(name)}


@deferred()
def hdf5(path: Path) -> Content:
    """Vectors of an HDF5 or netCDF file, with attributes that tell rates and units."""
    import h5py

    named: dict[str, Any] = {}
    if path.suffix.lower() == ".nc":  # with its checksum, where it has one
        data = read_dataset(path, str(path))
        for name, each in data.variables.items():
            named[str(name)] = each.values
            named |= {f"{name}/{key}": text for key, text in each.attrs.items() if tells(str(key))}
        return from_arrays(named | {k: v for k, v in data.attrs.items() if tells(str(k))}, path)
    mark = "." if path.suffix.lower() == ".mat" else "/"

    def put(name: str, held: Any, depth: int = 0) -> None:
        attributes, before = held.attrs, f"{name}{mark}" if name else ""
        named.update({f"{before}{key}": attributes[key] for key in attributes if tells(key)})
        if isinstance(held, h5py.Group):
            for key in held:
                if not key.startswith("#") and depth < _DEEPEST and held.get(key) is not None:
                    put(f"{before}{key}", held[key], depth + 1)
        elif "MATLAB_object_decode" in attributes:
            refuse_table(attributes.get("MATLAB_class", ""), path)
        elif h5py.check_ref_dtype(held.dtype) is not None:  # a cell, or a field of many structures
            for number, place in enumerate(held[()].reshape(-1), 1):
                if place and depth < _DEEPEST:
                    put(f"{name}{{{number}}}", held.file[place], depth + 1)
        elif not attributes.get("MATLAB_empty", 0):
            named.update(_values(name, held, mark))

    with h5py.File(path, "r") as file:
        put("", file)
    return from_arrays(named, path)


def _values(name: str, held: Any, mark: str) -> dict[str, Any]:
    """Values of one dataset of HDF5: numbers as they are scaled, characters as text."""
    value, attributes = held[()], held.attrs
    if attributes.get("MATLAB_class", b"") == b"char":
        return {name: "".join(map(chr, np.asarray(value).reshape(-1)))}
    if held.dtype.names:
        return {f"{name}{mark}{each}": value[each] for each in held.dtype.names}
    if held.dtype.kind in "iuf" and {"scale_factor", "add_offset"} & set(attributes):
        value = value * attributes.get("scale_factor", 1.0) + attributes.get("add_offset", 0.0)
    return {name: value}


def _library(name: str, path: Path) -> Any:
    import importlib

    try:
        return importlib.import_module(name)
    except ImportError:
        what, why = f"{name} is needed to read this file", "It is not installed"
        raise InputError(what, str(path), why, 'Run: pip install "tribodyn[io]"') from None


def mat(path: Path) -> Content:
    """Channels of a MAT file of any version: vectors, matrices, cells and structures of them."""
    with open(path, "rb") as file:
        head = file.read(128)
    if head.startswith(b"MATLAB 7.3"):
        return hdf5(path)  # which refuses tables as we do
    from scipy.io import loadmat
    from scipy.io.matlab import MatlabOpaque

    held = loadmat(path, squeeze_me=True, struct_as_record=True)
    named: dict[str, Any] = {}
    for name, value in held.items():
        if isinstance(value, MatlabOpaque) or name == "None":
            kinds = value["s2"].reshape(-1).tolist() if value.dtype.names else [""]
            refuse_table(kinds[0], path)
        elif not name.startswith("__"):
            named |= dict(_fields(name, value))
    return from_arrays(named, path)


def _fields(name: str, value: Any, depth: int = 0) -> Iterator[tuple[str, Any]]:
    """Structures as names with points, items of arrays of them and of cells by their number."""
    kind = getattr(value, "dtype", np.dtype(float))
    fields = kind.names
    if not (fields or kind.kind == "O") or depth > _DEEPEST:
        yield name, value
        return
    for number, item in enumerate(np.asarray(value).reshape(-1), 1):
        if fields:
            place = name if value.size == 1 else f"{name}({number})"
            for each in fields:
                yield from _fields(f"{place}.{each}", item[each], depth + 1)
        else:
            yield from _fields(f"{name}{{{number}}}", item, depth + 1)
