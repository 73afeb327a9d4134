"""Every quantity of the product once: name, symbol, unit, display unit, meaning.

Case fields, summary figures, plot axes and the glossary come from the table ``nomenclature.txt`` or
are tested against it: name, symbol, unit, display unit, meaning and example in each row. Symbols
follow ISO 21771 and ISO 6336 where they have one.
"""

from __future__ import annotations

import difflib
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Literal

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.arguments import guard
from tribodyn.errors import Argument, InputError, floats, real_numbers, require_positive, shortened
from tribodyn.types import Array

__all__ = ["GEARS", "QUANTITIES", "Quantity", "find", "lookup"]

#: Names of both gears of a pair, the smaller one first.
GEARS: Final = ("pinion", "wheel")
GearName = Literal["pinion", "wheel"]
#: Name of the mesh of a pair of gears.
PAIR_MESH: Final = "mesh"


class UnknownQuantityError(InputError, KeyError):
    """No quantity has this name."""

    __str__ = Exception.__str__


@dataclass(frozen=True)
class Quantity:
    """One named quantity.

    Parameters
    ----------
    name : str
        Long exact name used in the API.
    symbol : str
        Symbol of the field, plain text.
    unit : str
        SI unit, empty for a pure number.
    display_unit : str
        Unit shown to engineers.
    meaning : str
        One line.
    example : str
        A sensible value as a case file writes it.
    """

    name: str
    symbol: str
    unit: str
    display_unit: str
    meaning: str
    example: str = ""

    @property
    def label(self) -> str:
        """Axis label: name in words with the display unit."""
        label = self.name.replace("_", " ")
        label = label[0].upper() + label[1:]
        return f"{label} [{self.display_unit}]" if self.display_unit else label


def _read() -> dict[str, Quantity]:
    table = Path(__file__).with_name("nomenclature.txt").read_text(encoding="utf-8")
    rows = (line.split("|") for line in table.splitlines())
    quantities = (Quantity(*(cell.strip() for cell in row)) for row in rows)
    return {quantity.name: quantity for quantity in quantities}


#: Every quantity by its name.
QUANTITIES: dict[str, Quantity] = _read()


def lookup(name: str) -> Quantity:
    """Return the quantity called ``name``.

    Parameters
    ----------
    name : str
        Exact name.

    Raises
    ------
    InputError
        If there is none; the message names the nearest. It is a KeyError as well.

    Examples
    --------
    >>> lookup("base_radius").symbol
    'r_b'
    """
    if name in QUANTITIES:
        return QUANTITIES[name]
    matches = difflib.get_close_matches(name, QUANTITIES, n=1)
    hint = f'; did you mean "{matches[0]}"?' if matches else ""
    what, why = f'no quantity is called "{name}"{hint}', "QUANTITIES holds all names"
    raise UnknownQuantityError(what, Argument("name"), why, "Look for it with find(name)")


def find(text: str) -> list[Quantity]:
    """Find quantities by symbol, name or part of a name.

    Parameters
    ----------
    text : str
        What the user typed.

    Returns
    -------
    list of Quantity
        Exact matches of symbol or name alone if there are any, else all partial matches.

    Examples
    --------
    >>> [quantity.name for quantity in find("epsilon_alpha")]
    ['transverse_contact_ratio']
    """
    exact = [q for q in QUANTITIES.values() if text in (q.name, q.symbol)]
    if exact:
        return exact
    lowered = text.lower().replace(" ", "_")
    return [q for q in QUANTITIES.values() if lowered in q.name or lowered in q.meaning.lower()]


guard(__name__)


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


def require_whole(name: str, value: object, least: int = 1, *, why: str = "") -> int:
    """Return a whole number, or raise :class:`InputError`."""
    wanted = f"{why} a whole number".strip()
    number = real_numbers(Argument(name), value, wanted)
    if number.ndim or not (float(number).is_integer() and least <= number <= 1e9):
        reason = f"Wanted: {wanted} from {least} to {1e9:g}"
        what, remedy = f"{name} = {shortened(repr(value))}", "Give a number of this range"
        raise InputError(what, Argument(name), reason, remedy)
    return int(number)


def require_number(name: str, value: object) -> float:
    """Return one finite number, or raise :class:`InputError`."""
    number = real_numbers(Argument(name), value, "a number")
    if number.ndim or not np.abs(number) < 1e60:
        what, why = f"{name} = {shortened(repr(value))}", "Wanted: one finite number"
        raise InputError(what, Argument(name), why, "Give a number in SI units")
    return float(number)


def require_flag(name: str, value: object) -> bool:
    """Return True or False, or raise :class:`InputError` for anything else."""
    if not isinstance(value, bool | int | np.bool_) or value not in (0, 1):
        what, why = f"{name} = {shortened(repr(value))}", "Wanted: True or False"
        raise InputError(what, Argument(name), why, "Give one of the two")
    return bool(value)
