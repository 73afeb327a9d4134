"""What all tests share: compliances of gears are cached in a folder of the tests."""

from __future__ import annotations

import gc
import os
import random
import signal
import tempfile
from collections import Counter
from collections.abc import Callable, Generator, Iterator
from pathlib import Path
from typing import Any

import hypothesis
import pytest


def pytest_configure(config: pytest.Config) -> None:
    """Share one folder among all workers, and draw the same on every machine, slow or not."""
    hypothesis.settings.register_profile("same", derandomize=True, deadline=None)
    if not config.getoption("--hypothesis-profile"):
        hypothesis.settings.load_profile("same")
    # Tests share the cores already: threads of the matrix library would only wait for each other.
    for library in ("OPENBLAS", "OMP"):
        os.environ.setdefault(f"{library}_NUM_THREADS", "1")
    folder = Path(tempfile.gettempdir()) / "tribodyn-tests"
    os.environ.setdefault("TRIBODYN_CACHE_DIR", str(folder))
    # A job in the background of a shell may begin with Ctrl-C ignored, and so would all it starts.
    if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)


#: Folders whose files run on one worker, and the name of their scope. They share kernels, of which
#: the frozen figures need all that the pages compile, or the syntax trees of all files.
_TOGETHER = {
    "tests/docs/": "kernels", "tests/freeze/": "kernels", "tests/unit/dynamics/": "dynamics",
    "tests/style/": "style",
}  # fmt: skip
#: Folders whose tests need no compiled kernel, or few; the last is the longest.
_WITHOUT_KERNELS = tuple(
    f"tests/unit/{folder}/"
    for folder in (
        "gear", "lubricant", "friction", "contact", "arrays", "losses", "rating", "surrogate",
        "uncertainty", "measurement",
    )
)  # fmt: skip


def _scope(nodeid: str) -> str:
    """Tests that run one after the other on the same worker: those of a file or of folders."""
    file = nodeid.split("::", 1)[0]
    return next((_TOGETHER[folder] for folder in _TOGETHER if file.startswith(folder)), file)


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Order the files for parallel workers.

    The pages come first: they compile most kernels. Files that need none follow, so that no other
    worker compiles the same; then files with slow tests, so that none of them is last.
    """
    if not hasattr(config, "workerinput"):
        return
    slow = Counter(_scope(item.nodeid) for item in items if item.get_closest_marker("slow"))

    def rank(item: pytest.Item) -> tuple[int, int]:
        scope = _scope(item.nodeid)
        for place, folder in enumerate(_WITHOUT_KERNELS):
            if scope.startswith(folder):
                return 2, place
        return {"kernels": 0, "style": 1, "dynamics": 3}.get(scope, 4), -slow[scope]

    items.sort(key=rank)


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """Collect without garbage collections, a third of the time, and leave what is there out of all.

    They would look through half a million objects of modules and tests each time.
    """
    gc.disable()
    try:
        return (yield)
    finally:
        gc.collect()
        gc.freeze()
        gc.enable()


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Give each worker one scope after the other, in the order of the items."""
    from xdist.scheduler import LoadScopeScheduling

    class Together(LoadScopeScheduling):
        def _split_scope(self, nodeid: str) -> str:
            return _scope(nodeid)

    config.option.loadscopereorder = False
    return Together(config, log) if config.getvalue("dist") == "load" else None


def pytest_addoption(parser: pytest.Parser) -> None:
    """Options of the tests that draw their inputs."""
    parser.addoption("--runs", type=int, default=None, help="draws of each fuzz")
    parser.addoption("--seed", type=int, default=20251122, help="seed of the draws")


@pytest.fixture
def draws(request: pytest.FixtureRequest) -> Callable[[int], Iterator[random.Random]]:
    """Random sources: the number given by --runs, else a default; a failure prints its number."""

    def sources(default: int) -> Iterator[random.Random]:
        count, seed = (
            request.config.getoption("--runs") or default,
            request.config.getoption("--seed"),
        )
        for number in range(count):
            print(f"draw {number} of the seed {seed}")
            yield random.Random(f"{seed} {number}")

    return sources
