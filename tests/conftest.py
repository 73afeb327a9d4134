"""What all tests share: compliances of gears are kept in a folder of the tests, not of the user."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

import numpy as np
import pytest


def pytest_configure() -> None:
    """Share one folder among all workers."""
    folder = Path(tempfile.gettempdir()) / "tribodyn-tests"
    os.environ.setdefault("TRIBODYN_CACHE_DIR", str(folder))


def pytest_addoption(parser: pytest.Parser) -> None:
    """Take the size and the seed of the tests that draw their inputs."""
    parser.addoption("--runs", type=int, default=None, help="random inputs of each such test")
    parser.addoption("--seed", type=int, default=0, help="where the random inputs begin")


@pytest.fixture
def runs(request: pytest.FixtureRequest) -> int | None:
    """Random inputs asked for; None in the gate."""
    asked = request.config.getoption("--runs")
    return None if asked is None else int(asked)


@pytest.fixture
def generator(request: pytest.FixtureRequest) -> np.random.Generator:
    """Generator of random inputs."""
    return np.random.default_rng(request.config.getoption("--seed"))
