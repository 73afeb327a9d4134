"""Read regular files of limited size, and netCDF files whose checksum shows that they are intact.

A netCDF file carries a checksum over its dimensions, variables and attributes, so that a flipped
bit or a changed column is refused. Files without one come from an earlier version.
"""

from __future__ import annotations

import errno
import hashlib
import io
import os
import re
import stat
from collections.abc import Iterable, Mapping
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribodyn.errors import InputError
from tribodyn.interrupt import deferred
from tribodyn.types import Array, ByName, Tree

if TYPE_CHECKING:
    import xarray

__all__ = ["LARGEST", "file_kind", "plain_number", "read_bytes", "read_dataset", "write_dataset"]

#: Largest size of a file by its kind [bytes].
LARGEST = {
    "case": 10**6,
    "profile map": 4 * 10**6,
    "table": 10**7,
    "rexs": 5 * 10**7,
    "housing": 2**30,
    "netcdf": 2**30,
    "recording": 2**31,
}
#: How netCDF calls a variable with the name of a dimension over others, and a mere dimension.
_CLASH = "_nc4_non_coord_"
_NO_VARIABLE = "This is a netCDF dimension but not a netCDF variable."
#: netCDF attribute that names the writer of a file, and the checksum in it.
_ORIGIN, _ON_FILE = "_NCProperties", re.compile(rb"tribodyn=([0-9a-f]{64})")


def file_kind(path: Path) -> str:
    """``"file"``, ``"directory"``, empty if the path does not exist, or why it cannot be read."""
    try:
        mode = path.stat().st_mode
    except (FileNotFoundError, NotADirectoryError):
        return ""
    except (OSError, ValueError) as error:
        return getattr(error, "strerror", None) or str(error)
    if stat.S_ISDIR(mode):
        return "directory"
    return "file" if stat.S_ISREG(mode) else "it is not a regular file but a pipe, socket or device"


def read_bytes(path: str | PathLike[str], kind: str) -> bytes:
    """Content of a regular file; raises OSError, without waiting, if it is a pipe or too large."""
    fault = file_kind(Path(path))
    if fault != "file":
        fault = {"": "there is no such file", "directory": "it is a directory"}.get(fault, fault)
        raise OSError(errno.EINVAL, fault, str(path))
    most = LARGEST[kind]
    descriptor = os.open(
        path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
    )
    with open(descriptor, "rb") as file:
        content = file.read(most + 1)
    if len(content) > most:
        text = f"it is larger than {most / 1e6:g} MB, too large for a file of this kind"
        raise OSError(errno.EFBIG, text, str(path))
    return content


def plain_number(text: str) -> float | None:
    """A number written with the digits 0 to 9, a point and an exponent; None for other text."""
    try:
        return float(text) if text.isascii() and "_" not in text and len(text) < 400 else None
    except ValueError:
        return None


def csv_text(rows: Iterable[Iterable[Any]]) -> str:
    """Rows, with the header as the first, as comma-separated values."""
    import csv

    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()


class _Content(NamedTuple):
    """Content of a netCDF file: variables with dimensions and attributes, and global attributes."""

    variables: dict[str, tuple[tuple[str, ...], Array, ByName]]
    coordinates: set[str]
    attributes: ByName


def _content(data: Any) -> _Content:
    """Content of labelled arrays of xarray, or of the parts of a record."""
    if hasattr(data, "coords"):
        dataset = data.to_dataset() if hasattr(data, "to_dataset") else data
        variables = {str(n): (v.dims, v.values, v.attrs) for n, v in dataset.variables.items()}
        return _Content(variables, set(map(str, dataset.coords)), dataset.attrs)
    columns: Tree = {}
    for name, entry in {**data.variables, **data.coordinates}.items():
        # The values of an axis may come without dimensions.
        dims, values, *attributes = entry if isinstance(entry, tuple) else (name, entry)
        named = (dims,) if isinstance(dims, str) else tuple(dims)
        columns[name] = named, np.asarray(values), attributes[0] if attributes else {}
    return _Content(columns, set(data.coordinates), data.attributes)


@deferred()
def write_dataset(data: object, path: str | PathLike[str] | io.BytesIO) -> None:
    """Write labelled arrays to a netCDF file or into memory, with a checksum of their content."""
    content = _content(data)
    try:
        _write(content, path)
    except RuntimeError as error:  # HDF5 reports some disk errors this way.
        if number := re.search(r"errno = (\d+)", str(error)):
            raise OSError(int(number[1]), os.strerror(int(number[1])), str(path)) from None
        raise


def _write(content: _Content, path: str | PathLike[str] | io.BytesIO) -> None:
    """Write the same file as xarray does, which takes ten times as long and a second to import."""
    import h5py

    sizes: dict[str, int] = {}
    for name, (dims, values, _) in content.variables.items():
        shape = [sizes.setdefault(dim, size) for dim, size in zip(dims, values.shape, strict=True)]
        if shape != list(values.shape) or "/" in name:
            raise ValueError(f"{name} over {dims} cannot be stored with the other variables")
    attributes = _with_coordinates(content, sizes)
    writer = f"version=2,hdf5={h5py.version.hdf5_version},h5py={h5py.__version__}"
    axes = {n for n, (dims, *_) in content.variables.items() if dims == (n,)}
    with h5py.File(path, "w", track_order=True) as file:
        # Axes first: all other variables refer to them.
        for name in sorted(content.variables, key=lambda name: name not in axes):
            dims, values, _ = content.variables[name]
            variable = _put(file, name if name in axes or name not in sizes else _CLASH + name,
                            values, attributes[name])  # fmt: skip
            if dims:
                numbers = np.array([list(sizes).index(dim) for dim in dims], dtype=np.int32)
                variable.attrs["_Netcdf4Coordinates"] = numbers
                if name in axes or values.shape[0]:
                    variable.attrs["_Netcdf4Dimid"] = numbers[0]
            if name in axes:
                h5py.h5ds.set_scale(variable.id, name.encode())
            for axis, dim in enumerate(dims if name not in axes else ()):
                scale = file.get(dim)
                if scale is None:
                    scale = _dimension(file, dim, sizes[dim], list(sizes).index(dim))
                h5py.h5ds.attach_scale(variable.id, scale.id, axis)
        _put_attributes(file, attributes[""])
        file.attrs[_ORIGIN] = np.bytes_(f"{writer},tribodyn={_digest(content)}")


def _with_coordinates(content: _Content, sizes: Mapping[str, int]) -> dict[str, Tree]:
    """Attributes of all variables and, under "", of the file, with the names of coordinates."""
    auxiliary = {name for name in content.coordinates if name not in sizes}
    unreferenced, attributes = set(auxiliary), {"": dict(content.attributes)}
    for name, (dims, values, variable_attributes) in content.variables.items():
        attributes[name] = dict(variable_attributes)
        over = {n for n in auxiliary if set(content.variables[n][0]) <= set(dims)}
        if over and name not in auxiliary and name not in dims:
            attributes[name]["coordinates"] = " ".join(sorted(over))
            unreferenced -= over
        if values.dtype.kind == "b":  # netCDF has no booleans.
            attributes[name]["dtype"] = "bool"
    if unreferenced:
        attributes[""]["coordinates"] = " ".join(sorted(unreferenced))
    return attributes


def _put(file: Any, name: str, values: Array, attributes: ByName) -> Any:
    """Write a variable with its attributes; an empty axis is unlimited, as netCDF has it."""
    import h5py

    kind, options = values.dtype.kind, Tree()
    if kind in "OU":
        values, options["dtype"] = values.astype(object), h5py.string_dtype()
    elif kind == "b":
        values = values.astype("i1")
    if 0 in values.shape:
        options["maxshape"] = tuple(size or None for size in values.shape)
    if kind == "f":
        options["fillvalue"] = values.dtype.type(np.nan)
    variable = file.create_dataset(name, data=values, track_order=True, **options)
    if kind == "f":
        attributes = {"_FillValue": options["fillvalue"], **attributes}
    _put_attributes(variable, attributes)
    return variable


def _put_attributes(item: Any, attributes: ByName) -> None:
    """Write attributes, numbers as arrays of one."""
    for key, value in attributes.items():
        number = np.isscalar(value) and np.asarray(value).dtype.kind not in "SU"
        item.attrs[key] = np.atleast_1d(value) if number else value


def _dimension(file: Any, name: str, size: int, number: int) -> Any:
    """Write a dimension without a variable."""
    import h5py

    empty = {} if size else {"maxshape": (None,)}
    scale = file.create_dataset(name, (size,), ">f4", track_order=True, **empty)
    scale.attrs["_Netcdf4Dimid"] = np.int32(number)
    h5py.h5ds.set_scale(scale.id, f"{_NO_VARIABLE}{size:10}".encode())
    return scale


@deferred()
def read_dataset(path: str | PathLike[str], where: Any = "argument path") -> xarray.Dataset:
    """Read a netCDF file; one whose checksum does not match its content is refused."""
    import h5py
    import xarray

    try:
        content = io.BytesIO(read_bytes(path, "netcdf"))
        with h5py.File(content) as file:
            checksum = _ON_FILE.search(bytes(file.attrs.get(_ORIGIN, b"")))
        with xarray.open_dataset(content, engine="h5netcdf", phony_dims="sort") as opened:
            data = opened.load()
        intact = checksum is None or checksum[1].decode() == _digest(_content(data))
    # HDF5 and its readers raise errors of many types for a damaged file.
    except Exception as error:
        reason = getattr(error, "strerror", None) or str(error) or type(error).__name__
        remedy = "Give an unchanged netCDF 4 file"
        raise InputError(f"{path} cannot be read", where, reason, remedy) from None
    if not intact:
        why = "Its checksum does not match its content"
        remedy = "Write it again, or restore a copy"
        raise InputError(f"{path} was damaged or changed after it was written", where, why, remedy)
    return data


def _digest(content: _Content) -> str:
    """Hash of names, dimensions, values and attributes."""
    digest = hashlib.sha256(_encoded(content.attributes))
    for name, (dims, values, attributes) in sorted(content.variables.items()):
        kind = values.dtype.kind
        digest.update(repr((name, dims, values.shape, "f" if kind == "f" else "")).encode())
        if kind in "biuf":
            digest.update(values.astype("<f8" if kind == "f" else "<i8").tobytes())
        else:
            digest.update(repr([str(each) for each in values.reshape(-1)]).encode())
        digest.update(_encoded(attributes))
    return digest.hexdigest()


def _encoded(attributes: Any) -> bytes:
    """Attributes in the form in which they are read back from a file."""
    plain = {str(name): np.asarray(value).tolist() for name, value in attributes.items()}
    return repr(sorted((name, _plain(value)) for name, value in plain.items())).encode()


def _plain(value: object) -> Any:
    """A list of one number or text equals that number or text."""
    return value[0] if isinstance(value, list) and len(value) == 1 else value
