"""What a kernel calls has no machine code of its own: the first process computes as all later do.

A function that is compiled separately as well would be called in place of the kernel's own copy,
but only by the process that compiled it, and rounds in another way.
"""

from __future__ import annotations

import importlib
import pkgutil

import pytest
from numba.core.dispatcher import Dispatcher

from tribodyn.compiled.cache_lock import has_disk_cache
from tribodyn.compiled.jit import INNER_OPTIONS

_FOLDERS = "tribodyn.ehl._kernel", "tribodyn.dynamics._engine", "tribodyn.stiffness.loaded"


@pytest.mark.parametrize("folder", _FOLDERS)
def test_functions_of_kernels_are_inner_or_cached(folder: str) -> None:
    package = importlib.import_module(folder)
    modules = [
        importlib.import_module(f"{folder}.{module_info.name}")
        for module_info in pkgutil.iter_modules(package.__path__)
        if not module_info.ispkg
    ]
    compiled = {
        f"{module.__name__}.{name}": value
        for module in modules
        for name, value in vars(module).items()
        if isinstance(value, Dispatcher)
    }
    assert len(compiled) > 3
    inner = INNER_OPTIONS["pipeline_class"]
    others = {
        name
        for name, value in compiled.items()
        if value._compiler.pipeline_class is not inner and not has_disk_cache(value)
    }
    assert others == set()
