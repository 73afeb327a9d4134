"""Validation of the arguments of public functions by their annotations.

| Module | Content |
|---|---|
| `annotations` | values that an annotation accepts |
| `display` | one line for any object |
| `pages` | pages of public names, loaded when they are first used |
| `quantities` | numbers from objects of unit libraries |
| `reading` | validated calls, and messages about wrong arguments |
"""

from __future__ import annotations

from tribodyn.arguments.reading import guard, guarded

__all__ = ["guard", "guarded"]
