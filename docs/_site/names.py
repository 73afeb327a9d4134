"""Public names: the package that each is explained on, and its line."""

import importlib
import inspect
import pkgutil
import re
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

import tribodyn

#: Modules whose names are for our own use, and the commands, which have a page.
_INNER = {"cli", "compiled", "files", "interrupt", "stored"}


@cache
def packages() -> dict[str, ModuleType]:
    """Packages of public names."""
    modules = {"tribodyn": tribodyn}
    for info in pkgutil.iter_modules(tribodyn.__path__, "tribodyn."):
        short = info.name.partition(".")[2]
        if not short.startswith("_") and short not in _INNER:
            module = importlib.import_module(info.name)
            if getattr(module, "__all__", ()):
                modules[info.name] = module
    return modules


@cache
def homes() -> dict[tuple[str, str], str]:
    """Full name under which each name of each package is explained.

    It is that of the top level; else of the package in which the thing is defined; else of the
    first that has it.
    """
    full_names: dict[tuple[str, str], str] = {}
    first: dict[int, str] = {}
    places = [(name, public) for name, package in packages().items() for public in package.__all__]
    for name, public in sorted(places, key=lambda place: not _defined_in(*place)):
        value = getattr(packages()[name], public)
        if isinstance(value, ModuleType | str | int | float | tuple):
            full_names[name, public] = f"{name}.{public}"
        else:
            full_names[name, public] = first.setdefault(id(value), f"{name}.{public}")
    return full_names


def _defined_in(package: str, name: str) -> bool:
    module = getattr(getattr(packages()[package], name), "__module__", "") or ""
    return package == "tribodyn" or f"{module}.".startswith(f"{package}.")


def described(package: ModuleType, name: str) -> str:
    """First line of a contract, or the comment on a constant."""
    value = getattr(package, name)
    comment = _comments(package.__name__).get(name, "")
    documented = inspect.ismodule(value) or not is_constant(value)
    text = (inspect.getdoc(value) or "") if documented else ""
    text = text or comment
    if hasattr(value, "names") and not text:
        text = f"Named choices: {', '.join(f'``{each}``' for each in value.names())}."
    text = text or {"__version__": "Version of the package."}.get(name, "")
    first = text.partition("\n\n")[0].replace("\n", " ").replace("|", "\\|")
    return re.sub(r":[a-z]+:`~?([^`]*)`", r"`\1`", first).replace("``", "`")


def is_constant(value: Any) -> bool:
    """Whether a public name is a constant, whose own docstring is that of its type."""
    return not (inspect.isclass(value) or inspect.isroutine(value) or hasattr(value, "draw"))


@cache
def _comments(package: str) -> dict[str, str]:
    """Comments ``#:`` on the constants of a package."""
    comments: dict[str, str] = {}
    origin = Path(inspect.getfile(packages()[package]))
    files = origin.parent.rglob("*.py") if origin.name == "__init__.py" else [origin]
    for file in files:
        text = file.read_text("utf-8")
        for match in re.finditer(r"((?:^#: .*\n)+)^([A-Za-z]\w*)(?::| =)", text, re.MULTILINE):
            comments[match[2]] = re.sub(r"^#: ", "", match[1], flags=re.MULTILINE).strip()
    return comments
