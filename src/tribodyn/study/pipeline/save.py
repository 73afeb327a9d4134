"""Write files and directories whole or not at all, and never over something by accident."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tribodyn.errors import InputError, OutputExistsError, Problem

#: What a result directory holds; only such a directory may be replaced.
RESULT_FILES = ("case.toml", "summary.json", "mesh.nc", "response.nc", "report.html")
#: The same of studies.
SWEEP_FILES = ("case.toml", "sweep.csv", "sweep.nc", "report.html")
BIFURCATION_FILES = ("case.toml", "bifurcation.nc", "bifurcation.html")
#: File by which a directory is known -> all that it may hold.
_KINDS = {
    "summary.json": RESULT_FILES,
    "sweep.nc": SWEEP_FILES,
    "bifurcation.nc": BIFURCATION_FILES,
}


def write_file(path: Path, text: str) -> None:
    """Write a text file at once: it appears complete or not at all."""
    try:
        handle, name = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
    except OSError as error:
        raise InputError(_cannot(path, error)) from None
    partial = Path(name)
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as file:
            file.write(text)
        partial.chmod(0o666 & ~_umask())
        partial.replace(path)
    finally:
        partial.unlink(missing_ok=True)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def _cannot(path: Path, error: OSError) -> Problem:
    reason = error.strerror or str(error)
    return Problem(f"cannot write: {reason}", str(path), "", "Choose another place")


def check_target(
    target: Path, force: bool, *, remedy: str = "Choose another directory, or set force=True"
) -> None:
    """Refuse a directory that cannot or must not be written, before any work is done."""
    parent = target.absolute().parent
    if parent.exists() and not parent.is_dir():
        raise InputError(
            Problem("this is a file, not a directory", str(target.parent), "", "Choose another")
        )
    if not parent.is_dir():
        raise InputError(
            Problem("there is no such directory", str(target.parent), "", "Create it first")
        )
    if not os.access(parent, os.W_OK):
        raise InputError(
            Problem("no permission to write", str(target.parent), "", "Choose another place")
        )
    if not (target.exists() or target.is_symlink()):
        return
    if target.is_file():
        remedy = "Choose another name, or move the file away"
        raise OutputExistsError(Problem("a file is in the way", str(target), "", remedy))
    strange = _strangers(target)
    if strange:
        why = f"It is no result of tribodyn: it {strange}"
        problem = Problem("this exists already", str(target), why, "Choose another name")
        raise OutputExistsError(problem)
    if not force:
        raise OutputExistsError(Problem("this exists already", str(target), "", remedy))


def _strangers(target: Path) -> str:
    """Say what keeps an existing place from being replaced; empty if it is a result."""
    if target.is_symlink() or not target.is_dir():
        return "is not a directory"
    names = sorted(entry.name for entry in target.iterdir())
    allowed = next((files for mark, files in _KINDS.items() if mark in names), RESULT_FILES)
    others = [name for name in names if name not in allowed]
    if others:
        return f"holds {others[0]}"
    return "" if any(mark in names for mark in _KINDS) else "holds no summary.json"


@contextmanager
def new_directory(target: Path, *, force: bool = False) -> Iterator[Path]:
    """Fill a directory beside its place and move it there when it is complete."""
    check_target(target, force)
    place = target.absolute()
    try:
        partial = Path(tempfile.mkdtemp(prefix=f".{place.name}.", dir=place.parent))
    except OSError as error:
        raise InputError(_cannot(target, error)) from None
    try:
        yield partial
        partial.chmod(0o777 & ~_umask())
        check_target(target, force)
        _publish(partial, place)
    finally:
        shutil.rmtree(partial, ignore_errors=True)


def _publish(partial: Path, place: Path) -> None:
    """Move the complete directory to its place; what was there goes last."""
    if not place.exists():
        partial.rename(place)
        return
    old = Path(tempfile.mkdtemp(prefix=f".{place.name}.old.", dir=place.parent))
    try:
        place.rename(old / place.name)
        try:
            partial.rename(place)
        except BaseException:
            (old / place.name).rename(place)
            raise
    finally:
        shutil.rmtree(old, ignore_errors=True)
