"""Every warning that the code issues is explained, and no other."""

from __future__ import annotations

import ast
import re

from source_tree import Module, modules, read

from tribodyn.study.case.reference import warning_meanings

_CODE = re.compile(r"[a-z0-9]+(-[a-z0-9]+)*")


def codes(module: Module) -> set[str]:
    """First texts of warnings and of pairs of code and message."""
    issued = set()
    for node in module.nodes:
        first = None
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") in ("warn", "ModelWarning"):
            first = node.args[0]
        if isinstance(node, ast.Tuple) and len(node.elts) == 2:
            first = node.elts[0] if isinstance(node.elts[1], ast.JoinedStr) else None
        if isinstance(first, ast.Constant) and _CODE.fullmatch(str(first.value)):
            issued.add(str(first.value))
    return issued


def test_the_explained_warnings_are_those_that_are_issued() -> None:
    issued = {code for module in modules() for code in codes(module)}
    assert issued == set(warning_meanings())


def test_codes_are_detected() -> None:
    text = 'warn("thin-tip", "The tip is thin.")\nrows = [("undercut", f"{teeth} teeth")]\n'
    assert codes(read(text)) == {"thin-tip", "undercut"}
    assert codes(read('warn(code, "text")\npair = ("no code", f"{text}"), ("a", "b")\n')) == set()
