"""From a path to the content of the file, whatever it is called."""

from __future__ import annotations

import errno
import os
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from tribodyn.errors import Argument, InputError, TribodynError
from tribodyn.measurement.readers import binary, text
from tribodyn.measurement.readers.content import Content
from tribodyn.validated_files import LARGEST, file_kind


class Format(NamedTuple):
    """One kind of file."""

    name: str
    suffixes: tuple[str, ...]
    begins: Callable[[bytes], bool]  #: whether the first kilobyte of a file is of it
    read: Callable[[Path], Content]


_HDF5 = b"\x89HDF\r\n\x1a\n"
_TEXT = Format(
    "text in columns",
    (".csv", ".txt", ".dat", ".asc", ".tsv"),
    lambda head: not text.looks_binary(head),
    text.content,
)
#: In the order in which they are asked; text is what nothing else claims.
FORMATS = (
    Format("WAV", (".wav",), lambda head: head[:4] in (b"RIFF", b"RIFX", b"RF64"), binary.wav),
    Format("TDMS", (".tdms",), lambda head: head[:4] in (b"TDSm", b"TDSh"), binary.tdms),
    Format("MAT", (".mat",), lambda head: head[:6] == b"MATLAB", binary.mat),
    Format("HDF5", (".h5", ".hdf5", ".nc", ".hdf"), lambda head: _HDF5 in head, binary.hdf5),
    Format("UFF", (".uff", ".unv", ".uf"), lambda head: head.lstrip()[:2] == b"-1", binary.uff),
    Format("text that is compressed", (".gz",), lambda head: head[:2] == b"\x1f\x8b", text.content),
    _TEXT,
)


def content_of(path: str | os.PathLike[str]) -> Content:
    """Read a file by what it holds; refuse one that is not what its name says."""
    try:
        place = Path(path)
    except TypeError:
        what, why = f"path = {path!r}", "Wanted: the place of a file"
        raise InputError(what, Argument("path"), why, "Give it as a text or a Path") from None
    found = _format(place, _head(place))
    try:
        return found.read(place)
    except TribodynError:
        raise
    # A damaged file makes the libraries that read it stumble in many ways.
    except Exception as error:
        told = f"{error}" if " " in f"{error}" else f"{type(error).__name__} {error}".strip()
        reason = getattr(error, "strerror", None) or told
        remedy = "The file is damaged or cut short: take it from the measuring system again"
        raise InputError(f"cannot be read as {found.name}", str(path), reason, remedy) from None


def _head(place: Path) -> bytes:
    """First kilobyte of a regular file of limited size."""
    told = file_kind(place)
    if told == "file" and place.stat().st_size > LARGEST["recording"]:
        told = f"it is larger than {LARGEST['recording'] / 1e9:.3g} GB"
    if told != "file":
        reason = {"": "there is no such file", "directory": "it is a directory"}.get(told, told)
        raise InputError("cannot be read", str(place), reason, "Give the path of a file")
    try:
        with open(place, "rb") as file:
            head = file.read(1024)
    except OSError as error:
        reason = os.strerror(error.errno or errno.EIO)
        remedy = "Check that the file is whole, and what wrote it"
        raise InputError("cannot be read", str(place), reason, remedy) from None
    if not head.strip():
        raise InputError("is empty", str(place), "", "Take it from the system again")
    return head


def _format(place: Path, head: bytes) -> Format:
    suffix = place.suffix.lower()
    named = next((each for each in FORMATS if suffix in each.suffixes), None)
    found = next((each for each in FORMATS if each.begins(head)), None)
    if found in (None, _TEXT) and suffix == ".mat":  # a MAT file of version 4 has no mark
        return next(each for each in FORMATS if each.name == "MAT")
    free = suffix in (".txt", ".dat", ".asc")  # names that say nothing
    if found is None or (named is not None and named is not found and not free):
        told = f"its content is that of {found.name}" if found else "nothing here begins as it does"
        known = ", ".join(each.suffixes[0] for each in FORMATS)
        kind = f"no {named.name} file" if named else "no known recording"
        remedy = f"Name it {found.suffixes[0]}" if found else f"Known: {known}"
        raise InputError(f"is {kind}", str(place), told, remedy)
    return found
