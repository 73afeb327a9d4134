"""Detect the format of a recording from its content, and read it."""

from __future__ import annotations

import errno
import os
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from tribodyn.errors import Argument, InputError, TribodynError
from tribodyn.measurement.readers import binary, text
from tribodyn.measurement.readers.recording_data import RecordingData
from tribodyn.validated_files import LARGEST, file_kind


class Format(NamedTuple):
    """File format of a recording."""

    name: str
    suffixes: tuple[str, ...]
    begins: Callable[[bytes], bool]  #: whether the first kilobyte of a file matches
    read: Callable[[Path], RecordingData]


_HDF5 = b"\x89HDF\r\n\x1a\n"
_TEXT = Format(
    "text in columns",
    (".csv", ".txt", ".dat", ".asc", ".tsv"),
    lambda head: not text.looks_binary(head),
    text.read_columns,
)
#: In order of detection; text is the fallback.
FORMATS = (
    Format("WAV", (".wav",), lambda head: head[:4] in (b"RIFF", b"RIFX", b"RF64"), binary.wav),
    Format("TDMS", (".tdms",), lambda head: head[:4] in (b"TDSm", b"TDSh"), binary.tdms),
    Format("MAT", (".mat",), lambda head: head[:6] == b"MATLAB", binary.mat),
    Format("HDF5", (".h5", ".hdf5", ".nc", ".hdf"), lambda head: _HDF5 in head, binary.hdf5),
    Format("UFF", (".uff", ".unv", ".uf"), lambda head: head.lstrip()[:2] == b"-1", binary.uff),
    Format("compressed text", (".gz",), lambda head: head[:2] == b"\x1f\x8b", text.read_columns),
    _TEXT,
)


def read_recording_data(path: str | os.PathLike[str]) -> RecordingData:
    """Read a file by its content; raise InputError if the content contradicts the suffix."""
    try:
        file = Path(path)
    except TypeError:
        what, why = f"path = {path!r}", "Expected the path of a file"
        raise InputError(what, Argument("path"), why, "Pass a str or a Path") from None
    file_format = _detect_format(file, _read_head(file))
    try:
        return file_format.read(file)
    except TribodynError:
        raise
    # The libraries raise many kinds of exceptions on damaged files.
    except Exception as error:
        message = f"{error}" if " " in f"{error}" else f"{type(error).__name__} {error}".strip()
        reason = getattr(error, "strerror", None) or message
        remedy = "The file is damaged or cut short: export it from the measuring system again"
        raise InputError(
            f"cannot be read as {file_format.name}", str(path), reason, remedy
        ) from None


def _read_head(path: Path) -> bytes:
    """First kilobyte of a file; raise InputError if it is not regular, empty or too large."""
    kind = file_kind(path)
    if kind == "file" and path.stat().st_size > LARGEST["recording"]:
        kind = f"It is larger than {LARGEST['recording'] / 1e9:.3g} GB"
    if kind != "file":
        reason = {"": "There is no such file", "directory": "It is a directory"}.get(kind, kind)
        raise InputError("cannot be read", str(path), reason, "Give the path of a file")
    try:
        with open(path, "rb") as file:
            head = file.read(1024)
    except OSError as error:
        reason = os.strerror(error.errno or errno.EIO)
        remedy = "Check that the file is complete and readable"
        raise InputError("cannot be read", str(path), reason, remedy) from None
    if not head.strip():
        raise InputError("is empty", str(path), "", "Export it from the measuring system again")
    return head


def _detect_format(path: Path, head: bytes) -> Format:
    suffix = path.suffix.lower()
    expected = next((entry for entry in FORMATS if suffix in entry.suffixes), None)
    detected = next((entry for entry in FORMATS if entry.begins(head)), None)
    if detected in (None, _TEXT) and suffix == ".mat":  # MAT files of version 4 have no signature
        return next(entry for entry in FORMATS if entry.name == "MAT")
    free = suffix in (".txt", ".dat", ".asc")  # suffixes that any format may use
    if detected is None or (expected is not None and expected is not detected and not free):
        reason = (
            f"its content is {detected.name}"
            if detected
            else "its content matches no supported format"
        )
        suffixes = ", ".join(entry.suffixes[0] for entry in FORMATS)
        kind = f"no {expected.name} file" if expected else "no supported recording"
        remedy = f"Rename it to {detected.suffixes[0]}" if detected else f"Supported: {suffixes}"
        raise InputError(f"is {kind}", str(path), reason, remedy)
    return detected
