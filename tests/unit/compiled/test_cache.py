"""Kernels are cached where a folder can be written, else compiled by each process."""

from __future__ import annotations

import pickle
from pathlib import Path

import numba
import pytest
from numba.core.caching import CompileResultCacheImpl

import tribodyn.compiled.cache as module
from tribodyn.cases import warm_up
from tribodyn.compiled import announcing_to, cache_lock
from tribodyn.compiled.cache import cached_njit
from tribodyn.errors import ComputationError


def _double(value: float) -> float:
    return 2.0 * value


def test_a_kernel_is_cached_on_disk() -> None:
    compiled = cached_njit(nogil=True)(_double)
    assert cache_lock.has_disk_cache(compiled)
    assert not cache_lock.is_cached(compiled)


@pytest.mark.parametrize("name", ["no_such_module\nMoved", "tribodyn.compiled\nMovedClass"])
def test_an_index_with_classes_that_have_moved_counts_as_empty(
    name: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))
    kernel = cached_njit(nogil=True)(_double)
    cache_file = kernel._cache._cache_file
    reference = f"c{name}\n.".encode()  # a pickle that refers to a class of another version
    path = Path(cache_file._index_path)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(pickle.dumps(cache_file._version) + reference)
    assert kernel(21.0) == 42.0
    assert cache_lock.is_cached(kernel)


def test_cached_code_is_loaded_without_all_that_numba_can_compile(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))
    assert cached_njit(nogil=True)(_double)(21.0) == 42.0
    kernel = cached_njit(nogil=True)(_double)
    monkeypatch.setattr(type(kernel.targetctx), "refresh", None)
    assert kernel(21.0) == 42.0
    with pytest.raises(TypeError):  # nothing is cached for whole numbers: the compiler needs all
        kernel(21)


def test_without_a_cache_folder_kernels_are_compiled_with_one_message(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(CompileResultCacheImpl, "_locator_classes", [])
    module._announce_missing_cache.cache_clear()
    messages: list[str] = []
    with announcing_to(messages.append):
        kernels = [cached_njit(nogil=True)(_double) for _ in range(2)]
    assert len(messages) == 1
    assert "NUMBA_CACHE_DIR" in messages[0]
    for kernel in kernels:
        assert kernel(21.0) == 42.0
        assert not cache_lock.has_disk_cache(kernel)
        assert cache_lock.is_cached(kernel)  # so that no process compiles it for another


def test_another_failure_is_not_taken_for_a_missing_folder(monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(*_: object, **__: object) -> None:
        raise RuntimeError("something else")

    monkeypatch.setattr(module.nb, "njit", fails)
    with pytest.raises(RuntimeError, match="something else"):
        cached_njit(nogil=True)(_double)


def test_warm_up_is_refused_without_a_cache_folder(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cache_lock, "has_disk_cache", lambda kernel: False)
    with pytest.raises(ComputationError, match="NUMBA_CACHE_DIR"):
        warm_up("fzg-roughness")
