"""Sizes that may only shrink: files of a folder, arguments of a function, inner docstrings."""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterable, Mapping
from pathlib import Path

from source_tree import Function, Module

__all__ = ["crowded_folders", "crowded_functions", "long_inner_docstrings"]

MOST_FILES = 16
MOST_ARGUMENTS = 8


def crowded_folders(paths: Iterable[str], allowed: Mapping[str, int]) -> list[str]:
    """Folders of more modules than one can look over, unless they are known and did not grow."""
    counts = Counter(
        Path(path).parent.as_posix() for path in paths if not path.endswith("__init__.py")
    )
    return [
        f"{folder}: {count} files, at most {max(MOST_FILES, allowed.get(folder, 0))}"
        for folder, count in sorted(counts.items())
        if count > max(MOST_FILES, allowed.get(folder, 0))
    ]


def crowded_functions(modules: Iterable[Module], allowed: Mapping[str, int]) -> list[str]:
    """Inner functions with more arguments than one can remember, unless known and not grown."""
    return [
        f"{module.path}:{function.node.lineno}: {function.name} takes {count} arguments, at most "
        f"{max(MOST_ARGUMENTS, allowed.get(function.node.name, 0))}"
        for module in modules
        for function in module.functions()
        if (count := len(function.parameters))
        > max(MOST_ARGUMENTS, allowed.get(function.node.name, 0))
        and not (_on_page(module, function) or _for_kernels(function))
    ]


def _on_page(module: Module, function: Function) -> bool:
    name = function.owner.name if function.owner else function.node.name
    return not function.nested and name in module.surface


def _for_kernels(function: Function) -> bool:
    """Whether a function is compiled, or wraps a compiled function of many arguments."""
    typed = any(re.search(r"\b(overload|register_jitable)", text) for text in function.decorators)
    return function.compiled or typed or function.nested


def long_inner_docstrings(module: Module) -> list[str]:
    """Docstrings of more than one line of what is on no page of public names, and no help text."""
    if module.path.startswith("src/tribodyn/cli/"):
        return []  # which the command line shows
    problems = [
        f"{module.path}:{function.node.lineno}: {function.name}"
        for function in module.functions()
        if "\n" in function.docstring and not _on_page(module, function)
    ]
    return problems + [
        f"{module.path}:{node.lineno}: {node.name}"
        for node in module.classes()
        if "\n" in (ast.get_docstring(node) or "") and node.name not in module.surface
    ]
