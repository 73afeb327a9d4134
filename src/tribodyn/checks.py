"""Checks of arguments that are quantities of the nomenclature."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import Argument, InputError, floats, real_numbers, require_positive, shortened
from tribodyn.nomenclature import QUANTITIES
from tribodyn.types import Array

#: Remedy for a value that is not positive.
_REMEDIES = {
    "load_per_width": "1 N/mm is 1000 N/m",
    "entrainment_speed": "A film needs a rolling motion: give half the sum of the surface speeds",
    "eyring_stress": "5 MPa is 5e6 Pa",
}


def positive(**quantities: ArrayLike) -> list[Array]:
    """Arrays of named quantities; raise unless all values are finite and positive."""
    arrays = [floats(Argument(name), value) for name, value in quantities.items()]
    for name, array in zip(quantities, arrays, strict=True):
        if not array.size or (array.min() > 0.0 and array.max() < np.inf):
            continue
        if not np.all((array > 0.0) & (array < np.inf)):
            unit = QUANTITIES[name].unit if name in QUANTITIES else ""
            require_positive(name, array, unit, remedy=_REMEDIES.get(name, ""))
    require_one_shape(**dict(zip(quantities, arrays, strict=True)))
    return arrays


def require_one_shape(**arrays: Array) -> None:
    """Raise :class:`InputError` unless arrays, each called by its name, broadcast to one shape."""
    try:
        np.broadcast_shapes(*(array.shape for array in arrays.values()))
    except ValueError:
        what = ", ".join(f"{name} has the shape {array.shape}" for name, array in arrays.items())
        why, remedy = "They are combined element by element", "Give numbers, or arrays of one shape"
        raise InputError(what, Argument(" and ".join(arrays)), why, remedy) from None


def one_or_more(**quantities: ArrayLike) -> list[Array]:
    """Lists of positive quantities, each given as one value or as several."""
    lists = [np.array(positive(**{n: v})[0], ndmin=1) for n, v in quantities.items()]
    for name, values in zip(quantities, lists, strict=True):
        if values.ndim != 1 or values.size == 0:
            what = f"{name} has the shape {values.shape}"
            remedy = "Give each value once; all combinations are computed"
            raise InputError(what, Argument(name), "It is one value or a list of values", remedy)
    return lists


def require_whole(name: str, value: Any, least: int = 1, *, why: str = "") -> int:
    """Return a whole number, or raise :class:`InputError`."""
    wanted = f"{why} a whole number".strip()
    number = real_numbers(Argument(name), value, wanted)
    if number.ndim or not (float(number).is_integer() and least <= number <= 1e9):
        reason = f"Wanted: {wanted} from {least} to {1e9:g}"
        what, remedy = f"{name} = {shortened(repr(value))}", "Give a number of this range"
        raise InputError(what, Argument(name), reason, remedy)
    return int(number)


def require_number(name: str, value: Any) -> float:
    """Return one finite number, or raise :class:`InputError`."""
    number = real_numbers(Argument(name), value, "a number")
    if number.ndim or not np.abs(number) < 1e60:
        what, why = f"{name} = {shortened(repr(value))}", "Wanted: one finite number"
        raise InputError(what, Argument(name), why, "Give a number in SI units")
    return float(number)


def require_flag(name: str, value: Any) -> bool:
    """Return True or False, or raise :class:`InputError` for anything else."""
    if not isinstance(value, bool | int | np.bool_) or value not in (0, 1):
        what, why = f"{name} = {shortened(repr(value))}", "Wanted: True or False"
        raise InputError(what, Argument(name), why, "Give one of the two")
    return bool(value)
