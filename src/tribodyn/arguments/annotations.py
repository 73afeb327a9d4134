"""What annotations ask for, as tests that values pass or not.

They are mild: what may work is let through, and held against the annotation more strictly only
after a function stumbled over it.
"""

from __future__ import annotations

import collections.abc as abc
import functools
import inspect
import re
import types
import typing
from collections.abc import Callable, Iterable, Mapping, Sequence
from decimal import Decimal
from numbers import Real
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import ENDLESS

TINY = 1.0 / ENDLESS
#: Classes of these modules stand for no object of a mechanism.
_PLAIN = {"builtins", "numpy", "datetime", "decimal", "fractions", "pathlib"}
_USUAL = frozenset((float, int, np.float64))
_ITEMS = {np.float64: "fiu", np.int64: "iu", np.bool_: "b", np.complex128: "fiuc"}
_ARRAYS = {
    "b": "an array of True and False",
    "iu": "an array of whole numbers",
    "fiu": "numbers, in an array or a list of even rows",
}


class ValueRefusedError(TypeError):
    """The kind is right, the value is not; the message says which values are."""


class Wanted(NamedTuple):
    """What an annotation asks for.

    ``fits`` knows the usual values, in a tenth of a microsecond; ``read`` knows all that belong
    there and converts some of them, and raises TypeError for what does not.
    """

    words: str
    read: Callable[[Any], Any]
    types: frozenset[type] = frozenset()
    numbers: tuple[float, float] = (1.0, -1.0)
    kinds: str = ""

    def fits(self) -> Callable[[Any], bool]:
        """Quick look at a value."""
        known, (least, most), kinds = self.types, self.numbers, self.kinds
        if not self.words:
            return lambda value: True

        def quick(value: Any) -> bool:
            kind = type(value)
            if kind in _USUAL:
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
    if array.dtype.kind == "O" and all(isinstance(item, Real | Decimal) for item in array.flat):
        _require(not any(isinstance(item, bool) for item in array.flat))
        array = array.astype(float)  # fractions, whole numbers of more than 64 bits
    if not array.size and array.dtype.kind == "f" and kinds in ("b", "iu"):
        array = array.astype(bool if kinds == "b" else np.int64)
    _require(array.dtype.kind in kinds)
    return array


def _number(value: Any, sized: int, whole: bool, several: bool) -> Any:
    """One number; ``several`` lets arrays of numbers through, as they are."""
    number = _array(value, "fiu")
    if number.ndim and several:
        return value
    _require(number.ndim == 0)
    value = number.item()
    if sized and value and not TINY < abs(value) < ENDLESS:
        raise ValueRefusedError(
            f"Wanted: a finite number, zero or between {TINY:g} and {ENDLESS:g} in size"
        )
    if whole:
        _require(value == value and int(value) == value)
        return int(value)
    return value


def _numbers(kinds: str, sized: int, as_given: bool) -> Wanted:
    """Arrays; ``as_given`` leaves the conversion to the function."""

    def read(value: Any) -> Any:
        array = _array(value, kinds)
        if sized and not array.ndim and array != array:
            raise ValueRefusedError("Wanted: numbers; NaN is none")
        return value if as_given else array

    words = _ARRAYS.get(kinds, _ARRAYS["fiu"])
    if as_given:
        return Wanted(words, read, _USUAL, (0.0, 1e300), kinds)
    return Wanted(words, read, kinds=kinds)


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


def _items(hint: Any, origin: type, strict: bool) -> Wanted:
    """Lists, tuples and mappings of what is wanted."""
    kinds = [kind for kind in typing.get_args(hint) if kind is not ...]
    # Entries may be NaN, for what is not there, as those of arrays may.
    each = [wanted(kind, 0, strict) for kind in kinds]
    quick = [one.fits() for one in each]
    fixed = origin is tuple and bool(each) and ... not in typing.get_args(hint)

    def read(value: Any) -> Any:
        if issubclass(origin, Mapping):
            _require(isinstance(value, Mapping))
            for items, one in zip((value, value.values()), each, strict=False):
                for item in items:
                    one.read(item)
            return value
        if each and not strict and not isinstance(value, Iterable):
            return each[0].read(value)  # one alone, which some functions take too
        texts = isinstance(value, str) and kinds == [str]
        _require(isinstance(value, Iterable) and not isinstance(value, bytes))
        _require(texts or not isinstance(value, str))
        if not isinstance(value, Sequence | np.ndarray):
            if not issubclass(origin, Sequence):
                return value
            _require(hasattr(value, "__len__") and not isinstance(value, abc.Set))
            value = list(value)  # a column of a table
        _require(not fixed or len(value) == len(each))
        count = 1 if fixed else len(value)
        items = tuple(
            item if fits(item) else one.read(item)
            for item, one, fits in zip(value, each * count, quick * count, strict=False)
        )
        return items if origin is tuple and each and not isinstance(value, tuple) else value

    inner = [re.sub(r"^a (list|[\w ]+$)", r"\1s", one.words or "values") for one in each]
    words = "a mapping" if issubclass(origin, Mapping) else "a list"
    return Wanted(f"{words} of {', '.join(inner)}" if inner else words, read)


def _any_of(hints: Iterable[Any], sized: int, strict: bool) -> Wanted:
    several = [wanted(hint, sized, strict) for hint in hints]
    calls = any(one.words.startswith("a function") for one in several)

    def read(value: Any) -> Any:
        fault = TypeError()
        for one in several:
            try:
                return one.read(value)
            except ValueRefusedError as refused:
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


ANYTHING = Wanted("", lambda value: value)
_NOTHING = _that("None", lambda value: value is None, types.NoneType)
_TRUTHS = (int, np.bool_, np.integer)
_SIMPLE = {
    bool: _that("True or False", lambda v: isinstance(v, _TRUTHS) and v in (0, 1), bool),
    str: _that("a text", lambda value: isinstance(value, str), str),
    types.NoneType: _NOTHING,
    None: _NOTHING,
}


def wanted(hint: Any, sized: int, strict: bool = False, several: bool = False) -> Wanted:
    """What an annotation asks for; ``strict`` for a closer look, after something went wrong.

    ``sized`` is 0 for records, whose numbers may be NaN, 1 for methods, and 2 for functions;
    ``several`` lets an array stand for a number.
    """
    origin, args = typing.get_origin(hint), typing.get_args(hint)
    every, kind = set(typing.get_args(ArrayLike)), origin or hint
    if hint in (float, int):
        several = several and hint is float and not strict
        read = functools.partial(_number, sized=sized, whole=hint is int, several=several)
        words, usual = ("a whole number", {int}) if hint is int else ("a number", _USUAL)
        return Wanted(words, read, frozenset(usual), (TINY, ENDLESS))
    if hint in _SIMPLE:
        return _SIMPLE[hint]
    if hint == ArrayLike:
        return _numbers("fiu", sized, as_given=True)
    if isinstance(hint, typing.TypeVar):
        return _any_of(hint.__constraints__, sized, strict) if hint.__constraints__ else ANYTHING
    if origin in (typing.Union, types.UnionType):
        whole = [ArrayLike] if every <= set(args) else []
        rest = [arg for arg in args if not whole or arg not in every]
        return ANYTHING if {Any, object} & set(rest) else _any_of([*whole, *rest], sized, strict)
    if origin is np.ndarray:
        item = typing.get_args(args[1])[0]
        # Methods and records also serve the package itself, for complex and logical arrays too.
        kinds = _ITEMS.get(item, "") + "cb" * (sized < 2)
        return _numbers(kinds, sized, as_given=False) if item in _ITEMS else ANYTHING
    if origin is typing.Literal:
        words = ", ".join(f'"{v}"' if isinstance(v, str) else str(v) for v in args)
        return _that(words, lambda value: isinstance(value, str | int) and value in args)
    if kind is abc.Callable:
        count = len(args[0]) if args and isinstance(args[0], list) else None
        return _that("a function", callable) if count is None else _function(count, strict)
    if not isinstance(kind, type) or kind in (type, object, Any):
        return ANYTHING
    if kind is tuple or (issubclass(kind, abc.Iterable) and kind.__module__ == "collections.abc"):
        return _items(hint, kind, strict)
    return _instance(kind, strict)
