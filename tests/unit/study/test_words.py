"""Every warning and every choice of a model is explained, in the program and in its pages."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

import tribodyn
from tribodyn.cli import call
from tribodyn.study.case.reference import case_keys, choice_meanings, warning_meanings

_SOURCE = Path(tribodyn.__file__).parent
_PAGE = Path(__file__).resolve().parents[3] / "docs" / "command-line.md"
_CODE = re.compile(r"[a-z0-9]+(-[a-z0-9]+)*")


def _codes(tree: ast.AST) -> set[str]:
    """First texts of warnings and of pairs of code and message."""
    found = set()
    for node in ast.walk(tree):
        first = None
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") in ("warn", "ModelWarning"):
            first = node.args[0]
        if isinstance(node, ast.Tuple) and len(node.elts) == 2:
            first = node.elts[0] if isinstance(node.elts[1], ast.JoinedStr) else None
        if isinstance(first, ast.Constant) and _CODE.fullmatch(str(first.value)):
            found.add(str(first.value))
    return found


def test_the_explained_warnings_are_those_that_are_issued() -> None:
    issued = {
        code
        for path in _SOURCE.rglob("*.py")
        for code in _codes(ast.parse(path.read_text(encoding="utf-8")))
    }
    assert issued == set(warning_meanings())


def test_the_page_lists_every_warning_with_its_meaning() -> None:
    page = _PAGE.read_text(encoding="utf-8")
    for code, meaning in warning_meanings().items():
        assert f"| `{code}` | {meaning} |" in page


@pytest.mark.parametrize(
    "key", ["stiffness.model", "friction.law", "film.model", "dynamics.model", "solver.method"]
)
def test_every_choice_is_explained(key: str, capsys: pytest.CaptureFixture[str]) -> None:
    spec = {name: spec for name, spec, _ in case_keys()}[key]
    assert spec.names is not None
    for name in set(spec.names()) - {"none"}:
        assert call(["explain", name]) == 0
        assert choice_meanings()[name] in capsys.readouterr().out


def test_warning_codes_are_explained(capsys: pytest.CaptureFixture[str]) -> None:
    assert call(["explain", "thin-rim"]) == 0
    assert warning_meanings()["thin-rim"] in capsys.readouterr().out
    assert call(["explain", ""]) == 2
    assert "nothing to explain" in capsys.readouterr().err
    assert call(["explain", "backlsh"]) == 2
    remedy = capsys.readouterr().err.partition("Did you mean")[2].rstrip("?\n")
    words = [word.strip() for word in remedy.split(" or ")]
    assert "backlash" in words
    assert len(set(words)) == len(words)
