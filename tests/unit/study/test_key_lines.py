"""The scanner that finds the lines of keys in TOML text."""

from __future__ import annotations

import tomllib
from typing import Any

import pytest

from tribodyn.study.case.read import key_lines

TEXT = '''\
# [not.a.table]
title = "a # no comment, [no] = table" # comment
[gears] # comment with "quotes
"quoted key" = 'it''s'
pinion = { teeth = 16, inner = { deep = [1, 2], "x.y" = "}" } }
wheel.teeth = 24
list = [
  "a = 1", # b = 2
  [1, 2],
]
after = """
no = "key"
\\""" still
"""
literal = \'\'\'
[no.table]
\'\'\'
[ gears . extra ]
last = 1e3
'''.replace("'it''s'", "'its'")


def _flat(data: dict[str, Any], prefix: str = "") -> set[str]:
    keys: set[str] = set()
    for name, value in data.items():
        keys.add(f"{prefix}{name}")
        if isinstance(value, dict):
            keys |= _flat(value, f"{prefix}{name}.")
    return keys


def test_finds_exactly_the_keys_that_the_toml_reader_finds() -> None:
    lines = key_lines(TEXT)
    implied = {"gears.wheel"}
    assert set(lines) | implied == _flat(tomllib.loads(TEXT))


@pytest.mark.parametrize(
    ("key", "line"),
    [
        ("title", 2),
        ("gears", 3),
        ("gears.quoted key", 4),
        ("gears.pinion.inner.deep", 5),
        ("gears.pinion.inner.x.y", 5),
        ("gears.wheel.teeth", 6),
        ("gears.after", 11),
        ("gears.literal", 15),
        ("gears.extra.last", 19),
    ],
)
def test_lines(key: str, line: int) -> None:
    assert key_lines(TEXT)[key] == [line]


def test_repeated_keys_keep_both_lines() -> None:
    assert key_lines("a = 1\nb = 2\na = 3\n")["a"] == [1, 3]


@pytest.mark.parametrize("text", ["", "[", "a", "a = ", 'a = "', "a = {", "[[x", "= 3", "a = [1"])
def test_never_fails_on_broken_text(text: str) -> None:
    assert isinstance(key_lines(text), dict)
