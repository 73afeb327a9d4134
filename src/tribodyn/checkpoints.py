"""Finished members of a long study, kept on disk as they come, so that it goes on after a kill."""

from __future__ import annotations

import json
import os
import secrets
import shutil
import threading
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, BinaryIO

from tribodyn.errors import ComputationError, InputError
from tribodyn.files import absolute_target, cannot_write, lock

__all__ = ["NAME", "Members", "read_lines"]

#: File of the members.
NAME = "members.jsonl"
#: What a study is told by, and how a message calls it.
_WORDS = {
    "study": "it is another study",
    "version": "another version of tribodyn began it",
    "case": "its case differs",
    "over": "other values vary",
    "options": "its options differ",
}


class Members:
    """Members of a study by name, in a hidden folder beside its place until it is discarded.

    ``inside`` keeps them in the place itself, for good.
    """

    def __init__(
        self, target: Path | None = None, anew: bool = False, *, inside: bool = False
    ) -> None:
        self.target, self.anew, self.inside = target, anew, inside
        self.folder: Path | None = None
        self._found: dict[str, Any] = {}
        self._held, self._kept = -1, False
        self._file: BinaryIO | None = None
        self._writing = threading.Lock()

    def begin(self, identity: Mapping[str, Any]) -> Members:
        """Say which study it is; members of the same one are there already."""
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
            held = lock(folder)
            if held is None:
                why = "Another process computes a study that is to be saved there"
                remedy = "Wait for it, or choose another place"
                raise InputError("this place is taken", str(self.target), why, remedy)
            self._held = held
            if held < 0 or (folder.exists() and os.path.samestat(os.fstat(held), folder.stat())):
                return
            os.close(held)

    def _open(self, folder: Path, identity: dict[str, Any]) -> None:
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
        self._found = {line["name"]: line["value"] for line in lines[1:]}

    def __len__(self) -> int:
        """Number of members that were there."""
        return len(self._found)

    def all(self) -> dict[str, Any]:
        """Everything that was there, by name."""
        return dict(self._found)

    def get(self, name: str) -> Any:
        """Member that an earlier process has finished, or None."""
        return self._found.get(name)

    def keep(self, name: str, value: Any) -> None:
        """Keep a finished member."""
        if self._file is not None:
            self._write({"name": name, "value": value})
            self._kept = True

    def _write(self, line: Mapping[str, Any]) -> None:
        text = json.dumps(line, default=lambda array: array.tolist()).encode()
        with self._writing:
            if self._file is None:  # A thread that outlives an interruption has nowhere to write.
                return
            try:
                self._file.write(b"%08x %s\n" % (zlib.crc32(text), text))
                self._file.flush()
                os.fsync(self._file.fileno())
            except OSError as error:
                raise ComputationError(cannot_write(self.target, error)) from None

    def close(self) -> None:
        """Let another process go on with what is kept."""
        with self._writing:
            if self._file is not None:
                self._file.close()
                self._file = None
        if self._held >= 0:
            os.close(self._held)
            self._held = -1

    def discard(self) -> None:
        """Remove what is kept."""
        if self.folder is not None:
            aside = self.folder.with_suffix(f".{secrets.token_hex(4)}.part")
            self.folder.rename(aside)
            shutil.rmtree(aside, ignore_errors=True)
        self.close()

    def close_after(self, complete: bool) -> None:
        """Discard what is kept of a study that is saved, unless it was interrupted."""
        if complete:
            self.discard()
        elif self.folder is not None:
            os.utime(self.folder / NAME)  # It is newer than what is saved, and stays.

    def __enter__(self) -> Members:
        """Use it in a block."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close it; what is kept stays, if there is anything."""
        if self._file is not None and not (self._kept or self._found):
            self.discard()
        self.close()


def read_lines(path: Path) -> tuple[list[Any], int]:
    """Lines that were written whole, and where the last of them ends."""
    found, size = [], 0
    content = path.read_bytes() if path.is_file() else b""
    for line in content.splitlines(keepends=True):
        told, _, text = line.partition(b" ")
        if not line.endswith(b"\n") or told != b"%08x" % zlib.crc32(text[:-1]):
            break
        found.append(json.loads(text))
        size += len(line)
    return found, size


def _other(target: str, there: Any, asked: Mapping[str, Any]) -> tuple[str, str, str, str]:
    """Say that an unfinished study in a place is another one."""
    differ = [words for key, words in _WORDS.items() if there.get(key) != asked.get(key)]
    remedy = "Repeat its command to finish it, choose another place, or start anew with --force"
    return "an unfinished study lies here", target, ", ".join(differ).capitalize(), remedy
