"""Code asks a case or a result what it has, not of which kind it is; what is left may not grow."""

from __future__ import annotations

import ast

import pytest
from source_tree import Module, modules, read

#: Classes of cases and results of one kind.
_KINDS = {
    *("Case", "PairCase", "PartsCase", "MachineCase", "PlanetaryCase"),
    *("Result", "PartsResult", "MachineResult", "PlanetaryResult"),
    *("LoadResult", "PlanetaryLoadResult", "StageResult"),
}
#: Questions that are left, in all of src. Lower it with each one that goes; never raise it.
MOST = 0


def questions(module: Module) -> list[str]:
    """``isinstance`` with the class of a case or a result."""
    return [
        f"{module.path}:{node.lineno}: {ast.unparse(node)}"
        for node in module.nodes
        if isinstance(node, ast.Call)
        and getattr(node.func, "id", "") in ("isinstance", "issubclass")
        and any(isinstance(each, ast.Name) and each.id in _KINDS for each in ast.walk(node.args[1]))
        and not _of_itself(module, node)
    ]


def _of_itself(module: Module, node: ast.Call) -> bool:
    """Whether it stands in a comparison of two of a class, which asks for the class itself."""
    return any(
        function.node.name == "__eq__"
        and function.node.lineno <= node.lineno <= (function.node.end_lineno or 0)
        for function in module.functions()
    )


def test_questions_for_the_kind_of_a_case_do_not_grow() -> None:
    left = [each for module in modules() for each in questions(module)]
    assert len(left) <= MOST, "\n".join(left)


@pytest.mark.parametrize(
    "text",
    [
        "isinstance(case, MachineCase)",
        "isinstance(case, Case | PartsCase)",
        "isinstance(each, (Result, Other))",
        "issubclass(kind, PlanetaryResult)",
    ],
)
def test_questions_are_detected(text: str) -> None:
    assert questions(read(f"x = {text}\n"))
    assert not questions(read("x = isinstance(value, Other)\n"))
