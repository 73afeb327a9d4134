"""Mutated files of machines and planetary stages: each message has file, key and remedy."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from fuzz.damage import at_most
from tribodyn import load_case
from tribodyn.cases.catalogue import machine_files, planetary_files
from tribodyn.errors import ComputationError, InputError, quiet

Draws = Callable[[int], Iterator[random.Random]]
FILES = {**machine_files(), **planetary_files()}
VALUES = (
    '1.0', '-1', 'true', '""', '"x"', '[]', '["1 mm"]', '[1]', '[[1]]', '{}', '{a = 1}', 'nan',
    'inf', '1979-05-27', '[["1 mm"]]', '"1 mm"', '"-1 mm"', '[true]', '[{}]', '"1e300 mm"',
    '["z1"]', '3', '0', '["a", "a"]', '[1, 2]', '"1e-9 rpm"',
)  # fmt: skip
TABLES = (
    "material", "lubricant", "film", "friction", "operation", "dynamics", "gears", "meshes",
    "shafts", "bearings", "planets", "couplings", "housing", "faults", "assumed", "load_cases",
    "stiffness", "title", "origin",
)  # fmt: skip


def mutated(text: str, rng: random.Random) -> str:
    """Text of a case with the value of a key, a table, or a name of another kind."""
    lines = text.splitlines()
    for _ in range(rng.choice((1, 1, 3))):
        at = rng.randrange(len(lines))
        key, equals, _ = lines[at].partition("=")
        group = lines[at].strip("[] ").partition(".")[0]
        kind = rng.randrange(6)
        if lines[at].startswith("["):
            name = rng.choice(('""', "x", "z1", "sun", "pinion", "x.x"))
            lines[at] = rng.choice((f"[[{group}]]", f"[{group}.{name}]", f"[{group}]", f"[{name}]"))
        elif kind == 0 or not equals:
            del lines[at]
        elif kind == 1:
            lines[at] = f"{key.strip()}.x = {rng.choice(VALUES)}"
        elif kind == 2:
            lines.insert(0, f"{rng.choice(TABLES)} = {rng.choice(VALUES)}")
        else:
            lines[at] = f"{key}= {rng.choice(VALUES)}"
    return "\n".join(lines)


def faults_of(path: Path) -> list[str]:
    """Problems whose message lacks the file, what is wrong or what to do, or asks for a report."""
    try:
        with quiet(), at_most(10.0):
            load_case(path)
    except (InputError, ComputationError) as error:
        return [
            str(problem)
            for problem in error.problems
            if not str(problem.where).startswith(str(path))
            or "argument" in str(problem.where)
            or "please report" in str(problem)
            or not problem.what
        ]
    return []


def test_mutated_machine_and_stage_files(draws: Draws, tmp_path: Path) -> None:
    path = tmp_path / "case.toml"
    failed = []
    for rng in draws(150):
        name = rng.choice(sorted(FILES))
        text = mutated(FILES[name].read_text("utf-8"), rng)
        path.write_text(text, "utf-8")
        failed += [f"{name}: {text}" for text in faults_of(path)]
    assert failed == []


#: Parts of a case file that once ended without file, line and key.
PRINTED = {
    "lubricant of a list": ("wind-turbine-gearbox", "[lubricant]", "[[lubricant]]", "lubricant"),
    "film of a list": ("wind-turbine-gearbox", "[film]", "[[film]]", "film"),
    "film of a stage": ("planetary-stage", "[lubricant]", "[[lubricant]]", "lubricant"),
    "type of a list": (
        "hypoid-axle", 'type = "tapered-roller"', 'type = ["1 mm"]', "bearings.rear",
    ),
    "shaft without a name": ("hypoid-axle", "[shafts.pinion]", '[shafts.""]', "shafts"),
    "coupling of a number": (
        "hypoid-axle", "[operation]",
        "[couplings.k]\nshafts = 1.0\ntorsional_stiffness = '1e5 N*m/rad'\n[operation]",
        "couplings.k.shafts",
    ),
    "input without a name": ("hypoid-axle", 'input = "pinion"', 'input = ""', "operation.input"),
    "carrier without a name": (
        "wind-turbine-gearbox", 'carrier = "rotor"', 'carrier = ""', "planets.main.carrier",
    ),
}  # fmt: skip


@pytest.mark.parametrize("fault", PRINTED)
def test_messages_name_file_line_and_key(fault: str, tmp_path: Path) -> None:
    name, before, after, key = PRINTED[fault]
    text = FILES[name].read_text("utf-8")
    assert before in text
    path = tmp_path / "case.toml"
    path.write_text(text.replace(before, after, 1), "utf-8")
    with pytest.raises(InputError) as refused:
        load_case(path)
    places = [str(problem.where).removeprefix(f"{path}:") for problem in refused.value.problems]
    assert any(place.partition(":")[2].strip().startswith(key) for place in places), places
    assert faults_of(path) == []


def test_a_coupling_may_have_the_name_of_a_gear(tmp_path: Path) -> None:
    text = FILES["hypoid-axle"].read_text("utf-8")
    gear = next(line for line in text.splitlines() if line.startswith("[gears."))
    coupling = gear.replace("gears", "couplings")
    path = tmp_path / "case.toml"
    path.write_text(f"{text}\n{coupling}\nshafts = 3\n", "utf-8")
    with pytest.raises(InputError, match=r"couplings\."):
        load_case(path)
    assert faults_of(path) == []
