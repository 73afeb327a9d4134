"""Mutated case files: a sound message, never a traceback, a hang, or a flood of text."""

from __future__ import annotations

import random
import re
import unicodedata
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from fuzz.damage import at_most
from tribodyn import load_case
from tribodyn.cases import case_files
from tribodyn.errors import TribodynError, quiet
from tribodyn.study import Case
from tribodyn.study.pipeline.assembly import geometry
from tribodyn.study.pipeline.cautions import case_cautions

Draws = Callable[[int], Iterator[random.Random]]

_VALUES = [
    '""', '"4.5"', '"4.5 mmm"', '"4.5 m^9^9^9"', '"4.5 mm # x"', '"4.5 mm\\u0000"', '"٤.٥ mm"',
    '"４.5 mm"', '"1 km^400"', '"10 rpm²1**3"', '"2,500 rpm"', '"nan mm"', '"inf mm"', '"1e999 mm"',
    '"-1 mm"', "0", "-1", "1e308", "1e-320", "nan", "inf", "true", "[]", "{}", "[[1]]",
    "1979-05-27",
    "07:32:00", "0x" + "f" * 4000, "9" * 4301, "1" + "0" * 310, "0o7", "1_000", "+1",
    '"\\u001b[2J"',
    '"' + "x" * 5000 + '"', '"' + "(" * 90 + '"', "[" * 400 + "]" * 400, "[" * 900 + "]" * 900,
    '"4.5 a' + " " * 16000 + 'b"', "4.5 a" + " " * 16000 + "b", '"../../etc/passwd"',
    '"/dev/zero"',
    '"m"', '"4.5 m/m/m/m/m"', '"1 (((((9^9)^9)^9)^9)^9)^9 m"', "{a = 1}", '"\\uFFFF"',
    "'''\nx\n'''",
    '"\\ud800"', "# no value", "1e5mm", '"4.5 mm" "x"', "\x00", "“4.5 mm”", '"20 °"',
    "[1, [2], {}]",
]  # fmt: skip
_LINES = [
    "[gear.pinion]", "[gears.pinion]", "a" + ".a" * 1000 + " = 1", "[" + "a." * 500 + "a]", "= 1",
    "[assumed" + ".a" * 400 + "]", "[[gears]]", "teeth = 3", "[film]", 'model = "moes"', "\ufeff",
    "[assumed]", '"gears.pinion.teeth" = "why"', '"gears.pinion.teeth" = {value = 3, reason = 4}',
    "[based_on]", '"" = 1', '"\\u0000" = 1', "ключ = 1", "'a.b' = 1", "[", "]", '"""', "{", "x = [",
    'title = "x"', "[dynamics]\nbacklash = \"9 m\"", "[gears.wheel.modification]\ncrowning = 1",
]  # fmt: skip
_BYTES = [
    b"\x00",
    b"\xff",
    b"\xed\xa0\x80",
    b"\r",
    b"\x1b[2J",
    b"\xef\xbb\xbf",
    b"\xc2\x85",
    b"'",
    b'"',
]


def _mutated(rng: random.Random) -> bytes:
    """A built-in case with some faults of values, keys, lines, order and bytes."""
    name = rng.choice(sorted(case_files()))
    lines = case_files()[name].read_text(encoding="utf-8").splitlines()
    for _ in range(rng.choice((1, 1, 2, 5, 20))):
        at = rng.randrange(len(lines))
        key, equals, value = lines[at].partition("=")
        kind = rng.randrange(9)
        if kind <= 2 and equals:
            lines[at] = f"{key}= {rng.choice(_VALUES)}"
        elif kind == 3:
            lines.insert(at, rng.choice(_LINES))
        elif kind == 4:
            del lines[at]
        elif kind == 5 and key:
            spot = rng.randrange(len(key))
            lines[at] = (
                key[:spot]
                + chr(rng.choice((46, 95, 97, 0x301, 34, 32)))
                + key[spot + 1 :]
                + equals
                + value
            )
        elif kind == 6:
            lines.insert(at, lines[rng.randrange(len(lines))])
        elif kind == 7 and value:
            spot = rng.randrange(len(value))
            lines[at] = (
                key + equals + value[:spot] + chr(rng.randrange(1, 0x3000)) + value[spot + 1 :]
            )
        else:
            lines[at : at + 1] = [lines[at]] * rng.choice((2, 60))
        if not lines:
            lines = [""]
    text = _as_a_whole("\n".join(lines), rng) if rng.random() < 0.3 else "\n".join(lines)
    content = text.encode("utf-8", "surrogatepass")
    if rng.random() < 0.1:
        content = text.encode(rng.choice(("utf-16", "utf-32", "latin-1", "cp437")), "replace")
    if rng.random() < 0.2:
        spot = rng.randrange(len(content) + 1)
        content = content[:spot] + rng.choice(_BYTES) + content[spot + rng.randrange(2) :]
    return content[: rng.randrange(len(content) + 1)] if rng.random() < 0.05 else content


def _as_a_whole(text: str, rng: random.Random) -> str:
    """What editors, merges and other alphabets do to all of a file."""
    tables = re.split(r"(?m)^(?=\[)", text)
    kind, place = rng.randrange(6), rng.randrange(len(tables))
    if kind == 0:
        return text.replace("\n", rng.choice(("\r\n", "\r", "\n\r", "\u2028")))
    if kind == 1:
        rng.shuffle(tables)
    elif kind == 2:
        tables.insert(rng.randrange(len(tables)), tables[place])
    elif kind == 3:
        tables[place] = re.sub(r"\d", lambda match: chr(0x660 + int(match[0])), tables[place])
    elif kind == 4:
        odd = rng.choice(("nan", "inf", "-inf", "1e400", "1e-400", "-0.0", "0"))
        tables[place] = re.sub(r"\d+(\.\d+)?", odd, tables[place], count=rng.choice((0, 1)))
    else:
        tables[place] = tables[place].replace("[", "[" * rng.choice((2, 3, 99)), 1)
    return "".join(tables)


def _is_sound(error: TribodynError) -> None:
    text = str(error)
    assert len(text) < 60_000
    for problem in error.problems:
        assert problem.what
        for part in (problem.what, str(problem.where), problem.why, problem.remedy):
            assert not any(unicodedata.category(each) in ("Cc", "Cs") for each in part)
            assert all(len(term) <= 420 for term in part.split()), part[:300]


def _result_or_none(work: Callable[[], Any]) -> Any:
    """What some work returns, or None after a sound message; 5 s of the processor at most."""
    try:
        with quiet(), at_most(5.0):
            return work()
    except TribodynError as error:
        _is_sound(error)
        return None


def test_mutated_case_files(draws: Draws, tmp_path: Path) -> None:
    path = tmp_path / "case.toml"
    refused = 0
    for rng in draws(150):
        path.write_bytes(_mutated(rng))
        case = _result_or_none(lambda: load_case(path))
        if case is None:
            refused += 1
            continue
        _result_or_none(lambda case=case: (geometry(case), list(case_cautions(case))))
        again = tmp_path / "again.toml"
        again.write_text(case.to_toml(), encoding="utf-8")
        assert load_case(again) == case
    assert refused


def test_mutated_cases_of_python(draws: Draws) -> None:
    full_case = load_case("fzg-roughness")
    keys = [key for key, _ in full_case.values()]
    deep: Any = []
    for _ in range(2000):
        deep = [deep]
    strange = [None, 10**400, -(10**400), float("nan"), float("inf"), "\ud800", "a\0b", deep, {},
               {"a": deep}, object(), b"bytes", 1j, True, [1] * 5000, {1: 2}, "4.5 m^9^9^9", "", [],
               (), "x" * 10**6]  # fmt: skip
    for rng in draws(100):
        changes = {
            rng.choice([*keys, "a", "a.b", "\0", "", ".", "x." * 2000]): rng.choice(strange)
            for _ in range(rng.choice((1, 3)))
        }
        case = _result_or_none(lambda changes=changes: full_case.replace(changes))
        assert case is None or isinstance(case, Case)
        _result_or_none(lambda changes=changes: Case(**{**full_case.user_input.data, **changes}))


@pytest.mark.parametrize(
    "name", ["", "x" * 5000, "a\0b", "\ud800", "/dev/zero", "/", ".", "no/such/case"]
)
def test_names_that_are_no_case(name: str) -> None:
    assert _result_or_none(lambda: load_case(name)) is None
