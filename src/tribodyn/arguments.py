"""Arguments of public functions, held against their annotations.

A page of public names ends with :func:`guard`. Its functions, constructors and methods then refuse
values of another kind than they are annotated with: texts, truth values, complex numbers, numbers
that are NaN. What passes is computed as ever; whatever a function still stumbles over is told as an
error of the package, with the argument at fault where one can be named.
"""

from __future__ import annotations

import builtins
import collections.abc as abc
import functools
import inspect
import re
import sys
import sysconfig
import traceback
import types
import typing
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from importlib import import_module
from itertools import chain
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import ENDLESS, Argument, ComputationError, InputError, Problem, shortened

_TINY, _NONE = 1.0 / ENDLESS, frozenset[type]()
#: Classes of these modules stand for no object of a mechanism.
_PLAIN = {"builtins", "numpy", "datetime", "decimal", "fractions", "pathlib"}
_PATHS = sysconfig.get_paths()
#: Where the frames of a traceback lie that are not the user's.
_HOMES = (str(Path(__file__).parent), _PATHS["stdlib"], _PATHS["purelib"], _PATHS["platlib"], "<")
#: Parameters of functions that leave files behind.
_WRITES = {"path", "directory", "folder", "place", "force"}
_SIZED = f"Wanted: a finite number, zero or between {_TINY:g} and {ENDLESS:g} in size"


class _ValueRefusedError(TypeError):
    """The kind is right, the value is not; the message says which values are."""


class Wanted(NamedTuple):
    """What an annotation asks for.

    ``fits`` knows the usual values, in a tenth of a microsecond; ``read`` knows all that belong
    there and converts some of them, and raises TypeError for what does not.
    """

    words: str
    read: Callable[[Any], Any]
    types: frozenset[type] = _NONE
    numbers: tuple[float, float] = (1.0, -1.0)
    kinds: str = ""

    def fits(self) -> Callable[[Any], bool]:
        """Quick look at a value."""
        known, (least, most), kinds = self.types, self.numbers, self.kinds
        if not self.words:
            return lambda value: True

        def quick(value: Any) -> bool:
            kind = type(value)
            if kind is float or kind is int:
                sized = least < value < most or value == 0 or -most < value < -least
                return kind in known and sized
            return kind in known or (kind is np.ndarray and value.dtype.kind in kinds)

        return quick


def _require(holds: Any) -> None:
    if not holds:
        raise TypeError


def _array(value: Any, kinds: str) -> Any:
    """Array of numbers of one of these kinds; entries may be NaN, for nothing there."""
    array = np.asarray(value)
    if array.dtype.kind == "O" and all(type(item) is int for item in array.flat):
        array = array.astype(float)  # whole numbers of more than 64 bits
    if not array.size and array.dtype.kind == "f" and kinds in ("b", "iu"):
        array = array.astype(bool if kinds == "b" else np.int64)
    _require(array.dtype.kind in kinds)
    return array


def _number(value: Any, sized: int, whole: bool = False) -> Any:
    number = _array(value, "fiu")
    _require(number.ndim == 0)
    value = number.item()
    if sized and value and not _TINY < abs(value) < ENDLESS:
        raise _ValueRefusedError(_SIZED)
    if whole:
        _require(value == value and int(value) == value)
        return int(value)
    return value


def _numbers(kinds: str, sized: int, as_given: bool) -> Wanted:
    """Arrays; ``as_given`` leaves the conversion to the function."""

    def read(value: Any) -> Any:
        array = _array(value, kinds)
        if sized and not array.ndim and array != array:
            raise _ValueRefusedError("Wanted: numbers; NaN is none")
        return value if as_given else array

    words = {"b": "an array of True and False", "iu": "an array of whole numbers"}
    told = words.get(kinds, "numbers, in an array or a list of even rows")
    if as_given:
        return Wanted(told, read, frozenset((float, int)), (0.0, 1e300), kinds)
    return Wanted(told, read, kinds=kinds)


def _that(words: str, holds: Callable[[Any], Any], *kinds: type) -> Wanted:
    def read(value: Any) -> Any:
        _require(holds(value))
        return value

    return Wanted(words, read, frozenset(kinds))


def _instance(kind: type, strict: bool) -> Wanted:
    """Objects of a class; others may stand for them until a function stumbles over one."""

    def holds(value: Any) -> bool:
        if strict and not getattr(kind, "_is_protocol", False):
            return isinstance(value, kind)
        home = type(value).__module__.partition(".")[0]
        return home not in _PLAIN or callable(value) or isinstance(value, kind)

    name = kind.__name__
    return _that(f"{'an' if name[:1] in 'AEIO' else 'a'} {name}", holds, kind)


def _items(hint: Any, origin: type, sized: int, strict: bool) -> Wanted:
    """Lists, tuples and mappings of what is wanted."""
    kinds = [kind for kind in typing.get_args(hint) if kind is not ...]
    # Entries may be NaN, for what is not there, as those of arrays may.
    wanted = [_wanted(kind, False, strict) for kind in kinds]
    fixed = origin is tuple and bool(wanted) and ... not in typing.get_args(hint)

    def read(value: Any) -> Any:
        if issubclass(origin, Mapping):
            _require(isinstance(value, Mapping))
            for items, one in zip((value, value.values()), wanted, strict=False):
                for item in items:
                    one.read(item)
            return value
        if wanted and not strict and not isinstance(value, Iterable):
            return wanted[0].read(value)  # one alone, which some functions take too
        texts = isinstance(value, str) and kinds == [str]
        _require(isinstance(value, Iterable) and not isinstance(value, bytes | Mapping))
        _require(texts or not isinstance(value, str))
        if not isinstance(value, Sequence | np.ndarray):
            _require(not issubclass(origin, Sequence))
            return value
        _require(not fixed or len(value) == len(wanted))
        each = wanted if fixed else wanted * len(value)
        items = tuple(one.read(item) for item, one in zip(value, each, strict=False))
        return items if origin is tuple and wanted and not isinstance(value, tuple) else value

    inner = [re.sub(r"^a (list|[\w ]+$)", r"\1s", one.words or "values") for one in wanted]
    words = "a mapping" if issubclass(origin, Mapping) else "a list"
    return Wanted(f"{words} of {', '.join(inner)}" if inner else words, read)


def _any_of(hints: Iterable[Any], sized: int, strict: bool) -> Wanted:
    several = [_wanted(hint, sized, strict) for hint in hints]
    calls = any(one.words.startswith("a function") for one in several)

    def read(value: Any) -> Any:
        fault = TypeError()
        for one in several:
            try:
                return one.read(value)
            except _ValueRefusedError as refused:
                fault = refused
            except (TypeError, ValueError, OverflowError):
                continue
        if calls and isinstance(value, list | tuple) and value:
            return [read(item) for item in value] and value  # functions and numbers, in turn
        raise fault

    words = " or ".join(dict.fromkeys(one.words for one in several if one.words))
    known, kinds = frozenset().union(*(one.types for one in several)), {o.kinds for o in several}
    numbers = [one.numbers for one in several if one.types & {float, int}]
    return Wanted(words, read, known, numbers[0] if numbers else (1.0, -1.0), "".join(kinds))


def _function(count: int, strict: bool) -> Wanted:
    """Functions that can be called with so many values."""

    def holds(value: Any) -> bool:
        try:
            inspect.signature(value).bind(*[None] * count)
        except TypeError:
            return False
        except ValueError:  # those written in C have no signature
            return callable(value)
        return True

    words = f"a function of {count} value{'s'[: count - 1]}"
    return _that(words, holds if strict else callable, types.FunctionType)


_FUNCTIONS = (types.FunctionType, functools._lru_cache_wrapper)
_ANYTHING = Wanted("", lambda value: value)
_SIMPLE = {
    bool: _that("True or False", lambda v: isinstance(v, int | np.bool_) and v in (0, 1), bool),
    str: _that("a text", lambda value: isinstance(value, str), str),
    types.NoneType: _that("None", lambda value: value is None, types.NoneType),
    None: _that("None", lambda value: value is None, types.NoneType),
}
_ITEMS = {np.float64: "fiu", np.int64: "iu", np.bool_: "b", np.complex128: "fiuc"}


def _wanted(hint: Any, sized: int, strict: bool = False) -> Wanted:
    """What an annotation asks for; ``strict`` for a closer look, after something went wrong.

    ``sized`` is 0 for records, whose numbers may be NaN, 1 for methods, and 2 for functions.
    """
    origin, args = typing.get_origin(hint), typing.get_args(hint)
    every, kind = set(typing.get_args(ArrayLike)), origin or hint
    if hint in (float, int):
        read = functools.partial(_number, sized=sized, whole=hint is int)
        words, usual = ("a whole number", (int,)) if hint is int else ("a number", (float, int))
        return Wanted(words, read, frozenset(usual), (_TINY, ENDLESS))
    if hint in _SIMPLE:
        return _SIMPLE[hint]
    if hint == ArrayLike:
        return _numbers("fiu", sized, as_given=True)
    if isinstance(hint, typing.TypeVar):
        return _any_of(hint.__constraints__, sized, strict) if hint.__constraints__ else _ANYTHING
    if origin in (typing.Union, types.UnionType):
        whole = [ArrayLike] if every <= set(args) else []
        rest = [arg for arg in args if not whole or arg not in every]
        return _ANYTHING if {Any, object} & set(rest) else _any_of([*whole, *rest], sized, strict)
    if origin is np.ndarray:
        item = typing.get_args(args[1])[0]
        # Methods and records also serve the package itself, for complex and logical arrays too.
        kinds = _ITEMS.get(item, "") + "cb" * (sized < 2)
        return _numbers(kinds, sized, as_given=False) if item in _ITEMS else _ANYTHING
    if origin is typing.Literal:
        words = ", ".join(f'"{v}"' if isinstance(v, str) else str(v) for v in args)
        return _that(words, lambda value: isinstance(value, str | int) and value in args)
    if kind is abc.Callable:
        count = len(args[0]) if args and isinstance(args[0], list) else None
        return _that("a function", callable) if count is None else _function(count, strict)
    if not isinstance(kind, type) or kind in (type, object, Any):
        return _ANYTHING
    if kind is tuple or (issubclass(kind, abc.Iterable) and kind.__module__ == "collections.abc"):
        return _items(hint, kind, sized, strict)
    return _instance(kind, strict)


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


def _parameters(function: Any, owner: type | None, strict: bool = False) -> dict[str, Wanted]:
    """What the parameters of a function want, several that share a name too."""
    homes = [each.__module__ for each in getattr(owner, "__mro__", [])]
    names = _Names([*homes, getattr(function, "__globals__", {}).get("__name__", "")])
    wanted = {}
    for name, parameter in inspect.signature(function).parameters.items():
        if parameter.kind is parameter.VAR_KEYWORD:
            continue
        hint = getattr(parameter.annotation, "__forward_arg__", parameter.annotation)
        hint = eval(hint, {}, names) if isinstance(hint, str) else hint
        # Records may hold what is not there; functions take what a quantity may be, unless their
        # default or their documentation speaks of more.
        default, entry = parameter.default, _entry(function, name)
        makes = getattr(function, "__name__", "") in ("__init__", "__new__")
        ends = not (isinstance(default, float) and not np.isfinite(default))
        sized = (
            (not makes)
            * (1 + (owner is None))
            * (ends and "infinit" not in entry and "NaN" not in entry)
        )
        none = hint is inspect.Parameter.empty
        wanted[name] = _ANYTHING if none else _wanted(hint, sized, strict)
    return wanted


def _entry(documented: Any, name: str) -> str:
    """What a docstring says of one parameter."""
    pattern = rf"^ *(?:\w+, )*{re.escape(name)}(?:, \w+)* : .*\n +.*(?:\n +[a-z(].*)*"
    found = re.search(pattern, inspect.getdoc(documented) or "", re.MULTILINE)
    return re.sub(r"\s+", " ", found[0].partition(" : ")[2].replace("\n", "|", 1)) if found else ""


def _fault(documented: Any, name: str, value: Any, wanted: Wanted) -> Problem | None:
    """Fault of one argument, with unit and meaning as documented; None if it has none."""
    try:
        wanted.read(value)
    except _ValueRefusedError as refused:
        why = str(refused)
    except (TypeError, ValueError, OverflowError):
        why = f"Wanted: {wanted.words}"
    else:
        return None
    kind, _, text = _entry(documented, name).partition("|")
    unit, meaning = re.search(r"\[(.+?)\]", kind), re.split(r"[.;:](?:\s|$)", text.strip())[0]
    remedy = f"Give {name}{f' in {unit[1]}' if unit else ''}{': ' * bool(meaning)}{meaning}"
    if isinstance(value, str) and "number" in wanted.words:
        remedy += f". Functions take numbers in {unit[1] if unit else 'SI units'}, not texts"
    given = f'"{value[:60]}"' if isinstance(value, str) else _shown(value)
    owner = f"{documented.__name__}." if isinstance(documented, type) else ""
    return Problem(f"{name} = {given}", Argument(owner + name), why, remedy)


def _shown(value: Any) -> str:
    try:
        return shortened(repr(value), 60)
    except Exception:  # objects of wrong things cannot always be shown
        return f"an object of the class {type(value).__name__}"


def _is_own(error: Exception) -> bool:
    """Whether an error is one of the package, or a warning that is asked to be an error."""
    return type(error).__module__.startswith("tribodyn") or isinstance(error, Warning | ImportError)


class _Reader:
    """What one function is given, read by its annotations, and what it stumbles over."""

    def __init__(self, function: Callable[..., Any], owner: type | None) -> None:
        self.function, self.owner, self.wanted = function, owner, _parameters(function, owner)
        every = inspect.signature(function).parameters.values()
        self.names = [each.name for each in every if each.kind <= each.VAR_POSITIONAL]
        self.several = any(each.kind is each.VAR_POSITIONAL for each in every)
        self.fits = {name: one.fits() for name, one in self.wanted.items()}
        self.first = [self.fits[name] for name in self.names]

    def given(self, args: Sequence[Any], named: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
        """Arguments with the names of their parameters."""
        more = len(args) - len(self.names) if self.several else 0
        names = [*self.names, *self.names[-1:] * more]
        return chain(zip(names, args, strict=False), named.items())

    def fitting(self, args: Any, named: dict[str, Any]) -> bool:
        """Whether a quick look finds the kinds that are wanted."""
        if self.several:
            return False
        for quick, value in zip(self.first, args, strict=False):
            if not quick(value):
                return False
        fits = self.fits
        return all(fits[name](value) for name, value in named.items() if name in fits)

    def read(self, args: Any, named: dict[str, Any]) -> tuple[Any, dict[str, Any]]:
        wanted = self.wanted
        try:
            first = [wanted[name].read(value) for name, value in self.given(args, {})]
            rest = {k: wanted[k].read(v) if k in wanted else v for k, v in named.items()}
        except (TypeError, ValueError, OverflowError):
            refused = InputError(self.faults(args, named, wanted))
        else:
            return (*first, *args[len(first) :]), rest
        # What the function itself says of it knows more; what writes is not begun.
        if not _WRITES & set(wanted):
            try:
                self.function(*args, **named)
            except Exception as error:
                if _is_own(error):
                    raise
        raise refused

    def faults(
        self, args: Any, named: dict[str, Any], wanted: Mapping[str, Wanted]
    ) -> list[Problem]:
        makes = self.function.__name__ in ("__init__", "__new__")
        told = functools.partial(_fault, self.owner if makes else self.function)
        given = ((n, v, wanted[n]) for n, v in self.given(args, named) if n in wanted)
        return [fault for fault in (told(*each) for each in given) if fault]

    def told(self, error: Exception, args: Any, named: dict[str, Any]) -> Exception:
        """Error of the package that says what a function stumbled over."""
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
        users = [each for each in frames if not each.filename.startswith(_HOMES)]
        if users and type(error).__module__ != "builtins":
            return error  # raised on purpose by what the user wrote
        if users:
            place, why = users[-1], "It is called with numbers, and returns numbers"
            told = f"a function that was given raised {what}"
            return InputError(told, f"{place.filename}:{place.lineno}", why, "Correct it there")
        why = "Values or shapes of what it was given do not go together"
        remedy = f"Hold them against help({name}); if they are as stated there, please report this"
        return ComputationError(what, where, why, remedy)


def checked(function: Callable[..., Any], owner: type | None = None) -> Callable[..., Any]:
    """Have a function, or a method of the class ``owner``, read its arguments."""
    made: list[_Reader] = []

    @functools.wraps(function)
    def reading_arguments(*args: Any, **named: Any) -> Any:
        if not made:
            made.append(_Reader(function, owner))
        reader = made[0]
        try:
            if not reader.fitting(args, named):
                args, named = reader.read(args, named)
            return function(*args, **named)
        except Exception as error:
            if _is_own(error):
                raise
            told = reader.told(error, args, named)
            if told is error:
                raise
            raise told from error

    return reading_arguments


def guarded(thing: Any, page: str) -> Any:
    """Have one public function or class read its arguments; anything else is left as it is.

    Parameters
    ----------
    thing : object
        What a page names.
    page : str
        Name of its module.

    Returns
    -------
    object
        The function that reads its arguments first, or the same class.
    """
    if isinstance(thing, _FUNCTIONS):
        if getattr(thing, "reads", False):
            return thing
        new: Any = checked(thing)
        new.__module__, new.reads = page, True  # pickled by the name that it is found under
        return new
    if isinstance(thing, type) and not issubclass(thing, Exception):
        for home in thing.__mro__:
            if home.__module__.startswith("tribodyn") and not getattr(home, "_is_protocol", False):
                _guard_methods(home)
    return thing


def _guard_methods(owner: type) -> None:
    """Have the constructor and the public methods of a class read their arguments."""
    for name, value in list(vars(owner).items()):
        kind = type(value) if isinstance(value, classmethod | staticmethod) else None
        method = value.__func__ if kind else value
        public = not name.startswith("_") or name in ("__init__", "__new__", "__call__")
        if public and isinstance(method, _FUNCTIONS) and not getattr(method, "reads", False):
            new: Any = checked(method, owner)
            new.reads = True
            setattr(owner, name, kind(new) if kind else new)


def guard(page: str) -> None:
    """Have the public functions, constructors and methods of a page read their arguments.

    Parameters
    ----------
    page : str
        Name of its module; its ``__all__`` says what is public.
    """
    module = sys.modules[page]
    for name in module.__all__:
        setattr(module, name, guarded(getattr(module, name), page))
