"""Nothing that users rely on is gone or works differently; additions are welcome."""

from __future__ import annotations

from typing import Any

import pytest
from frozen_surface import losses, surface
from write_snapshot import read


@pytest.fixture(scope="module")
def current() -> dict[str, Any]:
    return surface(read("surface")["pages"])


@pytest.mark.parametrize("kind", list(read("surface")))
def test_nothing_is_gone(kind: str, current: dict[str, Any]) -> None:
    lost = losses(read("surface")[kind], current[kind], kind)
    assert not lost, "\n".join(lost)


@pytest.mark.parametrize(
    ("frozen", "current"),
    [
        ({"a": {}}, {}),
        ({"keys": ["a", "b"]}, {"keys": ["b", "c"]}),
        ({"value": [1, 2]}, {"value": [1, 2, 3]}),
        ({"parameters": ["keyword-only a = 1"]}, {"parameters": ["keyword-only a = 2"]}),
        ({"parameters": ["keyword-only a = 1"]}, {"parameters": ["keyword-only a"]}),
        ({"parameters": []}, {"parameters": ["keyword-only a"]}),
        (
            {"parameters": ["positional or keyword a", "positional or keyword b"]},
            {"parameters": ["positional or keyword b", "positional or keyword a"]},
        ),
        (
            {"parameters": ["positional or keyword a"]},
            {"parameters": ["positional or keyword c = 1", "positional or keyword a"]},
        ),
        ({"members": {"run": []}}, {"members": {"run": None}}),
    ],
)
def test_losses_are_detected(frozen: dict[str, Any], current: dict[str, Any]) -> None:
    assert losses(frozen, current)
    assert not losses(frozen, frozen)


def test_additions_are_no_losses() -> None:
    frozen = {"f": {"parameters": ["positional or keyword a"]}, "k": {"keys": ["a"]}}
    more = {
        "f": {"parameters": ["positional or keyword a", "keyword-only b = 1"]},
        "g": {},
        "k": {"keys": ["a", "b"]},
    }
    assert not losses(frozen, more)
