"""Figures of the structure of the package: ``python tests/style/targets.py`` prints them."""

from __future__ import annotations

import ast
import sys
import threading
import warnings
from collections.abc import Callable
from functools import partial
from types import FrameType
from typing import Any, NamedTuple

from source_tree import PACKAGE, modules
from test_class_dispatch import questions
from weight import import_circles, measures

import tribodyn as td
from tribodyn.study.studies.needs import KINDS, PARTS, STUDIES

#: Cases whose calls in a second run are counted.
CASES = ("fzg-roughness", "two-stage-spur", "planetary-stage")


class Calls(NamedTuple):
    """Calls of functions of the package, and how many of them lead into another file."""

    total: int
    between_files: int


def count_calls(compute: Callable[[], Any]) -> Calls:
    """Count the calls of Python functions of the package."""
    counts, package = [0, 0], str(PACKAGE)

    def record(frame: FrameType, event: str, _: Any) -> None:
        file = frame.f_code.co_filename
        if event == "call" and file.startswith(package):
            counts[0] += 1
            caller = frame.f_back
            if caller is not None and caller.f_code.co_filename != file:
                counts[1] += caller.f_code.co_filename.startswith(package)

    threading.setprofile(record)
    sys.setprofile(record)
    try:
        compute()
    finally:
        sys.setprofile(None)
        threading.setprofile(None)
    return Calls(*counts)


def _names_gears(tree: ast.AST) -> bool:
    """Whether code names the pinion or the wheel."""
    for node in ast.walk(tree):
        text = getattr(node, "id", None) or getattr(node, "attr", None) or getattr(node, "arg", "")
        text = node.value if isinstance(node, ast.Constant) else text
        if isinstance(text, str) and len(text) < 60 and ("pinion" in text or "wheel" in text):
            return True
    return False


def main() -> None:
    """Print every figure."""
    every = modules()
    lines, files, without = measures(every)
    naming = sum(_names_gears(ast.Module(list(module.tree.body[1:]), [])) for module in every)
    refused = sum(
        kind not in need.kinds and not (need.of_mesh and kind in PARTS)
        for need in STUDIES.values()
        for kind in KINDS
    )
    rows = {
        "questions for the class of a case or result": sum(len(questions(m)) for m in every),
        "circles of imports": len(import_circles(every)),
        "code lines": lines.total(),
        "code lines of study": lines["study"],
        "files": files,
        "Any": without,
        "files that name pinion or wheel": naming,
        "studies that refuse a kind of case": f"{refused} of {len(STUDIES) * len(KINDS)}",
    }
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for name in CASES:
            case = td.load_case(name)
            td.run(case)
            calls = count_calls(partial(td.run, case))
            rows[f"calls of a second run of {name}"] = calls.total
            rows[f"calls of a second run of {name} into another file"] = calls.between_files
    for what, figure in rows.items():
        print(f"{figure:>12}  {what}")


if __name__ == "__main__":
    main()
