"""Readers of WAV, UFF 58, TDMS, MAT, HDF5 and netCDF files."""

from __future__ import annotations

import logging
import re
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from tribodyn.errors import InputError, warn
from tribodyn.interrupt import deferred
from tribodyn.measurement.readers.recording_data import (
    RecordingData,
    from_arrays,
    is_metadata,
    rate_of,
    refuse_table,
)
from tribodyn.types import Array, Tree
from tribodyn.validated_files import read_dataset

#: Warning of SciPy.
_DUPLICATE = re.compile(r'Duplicate variable name "(.*?)"')
#: UFF 58: function types of time histories and abscissa types of time; HDF5: depth to which groups
#: are read; UFF 58: most samples in a line of text.
_GENERAL, _HISTORY, _TIME, _DEEPEST, _ROW = 0, 1, (0, 17), 8, 6


def wav(path: Path) -> RecordingData:
    """Read the channels of a WAV file; integer samples are divided by their full scale."""
    from scipy.io import wavfile

    with warnings.catch_warnings():
        # Ignore additional chunks of the recorder, but report missing samples.
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
    return RecordingData(
        dict(zip(names, columns.T, strict=True)), rates=dict.fromkeys(names, float(rate))
    )


def uff(path: Path) -> RecordingData:
    """Read the time histories (dataset 58, text or binary) of a universal file."""
    pyuff = optional_library("pyuff", path)
    with open(path, "rb") as file:
        file.seek(-min(200, path.stat().st_size), 2)
        if not file.read().rstrip(b"\0\r\n\t ").endswith(b"-1"):
            why = "The end of its last dataset is missing"
            remedy = "Export it from the measuring system again"
            raise InputError("is cut short", str(path), why, remedy)
    sets = pyuff.UFF(str(path))
    kinds = list(sets.get_set_types())
    channels: dict[str, Array] = {}
    units: dict[str, str] = {}
    rates: dict[str, float] = {}
    starts: dict[str, float] = {}
    left_out = []
    for index, kind in enumerate(kinds):
        if int(kind) != 58:
            continue
        dataset = sets.read_sets(index)
        data = np.asarray(dataset["data"])
        over_time = dataset.get("abscissa_spec_data_type", 0) in _TIME
        if (
            dataset["func_type"] not in (_GENERAL, _HISTORY)
            or data.dtype.kind == "c"
            or not over_time
        ):
            left_out.append(str(dataset["id1"]))
            continue
        size = int(dataset["num_pts"])
        if data.size < size or np.any(data[size:]) or data.size - size >= _ROW:
            what = f"has {data.size} samples in a dataset that announces {size}"
            why = "The file is cut short" if data.size < size else "Only zeros may fill a last line"
            raise InputError(what, str(path), why, "Export it from the measuring system again")
        name = _uff_name(dataset, channels)
        channels[name] = data[:size].astype(float)
        starts[name] = float(dataset["abscissa_min"])
        units[name] = _label(dataset["ordinate_axis_units_lab"])
        if dataset["abscissa_spacing"] != 1 or not dataset["abscissa_inc"] > 0.0:
            time = np.asarray(dataset["x"], dtype=float)[:size]
            rates[name], starts[name] = rate_of(time, path), float(time[0])
        else:
            rates[name] = 1.0 / float(dataset["abscissa_inc"])
    if not channels:
        content = (
            f"functions other than time histories: {', '.join(left_out)}"
            if left_out
            else (
                f"datasets {sorted({int(kind) for kind in kinds})}"
                if kinds
                else "no complete dataset"
            )
        )
        remedy = "Export the time histories as dataset 58, and check that the file is complete"
        raise InputError("holds no time history", str(path), f"It has {content}", remedy)
    return RecordingData(channels, units, rates, starts=starts)


def _label(text: object) -> str:
    plain = str(text or "").strip()
    return "" if plain.upper() == "NONE" else plain


def _uff_name(dataset: Tree, channels: dict[str, Array]) -> str:
    names = (dataset["id1"], dataset["rsp_ent_name"], dataset["ordinate_axis_lab"])
    name = next((_label(label) for label in names if _label(label)), "channel")
    return name if name not in channels else f"{name} ({1 + len(channels)})"


def tdms(path: Path) -> RecordingData:
    """Read the channels of a TDMS file."""
    library = optional_library("nptdms", path)
    logging.getLogger("nptdms").addHandler(
        logging.NullHandler()
    )  # incomplete segments are reported below
    tdms_file = library.TdmsFile.read(path)
    status = getattr(tdms_file, "file_status", None)
    if status is not None and status.incomplete_final_segment:
        what = "its last segment is incomplete"
        raise InputError(what, str(path), "The file is cut short, or was still being written")
    groups = tdms_file.groups()
    named: Tree = _properties("", tdms_file)
    for group in groups:
        prefix = f"{group.name}/" if len(groups) > 1 else ""
        named |= _properties(prefix, group)
        for channel in group.channels():
            values = np.asarray(channel[:])
            if values.size:
                named[prefix + channel.name] = values
                named |= _properties(f"{prefix}{channel.name}/", channel)
    return from_arrays(named, path)


def _properties(prefix: str, owner: Any) -> Tree:
    return {prefix + name: value for name, value in owner.properties.items() if is_metadata(name)}


@deferred()
def hdf5(path: Path) -> RecordingData:
    """Read the vectors of an HDF5 or netCDF file, with rates and units from their attributes."""
    import h5py

    named: Tree = {}
    if path.suffix.lower() == ".nc":  # read_dataset verifies the checksum, if any
        data = read_dataset(path, str(path))
        for name, variable in data.variables.items():
            named[str(name)] = variable.values
            named |= {
                f"{name}/{key}": text
                for key, text in variable.attrs.items()
                if is_metadata(str(key))
            }
        return from_arrays(
            named | {k: v for k, v in data.attrs.items() if is_metadata(str(k))}, path
        )
    separator = "." if path.suffix.lower() == ".mat" else "/"

    def put(name: str, node: Any, depth: int = 0) -> None:
        attributes, prefix = node.attrs, f"{name}{separator}" if name else ""
        named.update({f"{prefix}{key}": attributes[key] for key in attributes if is_metadata(key)})
        if isinstance(node, h5py.Group):
            for key in node:
                if not key.startswith("#") and depth < _DEEPEST and node.get(key) is not None:
                    put(f"{prefix}{key}", node[key], depth + 1)
        elif "MATLAB_object_decode" in attributes:
            refuse_table(attributes.get("MATLAB_class", ""), path)
        elif (
            h5py.check_ref_dtype(node.dtype) is not None
        ):  # a cell array or a field of a structure array
            for number, reference in enumerate(node[()].reshape(-1), 1):
                if reference and depth < _DEEPEST:
                    put(f"{name}{{{number}}}", node.file[reference], depth + 1)
        elif not attributes.get("MATLAB_empty", 0):
            named.update(_values(name, node, separator))

    with h5py.File(path, "r") as file:
        put("", file)
    return from_arrays(named, path)


def _values(name: str, dataset: Any, separator: str) -> Tree:
    """Values of one HDF5 dataset: numbers after scaling, characters as text."""
    value, attributes = dataset[()], dataset.attrs
    if attributes.get("MATLAB_class", b"") == b"char":
        return {name: "".join(map(chr, np.asarray(value).reshape(-1)))}
    if dataset.dtype.names:
        return {f"{name}{separator}{column}": value[column] for column in dataset.dtype.names}
    if dataset.dtype.kind in "iuf" and {"scale_factor", "add_offset"} & set(attributes):
        value = value * attributes.get("scale_factor", 1.0) + attributes.get("add_offset", 0.0)
    return {name: value}


def optional_library(name: str, path: Path) -> Any:
    """Import an optional library, or say how to install it."""
    import importlib

    try:
        return importlib.import_module(name)
    except ImportError:
        what, why = f"{name} is needed for this file", "It is not installed"
        raise InputError(what, str(path), why, 'Run: pip install "tribodyn[io]"') from None


def mat(path: Path) -> RecordingData:
    """Read the vectors, matrices, cells and structures of a MAT file of any version."""
    with open(path, "rb") as file:
        head = file.read(128)
    if head.startswith(b"MATLAB 7.3"):
        return hdf5(path)  # also refuses tables
    from scipy.io import loadmat
    from scipy.io.matlab import MatlabOpaque

    with warnings.catch_warnings(record=True) as raised:
        warnings.simplefilter("always")
        variables = loadmat(path, squeeze_me=True, struct_as_record=True)
    twice = dict.fromkeys(m[1] for w in raised if (m := _DUPLICATE.search(str(w.message))))
    if twice:
        names = ", ".join([*list(twice)[:5], *(["..."] if len(twice) > 5 else [])])
        message = f"{path} holds {names} twice: the second of each is read; save each variable once"
        warn("duplicate-variables", message)
    # Recording.save writes units and names of the channels with them.
    labels = {n: str(variables[f"{n}_name"]) for n in variables if f"{n}_name" in variables}
    named: Tree = {}
    for name, value in variables.items():
        if isinstance(value, MatlabOpaque) or name == "None":
            kinds = value["s2"].reshape(-1).tolist() if value.dtype.names else [""]
            refuse_table(kinds[0], path)
        elif name.endswith("_unit") and name[:-5] in variables:
            named[f"{labels.get(name[:-5], name[:-5])}.unit"] = value
        elif not (name.startswith("__") or (name.endswith("_name") and name[:-5] in labels)):
            named |= dict(_fields(labels.get(name, name), value))
    return from_arrays(named, path)


def _fields(name: str, value: Any, depth: int = 0) -> Iterator[tuple[str, Any]]:
    """Flatten a value to dotted field names; items of structure arrays and cells are numbered."""
    kind = getattr(value, "dtype", np.dtype(float))
    fields = kind.names
    if not (fields or kind.kind == "O") or depth > _DEEPEST:
        yield name, value
        return
    for number, item in enumerate(np.asarray(value).reshape(-1), 1):
        if fields:
            path = name if value.size == 1 else f"{name}({number})"
            for field in fields:
                yield from _fields(f"{path}.{field}", item[field], depth + 1)
        else:
            yield from _fields(f"{name}{{{number}}}", item, depth + 1)
