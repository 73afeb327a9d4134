"""Arrays kept on disk between runs, in a folder of the user."""

from __future__ import annotations

import os
import sys
import tempfile
import zipfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from tribodyn.types import Array

#: Environment variable that names another folder.
VARIABLE = "TRIBODYN_CACHE_DIR"


def cache_folder() -> Path:
    """Folder of the kept arrays, which need not exist."""
    given = os.environ.get(VARIABLE)
    if given:
        return Path(given)
    if sys.platform == "win32":
        local = os.environ.get("LOCALAPPDATA")
        return (Path(local) if local else Path.home() / "AppData" / "Local") / "tribodyn" / "Cache"
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches" / "tribodyn"
    shared = os.environ.get("XDG_CACHE_HOME")
    return (Path(shared) if shared else Path.home() / ".cache") / "tribodyn"


def load_arrays(name: str) -> dict[str, Array] | None:
    """Read kept arrays."""
    try:
        with np.load(_path(name), allow_pickle=False) as file:
            return {key: np.asarray(file[key], dtype=float) for key in file.files}
    except (OSError, ValueError, KeyError, EOFError, RuntimeError, zipfile.BadZipFile):
        return None


def store_arrays(name: str, arrays: Mapping[str, Array]) -> bool:
    """Keep arrays, at once or not at all: another process never sees half a file."""
    path = _path(name)
    temporary = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, temporary = tempfile.mkstemp(dir=path.parent, suffix=".part")
        with os.fdopen(handle, "wb") as file:
            np.savez(file, **dict(arrays))  # type: ignore[arg-type]
        os.replace(temporary, path)
    except (OSError, RuntimeError):
        if temporary is not None:
            Path(temporary).unlink(missing_ok=True)
        return False
    return True


def _path(name: str) -> Path:
    return cache_folder() / "fe2d" / f"{name}.npz"
