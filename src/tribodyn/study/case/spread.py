"""Values that are known within bounds: ``"0.05 +- 0.83 %"`` stands in the place of a value."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from tribodyn.errors import InputError, Problem
from tribodyn.nomenclature import QUANTITIES
from tribodyn.study.case.values import Plain
from tribodyn.uncertainty import distribution
from tribodyn.units import UnitProblemError, split

#: What tells a spread from a value, and where none is looked for.
_SPREAD, _RANGE = re.compile(r"\s*(?:\+-|\+/-|±)"), re.compile(r"\s\.\.\s")
_KIND = re.compile(r"^\s*(?:normal|lognormal|uniform)\s+", re.IGNORECASE)
_ELSEWHERE = ("title", "origin", "assumed", "based_on")

Found = list[tuple[str, Problem]]


def without_spread(
    data: Mapping[str, Any], prefix: str = ""
) -> tuple[dict[str, Any], dict[str, str], Found]:
    """Tables with the middle in place of every spread value, the spreads by key, and faults."""
    plain: dict[str, Any] = {}
    spreads: dict[str, str] = {}
    faults: Found = []
    for name, value in data.items():
        key, text = f"{prefix}{name}", value.value if isinstance(value, Plain) else value
        plain[name] = value
        if key in _ELSEWHERE:
            continue
        if isinstance(value, Mapping):
            plain[name], inner, wrong = without_spread(value, f"{key}.")
            spreads |= inner
            faults += wrong
        elif isinstance(text, str) and (_SPREAD.search(text) or _RANGE.search(text)):
            try:
                plain[name], spreads[key] = _middle(key, text), text
            except InputError as error:
                faults.append((key, error.problems[0]))
    return plain, spreads, faults


def _middle(key: str, text: str) -> str:
    """The value about which a quantity is spread, as text."""
    spread = _SPREAD.search(text)
    first = _KIND.sub("", text[: (spread or _RANGE.search(text) or spread).start()])  # type: ignore[union-attr]
    known = QUANTITIES.get(key.rpartition(".")[2])
    try:  # the unit as it is written where the nomenclature has none
        unit = known.unit if known else split(first)[1]
    except UnitProblemError as error:
        raise InputError(str(error)) from None
    drawn = distribution(key, text, unit)
    return first if spread else f"{float(drawn.ppf(0.5))!r} {unit}".strip()
