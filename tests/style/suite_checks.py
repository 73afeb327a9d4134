"""Checks of the tests themselves: they can fail, and no clock decides."""

from __future__ import annotations

import ast
import re

from source_tree import Module

__all__ = ["clocks", "doubled_names", "idle_tests", "silent_skips"]

_CLOCKS = {
    "time": {"time", "perf_counter", "monotonic", "process_time", "thread_time", "time_ns"},
    "timeit": {"timeit", "repeat", "default_timer", "Timer"},
    "datetime": {"now", "utcnow", "today"},
}
_STATES = re.compile(r"^(assert|check|expect|raises|warns|fail|refuse)")


def clocks(module: Module) -> list[str]:
    """No test reads a clock: what a busy machine decides is measured in benchmarks only."""
    problems = []
    for node in module.nodes:
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            owner, names = node.value.id, {node.attr}
        elif isinstance(node, ast.ImportFrom):
            owner, names = node.module or "", {alias.name for alias in node.names}
        else:
            continue
        suffixes = {name.rsplit("_ns", 1)[0] for name in names} | names
        if suffixes & _CLOCKS.get(owner, set()) and not (
            owner == "datetime" and isinstance(node, ast.ImportFrom)
        ):
            problems.append(f"{module.path}:{node.lineno}: reads a clock")
    return problems


def _called(node: ast.Call) -> str:
    return ast.unparse(node.func).split(".")[-1].lstrip("_")


def idle_tests(module: Module) -> list[str]:
    """Every test states something that can be false."""
    problems = []
    for function in module.functions():
        if not function.node.name.startswith("test") or function.nested:
            continue
        inside = list(ast.walk(function.node))
        asserts = [node for node in inside if isinstance(node, ast.Assert)]
        idle = [a for a in asserts if isinstance(a.test, ast.Constant)]
        states = (a for a in inside if isinstance(a, ast.Call) and _STATES.match(_called(a)))
        if idle or not (asserts or any(states) or _accepts(function.node.name)):
            problems.append(f"{module.path}:{function.node.lineno}: {function.name} states nothing")
    return problems


def _accepts(name: str) -> bool:
    """Whether the test is that something is not refused; it fails by the error."""
    return bool(re.search(r"accept|allowed|inclusive|no_error|silent|does_not_warn", name))


def silent_skips(module: Module) -> list[str]:
    """A test that is skipped or expected to fail says why."""
    problems = []
    for node in module.nodes:
        if isinstance(node, ast.Attribute) and node.attr in {"skip", "xfail", "skipif"}:
            called = [
                call for call in module.nodes if isinstance(call, ast.Call) and call.func is node
            ]
            reasoned = called and any(
                keyword.arg == "reason" for keyword in called[0].keywords
            ) | bool(node.attr == "skip" and called[0].args)
            if not reasoned:
                problems.append(f"{module.path}:{node.lineno}: {node.attr} without a reason")
    return problems


def doubled_names(paths: list[str]) -> list[str]:
    """Test modules are collected by their bare name, which therefore must be unique."""
    names = [path.rsplit("/", 1)[-1] for path in paths]
    return sorted({path for path, name in zip(paths, names, strict=True) if names.count(name) > 1})
