"""Syntax of values that vary: a range ``400..3500 rpm:60``, or a list ``50,150,300 N*m``."""

from __future__ import annotations

import re
import tomllib
from typing import Any

_NUMBER = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*)")


def toml_value(text: str) -> Any:
    """Read a TOML value; any other text stays text."""
    try:
        value = tomllib.loads(f"value = {text}\n")
    except (ValueError, RecursionError):
        return text
    return value["value"] if list(value) == ["value"] else text


class UnreadError(ValueError):
    """Reason why a text cannot be read as values."""


def read_values(text: str) -> Any:
    """Read a range or a list."""
    return read_range(text) if ".." in text else read_list(text)


def read_range(text: str) -> tuple[Any, Any, int]:
    """Read both ends, the unit behind the last of them, and the number of points."""
    ends, colon, count = text.rpartition(":")
    if not colon:
        raise UnreadError("The number of points after a colon is missing")
    try:
        points = int(count)
    except ValueError:
        raise UnreadError(f'"{count}" is no whole number of points') from None
    low, _, high = (part.strip() for part in ends.partition(".."))
    if high.startswith("."):
        raise UnreadError("There are two dots between the ends of a range")
    first, last = _NUMBER.fullmatch(low), _NUMBER.fullmatch(high)
    if not (first and last):
        raise UnreadError(f'"{high if first else low}" is no number')
    unit = last.group(2)
    return (_with(first.group(1), first.group(2) or unit), _with(last.group(1), unit), points)


def read_list(text: str) -> list[Any]:
    """Read values between commas, with the unit behind the last of them."""
    items = [item.strip() for item in text.split(",")]
    if not all(items):
        raise UnreadError("A value between two commas is missing")
    parts = [_NUMBER.fullmatch(item) for item in items]
    last = parts[-1]
    if any(parts) and not all(parts):
        odd = items[[part is None for part in parts].index(True)]
        raise UnreadError(f'"{odd}" is no number')
    if last is None:
        return [toml_value(item) for item in items]
    return [_with(part.group(1), part.group(2) or last.group(2)) for part in parts if part]


def _with(number: str, unit: str) -> Any:
    """Return number and unit as text, or the bare number."""
    return f"{number} {unit}" if unit else toml_value(number)
