"""How functions are compiled that only compiled functions call: not by themselves.

Numba optimises every function and turns it into machine code where it is first called, and does
both again with each of its callers. Here that is left to the outermost one, the only one that runs.
"""

from __future__ import annotations

from typing import Any

from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder, Flags
from numba.core.compiler_machinery import register_pass
from numba.core.typed_passes import NativeLowering


class _Nowhere:
    """Where functions are that have no machine code."""

    def set_env(self, name: str, env: Any) -> None:
        pass


class _InnerLibrary(JITCodeLibrary):  # type: ignore[misc]
    """Instructions of a function as they were lowered, for its callers to link."""

    codegen = _Nowhere()

    def _optimize_final_module(self) -> None:
        pass

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        self._ensure_finalized()
        return 0


class _Flags(Flags):  # type: ignore[misc]
    """Flags of the compiler that are compared by what was set, not by all that could be."""

    _hash = hash(Flags())

    def __hash__(self) -> int:
        return self._hash

    def __eq__(self, other: object) -> bool:
        same = type(other) is _Flags and self._values == other._values
        return same or bool(super().__eq__(other))


@register_pass(mutates_CFG=True, analysis_only=False)
class _InnerLowering(NativeLowering):  # type: ignore[misc]
    _name = "inner_lowering"

    def run_pass(self, state: Any) -> bool:
        codegen = state.targetctx.codegen()
        state.library = _InnerLibrary(codegen, state.func_id.func_qualname)
        done: bool = super().run_pass(state)
        return done


class _InnerCompiler(CompilerBase):  # type: ignore[misc]
    def __init__(self, *given: Any) -> None:
        super().__init__(*given)
        self.state.flags = _Flags(self.state.flags)

    def define_pipelines(self) -> list[Any]:
        pipeline = DefaultPassBuilder.define_nopython_pipeline(self.state)
        pipeline.passes = [
            (_InnerLowering if step is NativeLowering else step, text)
            for step, text in pipeline.passes
        ]
        pipeline.finalize()
        # The last of the steps that change the code brings it in order for the ones that follow.
        pipeline._ENFORCING = False
        return [pipeline]


#: Options of such a function: no entry from Python or C either.
INNER_OPTIONS: dict[str, Any] = {
    "no_cpython_wrapper": True,
    "no_cfunc_wrapper": True,
    "pipeline_class": _InnerCompiler,
}
