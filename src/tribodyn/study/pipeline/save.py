"""Write files and directories whole or not at all, and never over something by accident."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from fnmatch import fnmatch
from pathlib import Path

from tribodyn.errors import InputError, OutputExistsError, Problem
from tribodyn.files import absolute_target, atomic_write, cannot_write, clear_leftovers

#: What a result directory holds; only such a directory may be replaced.
RESULT_FILES = ("case.toml", "summary.json", "mesh.nc", "response.nc", "report.html")
#: The same of studies.
SWEEP_FILES = ("case.toml", "sweep.csv", "sweep.nc", "report.html")
STUDY_FILES = ("case.toml", "best.toml", "study.nc", "friction.csv", "report.html")
BIFURCATION_FILES = ("case.toml", "bifurcation.nc", "bifurcation.html")
#: What the result of a machine holds besides, and what was written on request.
_OF_PARTS = ("motion.nc", "mesh-*.nc", "load-*.nc", "housing-*", "response.csv")
#: File by which a directory is known -> all that it may hold.
_KINDS = {
    "summary.json": RESULT_FILES,
    "sweep.nc": SWEEP_FILES,
    "bifurcation.nc": BIFURCATION_FILES,
    "study.nc": STUDY_FILES,
}


def write_file(path: Path, text: str) -> None:
    """Write a text file at once: it appears complete or not at all."""
    with atomic_write(path) as partial:
        partial.write_text(text, encoding="utf-8")


def check_target(
    target: Path, force: bool, *, remedy: str = "Choose another directory, or set force=True"
) -> None:
    """Refuse a directory that cannot or must not be written, before any work is done."""
    check_parent(target)
    if not (target.exists() or target.is_symlink()):
        return
    if target.is_file():
        remedy = "Choose another name, or move the file away"
        raise OutputExistsError("a file is in the way", str(target), "", remedy)
    strange = _strangers(target)
    if strange:
        why = f"It is no result of tribodyn: it {strange}"
        problem = Problem("this exists already", str(target), why, "Choose another name")
        raise OutputExistsError(problem)
    if not force:
        raise OutputExistsError("this exists already", str(target), "", remedy)


def check_parent(target: Path) -> None:
    """Refuse a directory whose parent does not exist or cannot be written to."""
    path = absolute_target(target)
    parent = path.parent
    try:
        path.lstat()
    except (FileNotFoundError, NotADirectoryError):
        pass
    except (OSError, ValueError) as error:
        raise InputError(cannot_write(target, error)) from None
    if parent.exists() and not parent.is_dir():
        raise InputError(
            "this is a file, not a directory", str(target.parent), "", "Choose another"
        )
    if not parent.is_dir():
        raise InputError("there is no such directory", str(target.parent), "", "Create it first")
    if not os.access(parent, os.W_OK):
        raise InputError("no permission to write", str(target.parent), "", "Choose another place")


def _strangers(target: Path) -> str:
    """Say what keeps an existing place from being replaced; empty if it is a result."""
    if target.is_symlink() or not target.is_dir():
        return "is not a directory"
    names = sorted(entry.name for entry in target.iterdir())
    allowed = next((files for mark, files in _KINDS.items() if mark in names), RESULT_FILES)
    parts = [name for name in names if any(fnmatch(name, each) for each in _OF_PARTS)]
    others = [name for name in names if name not in allowed and name not in parts]
    if others:
        return f"holds {others[0]}"
    return "" if any(mark in names for mark in _KINDS) else "holds no summary.json"


@contextmanager
def new_directory(target: Path, *, force: bool = False) -> Iterator[Path]:
    """Fill a directory next to its target and move it there when it is complete."""
    clear_leftovers(target)
    check_target(target, force)
    with atomic_write(target, folder=True) as place:
        yield place
        check_target(target, force)
