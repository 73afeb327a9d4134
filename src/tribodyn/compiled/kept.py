"""Kernels that are kept on the disk, wherever a folder takes them."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numba as nb

from tribodyn.compiled import tell


def kept(**options: Any) -> Callable[[Any], Any]:
    """Compile a function at its first call and keep what was compiled, if a folder takes it."""

    def compiled(function: Any) -> Any:
        try:
            return nb.njit(cache=True, **options)(function)
        except RuntimeError as error:
            # Neither beside the sources nor in the home directory: a container of another user.
            if "no locator" not in str(error):
                raise
            _tell_that_nothing_is_kept()
            return nb.njit(**options)(function)

    return compiled


@cache
def _tell_that_nothing_is_kept() -> None:
    tell(
        "no folder takes compiled kernels, so that every process compiles them anew: set "
        "NUMBA_CACHE_DIR to one that can be written"
    )
