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
from importlib import import_module
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np

from tribodyn.arguments.annotations import ANYTHING, ValueRefusedError, Wanted, wanted
from tribodyn.errors import Argument, ComputationError, InputError, Problem, shortened

_FUNCTIONS = (types.FunctionType, functools._lru_cache_wrapper)
_PATHS = map(sysconfig.get_path, ("stdlib", "purelib", "platlib"))
#: Folders of traceback frames that are not user code.
_HOMES = (str(Path(__file__).parents[1]), *_PATHS, "<")
_PACKAGES = re.compile(r"[/\\](site|dist)-packages[/\\]")
#: Parameters of functions that write files.
_WRITES = {"path", "directory", "folder", "place", "force"}
#: What NumPy does about numbers out of range, whatever the user's script has set: what is computed
#: here rounds to zero where it does so on purpose.
_USUAL: dict[str, Any] = {"divide": "warn", "over": "warn", "under": "ignore", "invalid": "warn"}
_REFUSED = (TypeError, ValueError, OverflowError)
#: Modules of the package, which call guarded functions without checks.
_INSIDE = f"{__name__.partition('.')[0]}."


class _Names(dict[str, Any]):
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


def _makes(function: Any) -> bool:
    return getattr(function, "__name__", "") in ("__init__", "__new__")


def _parameters(function: Any, owner: type | None, strict: bool = False) -> dict[str, Wanted]:
    """Checks of the parameters of a function by name."""
    homes = [each.__module__ for each in getattr(owner, "__mro__", [])]
    names = _Names([*homes, getattr(function, "__module__", "")])
    wants, makes = {}, _makes(function)
    for name, parameter in inspect.signature(function).parameters.items():
        if parameter.kind is parameter.VAR_KEYWORD:
            continue
        hint = getattr(parameter.annotation, "__forward_arg__", parameter.annotation)
        hint = eval(hint, {}, names) if isinstance(hint, str) else hint
        # Records may hold what is not there; functions take what a quantity may be, unless their
        # default or their documentation speaks of more.
        default, entry = parameter.default, _entry(function, name)
        ends = not (isinstance(default, float) and not np.isfinite(default))
        sized = 0 if makes or not ends or re.search("infinit|NaN", entry) else 1 + (owner is None)
        none = hint is inspect.Parameter.empty
        wants[name] = ANYTHING if none else wanted(hint, sized, strict, several=not makes)
    return wants


#: Markup of documentation, which messages do not have.
_MARKUP = re.compile(r"(?::\w+:)?`+~?([^`]+)`+")


@functools.cache
def _entries(documented: Any) -> dict[str, str]:
    """Entries of the parameters in a docstring."""
    pattern = r"^ *(?=((?:\w+, )*\w+) : (.*\n +.*(?:\n +[a-z(].*)*))"
    entries: dict[str, str] = {}
    docstring = _MARKUP.sub(r"\1", inspect.getdoc(documented) or "")
    for names, text in re.findall(pattern, docstring, re.MULTILINE):
        for name in names.split(", "):
            entries.setdefault(name, re.sub(r"\s+", " ", text.replace("\n", "|", 1)))
    return entries


def _entry(documented: Any, name: str) -> str:
    return _entries(documented).get(name, "")


def _fault(documented: Any, name: str, value: Any, want: Wanted) -> Problem | None:
    """Problem of one argument, with documented unit and meaning; None if it is valid."""
    try:
        want.read(value)
    except ValueRefusedError as refused:
        why = str(refused)
    except _REFUSED:
        why = f"Wanted: {want.description}"
    else:
        return None
    kind, _, text = _entry(documented, name).partition("|")
    unit, meaning = re.search(r"\[(.+?)\]", kind), re.split(r"[.;:](?:\s|$)", text.strip())[0]
    remedy = f"Give {name}{f' in {unit[1]}' if unit else ''}{': ' * bool(meaning)}{meaning}"
    if isinstance(value, str) and "number" in want.description:
        remedy += f". Functions take numbers in {unit[1] if unit else 'SI units'}, not texts"
    shown_value = f'"{value[:60]}"' if isinstance(value, str) else _short_repr(value)
    owner = f"{documented.__name__}." if isinstance(documented, type) else ""
    return Problem(f"{name} = {shown_value}", Argument(owner + name), why, remedy)


def _short_repr(value: Any) -> str:
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
        self.first = [self.fits[name] for name in self.names]

    def named_values(
        self, args: Sequence[Any], named: Mapping[str, Any]
    ) -> Iterator[tuple[str, Any]]:
        """Arguments with the names of their parameters."""
        more = len(args) - len(self.names) if self.several else 0
        names = [*self.names, *self.names[-1:] * more]
        return chain(zip(names, args, strict=False), named.items())

    def fitting(self, args: Any, named: dict[str, Any]) -> bool:
        """Whether all arguments pass the quick check."""
        if self.several:
            return False
        for quick, value in zip(self.first, args, strict=False):
            if not quick(value):
                return False
        fits = self.fits
        return all(fits[name](value) for name, value in named.items() if name in fits)

    def read(self, args: Any, named: dict[str, Any]) -> tuple[Any, dict[str, Any]]:
        wants = self.wanted
        try:
            first = [wants[name].read(value) for name, value in self.named_values(args, {})]
            by_name = {k: wants[k].read(v) if k in wants else v for k, v in named.items()}
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
        values = ((n, v, wants[n]) for n, v in self.named_values(args, named) if n in wants)
        return [fault for fault in (fault_of(*each) for each in values) if fault]

    def explain(self, error: Exception, args: Any, named: dict[str, Any]) -> Exception:
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
    def reading_arguments(*args: Any, **named: Any) -> Any:
        if sys._getframe(1).f_globals.get("__name__", "").startswith(_INSIDE):
            return function(*args, **named)
        if not readers:
            readers.append(_Reader(function, owner))
        reader = readers[0]
        try:
            if not reader.fitting(args, named):
                args, named = reader.read(args, named)
            with np.errstate(**_USUAL):
                return function(*args, **named)
        except Exception as error:
            if _is_own(error):
                raise
            explained = reader.explain(error, args, named)
            if explained is error:
                raise
            raise explained from error

    return reading_arguments


def guarded(member: Any, page: str) -> Any:
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
    """Check the arguments of the constructor and the public methods of a class."""
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
