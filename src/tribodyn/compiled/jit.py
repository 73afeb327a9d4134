"""Compiler options of functions that only compiled functions call.

Numba optimises every function and generates machine code where it is first called, and does both
again with each of its callers. These options leave both to the outermost kernel, the only one that
Python calls.
"""

from __future__ import annotations

from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder, Flags, StateDict
from numba.core.compiler_machinery import PassManager, register_pass
from numba.core.typed_passes import NativeLowering

from tribodyn.types import Tree


class _NoCodegen:
    """Code generator of functions without machine code of their own."""

    def set_env(self, name: str, env: object) -> None:
        pass


class _InnerLibrary(JITCodeLibrary):  # type: ignore[misc]
    """Unoptimised instructions of a function, which its callers link."""

    codegen = _NoCodegen()

    def _optimize_final_module(self) -> None:
        pass

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        self._ensure_finalized()
        return 0


class _Flags(Flags):  # type: ignore[misc]
    """Compiler flags, compared by those that are set rather than by all that exist."""

    _hash = hash(Flags())

    def __hash__(self) -> int:
        return self._hash

    def __eq__(self, other: object) -> bool:
        same = type(other) is _Flags and self._values == other._values
        return same or bool(super().__eq__(other))


@register_pass(mutates_CFG=True, analysis_only=False)
class _InnerLowering(NativeLowering):  # type: ignore[misc]
    _name = "inner_lowering"

    def run_pass(self, state: StateDict) -> bool:
        codegen = state.targetctx.codegen()
        state.library = _InnerLibrary(codegen, state.func_id.func_qualname)
        return bool(super().run_pass(state))


class _InnerCompiler(CompilerBase):  # type: ignore[misc]
    def __init__(self, *arguments: object) -> None:
        super().__init__(*arguments)
        self.state.flags = _Flags(self.state.flags)

    def define_pipelines(self) -> list[PassManager]:
        pipeline = DefaultPassBuilder.define_nopython_pipeline(self.state)
        pipeline.passes = [
            (_InnerLowering if step is NativeLowering else step, text)
            for step, text in pipeline.passes
        ]
        pipeline.finalize()
        # The last pass that changes the code restores the invariants for the passes after it.
        pipeline._ENFORCING = False
        return [pipeline]


#: Options of an inner function: no entry point from Python or C either.
INNER_OPTIONS: Tree = {
    "no_cpython_wrapper": True,
    "no_cfunc_wrapper": True,
    "pipeline_class": _InnerCompiler,
}
#: Options of one that allocates nothing either: it does not count references to its arrays, which
#: in a short function takes longer than its work.
LEAN_OPTIONS: Tree = {**INNER_OPTIONS, "_nrt": False}

#: Options of kernels. NaN stays detectable: neither "nnan" nor "ninf".
JIT: Tree = {"nogil": True, "fastmath": {"contract", "nsz"}, "error_model": "numpy"}
#: Of functions that only kernels call, of those without allocations, and of those called once.
INNER: Tree = {**JIT, **INNER_OPTIONS}
LEAN: Tree = {**JIT, **LEAN_OPTIONS}
ONCE: Tree = {**INNER, "inline": "always"}
