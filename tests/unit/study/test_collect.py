"""Warnings are collected once each, and nothing else is swallowed."""

from __future__ import annotations

import warnings

import pytest

from tribodyn.errors import collected, warn


def test_each_warning_once_in_order() -> None:
    with collected() as caught:
        warn("a", "first")
        warn("b", "second")
        warn("a", "first")
    assert [(w.code, w.message) for w in caught] == [("a", "first"), ("b", "second")]


def test_warnings_survive_an_error() -> None:
    caught = []

    def fail() -> None:
        nonlocal caught
        with collected() as caught:
            warn("a", "first")
            raise ValueError

    with pytest.raises(ValueError):
        fail()
    assert [w.code for w in caught] == ["a"]


def test_other_warnings_pass() -> None:
    with pytest.warns(DeprecationWarning, match="old"), collected() as caught:
        warnings.warn("old", DeprecationWarning, stacklevel=1)
    assert caught == []
