"""Checks of the keys that tell how bodies take up heat, and where the losses go."""

from __future__ import annotations

from collections.abc import Iterator

from tribodyn.errors import Problem
from tribodyn.study.case.given import Given


def heat_of_bodies(given: Given) -> Iterator[tuple[str, Problem]]:
    """Conductivity and specific heat of a gear tell only together how its flank warms."""
    for gear in ("pinion", "wheel"):
        keys = [f"gears.{gear}.{name}" for name in ("thermal_conductivity", "specific_heat")]
        present = [key for key in keys if key in given]
        if len(present) == 1:
            absent = next(key for key in keys if key not in given)
            name = absent.rpartition(".")[2]
            why = f"{given.show(present[0])} of the {gear} needs its counterpart"
            example = {"specific_heat": "460 J/kg/K", "thermal_conductivity": "47 W/m/K"}[name]
            remedy = f'Add {name} = "{example}", that of steel, or remove both'
            yield absent, Problem(f"{name} of the {gear} is missing", "", why, remedy)


def heat_balance(given: Given) -> Iterator[tuple[str, Problem]]:
    """A heat balance needs an oil that is known at every temperature, and gears that rub."""
    key, other = "lubricant.heat_transfer", "lubricant.ambient_temperature"
    if key not in given:
        if other in given:
            why, remedy = "Without heat_transfer the oil keeps its temperature", "Remove it"
            yield other, Problem(given.show(other), "", why, f"{remedy}, or add heat_transfer")
        return
    from tribodyn.lubricant import library, temperature_range

    name, known = given.get("lubricant.name"), library()
    grades = [each for each in known if len(set(temperature_range(each))) == 2]
    if name not in grades:
        what = f"{given.show(key)} with an oil that is known at one temperature"
        why = "The balance asks for its viscosity at others"
        remedy = f'Name another oil, for example name = "{grades[0]}", or remove heat_transfer'
        yield key, Problem(what, "", why, remedy)
    if given.get("gears.kind", "spur") != "spur":
        why = "The losses at other temperatures are known of spur gears"
        yield key, Problem(given.show(key), "", why, "Remove it")
