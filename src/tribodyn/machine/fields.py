"""Checks of the fields of the parts of a machine."""

from __future__ import annotations

import math

from tribodyn.errors import Argument, InputError, real_numbers, shortened

#: Factor and name of the unit in which a message states a quantity.
_DISPLAY_UNITS = {
    "m": (1e3, "mm"),
    "rad": (180.0 / math.pi, "deg"),
    "rad/s": (30.0 / math.pi, "rpm"),
}
_LARGEST = 1e30


def display(value: float, unit: str) -> str:
    """Write an SI value in the unit of a drawing: mm, deg or rpm."""
    factor, name = _DISPLAY_UNITS.get(unit, (1.0, unit))
    return f"{value * factor:.6g} {name}".rstrip()


def check_number(
    part: object,
    name: str,
    unit: str = "",
    low: float = -_LARGEST,
    high: float = _LARGEST,
    *,
    above: bool = False,
    why: str = "",
) -> None:
    """Make a field of a part a float within its limits; ``above`` excludes the lower one."""
    if type(plain := getattr(part, name)) is float and low < plain < high:
        return
    where = Argument(f"{type(part).__name__}.{name}")
    value = real_numbers(where, plain, f"a number [{unit or 1}]")
    if value.ndim:
        what, remedy = f"{name} has the shape {value.shape}", "Give one number"
        raise InputError(what, where, "Wanted: one number in SI units", remedy)
    number = float(value)
    if not low <= number <= high or (above and number == low):
        sign = "greater than" if above else "at least"
        limits = [f"{sign} {display(low, unit)}"] if low > -_LARGEST else []
        limits += [f"at most {display(high, unit)}"] if high < _LARGEST else []
        limit = " and ".join(["finite", *limits])
        raise InputError(
            f"{name} = {display(number, unit)}",
            where,
            why or f"It must be {limit}",
            f"Give {name}{f' in {unit}' if unit else ''}, {limit}",
        )
    object.__setattr__(part, name, number)


def check_name(part: object, name: str) -> None:
    """Refuse a field that is not the name of a part."""
    value = getattr(part, name)
    if not isinstance(value, str) or not value:
        what, where = f"{name} = {quoted(value)}", Argument(f"{type(part).__name__}.{name}")
        raise InputError(what, where, "Wanted: the name of a part", "Give its name as a text")


def quoted(value: object) -> str:
    """Quote a value of any kind, shortened."""
    return f'"{value}"' if isinstance(value, str) else shortened(repr(value), 60)
