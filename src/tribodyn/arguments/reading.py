"""Public functions that check their arguments against their annotations.

A page of public names ends with :func:`guard`. Its functions, constructors and methods then refuse
values of another kind than they are annotated with: texts, truth values, complex numbers, numbers
that are NaN. If a function fails for accepted values, the failure is reported as an error of the
package, with the wrong argument where one can be identified. Calls from within the package are not
checked.
"""

from __future__ import annotations

import builtins
import functools
import inspect
import re
import sys
import sysconfig
import traceback
import types
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import fields
from importlib import import_module
from itertools import chain
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from tribodyn import progress
from tribodyn.arguments.annotations import (
    ANYTHING,
    UnitRefusedError,
    ValueRefusedError,
    Wanted,
    wanted,
    without_units,
)
from tribodyn.errors import Argument, ComputationError, InputError, Problem, shortened
from tribodyn.types import ByName, Tree

#: Most characters of a value, and of a line.
_VALUE, _LINE = 240, 400


def brief(value: object) -> str:
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


_FUNCTIONS = (types.FunctionType, functools._lru_cache_wrapper)
_PATHS = map(sysconfig.get_path, ("stdlib", "purelib", "platlib"))
#: Folders of traceback frames that are not user code.
_HOMES = (str(Path(__file__).parents[1]), *_PATHS, "<")
_PACKAGES = re.compile(r"[/\\](site|dist)-packages[/\\]")
#: Parameters of functions that write files.
_WRITES = {"path", "directory", "folder", "place", "force"}
#: What NumPy does about numbers out of range, whatever the user's script has set: what is computed
#: here rounds to zero where it does so on purpose.
_USUAL: Tree = {"divide": "warn", "over": "warn", "under": "ignore", "invalid": "warn"}
_REFUSED = (TypeError, ValueError, OverflowError)
#: Packages whose values without an annotation are those of cases, which read units themselves.
_CASES = re.compile(r"tribodyn\.(study|exchange|cases|variants|plot|report)\b")
#: Iterators that are used up by one reading.
_ONCE = (types.GeneratorType, map, filter, zip)
#: Name for the arguments that no parameter names.
_OTHERS = "**"
#: Modules of the package, which call guarded functions without checks.
_INSIDE = f"{__name__.partition('.')[0]}."


class _Names(Tree):
    """Names of modules, those that are imported for type checks alone among them."""

    def __init__(self, modules: Iterable[str]) -> None:
        self.modules = [sys.modules[module] for module in modules if module in sys.modules]

    def __missing__(self, name: str) -> Any:
        for module in self.modules:
            if name in vars(module):
                return vars(module)[name]
        for module in self.modules:
            imports = r"from ([\w.]+) import (\([^)]*\)|.+)"
            for home, names in re.findall(imports, inspect.getsource(module)):
                if name in re.findall(r"\w+", names):
                    return getattr(import_module(home), name)
        return vars(builtins)[name]


def _makes(function: object) -> bool:
    return getattr(function, "__name__", "") in ("__init__", "__new__")


def _parameters(function: Any, owner: type | None, strict: bool = False) -> dict[str, Wanted]:
    """Checks of the parameters of a function by name."""
    homes = [each.__module__ for each in getattr(owner, "__mro__", [])]
    names = _Names([*homes, getattr(function, "__module__", "")])
    wants, makes = {}, _makes(function)
    reads_units = _CASES.match(getattr(function, "__module__", "") or "")
    documents = [*owner.__mro__[:-1]] if owner and makes else [function]
    for name, parameter in inspect.signature(function).parameters.items():
        hint = getattr(parameter.annotation, "__forward_arg__", parameter.annotation)
        hint = eval(hint, {}, names) if isinstance(hint, str) else hint
        # Records may hold what is not there; functions take what a quantity may be, unless their
        # default or their documentation speaks of more.
        default, entry = parameter.default, _entry(function, name)
        ends = not (isinstance(default, float) and not np.isfinite(default))
        sized = 0 if makes or not ends or re.search("infinit|NaN", entry) else 1 + (owner is None)
        none = hint is inspect.Parameter.empty
        want = ANYTHING if none else wanted(hint, sized, strict, several=not makes)
        unit = next((u for u in (_unit(each, name) for each in documents) if u is not None), None)
        if parameter.kind is parameter.VAR_KEYWORD:
            name, want, unit = _OTHERS, ANYTHING, None
        written = str(parameter.annotation)
        options = re.search(r"\[str, (Any|object)\]|\b(ByName|Options|Tree)\b", written)
        anything = none or bool(options or re.search(r"\b(Any|object)\b", written))
        unit = None if options else unit  # they have units of their own
        cases = reads_units and anything
        if name not in ("self", "cls") and not (cases and not unit):
            want = _with_unit(want, unit, inside=not cases)
        wants[name] = want
    return wants


def _with_unit(want: Wanted, unit: str | None, inside: bool) -> Wanted:
    """Check that first converts quantities to the unit of the parameter."""

    def read(value: object) -> Any:
        return want.read(without_units(value, unit, inside))

    return want._replace(read=read)


#: Markup of documentation, which messages do not have.
_MARKUP = re.compile(r"(?::\w+:)?`+~?([^`]+)`+")
_SECTION = re.compile(r"^Parameters\n-+\n(.*?)(?=\n\n\S[^\n]*\n---|\Z)", re.DOTALL | re.MULTILINE)
_ENTRY = re.compile(r"^((?:\w+, )*\w+)(?: : (.*))?((?:\n(?: +.*)?)*)", re.MULTILINE)
#: Units are in brackets; a pure number is written 1 or -.
_BRACKETS = re.compile(r"\[([^\[\]]+)\]")


class _Entry(NamedTuple):
    """What a docstring says of a parameter."""

    names: tuple[str, ...] = ()
    kind: str = ""
    text: str = ""


@functools.cache
def _entries(documented: object) -> dict[str, _Entry]:
    """Entries of the parameters in a docstring."""
    entries: dict[str, _Entry] = {}
    section = _SECTION.search(inspect.getdoc(documented) or "")
    for names, kind, text in _ENTRY.findall(section[1] if section else ""):
        several = tuple(names.split(", "))
        for name in several:
            entries.setdefault(name, _Entry(several, kind, re.sub(r"\s+", " ", text).strip()))
    return entries


def _entry(documented: object, name: str) -> str:
    entry = _entries(documented).get(name, _Entry())
    return _MARKUP.sub(r"\1", f"{entry.kind}|{entry.text}")


def _unit(documented: object, name: str) -> str | None:
    """Documented unit of a parameter; empty for a pure number, None where none is known."""
    entry = _entries(documented).get(name)
    if entry is None:
        return None
    other = re.search(r"\b(?:[Aa]s|for) (?:in|for|of)? ?:\w+:`~?\.?([\w.]+)`", entry.text)
    if other and not _BRACKETS.search(entry.kind):
        page = ".".join(getattr(documented, "__module__", "").split(".")[:2])
        home, _, target = other[1].rpartition(".")
        module = sys.modules.get(home or page)
        if (unit := _unit(getattr(module, target, None), name)) is not None:
            return unit
    units = _BRACKETS.findall(entry.kind) or _BRACKETS.findall(entry.text)
    if len(units) > 1 and len(units) != len(entry.names):
        units = units[:1] if len(entry.names) == 1 else []
        if not units:
            return None
    if not units:
        return None if re.search(r"\bunits?\b", entry.text) else ""
    unit = units[entry.names.index(name) if len(units) > 1 else 0]
    return "" if unit in ("1", "-") else unit


def _fault(documented: object, name: str, value: object, want: Wanted) -> Problem | None:
    """Problem of one argument, with documented unit and meaning; None if it is valid."""
    try:
        want.read(value)
    except ValueRefusedError as refused:
        why = str(refused)
    except _REFUSED:
        why = f"Wanted: {want.description}"
    else:
        return None
    unit, text = _unit(documented, name), _entry(documented, name).partition("|")[2]
    meaning = re.split(r"[.;:](?:\s|$)", re.sub(r" \[[^\[\]]+\]", "", text))[0]
    remedy = f"Give {name}{f' in {unit}' if unit else ''}{': ' * bool(meaning)}{meaning}"
    if isinstance(value, str) and "number" in want.description:
        remedy += f". Functions take numbers in {unit or 'SI units'}, not texts"
    shown_value = f'"{value[:60]}"' if isinstance(value, str) else _short_repr(value)
    owner = f"{documented.__name__}." if isinstance(documented, type) else ""
    return Problem(f"{name} = {shown_value}", Argument(owner + name), why, remedy)


def _short_repr(value: object) -> str:
    try:
        return shortened(repr(value), 60)
    except Exception:  # __repr__ of a foreign object may fail
        return f"an object of the class {type(value).__name__}"


def _is_own(error: Exception) -> bool:
    """Whether an error comes from the package, or is a warning turned into an error."""
    return type(error).__module__.startswith("tribodyn") or isinstance(error, Warning | ImportError)


class _Reader:
    """Checks of the arguments of one function, and explanation of its failures."""

    def __init__(self, function: Callable[..., Any], owner: type | None) -> None:
        self.function, self.owner, self.wanted = function, owner, _parameters(function, owner)
        every = inspect.signature(function).parameters.values()
        self.names = [each.name for each in every if each.kind <= each.VAR_POSITIONAL]
        self.several = any(each.kind is each.VAR_POSITIONAL for each in every)
        self.fits = {name: want.fits() for name, want in self.wanted.items()}
        self.other_fits = self.fits.get(_OTHERS, lambda value: True)
        self.first = [self.fits[name] for name in self.names]
        reports = inspect.signature(function).parameters.get("progress")
        self.reports = reports is not None and reports.default is progress.SILENT

    def named_values(self, args: Sequence[Any], named: ByName) -> Iterator[tuple[str, Any]]:
        """Arguments with the names of their parameters."""
        more = len(args) - len(self.names) if self.several else 0
        names = [*self.names, *self.names[-1:] * more]
        return chain(zip(names, args, strict=False), named.items())

    def fitting(self, args: Any, named: Tree) -> bool:
        """Whether all arguments pass the quick check."""
        if self.several:
            return False
        for quick, value in zip(self.first, args, strict=False):
            if not quick(value):
                return False
        fits, other = self.fits, self.other_fits
        return all(fits.get(name, other)(value) for name, value in named.items())

    def with_progress(self, args: Any, named: Tree) -> Tree:
        """Named arguments with the receiver of progress of the session where none is passed."""
        if not self.reports or "progress" in named or "progress" in self.names[: len(args)]:
            return named
        return {**named, "progress": progress.automatic()}

    def read(self, args: Any, named: Tree) -> tuple[Any, Tree]:
        wants, other = self.wanted, self.wanted.get(_OTHERS, ANYTHING)
        args = [list(value) if isinstance(value, _ONCE) else value for value in args]
        named = {k: list(v) if isinstance(v, _ONCE) else v for k, v in named.items()}
        try:
            first = [wants[name].read(value) for name, value in self.named_values(args, {})]
            by_name = {k: wants.get(k, other).read(v) for k, v in named.items()}
        except UnitRefusedError as error:
            raise InputError(self.faults(args, named, wants)) from error
        except _REFUSED:
            refused = InputError(self.faults(args, named, wants))
        else:
            return (*first, *args[len(first) :]), by_name
        # The message of the function itself is more specific; functions that write are not called.
        if not _WRITES & set(wants):
            try:
                self.function(*args, **named)
            except Exception as error:
                if _is_own(error):
                    raise
        raise refused

    def faults(self, args: Any, named: Any, wants: Mapping[str, Wanted]) -> list[Problem]:
        fault_of = functools.partial(_fault, self.owner if _makes(self.function) else self.function)
        other = wants.get(_OTHERS, ANYTHING)
        values = ((n, v, wants.get(n, other)) for n, v in self.named_values(args, named))
        return [fault for fault in (fault_of(*each) for each in values) if fault]

    def explain(self, error: Exception, args: Any, named: Tree) -> Exception:
        """Error of the package that explains the failure of a function."""
        name = self.function.__qualname__.removesuffix(".__init__").removesuffix(".__new__")
        where, what = f"{name}()", f"{type(error).__name__}: {error}"
        try:
            inspect.signature(self.function).bind(*args, **named)
        except TypeError as fault:
            takes = ", ".join(each for each in self.wanted if each not in ("self", "cls"))
            return InputError(str(fault), where, f"It takes {takes or 'nothing'}", "Give these")
        faults = self.faults(args, named, _parameters(self.function, self.owner, strict=True))
        if faults:
            return InputError(faults)
        frames = traceback.extract_tb(error.__traceback__)
        others = (each for each in frames if not each.filename.startswith(_HOMES))
        users = [each for each in others if not _PACKAGES.search(each.filename)]
        if users and type(error).__module__ != "builtins":
            return error  # raised on purpose by user code
        if users:
            place, why = users[-1], "It is called with numbers and must return numbers"
            what = f"a function that was passed raised {what}"
            return InputError(what, f"{place.filename}:{place.lineno}", why, "Correct it there")
        why = "The values or shapes of its arguments do not fit together"
        remedy = f"Compare them with help({name}); if they agree with it, please report this"
        return ComputationError(what, where, why, remedy)


def checked(function: Callable[..., Any], owner: type | None = None) -> Callable[..., Any]:
    """Check the arguments of a function, or of a method of the class ``owner``.

    Calls from within the package are not checked again.
    """
    readers: list[_Reader] = []

    @functools.wraps(function)
    def reading_arguments(*args: object, **named: object) -> Any:
        caller = sys._getframe(1)
        if caller.f_globals.get("__name__") == "dataclasses":  # replace
            caller = caller.f_back or caller
        if caller.f_globals.get("__name__", "").startswith(_INSIDE):
            return function(*args, **named)
        if not readers:
            readers.append(_Reader(function, owner))
        reader = readers[0]
        try:
            if not reader.fitting(args, named):
                args, named = reader.read(args, named)
            with np.errstate(**_USUAL):
                return function(*args, **reader.with_progress(args, named))
        except Exception as error:
            if _is_own(error):
                raise
            explained = reader.explain(error, args, named)
            if explained is error:
                raise
            raise explained from error

    return reading_arguments


def guarded(member: object, page: str) -> Any:
    """Check the arguments of one public function or class; other objects are returned unchanged.

    Parameters
    ----------
    member : object
        Public name of a page.
    page : str
        Name of its module.

    Returns
    -------
    object
        The function with checked arguments, or the same class.
    """
    if isinstance(member, _FUNCTIONS):
        if getattr(member, "reads", False):
            return member
        new: Any = checked(member)
        new.__module__, new.reads = page, True  # pickled by the name that it is found under
        return new
    if isinstance(member, type) and not issubclass(member, Exception):
        for home in member.__mro__:
            if home.__module__.startswith("tribodyn") and not getattr(home, "_is_protocol", False):
                _guard_methods(home)
    return member


def _guard_methods(owner: type) -> None:
    """Check the arguments of the constructor and the public methods; display it in one line."""
    if hasattr(owner.__dict__.get("__repr__"), "__wrapped__"):  # written by dataclasses
        owner.__repr__ = fields_in_one_line  # type: ignore[method-assign, assignment]
    for name, value in list(vars(owner).items()):
        kind = type(value) if isinstance(value, classmethod | staticmethod) else None
        method = value.__func__ if kind else value
        public = not name.startswith("_") or name in ("__init__", "__new__", "__call__")
        if public and isinstance(method, _FUNCTIONS) and not getattr(method, "reads", False):
            new: Any = checked(method, owner)
            new.reads = True
            setattr(owner, name, kind(new) if kind else new)


def guard(page: str) -> None:
    """Check the arguments of the public functions, constructors and methods of a page.

    Parameters
    ----------
    page : str
        Name of its module; its ``__all__`` says what is public.
    """
    module = sys.modules[page]
    for name in module.__all__:
        setattr(module, name, guarded(getattr(module, name), page))
