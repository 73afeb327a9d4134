"""Conversion between text with a unit and SI floats.

``pint`` is imported only for units that are missing in the small table of common ones, since its
import takes longer than reading a case.
The field's spellings are known: ``Nm``, ``N·m``, ``r/min``, ``cSt``, ``cP``, ``mPa s``, ``µm``,
``N/(mm µm)``, ``kg mm2``, ``°``, ``°C``; plain pint reads ``150 Nm`` as a textile unit and rejects
``1400 r/min``. An angle is a kind of its own: ``15 Hz`` is no rotational speed, because only the
author knows whether a factor of 2 pi is meant.
"""

from __future__ import annotations

import contextlib
import math
import re
from collections.abc import Iterable
from decimal import Context, Decimal
from fractions import Fraction
from functools import lru_cache
from typing import Any

from tribodyn.arguments import guard

__all__ = [
    "SPELLINGS",
    "UnitProblemError",
    "convert",
    "format_quantity",
    "parse",
    "readings",
    "split",
]

_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)(.*)", re.DOTALL | re.ASCII)
#: Most characters of a quantity.
_LONGEST = 200
#: A unit in plain spelling: names and integer factors, with small integer powers.
_TOKEN = re.compile(
    r"\^\(?[+-]?\d(?:\.\d+)?(?![\d.])\)?(?!\^)|[A-Za-z_%][A-Za-z0-9_%]*"
    r"|\d{1,6}(?:\.\d{1,6})?(?![\w.])|[*/() ]",
    re.ASCII,
)

#: A number with a decimal comma or thousands separators, and the text after it.
_GROUPED = re.compile(
    r"\s*([+-]?\d+(?:[.,'’\s]\d+)*(?:[eE][+-]?\d+)?)(?![\d/])\s*(.*?)\s*", re.DOTALL
)

#: Field spelling -> the plain spelling used in the table below and understood by pint.
SPELLINGS: dict[str, str] = {
    "Nm": "(N*m)",
    "kNm": "(kN*m)",
    "mNm": "(mN*m)",
    "Nmm": "(N*mm)",
    "Ns": "(N*s)",
    "Nms": "(N*m*s)",
    "Pas": "(Pa*s)",
    "mPas": "(mPa*s)",
    "RPM": "rpm",
    "r/min": "rpm",
    "rev/min": "rpm",
    "U/min": "rpm",
    "1/min": "rpm",
    "min^-1": "rpm",
    "min-1": "rpm",
    "cSt": "(mm^2/s)",
    "cP": "(mPa*s)",
    "°C": "degC",
    "°F": "degF",
    "°": "deg",
    "mum": "um",
    "micron": "um",
    "rev": "turn",
}

_SIGNS = {
    **dict.fromkeys(("·", "⋅", "×", "•"), "*"),
    **dict.fromkeys(("µ", "μ"), "u"),
    **{"⁻¹": "^-1 ", "⁻²": "^-2 ", "⁻³": "^-3 ", "²": "^2 ", "³": "^3 ", "⁴": "^4 "},
    **{"−": "-", "**": "^"},
}
_WORD = re.compile(
    r"(?<![A-Za-z0-9_°])(?:"
    + "|".join(re.escape(spelling) for spelling in sorted(SPELLINGS, key=len, reverse=True))
    + r")(?![A-Za-z0-9_])"
)

#: Of pi more digits than a float has, so that 30 deg is the float nearest to pi / 6.
_PI = Fraction("3.14159265358979323846264338327950288419716939937510")
#: SI unit -> usual unit -> how many SI units it is, exactly. A test compares every entry with pint.
_SCALES: dict[str, dict[str, str | int | Fraction]] = {
    "m": {"mm": "1e-3", "um": "1e-6", "cm": "1e-2", "nm": "1e-9"},
    "m^2/s": {"mm^2/s": "1e-6"},
    "m^3": {"l": "1e-3"},
    "m/s": {"mm/s": "1e-3", "um/s": "1e-6"},
    "m/s^2": {"mm/s^2": "1e-3"},
    "kg": {"g": "1e-3"},
    "kg*m^2": {"kg*mm^2": "1e-6", "kg*cm^2": "1e-4", "g*mm^2": "1e-9"},
    "kg/m^3": {"g/cm^3": 1000, "kg/dm^3": 1000, "kg/l": 1000},
    "s": {"ms": "1e-3", "us": "1e-6", "min": 60, "h": 3600},
    "Hz": {"kHz": 1000},
    "rad": {"deg": _PI / 180},
    "rad/s": {"rpm": _PI / 30},
    "N": {"kN": 1000},
    "N^2": {"kN^2": "1e6"},
    "W": {"kW": 1000},
    "m/N": {"um/kN": "1e-9", "um/N": "1e-6"},
    "N*m": {"kN*m": 1000, "N*mm": "1e-3"},
    "N/m": {"N/um": "1e6", "N/mm": 1000, "kN/mm": "1e6", "kN/m": 1000},
    "N/m^2": {"N/(mm*um)": "1e9", "N/mm/um": "1e9"},
    "N*s/m": {"N*s/mm": 1000},
    "Pa": {"kPa": 1000, "MPa": "1e6", "GPa": "1e9", "N/mm^2": "1e6", "bar": "1e5"},
    "Pa*s": {"mPa*s": "1e-3"},
    "1/m^2": {"1/mm^2": "1e6"},
    "1/Pa": {"1/MPa": "1e-6", "1/GPa": "1e-9", "GPa^-1": "1e-9", "Pa^-1": 1},
    "byte": {"GB": "1e9", "MB": "1e6"},
}
_USUAL = {
    si: {unit: Fraction(scale) for unit, scale in scales.items()} for si, scales in _SCALES.items()
}
#: Multiples of the standard acceleration of gravity, where an acceleration is meant: the same ``g``
#: is a gram where a mass is meant.
STANDARD_GRAVITY = 9.80665
_GRAVITY = dict.fromkeys(("g", "gn", "g^0", "g_n", "g_0"), Fraction("9.80665"))
_GRAVITY["mg"] = Fraction("9.80665e-3")
#: Zero degrees Celsius [K], and one revolution per minute [rad/s].
ZERO_CELSIUS, RPM = 273.15, math.pi / 30.0


class UnitProblemError(ValueError):
    """Text is not a quantity of the required dimension; the message has the reason and the fix."""


#: Rule for numbers.
NUMBERS = "the decimal sign is a point, not a comma, and thousands have no separator"


def quoted(texts: Iterable[str]) -> str:
    """List texts in quotes, separated by or."""
    return " or ".join(f'"{text}"' for text in texts)


@lru_cache(maxsize=1)
def _registry() -> Any:
    import pint

    registry: Any = pint.UnitRegistry(
        autoconvert_offset_to_baseunit=True, cache_folder=None, non_int_type=Fraction
    )
    return registry


@lru_cache(maxsize=1024)
def _plain(unit: str) -> str:
    """Rewrite common spellings of units: ``mPa s`` -> ``mPa*s``, ``kg mm2`` -> ``kg*mm^2``."""
    text = unit.strip()
    if len(text) > _LONGEST:
        raise UnitProblemError(f'"{text[:40]}..." is longer than any unit')
    for sign, plain in _SIGNS.items():
        text = text.replace(sign, plain)
    text = _WORD.sub(lambda match: f" {SPELLINGS[match.group()]} ", text)
    text = re.sub(r"([A-Za-z])(-?\d+)", r"\1^\2", text)
    text = re.sub(r"\s*([*/^()])\s*", r"\1", text.strip())
    text = re.sub(r"([A-Za-z0-9)])\s+(?=[A-Za-z(])|(?<=\))(?=[A-Za-z(])", r"\1*", text)
    bracketed = re.fullmatch(r"\(([^()]*)\)", text)
    return bracketed.group(1) if bracketed else text


def _exact(value: Fraction, unit: str, to: str) -> Fraction:
    """Convert without rounding; both units in plain spelling."""
    if unit == to:
        return value
    if {unit, to} == {"K", "degC"}:
        return value + Fraction("273.15") * (1 if to == "K" else -1)
    if (scale := _scale(unit, to)) is not None:
        return value * scale
    return _by_pint(value, unit, to) if (scale := _scale(to, unit)) is None else value / scale


def _scale(unit: str, si: str) -> Fraction | None:
    """How many SI units a unit of the table is."""
    if si == "m/s^2" and unit in _GRAVITY:
        return _GRAVITY[unit]
    return _USUAL.get(si, {}).get(unit)


def _nearest(value: Fraction, unit: str, to: str) -> float:
    """The float nearest to a value in another unit; both units in plain spelling."""
    try:
        return float(_exact(value, unit, to))
    except OverflowError as error:
        text = f'"{float(value):g} {unit}" is too large a number in {to}'
        raise UnitProblemError(text) from error


def _by_pint(value: Fraction, unit: str, to: str) -> Fraction:
    """Convert with pint; both units in plain spelling."""
    import pint

    registry = _registry()
    # Refuse units that pint would compute for ever or read as a comment.
    odd = _TOKEN.sub("", unit) or unit.count("(") > 5
    try:
        if odd:
            raise ValueError
        quantity = registry.Quantity(value, unit.replace("^", "**"))
        wanted = registry.Quantity(Fraction(1), to.replace("^", "**"))
    except Exception as error:  # the tokenizer of pint raises errors of many types
        raise UnitProblemError(f'"{unit}" is not a known unit') from error
    message = (
        f'"{float(value):g} {unit}" cannot be expressed in {to or "a pure number"}: '
        "wrong kind of quantity"
    )
    try:
        if _angle_power(quantity) != _angle_power(wanted):
            raise UnitProblemError(f"{message} (one is an angle or a rotational speed)")
        return Fraction(quantity.to(wanted.units).magnitude)
    except (pint.DimensionalityError, pint.OffsetUnitCalculusError) as error:
        raise UnitProblemError(message) from error
    except TypeError as error:  # pint takes no logarithm of a fraction
        raise UnitProblemError(
            f'"{unit}" is a logarithmic unit; write {to or "a number"}'
        ) from error


def _angle_power(quantity: Any) -> float:
    """Power of the radian, which pint takes for the pure number 1."""
    return float(dict(quantity.to_root_units().unit_items()).get("radian", 0))


def readings(text: str) -> list[str]:
    """Possible meanings of a number with commas or separators; empty for a plain number.

    Parameters
    ----------
    text : str
        Number, perhaps followed by a unit.

    Returns
    -------
    list of str
        The same text with a decimal point and no separators: one reading, two, or none.

    Examples
    --------
    >>> readings("2,500 rpm"), readings("1.234,5 N"), readings("3,0 mm"), readings("4.5 mm")
    (['2500 rpm', '2.5 rpm'], ['1234.5 N'], ['3.0 mm'], [])
    """
    match = _GROUPED.fullmatch(text) if len(text) <= _LONGEST else None
    if match is None or any(each.isdecimal() and not each.isascii() for each in text):
        return []
    number, unit = match.groups()
    mantissa, power, exponent = re.fullmatch(r"([^eE]*)([eE]?)(.*)", number).groups()  # type: ignore[union-attr]
    head, *digit_groups = re.split(r"[.,'’\s]", mantissa)
    signs = re.sub(r"[\d+-]", "", mantissa)
    in_threes = all(len(group) == 3 for group in digit_groups)
    short_head = 0 < len(head.lstrip("+-")) <= 3 and head.lstrip("+-") != "0"
    meanings = []
    if signs and signs != "." and short_head and in_threes and len(set(signs)) == 1:
        meanings.append(head + "".join(digit_groups))
    if signs == ",":
        meanings.append(
            f"{head}.{digit_groups[0].rstrip('0') or '0' if meanings else digit_groups[0]}"
        )
    elif len(signs) > 1 and signs[-1] in ".," and len(set(signs[:-1])) == 1 != len(set(signs)):
        grouped = short_head and all(len(group) == 3 for group in digit_groups[:-1])
        meanings += [f"{head}{''.join(digit_groups[:-1])}.{digit_groups[-1]}"] if grouped else []
    return [f"{reading}{power}{exponent} {unit}".strip() for reading in meanings]


def split(text: str) -> tuple[float, str]:
    """Split ``"4.5 mm"`` into its number and its unit.

    Parameters
    ----------
    text : str
        Number followed by a unit; the unit may be empty.

    Returns
    -------
    tuple of float and str
        Number as written and unit as written.

    Raises
    ------
    UnitProblemError
        If the text does not begin with a number.

    Examples
    --------
    >>> split("4.5 mm")
    (4.5, 'mm')
    """
    digits, unit = _split(text)
    return float(digits), unit


def _split(text: str) -> tuple[str, str]:
    """Number and unit, both as written."""
    if meant := readings(text):
        raise UnitProblemError(f'"{text}": {NUMBERS}; write {quoted(meant)}')
    if len(text) > _LONGEST:
        length_text = f'"{text[:40]}..." has {len(text)} characters'
        raise UnitProblemError(f"{length_text}, and a quantity at most {_LONGEST}")
    if any(each.isdecimal() and not each.isascii() for each in text):
        raise UnitProblemError(f'"{text}": the digits of a number are 0 to 9')
    match = _NUMBER.fullmatch(text)
    if match is None:
        raise UnitProblemError(f'"{text}" does not begin with a number')
    return match.group(1), match.group(2).strip()


@lru_cache(maxsize=1024)
def parse(text: str, unit: str) -> float:
    """Read text with a unit as a float in SI.

    Parameters
    ----------
    text : str
        For example ``"4.5 mm"``, ``"1400 r/min"``, ``"150 Nm"``.
    unit : str
        The SI unit wanted; ``""`` for a pure number.

    Returns
    -------
    float
        Value in ``unit``: the float nearest to the number as written times the exact scale.

    Raises
    ------
    UnitProblemError
        If the text is no number, has no unit, an unknown unit or the wrong dimension.

    Examples
    --------
    >>> parse("150 Nm", "N*m")
    150.0
    >>> round(parse("1400 r/min", "rad/s"), 6)
    146.607657
    >>> round(parse("40 °C", "K"), 2)
    313.15
    """
    digits, written = _split(text)
    number = float(digits)
    if not math.isfinite(number):
        raise UnitProblemError(f'"{text}" is not a finite number')
    if not written:
        if unit:
            raise UnitProblemError(f'"{text}" has no unit; write for example "{number:g} {unit}"')
        return number
    # the exponent of a zero has no limit
    exact = Fraction(digits) if number else Fraction(0)
    return _nearest(exact, _plain(written), _plain(unit))


@lru_cache(maxsize=256)
def convert(value: float, unit: str, to: str) -> float:
    """Convert a float from one unit to another.

    Parameters
    ----------
    value : float
        Value in ``unit``; any, NaN too.
    unit, to : str
        Unit of the value and unit wanted.

    Returns
    -------
    float
        Value in ``to``.

    Raises
    ------
    UnitProblemError
        If the two units are of different kinds.

    Examples
    --------
    >>> convert(0.0045, "m", "mm")
    4.5
    """
    if not math.isfinite(value):
        return value + _nearest(Fraction(1), _plain(unit), _plain(to))
    return _nearest(Fraction(value), _plain(unit), _plain(to))


def shown_in(value: float, unit: str) -> float:
    """Return an SI value in one of its common units, or in SI if it has none."""
    plain = _plain(unit)
    if plain == "%":
        return 100.0 * value
    si = "K" if plain == "degC" else next((s for s, u in _USUAL.items() if plain in u), plain)
    return convert(value, si, plain)


def usual_units(unit: str) -> list[str]:
    """Common units for an SI unit, the SI unit first."""
    return [unit, *_USUAL.get(unit, {}), *(["degC"] if unit == "K" else [])]


def format_quantity(value: float, unit: str, display_unit: str | None = None) -> str:
    """Write an SI float as text with a unit that :func:`parse` reads back.

    Parameters
    ----------
    value : float
        Value in ``unit``; any, NaN too.
    unit : str
        SI unit.
    display_unit : str, optional
        Unit to write; ``unit`` by default.

    Examples
    --------
    >>> format_quantity(0.0045, "m", "mm")
    '4.5 mm'
    """
    target_unit = display_unit or unit
    return f"{convert(float(value), unit, target_unit):.10g} {target_unit}".strip()


#: Significant digits of a number, tried in order until it reads back.
_DIGITS = (10, 15, 16, 17)


def shortest_quantity(value: float, unit: str, display_unit: str = "") -> str:
    """Text with a unit in the fewest digits that read back to the same float."""
    for target in (display_unit or unit, unit):
        number = _exact(Fraction(value), _plain(unit), _plain(target))
        for digits in _DIGITS:
            quotient = Context(digits).divide(*map(Decimal, number.as_integer_ratio()))
            text = f"{float(quotient):.{digits}g}" if digits < 17 else f"{quotient:.17g}"
            with contextlib.suppress(UnitProblemError):  # above the largest float
                if parse(f"{text} {target}", unit) == value:
                    return f"{text} {target}"
    return f"{float(value)!r} {unit}"


guard(__name__)
