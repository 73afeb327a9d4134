"""Processes that share one cache: a kernel that one of them compiles the others wait for."""

from __future__ import annotations

import threading
import time
from pathlib import Path

import pytest

from tribodyn.compiled import cache_lock as module
from tribodyn.compiled.cache_lock import CacheLock, ElsewhereError, locked, use_lock


class _Cache:
    """Stand-in for the disk cache of a kernel."""

    def __init__(self) -> None:
        self.code: dict[str, str] = {}

    def load_overload(self, signature: str, context: object) -> str | None:
        return self.code.get(signature)

    def save_overload(self, signature: str, data: str) -> None:
        self.code[signature] = data


class _Kernel:
    def __init__(self, cache: _Cache) -> None:
        self._cache, self.py_func, self.messages = cache, len, []
        use_lock(self, lambda: self.messages.append("waits"))

    def wanted(self, signature: str, data: str) -> str:
        """What a dispatcher does: load, or compile and save."""
        code = self._cache.load_overload(signature, None)
        if code is not None:
            return code
        self._cache.save_overload(signature, data)
        return data


def test_whoever_comes_first_compiles_and_the_other_waits_for_it(tmp_path: Path) -> None:
    kernel = _Kernel(_Cache())
    with locked(CacheLock(tmp_path)):
        assert kernel.wanted("a", "first") == "first"
        kernel._cache.code.clear()
        assert kernel.wanted("a", "again") == "again"  # its own mark does not bind it
        kernel._cache.code.clear()
    with pytest.raises(ElsewhereError), locked(CacheLock(tmp_path)):
        kernel.wanted("a", "of another that waits for nobody")

    def writes_later() -> None:
        time.sleep(0.2)
        kernel._cache.code["a"] = "of the first"

    writer = threading.Thread(target=writes_later)
    writer.start()
    with locked(CacheLock(tmp_path, lambda: True)):
        assert kernel.wanted("a", "of the second") == "of the first"
        assert kernel.messages
        assert kernel.wanted("b", "of the second") == "of the second"  # nobody came before
    writer.join()


def test_kernels_of_an_ended_process_are_compiled_by_the_waiting_one(tmp_path: Path) -> None:
    kernel = _Kernel(_Cache())
    assert not CacheLock(tmp_path).retry_load("builtins.len a", lambda: None)
    with locked(CacheLock(tmp_path, lambda: False)):
        assert kernel.wanted("a", "of the second") == "of the second"


def test_an_interruption_ends_the_wait(tmp_path: Path) -> None:
    assert not CacheLock(tmp_path).retry_load("builtins.len a", lambda: None)

    def interrupted() -> bool:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt), locked(CacheLock(tmp_path, interrupted)):
        _Kernel(_Cache()).wanted("a", "of the second")


def test_files_are_written_one_after_the_other(tmp_path: Path) -> None:
    inside, most = [], []

    def write() -> None:
        with CacheLock(tmp_path).writing():
            inside.append(1)
            most.append(len(inside))
            time.sleep(0.02)
            inside.pop()

    threads = [threading.Thread(target=write) for _ in range(5)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert most == [1] * 5
    assert not list(tmp_path.iterdir())


def test_a_writer_that_was_killed_holds_nobody_for_long(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "_WRITE_TIMEOUT", 0.1)
    (tmp_path / "writing").touch()
    with CacheLock(tmp_path).writing():
        pass
    assert not list(tmp_path.iterdir())


def test_a_place_that_takes_no_marks_binds_nobody(tmp_path: Path) -> None:
    lost = CacheLock(tmp_path / "nowhere", lambda: True)
    assert not lost.retry_load("builtins.len a", lambda: None)
    with lost.writing():
        pass
