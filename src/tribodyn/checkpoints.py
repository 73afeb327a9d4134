"""Checkpoints of long studies: finished runs are stored on disk, so that a killed study resumes."""

from __future__ import annotations

import json
import os
import secrets
import shutil
import threading
import zlib
from pathlib import Path
from typing import Any, BinaryIO

from tribodyn.aliases import old_module
from tribodyn.errors import ComputationError, InputError
from tribodyn.files import absolute_target, cannot_write, lock
from tribodyn.types import ByName, Tree

__all__ = ["NAME", "Checkpoints", "read_lines"]

#: File of the finished runs.
NAME = "members.jsonl"
#: Parts of the identity of a study, and the message when they differ.
_DIFFERENCES = {
    "study": "it is another study",
    "version": "another version of tribodyn started it",
    "case": "its case differs",
    "over": "it varies other values",
    "options": "its options differ",
}

__getattr__ = old_module(__name__)


class Checkpoints:
    """Finished runs of a study by name, in a hidden folder next to its target until discarded.

    With ``inside`` they are stored in the target folder itself and stay there.
    """

    def __init__(
        self, target: Path | None = None, anew: bool = False, *, inside: bool = False
    ) -> None:
        self.target, self.anew, self.inside = target, anew, inside
        self.folder: Path | None = None
        self._earlier: Tree = {}
        self._descriptor, self._stored_new = -1, False
        self._file: BinaryIO | None = None
        self._writing = threading.Lock()

    def begin(self, identity: ByName) -> Checkpoints:
        """Open the checkpoints of a study; runs that the same study has finished are loaded."""
        if self.target is None:
            return self
        place = absolute_target(self.target)
        folder = place if self.inside else place.with_name(f".{place.name}.members")
        try:
            self._hold(folder)
            self._open(folder, json.loads(json.dumps(identity)))
        except OSError as error:
            raise InputError(cannot_write(self.target, error)) from None
        return self

    def _hold(self, folder: Path) -> None:
        while True:
            folder.mkdir(exist_ok=True)
            descriptor = lock(folder)
            if descriptor is None:
                why = "Another process that is still active computes a study there"
                remedy = "Wait until it has finished, or choose another directory"
                raise InputError("this directory is in use", str(self.target), why, remedy)
            self._descriptor = descriptor
            if descriptor < 0 or (
                folder.exists() and os.path.samestat(os.fstat(descriptor), folder.stat())
            ):
                return
            os.close(descriptor)

    def _open(self, folder: Path, identity: Tree) -> None:
        path = folder / NAME
        lines, size = read_lines(path)
        if lines and lines[0] != identity:
            if not self.anew:
                self.close()
                raise InputError(*_other(str(self.target), lines[0], identity))
            lines, size = [], 0
            for entry in folder.iterdir():
                shutil.rmtree(entry) if entry.is_dir() else entry.unlink()
        self.folder, self._file = folder, path.open("ab")
        self._file.truncate(size)
        if not lines:
            self._write(identity)
        self._earlier = {line["name"]: line["value"] for line in lines[1:]}

    def __len__(self) -> int:
        """Number of runs that an earlier process has finished."""
        return len(self._earlier)

    def all(self) -> Tree:
        """All runs that an earlier process has finished, by name."""
        return dict(self._earlier)

    def get(self, name: str) -> Any:
        """Value of a run that an earlier process has finished, or None."""
        return self._earlier.get(name)

    def keep(self, name: str, value: object) -> None:
        """Store a finished run."""
        if self._file is not None:
            self._write({"name": name, "value": value})
            self._stored_new = True

    def _write(self, line: ByName) -> None:
        text = json.dumps(line, default=lambda array: array.tolist()).encode()
        with self._writing:
            if self._file is None:  # closed: a thread is still running after an interruption
                return
            try:
                self._file.write(b"%08x %s\n" % (zlib.crc32(text), text))
                self._file.flush()
                os.fsync(self._file.fileno())
            except OSError as error:
                raise ComputationError(cannot_write(self.target, error)) from None

    def close(self) -> None:
        """Close the file and release the lock, so that another process can resume the study."""
        with self._writing:
            if self._file is not None:
                self._file.close()
                self._file = None
        if self._descriptor >= 0:
            os.close(self._descriptor)
            self._descriptor = -1

    def discard(self) -> None:
        """Remove all checkpoints."""
        if self.folder is not None:
            aside = self.folder.with_suffix(f".{secrets.token_hex(4)}.part")
            self.folder.rename(aside)
            shutil.rmtree(aside, ignore_errors=True)
        self.close()

    def close_after(self, complete: bool) -> None:
        """Remove the checkpoints of a study after it was saved, unless it was interrupted."""
        if complete:
            self.discard()
        elif self.folder is not None:
            os.utime(self.folder / NAME)  # newer than the saved result, so that it is not removed

    def __enter__(self) -> Checkpoints:
        """Return the checkpoints for a ``with`` block."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close the file; an empty one is removed."""
        if self._file is not None and not (self._stored_new or self._earlier):
            self.discard()
        self.close()


def read_lines(path: Path) -> tuple[list[Any], int]:
    """Complete lines of a file, and the position after the last of them."""
    lines, size = [], 0
    content = path.read_bytes() if path.is_file() else b""
    for line in content.splitlines(keepends=True):
        checksum, _, text = line.partition(b" ")
        if not line.endswith(b"\n") or checksum != b"%08x" % zlib.crc32(text[:-1]):
            break
        lines.append(json.loads(text))
        size += len(line)
    return lines, size


def _other(target: str, stored: Any, requested: ByName) -> tuple[str, str, str, str]:
    """Message for an unfinished study in a folder that differs from the requested one."""
    differ = [
        difference
        for key, difference in _DIFFERENCES.items()
        if stored.get(key) != requested.get(key)
    ]
    remedy = "Repeat its command to finish it, choose another directory, or restart with --force"
    return (
        "the directory contains another unfinished study",
        target,
        ", ".join(differ).capitalize(),
        remedy,
    )
