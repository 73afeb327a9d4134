"""Names: those of a stub, of messages, a table of what replaces deprecated ones, and aliases.

An alias works like the new name and issues a ``DeprecationWarning``, which Python displays once for
each line of a script that uses it. Functions and classes that are decorated with
:func:`with_old_names` accept the names of the table.
"""

from __future__ import annotations

import functools
import re
import sys
import warnings
from collections.abc import Callable, Iterable, Mapping
from difflib import get_close_matches
from importlib import import_module
from pathlib import Path
from typing import Any, TypeVar, cast

__all__ = ["RENAMED", "Alias", "old_module", "warn_of_old_name", "with_old_names"]

_Named = TypeVar("_Named", bound=Callable[..., Any])
#: Modules between the use of an old name and its alias.
_INNER = "tribodyn.", "importlib"

#: New name by old: ``module``, ``module.name``, ``Class.attribute`` or ``function(parameter)``.
RENAMED: Mapping[str, str] = {
    "Axis.shown": "display_values",
    "Case.given": "user_input",
    "DataSet.where(kept)": "mask",
    "FrictionLaw.told": "evaluate",
    "GearInfluence.between(seen_radius)": "displaced_radius",
    "MachineCase.central": "get",
    "PaperComparison(asked)": "computation_count",
    "PaperComparison.asked": "computation_count",
    "Section.known": "section_keys",
    "Section.whole": "case_class",
    "Study(told)": "specification",
    "Study.told": "specification",
    "Sweep.asked": "size",
    "Sweep.shown": "displayed_figures",
    "TransientLineContact(kept)": "stored_instants",
    "TransientLineContact.kept": "stored_instants",
    "TransientLineContact.kept_time": "stored_time",
    "TribologicalContact.known": "require",
    "bifurcation(members)": "checkpoints",
    "compare_with_paper(members)": "checkpoints",
    "friction_experiment(members)": "checkpoints",
    "require_one_of(known)": "choices",
    "resonances(near)": "frequency_tolerance",
    "simulate(kept)": "recorded_cycles",
    "sweep(members)": "checkpoints",
    "tribodyn.checkpoints.Members": "Checkpoints",
    "tribodyn.machine.Kinematics": "PowerFlow",
    "tribodyn.members": "tribodyn.checkpoints",
    "write_bifurcation_report(found)": "diagram",
    "write_bifurcation_report(told)": "results",
    "write_study_report(told)": "results",
    "write_sweep_report(found)": "sweep",
}


class Alias:
    """Old name of an attribute, a property or a method of a class."""

    def __init__(self, owner: str, old: str, new: str) -> None:
        self.owner, self.old, self.new = owner, old, new

    def __get__(self, instance: object, owner: type) -> Any:
        """Warn, and return the value of the new name."""
        warn_of_old_name(f"{self.owner}.{self.old}", f"{self.owner}.{self.new}")
        return getattr(owner if instance is None else instance, self.new)


def closest(name: object, names: Iterable[str]) -> str:
    """Names for a message; of more than a dozen the ten closest to an unknown one."""
    listed = list(dict.fromkeys(names))
    if len(listed) <= 12:
        return ", ".join(listed) or "none"
    return f"{', '.join(get_close_matches(str(name), listed, 10, 0.0))} and {len(listed) - 10} more"


def with_old_names(named: _Named) -> _Named:
    """Give a class its old names of attributes, a function or constructor those of parameters."""
    if not isinstance(named, type):
        return cast("_Named", _accepting(named, named.__qualname__))
    for name, new in RENAMED.items():
        owner, _, old = name.partition(".")
        if owner == named.__name__ and "(" not in old:
            setattr(named, old, Alias(owner, old, new))
    if any(name.startswith(f"{named.__name__}(") for name in RENAMED):
        named.__init__ = _accepting(named.__init__, named.__name__)  # type: ignore[misc]
    return named


def _accepting(function: Callable[..., Any], name: str) -> Callable[..., Any]:
    """Let a function, or the constructor of the class ``name``, accept old names of parameters."""
    heads = ((old.partition("("), new) for old, new in RENAMED.items())
    new_names = {end[:-1]: new for (head, mark, end), new in heads if mark and head == name}

    @functools.wraps(function)
    def accepting_old_names(*args: object, **named: object) -> Any:
        for old in new_names.keys() & named.keys():
            if (new := new_names[old]) not in named:
                warn_of_old_name(f"{name}({old}=...)", f"{name}({new}=...)")
                named[new] = named.pop(old)
        return function(*args, **named)

    return accepting_old_names


def old_module(name: str) -> Callable[[str], Any]:
    """``__getattr__`` of a module that was renamed or holds renamed names."""

    def find(attribute: str) -> Any:
        home = RENAMED.get(name, name)
        new = RENAMED.get(f"{home}.{attribute}", attribute)
        if attribute.startswith("__") or (home, new) == (name, attribute):
            raise AttributeError(f"module {name!r} has no attribute {attribute!r}")
        value = getattr(import_module(home), new)
        warn_of_old_name(f"{name}.{attribute}", f"{home}.{new}")
        return value

    return find


def warn_of_old_name(old: str, new: str) -> None:
    """Warn of an old name at the line outside the package that uses it."""
    frame = sys._getframe(1)
    while frame.f_back is not None and frame.f_globals["__name__"].startswith(_INNER):
        frame = frame.f_back
    warnings.warn_explicit(
        f"tribodyn: {old} is deprecated; use {new}",
        DeprecationWarning,
        frame.f_code.co_filename,
        frame.f_lineno,
        frame.f_globals["__name__"],
        frame.f_globals.setdefault("__warningregistry__", {}),
    )


def names_of_stub(page: str) -> dict[str, str]:
    """Module of each public name of a page, as the stub of the page imports it.

    The stub ``__init__.pyi`` is the only list of the names: editors and type checkers read it, and
    so does the page when it is imported. Each name has a statement
    ``from MODULE import NAME as NAME`` of its own.

    Parameters
    ----------
    page : str
        Path of the page, its ``__file__``.

    Returns
    -------
    dict of str to str
        Module by name.
    """
    stub = Path(page).with_suffix(".pyi").read_text(encoding="utf-8")
    imports = re.findall(r"from (tribodyn[\w.]*) import \(?\s*(\w+) as", stub)
    return {name: module for module, name in imports}
