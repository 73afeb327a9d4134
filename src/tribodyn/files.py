"""Write files and folders atomically, and clear what killed processes left.

Content is written to a hidden folder ``.NAME.xxxxxxxx.part`` next to the target, which its process
holds locked. Once complete and synced to disk it is renamed to the target; an existing result is
exchanged for it in one step. On systems that cannot exchange two paths, the earlier result is
renamed to ``.NAME.xxxxxxxx.old`` first, and restored if the process is killed before the new one
is in place.

A result folder has one writer at a time: :func:`reserved` locks ``.NAME.lock`` next to it. The
system releases that lock when the process ends, however it ends.
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
from contextlib import contextmanager, nullcontext, suppress
from contextvars import ContextVar
from functools import lru_cache
from pathlib import Path
from typing import Any

from tribodyn.errors import Argument, ComputationError, InputError, OutputExistsError, Problem, warn

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]

__all__ = ["LOCATION_ERRNOS", "atomic_write", "cannot_write", "clear_leftovers", "lock", "reserved"]

#: Error numbers of the location that is written to, not of the program.
LOCATION_ERRNOS = (
    errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.EROFS, errno.EACCES, errno.EPERM,
    errno.ENAMETOOLONG, errno.ENOENT, errno.ENOTDIR, errno.ENODEV,
    errno.EISDIR,
)  # fmt: skip
_CANNOT_EXCHANGE = (errno.EINVAL, errno.ENOSYS, errno.ENOTSUP, errno.EPERM)
#: A folder that is being written.
_PARTIAL = re.compile(r"\.[\da-f]{8}\.part(?!\w)")
#: On systems without locks, age at which an untouched temporary folder counts as abandoned [s].
_ABANDONED_AFTER = 86400.0
#: Files that an earlier version wrote before the report.
_BEFORE_REPORT = {
    "case.toml",
    "summary.json",
    "mesh.nc",
    "response.nc",
    "sweep.csv",
    "sweep.nc",
    "bifurcation.nc",
}
#: Targets that the running command or thread has reserved.
_reserved: ContextVar[frozenset[Path]] = ContextVar("reserved", default=frozenset())


def check_new(path: str | os.PathLike[str], where: Argument | str) -> Path:
    """Path of a file to write, which must not exist yet."""
    target = Path(path)
    if target.exists():
        what, why = f"{target} exists already", "An existing file is never overwritten"
        raise OutputExistsError(what, where, why, "Choose another name")
    return target


def cannot_write(location: object, error: Exception) -> Problem:
    """Explain why a location cannot be written to."""
    code = getattr(error, "errno", None)
    reason = os.strerror(code) if code else str(error)
    full = code in (errno.ENOSPC, errno.EDQUOT)
    remedy = "Free some space, or write to another disk" if full else "Choose another location"
    return Problem(f"cannot write: {reason.lower()}", str(location), "", remedy)


def absolute_target(target: Path) -> Path:
    """Absolute path of a file or folder to write; the root of a disk is refused."""
    path = target.absolute()
    if path.name in ("", ".."):
        path = path.resolve()
    if not path.name:
        why = "A result is a new file or directory; the root directory cannot be replaced"
        raise InputError("this is the root directory", str(target), why, "Choose a directory in it")
    return path


@contextmanager
def reserved(target: Path) -> Iterator[None]:
    """Be the only writer of a result folder inside the block; refuse if another one is active."""
    path = absolute_target(target)
    if path in _reserved.get():
        yield
        return
    lock_file = _lock_file(path)
    try:
        descriptor = _lock_new(lock_file)
    except (OSError, ValueError) as error:
        raise InputError(cannot_write(target, error)) from None
    if descriptor is None:
        why = "Another run that is still active writes its result there"
        remedy = "Wait until it has finished, or choose another directory"
        raise InputError("this directory is in use", str(target), why, remedy)
    token = _reserved.set(_reserved.get() | {path})
    try:
        yield
    finally:
        _reserved.reset(token)
        if descriptor >= 0:
            with suppress(OSError):
                lock_file.unlink()
            os.close(descriptor)


def _lock_file(path: Path) -> Path:
    return path.with_name(f".{path.name}.lock")


def _lock_new(lock_file: Path) -> int | None:
    """Create and lock a file; its holder may remove it between the two steps."""
    while True:
        if fcntl is not None:
            lock_file.touch()
        try:
            descriptor = lock(lock_file)
        except FileNotFoundError:
            continue
        if descriptor is None or descriptor < 0 or _is_at(descriptor, lock_file):
            return descriptor
        os.close(descriptor)


def _remove_abandoned_lock(lock_file: Path) -> None:
    """Remove the lock file of a killed process; it is removed while locked, as in `reserved`."""
    descriptor = lock(lock_file)
    if descriptor is not None and descriptor >= 0:
        lock_file.unlink()
        os.close(descriptor)


def _is_at(descriptor: int, path: Path) -> bool:
    """Whether an open file or folder is still the one at a path."""
    return path.exists() and os.path.samestat(os.fstat(descriptor), path.stat())


@contextmanager
def atomic_write(target: Path, *, folder: bool = False) -> Iterator[Path]:
    """Yield a temporary path to write a file or folder; after the block it becomes the target.

    Disk errors are reported with the target path.
    """
    path = absolute_target(target)
    with reserved(target) if folder else nullcontext():
        clear_leftovers(path)
        try:
            partial, descriptor = _create_partial(path)
        except (OSError, ValueError) as error:
            raise InputError(cannot_write(target, error)) from None
        try:
            content = partial if folder else partial / path.name
            yield content
            if not _PARTIAL.search(str(path.parent)):  # what is inside another is synced with it
                _sync(partial)
            _publish(content, path, partial.with_suffix(".old"))
        except OSError as error:
            if error.errno in LOCATION_ERRNOS:
                raise ComputationError(cannot_write(target, error)) from None
            raise
        finally:
            shutil.rmtree(partial, ignore_errors=True)
            if descriptor >= 0:
                os.close(descriptor)


def _create_partial(path: Path) -> tuple[Path, int]:
    """Create and lock a temporary folder; another process may clear it before it is locked."""
    while True:
        partial = path.with_name(f".{path.name}.{secrets.token_hex(4)}.part")
        partial.mkdir()
        descriptor = lock(partial)
        if descriptor is None:
            continue
        if descriptor < 0 or _is_at(descriptor, partial):
            return partial, descriptor
        os.close(descriptor)


def lock(path: Path) -> int | None:
    """Lock a file or folder until the returned descriptor is closed; None if it is locked already.

    The descriptor is -1 on systems without such locks.
    """
    if fcntl is None:
        return -1
    descriptor = os.open(path, os.O_RDONLY)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(descriptor)
        return None
    except OSError:  # a file system without locks
        os.close(descriptor)
        return -1
    return descriptor


def _sync(path: Path) -> None:
    """Flush a file, or a folder with its content, to disk."""
    for entry in path.iterdir() if path.is_dir() else ():
        _sync(entry)
    try:
        _flush(path)
    except PermissionError:  # Windows opens no folders.
        if not path.is_dir():
            raise


def _publish(new: Path, path: Path, old: Path) -> None:
    """Rename a complete result to its target; an existing folder is removed only after that."""
    if not (new.is_dir() and path.exists()):
        os.replace(new, path)
    elif not _exchange(new, path):
        path.rename(old)
        try:
            new.rename(path)
        except BaseException:
            old.rename(path)
            raise
        shutil.rmtree(old, ignore_errors=True)
    with suppress(OSError):
        _flush(path.parent)


def _flush(path: Path) -> None:
    """Flush a file, or the names in a folder, to disk."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


@lru_cache(maxsize=1)
def _exchanger() -> Any:
    """System call of Linux or macOS that exchanges two paths, or None."""
    try:
        system = ctypes.CDLL(None, use_errno=True)
    except (OSError, TypeError):
        return None
    current_folder, swap = -100, 2  # AT_FDCWD; RENAME_EXCHANGE on Linux, RENAME_SWAP on macOS
    if hasattr(system, "renameat2"):
        return lambda a, b: system.renameat2(current_folder, a, current_folder, b, swap)
    if hasattr(system, "renamex_np"):
        return lambda a, b: system.renamex_np(a, b, swap)
    return None


def _exchange(new: Path, path: Path) -> bool:
    """Exchange two paths in one step; False where the system or the file system cannot."""
    exchange = _exchanger()
    if exchange is None:
        return False
    if exchange(os.fsencode(new), os.fsencode(path)) == 0:
        return True
    code = ctypes.get_errno()
    if code in _CANNOT_EXCHANGE:
        return False
    raise OSError(code, os.strerror(code), str(path))


def clear_leftovers(target: Path) -> None:
    """Remove temporary folders of killed processes, and restore a result that they moved away."""
    path = absolute_target(target)
    pattern = re.compile(rf"\.{re.escape(path.name)}\.(?:\w{{8}}(\.part|\.old)?|(old\.)\w{{8}})")
    try:
        entries = [(entry, pattern.fullmatch(entry.name)) for entry in path.parent.iterdir()]
    except OSError:
        return
    with suppress(OSError):
        _clear_checkpoints(path)
    with suppress(OSError, ValueError):
        _remove_abandoned_lock(_lock_file(path))
    for entry, match in entries:
        if match is None or entry.is_symlink() or not entry.is_dir():
            continue
        kind = match.group(1) or match.group(2)
        with suppress(OSError):  # Another process may clear the same entry.
            if kind == "old.":  # An earlier version moved the old result into this folder.
                _restore(entry / path.name, entry, path)
            elif kind == ".old":
                if not _is_locked(entry.with_suffix(".part")):
                    _restore(entry, entry, path)
            elif (kind or _is_unfinished(entry)) and not _is_locked(entry):
                shutil.rmtree(entry)
                warn("leftover", f"{entry} is removed: a process was killed while it wrote there")


def _clear_checkpoints(path: Path) -> None:
    """Remove checkpoints of a study that was saved after the last of them: it is complete."""
    folder = path.with_name(f".{path.name}.members")
    if not folder.is_dir() or not path.is_dir() or _is_locked(folder):
        return
    if path.stat().st_mtime_ns > (folder / "members.jsonl").stat().st_mtime_ns:
        shutil.rmtree(folder)


def _is_unfinished(entry: Path) -> bool:
    """Whether an earlier version was killed while it filled a folder: its report came last."""
    return {file.name for file in entry.iterdir()} <= _BEFORE_REPORT


def _is_locked(path: Path) -> bool:
    """Whether a running process has locked a file or folder."""
    if not path.exists():
        return False
    descriptor = lock(path)
    if descriptor is not None and descriptor >= 0:
        os.close(descriptor)
    no_locks = descriptor is not None and descriptor < 0
    return descriptor is None or (
        no_locks and time.time() - path.stat().st_mtime < _ABANDONED_AFTER
    )


def _restore(old: Path, entry: Path, path: Path) -> None:
    """Rename an earlier result back to its target, if its replacement never got there."""
    if old.exists() and not path.exists():
        old.rename(path)
        warn("leftover", f"{path} is restored: the process that was replacing it was killed")
    shutil.rmtree(entry, ignore_errors=True)
