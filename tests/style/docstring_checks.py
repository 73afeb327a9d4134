"""Checks of the docstrings: they equal the signature, state units, and name their errors."""

from __future__ import annotations

import ast
import re

from source_tree import Function, Module, parse_entries

from tribodyn.cli import settings
from tribodyn.nomenclature import QUANTITIES
from tribodyn.units import parse

__all__ = [
    "missing_docstrings",
    "missing_doctests",
    "missing_raises",
    "missing_returns",
    "missing_units",
    "parameters_differ",
    "units_differ",
]

#: Parts that hold physics: every public function there has a doctest and units.
PHYSICS = {
    "gear",
    "contact",
    "lubricant",
    "ehl",
    "friction",
    "losses",
    "stiffness",
    "mesh",
    "dynamics",
    "analysis",
    "nonlinear",
    "signals",
    "machine",
    "faults",
    "rating",
}
#: Types of options of commands that bring their own text.
OPTIONS = {
    name
    for name, kind in vars(settings).items()
    if any(getattr(each, "help", None) for each in getattr(kind, "__metadata__", ()))
    or (isinstance(kind, type) and issubclass(kind, settings.Place))
}
#: Words before a quantity's name that leave its unit alone.
_PREFIXES = ("pinion_", "wheel_", "mean_", "minimum_", "maximum_", "rms_", "peak_", "nominal_")
_WORDED = re.compile(r"pure number|dimensionless|same unit|unit of|mixed|coefficient|\bphases?\b")
#: Names of arguments that take any quantity.
_ANY = {"values", "signal"}
#: Last words of names that are pure numbers.
_PURE = re.compile(
    r"(coefficient|ratio|share|factor|index|phase|phases|tolerance|order|exponent|variance"
    r"|multiplier|duty|cosine|sine|fraction|sense|sign|direction)s?$"
)


def _place(module: Module, function: Function) -> str:
    return f"{module.path}:{function.node.lineno}: {function.name}"


def missing_docstrings(module: Module) -> list[str]:
    """Modules, public classes and public functions say what they are."""
    problems = [] if ast.get_docstring(module.tree) else [f"{module.path}: no docstring"]
    problems += [
        f"{module.path}:{node.lineno}: {node.name}"
        for node in module.classes()
        if not node.name.startswith("_") and not ast.get_docstring(node)
    ]
    problems += [_place(module, f) for f in module.functions() if f.public and not f.docstring]
    return problems


def parameters_differ(module: Module) -> list[str]:
    """Documented parameters equal the signature, in order."""
    problems = []
    for function in module.functions():
        if not function.public:
            continue
        documented = list(parse_entries(function.docstring, "Parameters"))
        required = documented or _is_contract(module, function)
        wanted = [
            name for name in function.parameters if _annotation(function, name) not in OPTIONS
        ]
        if required and documented != wanted:
            problems.append(f"{_place(module, function)}: {documented} != {wanted}")
    for node in module.classes():
        documented = list(parse_entries(ast.get_docstring(node) or "", "Parameters"))
        fields = _constructor(node)
        if fields is None or node.name.startswith("_"):
            continue
        # fields of a base class are documented with the others, wherever they stand
        documented_fields = (
            [name for name in documented if name in fields] if node.bases else documented
        )
        if documented_fields != fields and (documented or node.name in module.surface):
            problems.append(f"{module.path}:{node.lineno}: {node.name}: {documented} != {fields}")
    return problems


def _annotation(function: Function, name: str) -> str:
    arguments = function.node.args
    every = (*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs)
    return next((ast.unparse(a.annotation) for a in every if a.arg == name and a.annotation), "")


def _is_contract(module: Module, function: Function) -> bool:
    """Whether the docstring must be complete: that of a name on a page of public names."""
    surface = function.owner.name if function.owner else function.node.name
    return not function.compiled and surface in module.surface


def _constructor(node: ast.ClassDef) -> list[str] | None:
    """Return the parameters of a dataclass or of an explicit constructor, else None."""
    decorators = [ast.unparse(decorator) for decorator in node.decorator_list]
    if any("dataclass" in text or text == "record" for text in decorators):
        return [
            item.target.id
            for item in node.body
            if isinstance(item, ast.AnnAssign)
            and isinstance(item.target, ast.Name)
            and not item.target.id.startswith("_")
            and "ClassVar" not in ast.unparse(item.annotation)
            and "init=False" not in (ast.unparse(item.value) if item.value else "")
        ]
    for item in node.body:
        if isinstance(item, ast.FunctionDef) and item.name == "__init__":
            return Function(item, item.name, node, nested=False).parameters
    return None


def missing_returns(module: Module) -> list[str]:
    """A function says what it returns where its annotation does not: shape, unit or meaning."""
    problems = []
    for function in module.functions():
        annotation = ast.unparse(function.node.returns) if function.node.returns else "None"
        # None, a text, a truth or an object of a class that says itself what it is
        silent = re.fullmatch(r"(?!Any|Index|Mask|Number|\w*Array)[A-Z]\w+|str|bool", annotation)
        special = function.node.name.startswith("__") or any(
            "property" in decorator or "overload" in decorator for decorator in function.decorators
        )
        section = re.search(r"^(Returns|Yields)\n-+$", function.docstring, re.MULTILINE)
        if (
            function.public
            and not (silent or special or section)
            and _is_contract(module, function)
        ):
            problems.append(_place(module, function))
    return problems


def missing_raises(module: Module) -> list[str]:
    """A public function that raises, or validates, has a Raises section."""
    problems = []
    for function in module.functions():
        raises = any(
            isinstance(node, ast.Raise)
            or (
                isinstance(node, ast.Call)
                and ast.unparse(node.func) in {"require_positive", "require_between"}
            )
            for node in ast.walk(function.node)
        )
        section = re.search(r"^Raises\n-+$", function.docstring, re.MULTILINE)
        dunder = function.node.name.startswith("__")
        on_screen = module.package == "cli"  # there the docstring is the help text
        excused = section or dunder or on_screen or not _is_contract(module, function)
        if function.public and raises and not excused:
            problems.append(_place(module, function))
    return problems


def missing_doctests(module: Module) -> list[str]:
    """Every function on a page of public names of the physics shows itself once."""
    return [
        _place(module, function)
        for function in module.functions()
        if module.package in PHYSICS
        and function.owner is None
        and function.node.name in module.surface
        and ">>>" not in function.docstring
    ]


def _entries(module: Module) -> list[tuple[str, str, str, str]]:
    """Return (place, parameter, entry, annotation) of everything documented in the module."""
    rows = []
    for function in module.functions():
        if function.public:
            arguments = function.node.args
            notes = {
                a.arg: ast.unparse(a.annotation) if a.annotation else ""
                for a in (*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs)
            }
            entries = parse_entries(function.docstring, "Parameters")
            rows += [
                (_place(module, function), name, entry, notes.get(name, ""))
                for name, entry in entries.items()
            ]
    for node in module.classes():
        notes = {
            item.target.id: ast.unparse(item.annotation)
            for item in node.body
            if isinstance(item, ast.AnnAssign) and isinstance(item.target, ast.Name)
        }
        for section in ("Parameters", "Attributes"):
            entries = parse_entries(ast.get_docstring(node) or "", section)
            place = f"{module.path}:{node.lineno}: {node.name}"
            rows += [(place, name, entry, notes.get(name, "")) for name, entry in entries.items()]
    return rows


def _stated(entry: str) -> list[str]:
    """Units in square brackets of an entry; ``[1]`` and ``[-]`` are the pure number."""
    texts = re.findall(r"\[([^\[\]]*)\]", entry)
    return ["" if text in {"1", "-"} else text for text in texts]


def _quantity(name: str) -> str | None:
    """Return the SI unit that the nomenclature gives to a name, None if it has none."""
    for prefix in ("", *_PREFIXES):
        if name.startswith(prefix) and name.removeprefix(prefix) in QUANTITIES:
            return QUANTITIES[name.removeprefix(prefix)].unit
    return None


def missing_units(module: Module) -> list[str]:
    """On the public pages of the physics, every dimensional number states its SI unit: [m]."""
    if module.package not in PHYSICS:
        return []
    public = {name for name in module.surface if not name.startswith("_")}
    numeric = re.compile(r"\b(float|NDArray\[np\.float64\]|ArrayLike|FloatArray|Array)\b")
    problems = []
    for place, name, entry, annotation in _entries(module):
        pure = name in _ANY or _quantity(name) == "" or _PURE.search(name)
        if place.rsplit(": ", 1)[-1].split(".")[0] not in public:
            continue
        has_unit = pure or _WORDED.search(entry) or _stated(entry) or "Callable" in annotation
        if numeric.search(annotation) and not has_unit:
            problems.append(f"{place}: {name} states no unit")
    return problems


def _same(stated: str, unit: str) -> bool:
    try:
        return not stated if not unit else parse(f"1 {stated}", unit) == 1.0
    except ValueError:
        return False


def units_differ(module: Module) -> list[str]:
    """Where a name is in the nomenclature, the docstring gives the nomenclature's unit."""
    problems = []
    for place, name, entry, annotation in _entries(module):
        unit = _quantity(name)
        mixed = "matrix" in entry or " or " in "".join(_stated(entry)) or "int" in annotation
        if unit is None or mixed or module.package not in PHYSICS:
            continue
        wrong = [text for text in _stated(entry) if not _same(text, unit)]
        if wrong and len(wrong) == len(_stated(entry)):
            problems.append(f"{place}: {name} [{wrong[0]}], nomenclature [{unit}]")
    return problems
