"""Every choice of every key that names a model runs on every kind of case, or is refused at once.

What ``check`` rehearses and what a run computes agree, and neither fails by a fault of its own.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from typing import Any

import pytest

import tribodyn as td
from tribodyn.errors import ModelWarning, TribodynError
from tribodyn.study import MachineCase
from tribodyn.study.case.section import Section
from tribodyn.study.machine.run import rehearse_machine
from tribodyn.study.pipeline.run import rehearse

#: Cases with teeth and films by formula, under one load.
KINDS: dict[str, dict[str, Any]] = {
    "fzg-roughness": {"stiffness.model": "iso6336", "film.model": "dowson-higginson"},
    "helical-pair": {"stiffness.model": "iso6336", "film.model": "dowson-higginson"},
    "hypoid-mixed-ehl": {"gears.stiffness_model": None},
    "two-stage-spur": {
        "stiffness.model": "iso6336",
        "film.model": "dowson-higginson",
        "load_cases": None,
    },
    "hypoid-axle": {"load_cases": None},
    "planetary-stage": {
        "stiffness.model": "iso6336",
        "film.model": "dowson-higginson",
        "load_cases": None,
    },
}
#: Choices that take many seconds: solved films, solid teeth, engines that march until all repeats.
DEAR = ("newton", "multigrid", "thermal", "fe3d", "dormand-prince", "newmark", "cuda")
#: Options that a choice needs.
NEEDED = {"constant": {"friction.coefficient": 0.05}, "weber": {"stiffness.reference": "rim"}}


def choices_of(table: str) -> Iterator[tuple[str, str]]:
    """Key and name of every choice of a table and of its models."""
    kind: Any = Section.case_class.fields[table]
    for key, option in kind.kind.specs():
        names = getattr(option, "names", None) or ()
        for name in names() if callable(names) else names:
            if name not in DEAR:
                yield f"{table}.{key}", name


def message(study: Any, case: Any) -> str:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        try:
            study(case)
        except TribodynError as error:
            return str(error)
    return ""


def rehearsal_of(case: Any) -> Any:
    return rehearse_machine if isinstance(case, MachineCase) else rehearse


def disagreements(case: Any, choices: Iterator[tuple[str, str]]) -> list[str]:
    """Choices that are refused by the rehearsal and not by the run, or the other way round."""
    differing, accepted = [], 0
    for key, name in choices:
        try:
            changed = case.replace({key: name, **NEEDED.get(name, {})}, by="--set")
        except TribodynError:
            continue
        accepted += 1
        before = message(rehearsal_of(changed), changed)
        after = message(lambda each: td.run(each).summary(), changed)
        if bool(before) != bool(after):
            differing.append(f"{key} = {name}: check says {before!r}, run says {after!r}")
    assert accepted
    return differing


@pytest.mark.parametrize(
    "name",
    ["fzg-roughness", pytest.param("two-stage-spur", marks=pytest.mark.slow), "planetary-stage"],
)
@pytest.mark.parametrize("key", ["mesh_law", "friction_load"])
def test_laws_of_the_mesh(name, key):
    case = td.load_case(name).replace(KINDS[name])
    laws = [choice for choice in choices_of("dynamics") if choice[0] == f"dynamics.{key}"]
    assert disagreements(case, iter(laws)) == []


@pytest.mark.slow
@pytest.mark.parametrize("name", KINDS)
def test_choices_run_or_are_refused(name):
    case = td.load_case(name).replace(KINDS[name])
    tables = ["film", "dynamics", "stiffness", "friction", "operation", "solver", "gears"]
    if "hypoid" in name:
        tables = tables[:2]  # each choice takes seconds
    elif isinstance(case, MachineCase):
        tables = tables[:4]
    differing = []
    for table in tables:
        differing += disagreements(case, choices_of(table))
    assert differing == []
