"""Checks of the shape of the code. Each takes a module and returns what is wrong with it."""

from __future__ import annotations

import ast
import re
import sys
from pathlib import Path

from source_tree import Module, listed_names

__all__ = [
    "broad_errors",
    "constants_bound_twice",
    "exports",
    "left_overs",
    "long_file",
    "long_functions",
    "prints",
    "star_imports",
    "top_level_imports",
]

LONGEST_FILE = 500
LONGEST_FUNCTION = 60

#: Third-party package -> parts of tribodyn whose files may import it at their top.
TOP_IMPORTS = {
    "numpy": None,
    "numba": None,
    "llvmlite": {"dynamics", "ehl"},
    "pydantic": {"study"},
    "pydantic_core": {"study"},
    "cyclopts": {"cli"},
    "rich": {"cli"},
    "dash": {"app"},
    "flask": {"app"},
    "werkzeug": {"app"},
}


def long_file(module: Module) -> list[str]:
    """A file is a room that one can look over."""
    lines = len(module.text.splitlines())
    return [f"{module.path}: {lines} lines"] if lines > LONGEST_FILE else []


def constants_bound_twice(module: Module) -> list[str]:
    """A constant has one value: modules that were joined may have had one name for two."""
    bound: dict[str, int] = {}
    for statement in module.tree.body:
        if isinstance(statement, ast.Assign):
            for node in (each for t in statement.targets for each in ast.walk(t)):
                if not isinstance(node, ast.Name) or not isinstance(node.ctx, ast.Store):
                    continue
                if node.id.isupper():
                    bound[node.id] = bound.get(node.id, 0) + 1
    return [
        f"{module.path}: {name} has {count} values" for name, count in bound.items() if count > 1
    ]


def long_functions(module: Module) -> list[str]:
    """A function is one thought; only compiled kernels may be long."""
    return [
        f"{module.path}:{function.node.lineno}: {function.name} has {function.code_lines} lines"
        for function in module.functions()
        if function.code_lines > LONGEST_FUNCTION and not function.compiled
    ]


def star_imports(module: Module) -> list[str]:
    """Every name can be traced to where it is made."""
    return [
        f"{module.path}:{node.lineno}: star import"
        for node in module.nodes
        if isinstance(node, ast.ImportFrom) and any(alias.name == "*" for alias in node.names)
    ]


def broad_errors(module: Module) -> list[str]:
    """No bare except, no swallowed exception, no `raise Exception`."""
    problems = []
    for node in module.nodes:
        if isinstance(node, ast.ExceptHandler):
            caught = ast.unparse(node.type) if node.type else ""
            idle = all(isinstance(step, ast.Pass | ast.Continue) for step in node.body)
            ends = node.body[-1]
            again = isinstance(ends, ast.Raise) and ends.exc is None  # cleans up, then goes on
            broad = caught == "" or (caught == "BaseException" and not again)
            if broad or (caught == "Exception" and idle):
                problems.append(f"{module.path}:{node.lineno}: except {caught or 'everything'}")
        if isinstance(node, ast.Raise) and node.exc is not None:
            raised = ast.unparse(node.exc).split("(")[0]
            if raised in {"Exception", "BaseException", "NotImplementedError"}:
                problems.append(f"{module.path}:{node.lineno}: raise {raised}")
    return problems


def left_overs(module: Module) -> list[str]:
    """Nothing is left for later, and no commented-out code stays."""
    marks = re.compile(r"#.*\b(TO" + r"DO|FIX" + r"ME|XX" + r"X|HACK)\b")
    return [
        f"{module.path}:{number}: {line.strip()}"
        for number, line in enumerate(module.text.splitlines(), 1)
        if marks.search(line)
    ]


def prints(module: Module) -> list[str]:
    """Only the command line writes to the terminal."""
    if module.package == "cli":
        return []
    return [
        f"{module.path}:{node.lineno}: print"
        for node in module.nodes
        if isinstance(node, ast.Call)
        and isinstance(node.func, ast.Name)
        and node.func.id == "print"
    ]


def exports(module: Module) -> list[str]:
    """Public names stand on the pages of the packages; a module has no list of its own."""
    page = module.path.endswith("__init__.py") or len(Path(module.path).parts) == 3
    listed = listed_names(module.tree) is not None
    return [f"{module.path}: __all__ outside of a page"] if listed and not page else []


def top_level_imports(module: Module) -> list[str]:
    """Heavy packages are imported where they are needed, not when a module is loaded."""
    problems = []
    for node in module.tree.body:
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            names = [node.module or ""]
        else:
            continue
        for name in names:
            package = name.split(".")[0]
            if package in sys.stdlib_module_names or package == "tribodyn":
                continue
            allowed = TOP_IMPORTS.get(package, set())
            if allowed is not None and module.package not in allowed:
                problems.append(f"{module.path}:{node.lineno}: imports {package} at its top")
    return problems
