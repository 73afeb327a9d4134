"""Kernels are kept where a folder takes them, and compiled by each process where none does."""

from __future__ import annotations

import pytest
from numba.core.caching import CompileResultCacheImpl

import tribodyn.compiled.kept as module
from tribodyn.cases import warm_up
from tribodyn.compiled import agreement, telling
from tribodyn.compiled.kept import kept
from tribodyn.errors import ComputationError


def _double(value: float) -> float:
    return 2.0 * value


def test_a_kernel_is_kept_on_the_disk() -> None:
    compiled = kept(nogil=True)(_double)
    assert agreement.is_kept(compiled)
    assert not agreement.cached(compiled)


def test_without_a_folder_a_kernel_is_compiled_and_that_is_told_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(CompileResultCacheImpl, "_locator_classes", [])
    module._tell_that_nothing_is_kept.cache_clear()
    told: list[str] = []
    with telling(told.append):
        kernels = [kept(nogil=True)(_double) for _ in range(2)]
    assert len(told) == 1
    assert "NUMBA_CACHE_DIR" in told[0]
    for kernel in kernels:
        assert kernel(21.0) == 42.0
        assert not agreement.is_kept(kernel)
        assert agreement.cached(kernel)  # so that no process compiles it for another


def test_another_failure_is_not_taken_for_a_missing_folder(monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(*_: object, **__: object) -> None:
        raise RuntimeError("something else")

    monkeypatch.setattr(module.nb, "njit", fails)
    with pytest.raises(RuntimeError, match="something else"):
        kept(nogil=True)(_double)


def test_nothing_is_compiled_ahead_that_cannot_be_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(agreement, "is_kept", lambda kernel: False)
    with pytest.raises(ComputationError, match="NUMBA_CACHE_DIR"):
        warm_up("fzg-roughness")
