"""Files and folders appear whole or not at all, and what a killed process left is cleared.

What is written fills a hidden folder ``.NAME.xxxxxxxx.part`` beside its place, which its process
holds locked. When it is complete and on the disk it takes its name; what stood there is exchanged
for it at once. Where a system cannot exchange two places, the old one steps aside as
``.NAME.xxxxxxxx.old``, and comes back if the process is killed before the new one is there.
"""

from __future__ import annotations

import ctypes
import errno
import os
import re
import secrets
import shutil
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import lru_cache
from pathlib import Path
from typing import Any

from tribodyn.errors import Argument, ComputationError, InputError, OutputExistsError, Problem, warn

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]

__all__ = ["FAULTS_OF_THE_PLACE", "cannot_write", "clear_leftovers", "lock", "whole"]

#: Faults of the place that is written to, not of the program.
FAULTS_OF_THE_PLACE = (
    errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.EROFS, errno.EACCES, errno.EPERM,
    errno.ENAMETOOLONG, errno.ENOENT, errno.ENOTDIR, errno.ENODEV,
    errno.EISDIR,
)  # fmt: skip
_CANNOT_EXCHANGE = (errno.EINVAL, errno.ENOSYS, errno.ENOTSUP, errno.EPERM)
#: Without locks, what nobody has touched for so long is left over [s].
_LONG = 86400.0
#: What an earlier version wrote before the report.
_BEFORE_REPORT = {
    "case.toml",
    "summary.json",
    "mesh.nc",
    "response.nc",
    "sweep.csv",
    "sweep.nc",
    "bifurcation.nc",
}


def check_new(path: str | os.PathLike[str], where: Argument | str) -> Path:
    """Path of a file to write, which must not be there yet."""
    target = Path(path)
    if target.exists():
        what, why = f"{target} exists already", "An existing file is never overwritten"
        raise OutputExistsError(what, where, why, "Choose another name")
    return target


def cannot_write(place: object, error: Exception) -> Problem:
    """Say why a place cannot be written to."""
    code = getattr(error, "errno", None)
    reason = os.strerror(code) if code else str(error)
    full = code in (errno.ENOSPC, errno.EDQUOT)
    remedy = "Make room, or write to another place" if full else "Choose another place"
    return Problem(f"cannot write: {reason.lower()}", str(place), "", remedy)


@contextmanager
def whole(target: Path, *, folder: bool = False) -> Iterator[Path]:
    """Yield a place to write a file or a folder; at the end of the block it takes its name.

    A fault of the disk is told with the place that was asked for.
    """
    place = target.absolute()
    clear_leftovers(place)
    try:
        partial, held = _begin(place)
    except (OSError, ValueError) as error:
        raise InputError(cannot_write(target, error)) from None
    try:
        inner = partial if folder else partial / place.name
        yield inner
        _to_disk(partial)
        _publish(inner, place, partial.with_suffix(".old"))
    except OSError as error:
        if error.errno in FAULTS_OF_THE_PLACE:
            raise ComputationError(cannot_write(target, error)) from None
        raise
    finally:
        shutil.rmtree(partial, ignore_errors=True)
        if held >= 0:
            os.close(held)


def _begin(place: Path) -> tuple[Path, int]:
    """Make a folder that this process holds; another may clear it before it is locked."""
    while True:
        partial = place.with_name(f".{place.name}.{secrets.token_hex(4)}.part")
        partial.mkdir()
        held = lock(partial)
        if held is None:
            continue
        if held < 0 or (partial.exists() and os.path.samestat(os.fstat(held), partial.stat())):
            return partial, held
        os.close(held)


def lock(path: Path) -> int | None:
    """Hold a file or folder until the returned number is closed; None if another process does.

    The number is -1 where the system has no such locks.
    """
    if fcntl is None:
        return -1
    held = os.open(path, os.O_RDONLY)
    try:
        fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(held)
        return None
    except OSError:  # a file system without locks
        os.close(held)
        return -1
    return held


def _to_disk(path: Path) -> None:
    """Let a folder and all that it holds reach the disk."""
    for entry in path.iterdir() if path.is_dir() else ():
        _to_disk(entry)
    try:
        held = os.open(path, os.O_RDONLY)
    except OSError:  # Windows opens no folders.
        if path.is_dir():
            return
        raise
    try:
        os.fsync(held)
    finally:
        os.close(held)


def _publish(new: Path, place: Path, aside: Path) -> None:
    """Give what is complete its name; a folder that stood there is gone only after that."""
    if not (new.is_dir() and place.exists()):
        os.replace(new, place)
    elif not _exchange(new, place):
        place.rename(aside)
        try:
            new.rename(place)
        except BaseException:
            aside.rename(place)
            raise
        shutil.rmtree(aside, ignore_errors=True)
    with suppress(OSError):
        _to_disk_alone(place.parent)


def _to_disk_alone(folder: Path) -> None:
    """Let the names in a folder reach the disk."""
    held = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(held)
    finally:
        os.close(held)


@lru_cache(maxsize=1)
def _exchanger() -> Any:
    """Exchange of two places as Linux and macOS have it, or None."""
    try:
        system = ctypes.CDLL(None, use_errno=True)
    except (OSError, TypeError):
        return None
    here, swap = -100, 2  # AT_FDCWD; RENAME_EXCHANGE on Linux, RENAME_SWAP on macOS
    if hasattr(system, "renameat2"):
        return lambda one, other: system.renameat2(here, one, here, other, swap)
    if hasattr(system, "renamex_np"):
        return lambda one, other: system.renamex_np(one, other, swap)
    return None


def _exchange(one: Path, other: Path) -> bool:
    """Exchange two places at once; False where the system or its disk cannot."""
    exchange = _exchanger()
    if exchange is None:
        return False
    if exchange(os.fsencode(one), os.fsencode(other)) == 0:
        return True
    code = ctypes.get_errno()
    if code in _CANNOT_EXCHANGE:
        return False
    raise OSError(code, os.strerror(code), str(other))


def clear_leftovers(target: Path) -> None:
    """Clear what killed processes left beside a place, and bring back what stood there."""
    place = target.absolute()
    known = re.compile(rf"\.{re.escape(place.name)}\.(?:\w{{8}}(\.part|\.old)?|(old\.)\w{{8}})")
    try:
        entries = [(entry, known.fullmatch(entry.name)) for entry in place.parent.iterdir()]
    except OSError:
        return
    with suppress(OSError):
        _clear_members(place)
    for entry, match in entries:
        if match is None or entry.is_symlink() or not entry.is_dir():
            continue
        kind = match.group(1) or match.group(2)
        with suppress(OSError):  # Another process may clear the same.
            if kind == "old.":  # An earlier version put the old result inside.
                _bring_back(entry / place.name, entry, place)
            elif kind == ".old":
                if not _is_held(entry.with_suffix(".part")):
                    _bring_back(entry, entry, place)
            elif (kind or _is_unfinished(entry)) and not _is_held(entry):
                shutil.rmtree(entry)
                warn("leftover", f"{entry} is removed: a process was killed while it wrote there")


def _clear_members(place: Path) -> None:
    """Remove members of a study that was saved after the last of them: it is complete."""
    folder = place.with_name(f".{place.name}.members")
    if not folder.is_dir() or not place.is_dir() or _is_held(folder):
        return
    if place.stat().st_mtime_ns > (folder / "members.jsonl").stat().st_mtime_ns:
        shutil.rmtree(folder)


def _is_unfinished(entry: Path) -> bool:
    """Whether an earlier version was killed while it filled a folder: its report came last."""
    return {each.name for each in entry.iterdir()} <= _BEFORE_REPORT


def _is_held(partial: Path) -> bool:
    """Whether a living process fills a folder."""
    if not partial.exists():
        return False
    held = lock(partial)
    if held is not None and held >= 0:
        os.close(held)
    return held is None or (held < 0 and time.time() - partial.stat().st_mtime < _LONG)


def _bring_back(old: Path, entry: Path, place: Path) -> None:
    """Put an earlier result back to its name, if its successor never came there."""
    if old.exists() and not place.exists():
        old.rename(place)
        warn("leftover", f"{place} is back: the process that was to replace it was killed")
    shutil.rmtree(entry, ignore_errors=True)
