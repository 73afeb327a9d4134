"""What all tests share: compliances of gears are kept in a folder of the tests, not of the user."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path


def pytest_configure() -> None:
    """Share one folder among all workers."""
    folder = Path(tempfile.gettempdir()) / "tribodyn-tests"
    os.environ.setdefault("TRIBODYN_CACHE_DIR", str(folder))
