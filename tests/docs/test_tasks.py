"""Each task is solved by a script of at most twenty lines that the skill suffices to write."""

import ast
from pathlib import Path

import pytest
from tasks import TASKS

import tribodyn as td
from registries import as_before
from tribodyn.cookbook import recipes, write_skill


@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
@pytest.mark.parametrize("task", TASKS, ids=lambda task: task.question[:40])
def test_the_script_gives_the_answer(task, tmp_path: Path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert len(task.script.strip().splitlines()) <= 20
    names: dict[str, object] = {"td": td}
    with as_before():
        exec(task.script, names)
    expected = task.expected
    if isinstance(expected, float | list):
        expected = pytest.approx(expected, rel=1e-6)
    assert names["answer"] == expected


def test_the_skill_names_what_the_scripts_use(tmp_path: Path) -> None:
    text = (write_skill(tmp_path) / "SKILL.md").read_text("utf-8")
    text += "".join(recipe.script for recipe in recipes().values())
    used = {
        f"{node.value.id}.{node.attr}"
        for task in TASKS
        for node in ast.walk(ast.parse(task.script))
        if isinstance(node, ast.Attribute)
        and isinstance(node.value, ast.Name)
        and node.value.id == "td"
    }
    used |= {
        f"from {node.module}"
        for task in TASKS
        for node in ast.walk(ast.parse(task.script))
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("tribodyn")
    }
    assert sorted(name for name in used if name not in text) == []
