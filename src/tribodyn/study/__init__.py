"""The case and its result: user input, computation and results."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from tribodyn.aliases import names_of_stub
from tribodyn.arguments import guarded

#: Modules of the public names, which are loaded when they are first used.
_HOMES = names_of_stub(__file__)

#: Modules to load in place of the one that defines a class: those of its subclasses.
_LOADED = {
    "Case": "tribodyn.study.machine.case",
    "PairCase": "tribodyn.study.machine.case",
    "Result": "tribodyn.study.pipeline.result",
}

__all__ = sorted(_HOMES)


def __getattr__(name: str) -> Any:
    """Load a public name when it is first used."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(_LOADED.get(name, _HOMES[name])), name)
    return globals().setdefault(name, guarded(value, __name__))
