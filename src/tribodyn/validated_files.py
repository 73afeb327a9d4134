"""What is read is a regular file of limited size, and a stored table proves that it is whole.

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
from tribodyn.types import Array

if TYPE_CHECKING:
    import xarray

__all__ = ["LARGEST", "file_kind", "plain_number", "read_bytes", "read_dataset", "write_dataset"]

#: Size of the largest file that is read: text, tables as text, netCDF [bytes].
LARGEST = {
    "case": 10**6,
    "profile map": 4 * 10**6,
    "table": 10**7,
    "rexs": 5 * 10**7,
    "netcdf": 2**30,
    "recording": 2**31,
}
#: Attribute in which netCDF tells who wrote a file, and the checksum in it.
_ORIGIN, _ON_FILE = "_NCProperties", re.compile(rb"tribodyn=([0-9a-f]{64})")


def file_kind(path: Path) -> str:
    """``"file"``, ``"directory"``, empty where nothing is, or why it cannot be read."""
    try:
        mode = path.stat().st_mode
    except (FileNotFoundError, NotADirectoryError):
        return ""
    except (OSError, ValueError) as error:
        return getattr(error, "strerror", None) or str(error)
    if stat.S_ISDIR(mode):
        return "directory"
    return "file" if stat.S_ISREG(mode) else "it is no regular file but a pipe, socket or device"


def read_bytes(path: str | PathLike[str], kind: str) -> bytes:
    """Content of a regular file; OSError says why there is none, before anything is awaited."""
    told = file_kind(Path(path))
    if told != "file":
        told = {"": "there is no such file", "directory": "it is a directory"}.get(told, told)
        raise OSError(errno.EINVAL, told, str(path))
    most = LARGEST[kind]
    held = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    with open(held, "rb") as file:
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
    """Rows as comma-separated values, the head among them."""
    import csv

    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()


class _Content(NamedTuple):
    """What a file holds: dimensions, values and attributes of every variable, and what it tells."""

    variables: dict[str, tuple[tuple[str, ...], Array, Mapping[str, Any]]]
    coordinates: set[str]
    attributes: Mapping[str, Any]


def _content(data: Any) -> _Content:
    """Content of labelled arrays of xarray, or of the parts of a record."""
    if hasattr(data, "coords"):
        whole = data.to_dataset() if hasattr(data, "to_dataset") else data
        variables = {str(n): (v.dims, v.values, v.attrs) for n, v in whole.variables.items()}
        return _Content(variables, set(map(str, whole.coords)), whole.attrs)
    found: dict[str, Any] = {}
    for name, given in {**data.variables, **data.coordinates}.items():
        # The values of an axis may stand alone.
        dims, values, *told = given if isinstance(given, tuple) else (name, given)
        named = (dims,) if isinstance(dims, str) else tuple(dims)
        found[name] = named, np.asarray(values), told[0] if told else {}
    return _Content(found, set(data.coordinates), data.attributes)


@deferred()
def write_dataset(data: Any, path: str | PathLike[str]) -> None:
    """Write labelled arrays to a netCDF file, with the checksum of what they hold."""
    import h5py

    content = _content(data)
    try:
        _write(content, path)
        with h5py.File(path, "r+") as file:
            told = bytes(file.attrs[_ORIGIN]).decode()
            file.attrs[_ORIGIN] = np.bytes_(f"{told},tribodyn={_digest(content)}")
    except RuntimeError as error:  # HDF5 tells some faults of the disk so.
        if number := re.search(r"errno = (\d+)", str(error)):
            raise OSError(int(number[1]), os.strerror(int(number[1])), str(path)) from None
        raise


def _write(content: _Content, path: str | PathLike[str]) -> None:
    """Write the file that xarray writes through h5netcdf, without the second that it loads in."""
    import h5netcdf
    import h5py

    sizes: dict[str, int] = {}
    for name, (dims, values, _) in content.variables.items():
        shape = [sizes.setdefault(dim, size) for dim, size in zip(dims, values.shape, strict=True)]
        if shape != list(values.shape) or "/" in name:
            raise ValueError(f"{name} over {dims} cannot be stored with the other variables")
    beside = {name for name in content.coordinates if name not in sizes}
    alone = set(beside)
    with h5netcdf.File(path, "w") as file:
        file.dimensions = sizes
        for name, (dims, values, attributes) in content.variables.items():
            told, kind = dict(attributes), values.dtype.kind
            if name not in beside and name not in dims:
                over = {n for n in beside if set(content.variables[n][0]) <= set(dims)}
                if over:
                    told["coordinates"] = " ".join(sorted(over))
                alone -= over
            if kind == "b":  # netCDF has no truth values.
                values, told["dtype"] = values.astype("i1"), "bool"
            texts = kind in "OU"
            made = file.create_variable(
                name,
                dims,
                h5py.string_dtype() if texts else values.dtype,
                fillvalue=values.dtype.type(np.nan) if kind == "f" else None,
            )
            made.attrs.update(told)
            made[...] = values.astype(object) if texts else values
        file.attrs.update(content.attributes)
        if alone:
            file.attrs["coordinates"] = " ".join(sorted(alone))


@deferred()
def read_dataset(path: str | PathLike[str], where: Any = "argument path") -> xarray.Dataset:
    """Read a netCDF file that this library may have written; a changed one is refused."""
    import h5py
    import xarray

    try:
        content = io.BytesIO(read_bytes(path, "netcdf"))
        with h5py.File(content) as file:
            told = _ON_FILE.search(bytes(file.attrs.get(_ORIGIN, b"")))
        with xarray.open_dataset(content, engine="h5netcdf", phony_dims="sort") as opened:
            data = opened.load()
        whole = told is None or told[1].decode() == _digest(_content(data))
    # A damaged file makes HDF5 and its readers stumble in many ways.
    except Exception as error:
        reason = getattr(error, "strerror", None) or str(error) or type(error).__name__
        remedy = "Give a netCDF 4 file as it was written"
        raise InputError(f"{path} cannot be read", where, reason, remedy) from None
    if not whole:
        why = "Its checksum belongs to other values: it was damaged or changed after it was written"
        remedy = "Write it anew, or take a copy from before"
        raise InputError(f"{path} is not as it was written", where, why, remedy)
    return data


def _digest(content: _Content) -> str:
    """Hash of names, dimensions, values and attributes."""
    found = hashlib.sha256(_told(content.attributes))
    for name, (dims, values, attributes) in sorted(content.variables.items()):
        kind = values.dtype.kind
        found.update(repr((name, dims, values.shape, "f" if kind == "f" else "")).encode())
        if kind in "biuf":
            found.update(values.astype("<f8" if kind == "f" else "<i8").tobytes())
        else:
            found.update(repr([str(each) for each in values.reshape(-1)]).encode())
        found.update(_told(attributes))
    return found.hexdigest()


def _told(attributes: Any) -> bytes:
    """Attributes as they come back from a file."""
    plain = {str(name): np.asarray(value).tolist() for name, value in attributes.items()}
    return repr(sorted((name, _plain(value)) for name, value in plain.items())).encode()


def _plain(value: Any) -> Any:
    """One number or text is the same as a list of it."""
    return value[0] if isinstance(value, list) and len(value) == 1 else value
