"""Sizes that may only shrink, and what was over them when they were set."""

from __future__ import annotations

import size_checks
from source_tree import modules, read

#: Inner docstrings of several lines: formulas of papers, pages of single files.
LONG_DOCSTRINGS = 117

#: Folder -> files that it had when the limit was set. Lower a number when a folder shrinks.
FOLDERS = {
    "src/tribodyn/dynamics": 22,
    "src/tribodyn/mesh": 26,
}

#: Inner function -> arguments that it had when the limit was set.
FUNCTIONS = {
    "basins": 9,
    "bifurcation": 11,
    "continuation": 9,
    "follow": 9,
    "march": 12,
    "number": 11,
}


def test_folders_can_be_listed() -> None:
    crowded = size_checks.crowded_folders([module.path for module in modules()], FOLDERS)
    assert not crowded, "\n".join(crowded)


def test_inner_functions_take_few_arguments() -> None:
    crowded = size_checks.crowded_functions(modules(), FUNCTIONS)
    assert not crowded, "\n".join(crowded)


def test_inner_names_have_short_docstrings() -> None:
    long = [place for m in modules() for place in size_checks.long_inner_docstrings(m)]
    assert len(long) <= LONG_DOCSTRINGS, "\n".join(long)


def test_a_new_crowded_folder_and_a_grown_one_are_detected() -> None:
    paths = [f"a/b/{number}.py" for number in range(17)]
    assert size_checks.crowded_folders(paths, {})
    assert not size_checks.crowded_folders(paths, {"a/b": 17})
    assert size_checks.crowded_folders([*paths, "a/b/more.py"], {"a/b": 17})
    assert not size_checks.crowded_folders([*paths[:16], "a/b/__init__.py"], {})


def test_a_function_of_many_arguments_is_detected() -> None:
    text = f"def f({', '.join('abcdefghi')}):\n    return a\n"
    assert size_checks.crowded_functions([read(text)], {})
    assert not size_checks.crowded_functions([read(text)], {"f": 9})
    assert not size_checks.crowded_functions([read(text, page='__all__ = ["f"]\n')], {})
    assert not size_checks.crowded_functions([read(f"@njit(cache=True)\n{text}")], {})


def test_a_long_docstring_off_the_page_is_detected() -> None:
    text = 'def f():\n    """One.\n\n    Two.\n    """\n'
    assert size_checks.long_inner_docstrings(read(text))
    assert not size_checks.long_inner_docstrings(read(text, page='__all__ = ["f"]\n'))
    assert size_checks.long_inner_docstrings(read('class Room:\n    """One.\n\n    Two."""\n'))
