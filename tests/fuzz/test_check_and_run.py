"""What ``tribodyn check`` accepts ``tribodyn run`` computes, and the other way round."""

from __future__ import annotations

import math
import random
import tomllib
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import lru_cache
from typing import Any

import pytest

from fuzz.damage import at_most
from tribodyn import load_case
from tribodyn.dynamics import STRUCTURES
from tribodyn.ehl import FILM_MODELS
from tribodyn.errors import ComputationError, InputError, collected
from tribodyn.friction import LAWS
from tribodyn.model import Option
from tribodyn.stiffness import MODELS
from tribodyn.study import Case
from tribodyn.study.case.provenance import assumptions
from tribodyn.study.case.to_models import options_of
from tribodyn.study.pipeline.assembly import geometry
from tribodyn.study.pipeline.cautions import case_cautions
from tribodyn.study.pipeline.preview import operating_figures
from tribodyn.study.pipeline.run import computed, rehearse

Draws = Callable[[int], Iterator[random.Random]]

#: Cases whose run needs a tenth of a second.
_QUICK = {"stiffness.model": "iso6336", "solver.steps_per_mesh_cycle": 128}
CASES = {
    "fzg-roughness": _QUICK,
    "time-varying-friction": {},
    "fzg-12dof-light": {**_QUICK, "film.model": "dowson-higginson", "friction.law": "xu-2007"},
    "fzg-stiffness": _QUICK,
}
_MODELS: dict[str, Any] = {"film": FILM_MODELS, "stiffness": MODELS, "friction": LAWS,
                           "dynamics": STRUCTURES}  # fmt: skip
_FACTORS = (0.0, -1.0, 0.3, 0.7, 0.95, 1.05, 1.5, 3.0, 10.0, 1e-3, 1e3, 1e-6)
#: What needs minutes, or another kind of gears.
_LONG = {
    "newton",
    "multigrid",
    "fe2d",
    "hypoid-14dof",
    "mixed-solved",
    "mixed-ehl",
    "dormand-prince",
}


@lru_cache(maxsize=1)
def _options() -> dict[str, Option]:
    """All keys of a case and what they take."""
    options = dict(options_of(Case, ""))
    for section, registry in _MODELS.items():
        for model in registry:
            options |= {
                f"{section}.{key}": option for key, option in registry[model].options.items()
            }
    strange = ("gears.kind", "gears.table")
    known_options = {key: option for key, option in options.items() if isinstance(option, Option)}
    return {
        key: option
        for key, option in known_options.items()
        if option.in_case and key not in strange
    }


def _value(rng: random.Random, option: Option, value: Any) -> Any:
    """A value that an option may take, by a factor of the present one if it has any."""
    if option.names is not None:
        return rng.choice([name for name in option.names() if name not in _LONG])
    if option.kind == "flag":
        return rng.random() < 0.5
    if isinstance(value, int | float) and rng.random() < 0.7:
        new = value * rng.choice(_FACTORS) or rng.choice((0.0, 1e-6))
        return round(new) if option.kind == "integer" else new
    if option.kind in ("number", "integer") and rng.random() < 0.5 and option.high < 1e300:
        most, least = option.high, max(option.low, 1e-9 * option.high)
        new = math.exp(rng.uniform(math.log(least), math.log(most)))
        return round(new) if option.kind == "integer" else new
    with suppress(tomllib.TOMLDecodeError):  # some examples are words: 'a list of numbers'
        return tomllib.loads(f"value = {option.example}")["value"]
    return value


def _draw_changes(rng: random.Random) -> tuple[str, dict[str, Any]]:
    """A case and what changes in it."""
    name = rng.choice(sorted(CASES))
    values, changes = dict(load_case(name).values()), dict(CASES[name])
    for _ in range(rng.choice((1, 1, 2, 3))):
        key = rng.choice(sorted(_options()))
        changes[key] = _value(rng, _options()[key], values.get(key))
    return name, changes


def _checked(case: Case) -> None:
    """What the command does."""
    rehearse(case)
    geometry(case), operating_figures(case), list(case_cautions(case)), assumptions(case)


def _refusal(work: Callable[[], object]) -> str:
    try:
        with collected(), at_most(20.0):
            work()
    except InputError as error:
        return str(error)
    except ComputationError:
        pass  # no input at fault: a motion that grows without bounds, say
    return ""


@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
def test_check_refuses_the_cases_that_run_refuses(draws: Draws) -> None:
    differ, accepted = [], 0
    for rng in draws(14):
        name, changes = _draw_changes(rng)
        try:
            case = load_case(name).replace(changes)
        except InputError:
            continue  # refused before either
        checked = _refusal(lambda case=case: _checked(case))
        run = _refusal(lambda case=case: computed(case))
        accepted += not run
        if bool(checked) != bool(run):
            differ.append(f"{name} {changes}\n  check: {checked}\n  run: {run}")
    assert not differ, "\n".join(differ)
    assert accepted
