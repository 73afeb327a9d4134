"""Conversion between text with a unit and SI floats.

``pint`` is imported only for units that are missing in the small table of common ones, since its
import takes longer than reading a case.
The field's spellings are known: ``Nm``, ``N·m``, ``r/min``, ``cSt``, ``cP``, ``mPa s``, ``µm``,
``N/(mm µm)``, ``kg mm2``, ``°``, ``°C``; plain pint reads ``150 Nm`` as a textile unit and rejects
``1400 r/min``. An angle is a kind of its own: ``15 Hz`` is no rotational speed, because only the
author knows whether a factor of 2 pi is meant.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
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

#: SI unit -> usual unit -> (times, per): SI value = value * times / per. Two integers, so
#: that 4.5 mm is the float nearest to 0.0045. A test compares every entry with pint.
_USUAL: dict[str, dict[str, tuple[float, float]]] = {
    "m": {"mm": (1, 1e3), "um": (1, 1e6), "cm": (1, 1e2), "nm": (1, 1e9)},
    "m^2/s": {"mm^2/s": (1, 1e6)},
    "m/s": {"mm/s": (1, 1e3), "um/s": (1, 1e6)},
    "m/s^2": {"mm/s^2": (1, 1e3)},
    "kg": {"g": (1, 1e3)},
    "kg*m^2": {"kg*mm^2": (1, 1e6), "kg*cm^2": (1, 1e4), "g*mm^2": (1, 1e9)},
    "kg/m^3": {"g/cm^3": (1e3, 1), "kg/dm^3": (1e3, 1), "kg/l": (1e3, 1)},
    "s": {"ms": (1, 1e3), "us": (1, 1e6), "min": (60, 1)},
    "Hz": {"kHz": (1e3, 1)},
    "rad": {"deg": (math.pi, 180)},
    "rad/s": {"rpm": (math.pi, 30)},
    "N": {"kN": (1e3, 1)},
    "N^2": {"kN^2": (1e6, 1)},
    "W": {"kW": (1e3, 1)},
    "m/N": {"um/kN": (1, 1e9), "um/N": (1, 1e6)},
    "N*m": {"kN*m": (1e3, 1), "N*mm": (1, 1e3)},
    "N/m": {"N/um": (1e6, 1), "N/mm": (1e3, 1), "kN/mm": (1e6, 1), "kN/m": (1e3, 1)},
    "N/m^2": {"N/(mm*um)": (1e9, 1), "N/mm/um": (1e9, 1)},
    "N*s/m": {"N*s/mm": (1e3, 1)},
    "Pa": {"kPa": (1e3, 1), "MPa": (1e6, 1), "GPa": (1e9, 1), "N/mm^2": (1e6, 1), "bar": (1e5, 1)},
    "Pa*s": {"mPa*s": (1, 1e3)},
    "1/m^2": {"1/mm^2": (1e6, 1)},
    "1/Pa": {"1/MPa": (1, 1e6), "1/GPa": (1, 1e9), "GPa^-1": (1, 1e9), "Pa^-1": (1, 1)},
}
#: Multiples of the standard acceleration of gravity, where an acceleration is meant: the same ``g``
#: is a gram where a mass is meant.
STANDARD_GRAVITY = 9.80665
_GRAVITY = {"g": 1.0, "gn": 1.0, "g^0": 1.0, "g_n": 1.0, "g_0": 1.0, "mg": 1e-3}
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

    registry: Any = pint.UnitRegistry(autoconvert_offset_to_baseunit=True, cache_folder=None)
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


def _usual(value: float, unit: str, si: str) -> float | None:
    """Return ``value`` in ``si``, or None when the table does not hold the unit."""
    if unit == si:
        return value
    if si == "K" and unit == "degC":
        return value + ZERO_CELSIUS
    if si == "m/s^2" and unit in _GRAVITY:
        return value * _GRAVITY[unit] * STANDARD_GRAVITY
    scale = _USUAL.get(si, {}).get(unit)
    return None if scale is None else value * scale[0] / scale[1]


def _from_si(value: float, si: str, unit: str) -> float | None:
    """Return an SI ``value`` in ``unit``, or None when the table does not hold the unit."""
    if si == "K" and unit == "degC":
        return value - ZERO_CELSIUS
    if si == "m/s^2" and unit in _GRAVITY:
        return value / (_GRAVITY[unit] * STANDARD_GRAVITY)
    scale = _USUAL.get(si, {}).get(unit)
    return None if scale is None else value * scale[1] / scale[0]


def _by_pint(value: float, unit: str, to: str) -> float:
    """Convert with pint; both units in plain spelling."""
    import pint

    registry = _registry()
    # Refuse units that pint would compute for ever or read as a comment.
    odd = _TOKEN.sub("", unit) or unit.count("(") > 5
    try:
        if odd:
            raise ValueError
        quantity = registry.Quantity(value, unit.replace("^", "**"))
        wanted = registry.Quantity(1.0, to.replace("^", "**"))
    except Exception as error:  # the tokenizer of pint raises errors of many types
        raise UnitProblemError(f'"{unit}" is not a known unit') from error
    message = (
        f'"{value:g} {unit}" cannot be expressed in {to or "a pure number"}: wrong kind of quantity'
    )
    try:
        if _angle_power(quantity) != _angle_power(wanted):
            raise UnitProblemError(f"{message} (one is an angle or a rotational speed)")
        converted = float(quantity.to(wanted.units).magnitude)
    except (pint.DimensionalityError, pint.OffsetUnitCalculusError) as error:
        raise UnitProblemError(message) from error
    except ArithmeticError:
        converted = math.inf
    if not math.isfinite(converted):
        raise UnitProblemError(f'"{value:g} {unit}" is too large a number in {to}')
    return converted


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
    return float(match.group(1)), match.group(2).strip()


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
        Value in ``unit``.

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
    number, written = split(text)
    if not math.isfinite(number):
        raise UnitProblemError(f'"{text}" is not a finite number')
    if not written:
        if unit:
            raise UnitProblemError(f'"{text}" has no unit; write for example "{number:g} {unit}"')
        return number
    plain, wanted = _plain(written), _plain(unit)
    value = _usual(number, plain, wanted)
    return _by_pint(number, plain, wanted) if value is None else value


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
    plain, wanted = _plain(unit), _plain(to)
    for converted in (_usual(value, plain, wanted), _from_si(value, plain, wanted)):
        if converted is not None:
            return converted
    return _by_pint(value, plain, wanted)


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
    """Text with a unit in the fewest digits that read back to the same float, within rounding."""
    for target in (display_unit or unit, unit):
        number = convert(float(value), unit, target)
        for digits in _DIGITS:
            text = f"{number:.{digits}g} {target}"
            # 0.4 um is read as the float next to 4e-7
            rounding = 2.3e-16 if digits == _DIGITS[0] else 0.0
            if math.isclose(parse(text, unit), value, rel_tol=rounding):
                return text
    return f"{float(value)!r} {unit}"


guard(__name__)
