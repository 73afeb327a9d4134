"""Any case that is written reads back equal, and writes the same again."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from typing import Any

import tribodyn as td
from tribodyn.errors import InputError
from tribodyn.friction import LAWS
from tribodyn.stiffness import MODELS
from tribodyn.study import read_case
from tribodyn.study.case.reference import case_keys, start_toml

PINION, WHEEL = "gears.pinion", "gears.wheel"
#: Keys of which defaults and models depend, with what a draw may put there.
CHOICES: dict[str, list[Any]] = {
    "stiffness.model": sorted(MODELS),
    "friction.law": sorted(LAWS),
    "film.model": ["none", "moes", "newton", "dowson-1968"],
    "film.stiffness": ["none", "tangent", "secant"],
    "dynamics.model": ["torsional", "spur-6dof"],
    "dynamics.mesh_law": ["force-law", "tangent", "stiffness"],
    "solver.method": ["steady", "transient"],
    "stiffness.reference": ["rim", "bore"],
    "gears.driver": ["pinion", "wheel"],
    "operation.speed": ["3/7 rad/s", "1234.5 rpm", "0.1 rps"],
    "dynamics.backlash": ["0.1 mm", "3 um"],
    **{f"{gear}.bore_diameter": [None, "20 mm"] for gear in (PINION, WHEEL)},
    **{f"{gear}.modification.tip_relief": ["7 um", "0.0123 mm"] for gear in (PINION, WHEEL)},
    **{f"{gear}.modification.crowning": ["3.3 um"] for gear in (PINION, WHEEL)},
}


def random_case(chance: random.Random) -> td.Case:
    base = chance.choice(["", "fzg-roughness", "fzg-film", "fzg-stiffness", "fzg-12dof"])
    case = td.load_case(base) if base else read_case(start_toml())
    for key in chance.sample(sorted(CHOICES), chance.randint(1, 8)):
        try:
            case = case.replace({key: chance.choice(CHOICES[key])})
        except InputError:
            continue  # it does not go with the others
    return case


def test_every_key_that_is_drawn_exists() -> None:
    assert set(CHOICES) <= {key for key, *_ in case_keys()}


def test_cases_read_back_equal(draws: Callable[[int], Iterator[random.Random]]) -> None:
    for chance in draws(40):
        case = random_case(chance)
        again = read_case(case.to_toml())
        assert again == case
        assert again.to_toml() == case.to_toml()
