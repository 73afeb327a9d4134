"""Arguments of public functions, held against their annotations.

| Module | What it answers |
|---|---|
| `annotations` | Which values does an annotation ask for? |
| `reading` | Which argument is wrong, and what did a function stumble over? |
"""

from __future__ import annotations

from tribodyn.arguments.reading import guard, guarded

__all__ = ["guard", "guarded"]
