"""One line for any object: class and fields, long values cut."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import fields
from typing import Any

import numpy as np

#: Most characters of a value, and of a line.
_VALUE, _LINE = 240, 400


def brief(value: Any) -> str:
    """Text of a value in one line; of a long array its shape."""
    if isinstance(value, np.ndarray) and value.size > 8:
        return f"array({' x '.join(map(str, value.shape))})"
    return _cut(" ".join(repr(value).split()), _VALUE)


def _cut(text: str, most: int) -> str:
    return text if len(text) <= most else f"{text[: most - 3]}..."


def one_line(kind: type, values: Iterable[tuple[str, Any]]) -> str:
    """Class and named values in one line."""
    text = ", ".join(f"{name}={brief(value)}" for name, value in values)
    return f"{kind.__qualname__}({_cut(text, _LINE)})"


def fields_in_one_line(self: Any) -> str:
    """One line."""
    names = (each.name for each in fields(self) if each.repr)
    return one_line(type(self), ((name, getattr(self, name)) for name in names))
