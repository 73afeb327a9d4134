"""Values of arguments: what a parameter may be by its annotation, and numbers in its unit.

Objects with a unit are recognised by their attributes, since no unit library is imported:
``magnitude`` and ``units`` (pint, quantities), ``value`` and ``unit`` (astropy), ``value`` and
``units`` (unyt). NumPy drops their units without an error.
"""

from __future__ import annotations

import collections.abc as abc
import contextlib
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

#: Common types of values, which have no unit.
PLAIN = frozenset((float, int, bool, str, bytes, type(None), complex, np.float64, np.int64))

_SEVERAL = (list, tuple, set, frozenset)


class ValueRefusedError(TypeError):
    """The type is right but the value is not; the message says which values are accepted."""


class UnitRefusedError(ValueRefusedError):
    """A quantity is not of the unit that is wanted."""


def quantity_in(value: object) -> Any:
    """Object with a unit that a value is, or that a labelled array holds; None without a unit."""
    if type(value) in PLAIN or type(value).__module__.partition(".")[0] == "tribodyn":
        return None
    with contextlib.suppress(Exception):  # attributes of foreign objects may raise anything
        for item in (value, getattr(value, "data", None)):
            has_unit = hasattr(item, "units") or hasattr(item, "unit")
            if has_unit and (hasattr(item, "magnitude") or hasattr(item, "value")):
                return item
    return None


def unit_text(quantity: Any) -> str:
    """Unit of an object, as its library writes it."""
    unit = str(quantity.units if hasattr(quantity, "units") else quantity.unit)
    return "1" if unit in ("", "dimensionless") else unit


def _counts_angles(quantity: object, converted: object, unit: str) -> bool:
    """Whether two quantities have one power of the radian, which pint takes for the number 1."""
    if hasattr(quantity, "to_root_units"):
        return angle_power(quantity) == angle_power(converted)
    if "rad" not in unit and unit not in ("Hz", "1/s", ""):
        return True
    try:
        _convert(quantity, f"({unit or '1'})*rad")
    except Exception:
        return True
    return False  # the library cannot tell them apart


def angle_power(quantity: Any) -> float:
    """Power of the radian in the unit of a quantity of pint."""
    return float(dict(quantity.to_root_units().unit_items()).get("radian", 0))


def _convert(quantity: Any, unit: str) -> Any:
    unit = unit.replace("^", "**")
    return quantity.to(unit) if hasattr(quantity, "to") else quantity.rescale(unit)


def magnitude(value: object, unit: str | None) -> Any:
    """Number or array that an object with a unit is in ``unit``; None where none is known."""
    quantity = quantity_in(value)
    if unit is None:
        raise UnitRefusedError("Wanted: a value without a unit")
    text = f"Wanted: a quantity in {unit}" if unit else "Wanted: a pure number"
    refused = UnitRefusedError(f"{text}, but its unit is {unit_text(quantity)}")
    try:
        converted = _convert(quantity, unit)
        equal = _counts_angles(quantity, converted, unit)
    except Exception as error:  # each library raises errors of its own
        raise refused from error
    if not equal:
        why = "angles and rotational speeds are kinds of their own"
        raise UnitRefusedError(f"{refused}; {why}")
    return converted.magnitude if hasattr(converted, "magnitude") else converted.value


def without_units(value: Any, unit: str | None, inside: bool = True) -> Any:
    """Value with all quantities as numbers in ``unit``, those ``inside`` of mappings too."""
    kind = type(value)
    if kind in PLAIN or (kind is np.ndarray and value.dtype.kind != "O"):
        return value
    if quantity_in(value) is not None:
        return magnitude(value, unit)
    if isinstance(value, Mapping):
        entries = dict(value) if inside else {}  # a data set makes new arrays at each access
        new = {key: without_units(item, unit) for key, item in entries.items()}
        return new if any(new[key] is not entries[key] for key in new) else value
    if kind is np.ndarray:
        has_units = any(quantity_in(item) is not None for item in value.flat)
        return np.array(without_units(value.tolist(), unit)) if has_units else value
    if not isinstance(value, _SEVERAL) or PLAIN.issuperset(map(type, value)):
        return value
    items = [without_units(item, unit, inside) for item in value]
    if all(new is old for new, old in zip(items, value, strict=True)):
        return value
    return kind(*items) if hasattr(kind, "_fields") else kind(items)


def is_plain(value: Any) -> bool:
    """Quick check that neither a value nor what it holds has a unit."""
    kind = type(value)
    if kind in PLAIN:
        return True
    if kind is np.ndarray:
        return bool(value.dtype.kind != "O")
    return not isinstance(value, (*_SEVERAL, Mapping)) and quantity_in(value) is None


TINY = 1.0 / ENDLESS
#: Classes of these modules are no objects of this package.
_PLAIN = {"builtins", "numpy", "datetime", "decimal", "fractions", "pathlib"}
_USUAL = frozenset((float, int, np.float64))
_ITEMS = {np.float64: "fiu", np.int64: "iu", np.bool_: "b", np.complex128: "fiuc"}
_ARRAYS = {
    "b": "an array of True and False",
    "iu": "an array of integers",
    "fiu": "numbers, in an array or a list of even rows",
}


class Wanted(NamedTuple):
    """Check of the values that an annotation accepts; ``read`` raises TypeError for others."""

    description: str
    read: Callable[[Any], Any]
    types: frozenset[type] = frozenset()
    numbers: tuple[float, float] = (1.0, -1.0)
    kinds: str = ""

    def fits(self) -> Callable[[Any], bool]:
        """Quick check of a value."""
        accepted_types, (least, most), kinds = self.types, self.numbers, self.kinds
        if not self.description:
            return (lambda value: True) if self is ANYTHING else is_plain

        def quick(value: Any) -> bool:
            kind = type(value)
            if kind in _USUAL:
                sized = least < value < most or value == 0 or -most < value < -least
                return kind in accepted_types and sized
            return kind in accepted_types or (kind is np.ndarray and value.dtype.kind in kinds)

        return quick


def _require(holds: object) -> None:
    if not holds:
        raise TypeError


def _array(value: object, kinds: str) -> Any:
    """Array of numbers of one of these kinds; entries may be NaN for missing values."""
    _require(quantity_in(value) is None)  # NumPy would drop its unit
    array = np.asarray(value)
    if array.dtype.kind == "O" and all(isinstance(item, Real | Decimal) for item in array.flat):
        _require(not any(isinstance(item, bool) for item in array.flat))
        array = array.astype(float)  # fractions, integers of more than 64 bits
    if not array.size and array.dtype.kind == "f" and kinds in ("b", "iu"):
        array = array.astype(bool if kinds == "b" else np.int64)
    _require(array.dtype.kind in kinds)
    return array


def _number(value: Any, sized: int, integer: bool, several: bool) -> Any:
    """One number; with ``several`` arrays of numbers are returned unchanged."""
    number = _array(value, "fiu")
    if number.ndim and several:
        return value
    _require(number.ndim == 0)
    value = number.item()
    if sized and value and not TINY < abs(value) < ENDLESS:
        raise ValueRefusedError(
            f"Wanted: a finite number, zero or between {TINY:g} and {ENDLESS:g} in size"
        )
    if integer:
        _require(value == value and int(value) == value)
        return int(value)
    return value


def _numbers(kinds: str, sized: int, as_given: bool) -> Wanted:
    """Arrays; ``as_given`` leaves the conversion to the function."""

    def read(value: object) -> Any:
        array = _array(value, kinds)
        if sized and not array.ndim and array != array:
            raise ValueRefusedError("Wanted: numbers, not NaN")
        return value if as_given else array

    description = _ARRAYS.get(kinds, _ARRAYS["fiu"])
    if as_given:
        return Wanted(description, read, _USUAL, (0.0, 1e300), kinds)
    return Wanted(description, read, kinds=kinds)


def _that(description: str, holds: Callable[[Any], Any], *kinds: type) -> Wanted:
    def read(value: object) -> Any:
        _require(holds(value))
        return value

    return Wanted(description, read, frozenset(kinds))


def _instance(kind: type, strict: bool) -> Wanted:
    """Objects of a class; other objects are refused only after a function has failed."""

    def holds(value: object) -> bool:
        if strict and not getattr(kind, "_is_protocol", False):
            return isinstance(value, kind)
        home = type(value).__module__.partition(".")[0]
        return home not in _PLAIN or callable(value) or isinstance(value, kind)

    name = kind.__name__
    return _that(f"{'an' if name[:1] in 'AEIO' else 'a'} {name}", holds, kind)


def _items(hint: object, origin: type, strict: bool) -> Wanted:
    """Lists, tuples and mappings of checked items."""
    kinds = [kind for kind in typing.get_args(hint) if kind is not ...]
    # Entries may be NaN for missing values, as in arrays.
    each = [wanted(kind, 0, strict) for kind in kinds]
    quick = [item_kind.fits() for item_kind in each]
    fixed = origin is tuple and bool(each) and ... not in typing.get_args(hint)

    def read(value: Any) -> Any:
        if issubclass(origin, Mapping):
            _require(isinstance(value, Mapping))
            for items, item_kind in zip((value, value.values()), each, strict=False):
                for item in items:
                    item_kind.read(item)
            return value
        if each and not strict and not isinstance(value, Iterable):
            return each[0].read(value)  # a single item, which some functions accept
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
            item if fits(item) else item_kind.read(item)
            for item, item_kind, fits in zip(value, each * count, quick * count, strict=False)
        )
        return items if origin is tuple and each and not isinstance(value, tuple) else value

    inner = [
        re.sub(r"^a (list|[\w ]+$)", r"\1s", item_kind.description or "values")
        for item_kind in each
    ]
    container = "a mapping" if issubclass(origin, Mapping) else "a list"
    return Wanted(f"{container} of {', '.join(inner)}" if inner else container, read)


def _any_of(hints: Iterable[Any], sized: int, strict: bool) -> Wanted:
    several = [wanted(hint, sized, strict) for hint in hints]
    calls = any(alternative.description.startswith("a function") for alternative in several)

    def read(value: object) -> Any:
        fault = TypeError()
        for alternative in several:
            try:
                return alternative.read(value)
            except ValueRefusedError as refused:
                fault = refused
            except (TypeError, ValueError, OverflowError):
                continue
        if calls and isinstance(value, list | tuple) and value:
            return [read(item) for item in value] and value  # functions and numbers, in turn
        raise fault

    description = " or ".join(
        dict.fromkeys(alternative.description for alternative in several if alternative.description)
    )
    accepted_types = frozenset().union(*(alternative.types for alternative in several))
    kinds = {o.kinds for o in several}
    numbers = [alternative.numbers for alternative in several if alternative.types & {float, int}]
    return Wanted(
        description, read, accepted_types, numbers[0] if numbers else (1.0, -1.0), "".join(kinds)
    )


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

    description = f"a function of {count} value{'s'[: count - 1]}"
    return _that(description, holds if strict else callable, types.FunctionType)


ANYTHING = Wanted("", lambda value: value)
_NOTHING = _that("None", lambda value: value is None, types.NoneType)
_TRUTHS = (int, np.bool_, np.integer)
_SIMPLE = {
    bool: _that("True or False", lambda v: isinstance(v, _TRUTHS) and v in (0, 1), bool),
    str: _that("a text", lambda value: isinstance(value, str), str),
    types.NoneType: _NOTHING,
    None: _NOTHING,
}


def _without_alias(hint: Any) -> Any:
    """Type that an alias in an annotation names, such as that of arrays from NumPy 2.5 on."""
    alias = typing.get_origin(hint)
    if hasattr(alias, "__value__"):
        return alias.__value__[typing.get_args(hint)]
    named = hasattr(hint, "__value__") and hint != ArrayLike
    return _without_alias(hint.__value__) if named else hint


def wanted(hint: object, sized: int, strict: bool = False, several: bool = False) -> Wanted:
    """Check of an annotation; ``strict`` after a function has failed.

    ``sized`` is 0 for records, whose numbers may be NaN, 1 for methods, and 2 for functions;
    ``several`` accepts an array for a number.
    """
    hint = _without_alias(hint)
    origin, args = typing.get_origin(hint), typing.get_args(hint)
    every, kind = set(typing.get_args(ArrayLike)) or {ArrayLike}, origin or hint
    if hint in (float, int):
        several = several and hint is float and not strict
        read = functools.partial(_number, sized=sized, integer=hint is int, several=several)
        description, usual = ("a whole number", {int}) if hint is int else ("a number", _USUAL)
        return Wanted(description, read, frozenset(usual), (TINY, ENDLESS))
    if hint in _SIMPLE:
        return _SIMPLE[hint]
    if hint == ArrayLike:
        return _numbers("fiu", sized, as_given=True)
    if isinstance(hint, typing.TypeVar):
        return _any_of(hint.__constraints__, sized, strict) if hint.__constraints__ else ANYTHING
    if origin in (typing.Union, types.UnionType):
        array_like = [ArrayLike] if every <= set(args) else []
        others = [arg for arg in args if not array_like or arg not in every]
        if {Any, object} & set(others):
            return ANYTHING
        return _any_of([*array_like, *others], sized, strict)
    if origin is np.ndarray:
        item = typing.get_args(args[1])[0]
        # Methods and records also serve the package itself, for complex and logical arrays too.
        kinds = _ITEMS.get(item, "") + "cb" * (sized < 2)
        return _numbers(kinds, sized, as_given=False) if item in _ITEMS else ANYTHING
    if origin is typing.Literal:
        description = ", ".join(f'"{v}"' if isinstance(v, str) else str(v) for v in args)
        return _that(description, lambda value: isinstance(value, str | int) and value in args)
    if kind is abc.Callable:
        count = len(args[0]) if args and isinstance(args[0], list) else None
        return _that("a function", callable) if count is None else _function(count, strict)
    if not isinstance(kind, type) or kind in (type, object, Any):
        return ANYTHING
    if kind is tuple or (issubclass(kind, abc.Iterable) and kind.__module__ == "collections.abc"):
        return _items(hint, kind, strict)
    return _instance(kind, strict)
