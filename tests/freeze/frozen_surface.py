"""What users rely on, read off the package as plain data: names, keys, commands, codes."""

from __future__ import annotations

import contextlib
import importlib
import inspect
import io
import os
import re
import tomllib
from collections.abc import Iterator, Mapping
from importlib.resources import files
from pathlib import Path
from typing import Any

from tribodyn.aliases import RENAMED, Alias

PACKAGE = Path(str(files("tribodyn")))

_PARTS = """
analysis cases cli contact dynamics ehl errors exchange friction gear losses lubricant machine
measurement mesh nomenclature plot progress report signals stiffness study surrogate uncertainty
units variants
"""

#: Pages of public names.
PAGES = ("tribodyn", *(f"tribodyn.{part}" for part in _PARTS.split()))

#: What a class may do without a name: written by whoever uses its objects.
_SPECIAL = ("__call__", "__contains__", "__getitem__", "__iter__", "__len__")


def surface(names: Mapping[str, Mapping[str, Any]] | None = None) -> dict[str, Any]:
    """Everything by kind; ``names`` are searched on the pages besides those that they list."""
    return {
        "pages": {page: page_names(page, (names or {}).get(page, {})) for page in PAGES},
        "case keys": case_keys(),
        "commands": commands(),
        "quantities": quantities(),
        "summary": summary_names(),
        "figures": figures(),
        "deprecated names": dict(RENAMED),
        "warning codes": warning_codes(),
    }


def page_names(page: str, expected: Mapping[str, Any]) -> dict[str, Any]:
    """Names of one page and how each is used; a name that is gone is left out."""
    module = importlib.import_module(page)
    names = sorted({*getattr(module, "__all__", ()), *expected})
    return {name: described(getattr(module, name)) for name in names if hasattr(module, name)}


def described(entry: Any) -> dict[str, Any]:
    """How a public thing is used: parameters, members, keys or its value."""
    if hasattr(entry, "draw") and not inspect.isclass(entry):
        # a figure is called with what it draws, whatever its function calls that
        return {"options": {"parameters": parameters(entry.draw)[1:]}}
    if inspect.isclass(entry):
        return {"constructor": parameters(entry), "members": members(entry)}
    if callable(entry) and not _is_alias(entry):
        return {"parameters": parameters(entry)}
    if isinstance(entry, Mapping) or hasattr(entry, "names"):
        return {"keys": sorted(entry)}
    if isinstance(entry, int | float | str | tuple):
        return {"value": list(entry) if isinstance(entry, tuple) else entry}
    return {}


def _is_alias(entry: Any) -> bool:
    return hasattr(entry, "__origin__")


def parameters(function: Any) -> list[str]:
    """Parameters in order, each as ``kind name = default``; of none where there is no signature."""
    try:
        signature = inspect.signature(getattr(function, "py_func", function))
    except (TypeError, ValueError):
        return []
    return [_written(parameter) for parameter in signature.parameters.values()]


def _written(parameter: inspect.Parameter) -> str:
    text = f"{parameter.kind.description} {parameter.name}"
    if parameter.default is inspect.Parameter.empty:
        return text
    return f"{text} = {_plain(parameter.default)}"


def _plain(value: Any) -> str:
    """Text of a default that is the same in every process."""
    return re.sub(
        r" (object )?at 0x[0-9a-f]+", "", re.sub(r"<function (\w+).*>", r"\1", repr(value))
    )


def members(owner: type) -> dict[str, list[str] | None]:
    """Public methods with their parameters, properties and fields with None."""
    attributes: dict[str, list[str] | None] = {}
    for home in reversed(owner.__mro__):
        if home.__module__.partition(".")[0] != "tribodyn":
            continue
        for name in (*vars(home).get("__annotations__", {}), *vars(home)):
            if not name.startswith(("_", "model_config", "model_post_init")) or name in _SPECIAL:
                attributes[name] = _member(owner, name)
    return dict(sorted(attributes.items()))


def _member(owner: type, name: str) -> list[str] | None:
    value = inspect.getattr_static(owner, name, None)
    if isinstance(value, Alias):
        return _member(owner, value.new)
    return parameters(getattr(owner, name)) if _is_method(value) else None


def _is_method(value: Any) -> bool:
    return inspect.isfunction(value) or isinstance(value, classmethod | staticmethod)


def case_keys() -> dict[str, dict[str, Any]]:
    """Keys of the case file: unit, default and what a choice allows."""
    from tribodyn.study.case.reference import case_keys as keys

    return {
        key: {
            "kind": spec.kind,
            "unit": spec.unit,
            "default": default,
            "choices": sorted(spec.names()) if spec.names is not None else [],
        }
        for key, spec, default in keys()
    }


def commands() -> dict[str, list[str]]:
    """Commands with their arguments and options, as their help shows them."""
    names = _heads(_help(), r"[a-z]+")
    arguments = {"": [], **{name: [name] for name in names}}
    return {n: _heads(_help(*w), r"[A-Z]+|--[a-z-]+(?: [A-Z.]+)?") for n, w in arguments.items()}


def _help(*arguments: str) -> str:
    from tribodyn.cli import call

    text = io.StringIO()
    with contextlib.redirect_stdout(text), _wide_terminal():
        assert call([*arguments, "--help"]) == 0
    return text.getvalue()


@contextlib.contextmanager
def _wide_terminal() -> Iterator[None]:
    """Have help texts unbroken."""
    before = os.environ.get("COLUMNS")
    os.environ["COLUMNS"] = "200"
    try:
        yield
    finally:
        del os.environ["COLUMNS"]
        if before is not None:
            os.environ["COLUMNS"] = before


def _heads(text: str, pattern: str) -> list[str]:
    """First words of the lines of a help's boxes."""
    return sorted(re.findall(rf"^│ [* ]{{0,3}}({pattern})(?= |$)", text, re.MULTILINE))


def quantities() -> dict[str, list[str]]:
    """Quantities of the nomenclature with symbol, unit and unit shown."""
    from tribodyn.nomenclature import QUANTITIES

    return {n: [q.symbol, q.unit, q.display_unit] for n, q in QUANTITIES.items()}


def summary_names() -> dict[str, list[str]]:
    """Figures of a summary with unit and unit shown."""
    from tribodyn.study import SUMMARY

    return {name: [figure.unit, figure.display_unit] for name, figure in SUMMARY.items()}


def figures() -> dict[str, str]:
    """Names of the figures with their headings."""
    from tribodyn.plot import FIGURES

    return {name: FIGURES[name].heading for name in FIGURES}


def warning_codes() -> list[str]:
    """Codes of warnings that are explained and stand in the source."""
    explained: set[str] = set()
    for path in PACKAGE.rglob("*.toml"):
        explained |= set(tomllib.loads(path.read_text("utf-8")).get("warnings", {}))
    source = "\n".join(path.read_text("utf-8") for path in PACKAGE.rglob("*.py"))
    return sorted(code for code in explained if f'"{code}"' in source)


def losses(frozen: Any, current: Any, place: str = "") -> list[str]:
    """List what of the frozen data is gone or differs; additions are no loss."""
    if place.endswith(("/constructor", "/parameters")) or "/members/" in place:
        return _parameter_losses(frozen, current, place)
    if isinstance(frozen, dict) and isinstance(current, dict):
        lost = [f"{place}/{key}: gone" for key in frozen if key not in current]
        common = [key for key in frozen if key in current]
        return lost + [
            x for key in common for x in losses(frozen[key], current[key], f"{place}/{key}")
        ]
    if place.endswith(("/keys", "/choices", "warning codes")) or "commands/" in place:
        return [f"{place}: {item!r} is gone" for item in frozen if item not in current]
    return [] if frozen == current else [f"{place}: {frozen!r} became {current!r}"]


def _parameter_losses(frozen: list[str] | None, current: list[str] | None, place: str) -> list[str]:
    """Every call that worked still works: old parameters stay, new ones are optional and later."""
    if frozen is None or current is None:
        # a field may become a property or the other way round, but no method
        return [] if frozen == current else [f"{place}: {frozen} became {current}"]
    takes_any = any(text.startswith("variadic keyword") for text in current)
    lost = [
        f"{place}: {text!r} is gone"
        for text in frozen
        if text not in current and not (takes_any and text.startswith("keyword-only"))
    ]
    added = [text for text in current if text not in frozen]
    lost += [
        f"{place}: {t!r} is new and required" for t in added if "=" not in t and "var" not in t
    ]
    old, new = ([text for text in texts if "positional" in text] for texts in (frozen, current))
    if not lost and new[: len(old)] != old:
        lost.append(f"{place}: the order changed from {frozen} to {current}")
    return lost
