"""Build flanks, masses and lever arms of a hypoid pair from the keys of ``[gears]``."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from copy import copy
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.errors import Argument, InputError, ModelWarning, Problem, collected
from tribodyn.gear.hypoid.blank import hypoid_blank
from tribodyn.study.case.gears import MEANINGS, EaseOffData, Gears, MountingData
from tribodyn.study.case.section import Section
from tribodyn.study.case.user_input import UserInput

if TYPE_CHECKING:
    from tribodyn.gear import HypoidBlank, HypoidFlanks, MassProperties, Misalignment


#: Keys of the blank that are no figures of :data:`MEANINGS`.
_CUTTING = ("hand_pinion", "process", "wheel_generation", "blade_groups")


@contextmanager
def _located_in(table: str) -> Iterator[None]:
    """Map the arguments named by input errors to keys of a table of the case."""
    try:
        yield
    except InputError as error:
        raise InputError(
            [
                replace(problem, where=Argument(table + problem.where.name.removeprefix("blank.")))
                if isinstance(problem.where, Argument)
                else problem
                for problem in error.problems
            ]
        ) from None


def torque_problem(key: str, problem: Problem, inputs: UserInput) -> Problem:
    """Problem of a key; of a negative torque of a hypoid pair with the side of its teeth."""
    negative = key == "operation.torque" and str(inputs.get(key)).strip().startswith("-")
    if not negative or inputs.get("gears.kind") != "hypoid":
        return problem
    why = "The size of a torque is positive; the other side of the teeth carries a negative one"
    other = "drive" if inputs.get("gears.side") == "coast" else "coast"
    return replace(problem, why=why, remedy=f'Leave out its sign, and set gears.side = "{other}"')


def blank_of(data: Section, teeth: tuple[int, int]) -> HypoidBlank:
    """Build the blanks of pinion and wheel from the keys of a table."""
    values = {name: getattr(data, name) for name in (*MEANINGS, *_CUTTING)}
    with _located_in(""):
        return hypoid_blank(*teeth, **values)


def hypoid_flanks(gears: Gears) -> HypoidFlanks:
    """Build the flanks of the loaded side; warnings are in :func:`hypoid_warnings`."""
    return _built(_unmounted(gears))[0]


def hypoid_warnings(gears: Gears) -> tuple[ModelWarning, ...]:
    """Return warnings about blank and flanks."""
    return _built(_unmounted(gears))[1]


def _unmounted(gears: Gears) -> Gears:
    """Gears without their position, which does not change their flanks."""
    bare = copy(gears)
    vars(bare)["mounting"] = None
    return bare


@lru_cache(maxsize=16)
def _built(gears: Gears) -> tuple[HypoidFlanks, tuple[ModelWarning, ...]]:
    from tribodyn.gear import EaseOff
    from tribodyn.gear import hypoid_flanks as flanks_of

    eased = {name: getattr(gears.ease_off, name) for name, _ in EaseOffData.specs()}
    with collected() as warnings:
        with _located_in("ease_off."):
            ease_off = EaseOff(**eased)
        blank = blank_of(gears, (gears.pinion.teeth, gears.wheel.teeth))
        with _located_in(""):
            flanks = flanks_of(blank, gears.side, ease_off)
    return flanks, tuple(warnings)


def contact_ratio(gears: Gears) -> float:
    """Return the contact ratio: rotation with contact lines over the pitch angle."""
    from tribodyn.gear.hypoid.conjugate import contact_lines

    return contact_lines(hypoid_flanks(gears).conjugate).contact_ratio


def mounting(gears: Gears) -> Misalignment:
    """Return the displacements of both gears."""
    from tribodyn.gear import Misalignment

    return Misalignment(**{n: getattr(gears.mounting, n) for n, _ in MountingData.specs()})


def levers(flanks: HypoidFlanks) -> tuple[float, float]:
    """Return the lever arms of the normal at the calculation point about both axes [m]."""
    wheel = float(flanks.conjugate.touch(np.zeros(2)).lever)
    return wheel / flanks.blank.ratio, wheel


def bodies(flanks: HypoidFlanks, density: float, gears: Gears) -> dict[str, MassProperties]:
    """Return mass and inertia of both gears: prescribed ones, else those of their pitch cones."""
    from tribodyn.gear.hypoid.blank import cone_bodies

    cones = cone_bodies(flanks.blank, density)
    return {
        name: cones[name].with_values(gear.mass, gear.moment_of_inertia)
        for name, gear in gears.by_name.items()
    }
