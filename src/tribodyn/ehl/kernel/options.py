"""How the kernels of the film are compiled."""

from __future__ import annotations

from typing import Any

#: NaN stays detectable: neither "nnan" nor "ninf". Only the outermost kernel is cached on disk.
JIT: dict[str, Any] = {
    "nogil": True,
    "fastmath": {"contract", "nsz", "arcp", "reassoc"},
    "error_model": "numpy",
}

#: For what only compiled functions call: no entry from C has to be compiled.
INNER: dict[str, Any] = {**JIT, "no_cfunc_wrapper": True}

#: For what not even a test calls from Python: no entry from there either, which is much to compile.
BURIED: dict[str, Any] = {**INNER, "no_cpython_wrapper": True}
