"""Units in documentation and cookbook: the factor beside a unit turns SI into it."""

from __future__ import annotations

import math
import re
from pathlib import Path

import pytest

from references.cracked_solid import COMPLIANCE
from references.cracked_tooth import CRACKS
from tribodyn.units import convert

ROOT = Path(__file__).parents[2]
PAGES = [
    *(page for page in (ROOT / "docs").rglob("*.md") if "_generated" not in page.parts),
    ROOT / "README.md",
    *(ROOT / "src/tribodyn/cookbook").rglob("*.py"),
]
#: A field of a format string with a power of ten, and the unit after it.
SCALED = re.compile(r"\{(1e-?\d+) \* [^}]*\} ((?:[a-zA-Zµ%]+)(?:[ */^][a-zA-Z]+|\^\d)*)")
#: SI units of what is printed; a product of two lengths over a force is a compliance.
KINDS = ("m", "N", "Pa", "W", "s", "rad", "m^2/N", "N/m", "kg", "m^2", "Hz")
FAULTS = (ROOT / "docs/faults.md").read_text(encoding="utf-8")


def size(unit: str) -> float | None:
    """SI value of a unit; None for a word."""
    for kind in KINDS:
        try:
            return convert(1.0, unit, kind)
        except Exception:  # a unit of another kind, or no unit
            continue
    return None


def leading_unit(text: str) -> tuple[str, float] | None:
    """The longest unit at the beginning of a text, words after it left out."""
    words = text.split(" ")
    for count in range(len(words), 0, -1):
        unit = "*".join(words[:count])
        value = size(unit)
        if value is not None:
            return unit, value
    return None


def scaled_fields() -> list[tuple[str, str, str]]:
    """Page, factor and text after each scaled field."""
    return [
        (str(page.relative_to(ROOT)), *match.groups())
        for page in PAGES
        for match in SCALED.finditer(page.read_text(encoding="utf-8"))
    ]


def test_there_are_scaled_fields() -> None:
    assert len(scaled_fields()) > 8
    assert leading_unit("um peak to peak") == ("um", pytest.approx(1e-6))
    assert leading_unit("nm mm/N at the tip") == ("nm*mm/N", pytest.approx(1e-12))


@pytest.mark.parametrize(("page", "factor", "text"), scaled_fields())
def test_factor_turns_si_into_the_unit_beside_it(page: str, factor: str, text: str) -> None:
    unit = leading_unit(text)
    assert unit is not None, (page, text)
    assert math.isclose(float(factor) * unit[1], 1.0, rel_tol=1e-9), (page, factor, unit[0])


def test_compliances_of_cracks_are_those_of_the_reference() -> None:
    head = re.search(r"Triangles, load low, middle, high on the flank \[([^]]+)\]", FAULTS)
    assert head
    unit = convert(1.0, head[1].replace(" ", "*"), "m^2/N")
    rows = re.findall(r"^\|[^|]*\| ([\d.]+) mm \| (\d+)° \| (\d+)° \| ([^|]+) \|", FAULTS, re.M)
    assert len(rows) == len(CRACKS)
    for (depth, angle, tangent, values), (key, expected) in zip(rows, CRACKS.items(), strict=True):
        assert tuple(map(float, (depth, angle, tangent))) == key[1:]
        printed = [unit * float(value) for value in values.split(",")]
        assert printed == pytest.approx([1e-12 * each for each in expected], abs=0.006e-12)
    solid = re.search(r"high on the flank: ([\d., ]+) (\S+ mm/N)", FAULTS)
    assert solid
    unit = convert(1.0, solid[2].replace(" ", "*"), "m^2/N")
    values = [unit * float(value) for value in solid[1].split(",")]
    assert values == pytest.approx([1e-12 * each for each in COMPLIANCE], abs=0.006e-12)
