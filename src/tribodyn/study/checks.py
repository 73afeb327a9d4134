"""Checks across keys: contradictions, missing partners, and marks on keys that do not exist."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from tribodyn.errors import Problem
from tribodyn.study.given import Given
from tribodyn.study.options import (
    film_problems,
    foreign_dynamics,
    friction_problems,
    stiffness_problems,
)
from tribodyn.study.rig import is_rig_key

#: The reason that marks a written value as the default of the library that wrote it.
DEFAULT_MARK = "default"

Found = Iterator[tuple[str, Problem]]

_PROPERTIES = ("dynamic_viscosity", "density", "pressure_viscosity_coefficient")
#: Options of the friction of the film, and the properties that only they need.
_HEAT = ("inlet_heating", "flash_temperature")
_THERMAL = ("temperature_viscosity_coefficient", "thermal_conductivity")
#: Tables about values of the other tables.
_ABOUT = ("assumed", "based_on")
_SAME = "They are two ways of saying the same thing"


def _both(given: Given, one: str, other: str) -> tuple[str, Problem]:
    what = f"{given.show(one)} and {given.show(other)} are both given"
    return one, Problem(what, "", _SAME, "Keep one of them")


def _roughness(given: Given) -> Found:
    keys = [f"gears.{gear}.roughness_rms" for gear in ("pinion", "wheel")]
    present = [key for key in keys if key in given]
    if "gears.composite_roughness" in given:
        for key in present:
            what = (
                f"{given.show('gears.composite_roughness')} and {given.show(key)} "
                f"of the {key.split('.')[1]} are both given"
            )
            yield "gears.composite_roughness", Problem(what, "", _SAME, "Keep one of them")
    elif len(present) == 1:
        absent = next(key for key in keys if key not in given)
        what = f"roughness_rms of the {absent.split('.')[1]} is missing"
        why = f"{given.show(present[0])} of the {present[0].split('.')[1]} needs its counterpart"
        yield absent, Problem(what, "", why, "Add it, or give composite_roughness in [gears]")


def _face_width(given: Given) -> Found:
    gears = ("gears.pinion", "gears.wheel")
    if all(gear in given and f"{gear}.face_width" not in given for gear in gears):
        what, why = "face_width is missing", "At least one gear needs its face width"
        yield "gears.pinion", Problem(what, "", why, 'Add face_width = "20 mm" to [gears.pinion]')


def _size(given: Given) -> Found:
    pinion, wheel = (given.value(f"gears.{gear}.teeth") for gear in ("pinion", "wheel"))
    if type(pinion) is int and type(wheel) is int and pinion > wheel:
        what = f"teeth = {pinion} of the pinion and teeth = {wheel} of the wheel"
        why = "The pinion is the smaller gear, whichever drives"
        remedy = "Exchange the two tables, speed_of and driver"
        yield "gears.pinion.teeth", Problem(what, "", why, remedy)


def _lubricant(given: Given) -> Found:
    if "lubricant" not in given:
        return
    present = [name for name in (*_PROPERTIES, *_THERMAL) if f"lubricant.{name}" in given]
    if "lubricant.name" in given:
        for name in present:
            yield _both(given, "lubricant.name", f"lubricant.{name}")
        return
    for name in _PROPERTIES:
        if name not in present:
            why = "Without a name from the library all three properties are needed"
            remedy = f'Add {name}, or name an oil, for example name = "80W"'
            yield f"lubricant.{name}", Problem(f"{name} is missing", "", why, remedy)


def _needs(given: Given) -> Found:
    """What the friction law and the film model need to know."""
    law = given.value("friction.law", "none")
    film = given.value("film.model", "none")
    tribological = law not in ("none", "constant")
    users = [f'law = "{law}"'] if tribological else []
    users += [f'film model = "{film}"'] if film != "none" else []
    if users and "lubricant" not in given:
        why = f"{users[0]} needs an oil"
        remedy = 'Add [lubricant] with for example name = "80W"'
        yield "lubricant", Problem("the table [lubricant] is missing", "", why, remedy)
    rough = ("composite_roughness", "pinion.roughness_rms", "wheel.roughness_rms")
    if (
        tribological
        and not _shears_film(law)
        and not any(f"gears.{name}" in given for name in rough)
    ):
        why, remedy = f"{users[0]} needs it", 'Add composite_roughness = "0.5 um" to [gears]'
        what = "composite_roughness is missing"
        yield "gears.composite_roughness", Problem(what, "", why, remedy)


def _shears_film(law: Any) -> bool:
    """Whether a friction law works on the solved film, and knows no roughness."""
    from tribodyn.friction import LAWS

    return law in LAWS and LAWS[law].needs_film


def _film_of_friction(given: Given) -> Found:
    """What a law that shears the solved film needs besides an oil."""
    from tribodyn.ehl import FILM_MODELS

    law, film = given.value("friction.law", "none"), given.value("film.model", "none")
    if not _shears_film(law) or film not in FILM_MODELS:
        return
    if not FILM_MODELS[film].method:
        what = f'law = "{law}" and film model = "{film}"'
        why = "That law shears the solved film, and this model gives no pressure"
        yield "friction.law", Problem(what, "", why, 'Set model = "newton" in [film]')
    heated = [key for key in _HEAT if given.value(f"friction.{key}")]
    if heated and "lubricant" in given and "lubricant.name" not in given:
        for name in _THERMAL:
            if f"lubricant.{name}" not in given:
                remedy = f"Add {name}, or set {heated[0]} = false in [friction]"
                why = f"{heated[0]} = true needs it"
                yield f"lubricant.{name}", Problem(f"{name} is missing", "", why, remedy)


#: Why a structure that only turns has no supports.
_FIXED = "That model turns the gears about fixed axes"


def _dynamics(given: Given) -> Found:
    for name in ("mesh_damping", "bearing_damping"):
        value, ratio = f"dynamics.{name}", f"dynamics.{name}_ratio"
        if value in given and ratio in given:
            yield _both(given, value, ratio)
    model = given.value("dynamics.model", "spur-6dof")
    key = "dynamics.bearing_stiffness"
    if model == "spur-6dof" and key not in given:
        what, why = "bearing_stiffness is missing", 'model = "spur-6dof" supports each gear'
        remedy = 'Add bearing_stiffness = "3.5e9 N/m" to [dynamics], or choose "torsional"'
        yield key, Problem(what, "", why, remedy)
    foreign = foreign_dynamics(str(model))
    for key in given.keys("dynamics"):
        if key.rpartition(".")[2] in foreign:
            what = f'{given.show(key)} does not belong to model = "{model}"'
            shaft = is_rig_key(key)
            why = "That model has no shafts" if shaft else _FIXED
            other = "fzg-12dof" if shaft else "spur-6dof"
            yield key, Problem(what, "", why, f'Remove it, or choose "{other}"')


def _friction_load(given: Given) -> Found:
    key = "dynamics.friction_load"
    if given.value(key) == "dynamic" and given.value("friction.law") == "none":
        what = f"{given.show(key)} without friction"
        why = 'friction.law = "none": nothing follows the load'
        yield key, Problem(what, "", why, "Choose a friction law, or leave the key out")


def _solver(given: Given) -> Found:
    if "solver.cycles" in given and given.value("solver.method", "steady") == "steady":
        what = f'{given.show("solver.cycles")} does not belong to method = "steady"'
        why = "A steady state is found directly, without counting cycles"
        yield "solver.cycles", Problem(what, "", why, 'Remove it, or choose "transient"')


def _assumed(given: Given, faulty: set[str]) -> Found:
    marks = given.value("assumed", {})
    for key, reason in marks.items() if isinstance(marks, Mapping) else ():
        absent = key not in given or isinstance(given.value(key), Mapping)
        recorded = isinstance(reason, Mapping) and "value" in reason
        if absent and reason != DEFAULT_MARK and not recorded:
            known = [k for k in given.keys("") if k not in faulty and k.split(".")[0] not in _ABOUT]
            near = difflib.get_close_matches(key, known, n=1)
            why = "[assumed] marks values that this case gives"
            remedy = f'Did you mean "{near[0]}"?' if near else f"Give {key}, or remove the mark"
            yield f"assumed.{key}", Problem(f'no value is given for "{key}"', "", why, remedy)


_CHECKS: tuple[Callable[[Given], Found], ...] = (
    _roughness, _face_width, _size, _lubricant, _needs, _film_of_friction, _dynamics,
    _friction_load, _solver,
)  # fmt: skip


def cross_problems(given: Given, faulty: set[str]) -> list[tuple[str, Problem]]:
    """Check the keys of a case against each other."""
    found = [problem for check in _CHECKS for problem in check(given)]
    found += _assumed(given, faulty)
    if "stiffness.model" not in faulty:
        found += stiffness_problems(given, given.value("stiffness.model", "potential-energy"))
    if "film.model" not in faulty:
        found += film_problems(given, given.value("film.model", "none"), faulty)
    if "friction.law" not in faulty:
        found += friction_problems(given, given.value("friction.law", "none"))
    return [(key, problem) for key, problem in found if key not in faulty]
