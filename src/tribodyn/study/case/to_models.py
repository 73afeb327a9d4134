"""Build the physics objects of a case, and map their errors back to its keys."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import lru_cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, cast

from tribodyn.errors import Argument, InputError, ModelOption, ModelWarning, Problem, collected
from tribodyn.study.case.gears import Gear, Gears, Modification
from tribodyn.study.case.hypoid import hypoid_flanks, levers
from tribodyn.study.case.rating_tables import rating_problems
from tribodyn.study.case.section import Section, options_of
from tribodyn.study.case.sections import Dynamics, Losses, LubricantData, MaterialData

if TYPE_CHECKING:
    from tribodyn.dynamics import MeshForce
    from tribodyn.gear import FlankModification, Material, ProfileMap, SpurPair
    from tribodyn.losses import Gearbox, ShaftParts
    from tribodyn.lubricant import Lubricant
    from tribodyn.mesh.table_file import TableFile
    from tribodyn.study.case.pair import PairCase

#: Play of usual gears on the line of action [m], and the most over the normal module.
USUAL_BACKLASH, _MODULES = 0.1e-3, 0.1
#: Basis of a usual backlash.
USUAL_GEARS = "usual gears: without play, teeth that touch early are clamped between both flanks"


def _gear_arguments(name: str, gear: Gear, other: Gear) -> dict[str, Any]:
    values = {key: getattr(gear, key) for key in _GEAR_ARGUMENTS}
    values["teeth"] = gear.tooth_count
    values["face_width"] = gear.face_width if gear.face_width is not None else other.face_width
    return {f"{name}_{key}": value for key, value in values.items()}


_GEAR_ARGUMENTS = (
    "profile_shift_coefficient",
    "tip_diameter",
    "bore_diameter",
    "mass",
    "moment_of_inertia",
)


def flank_modification(data: Modification | None, chart: ProfileMap | None) -> FlankModification:
    """Build the modification of one gear."""
    from tribodyn.gear import FlankModification

    if data is None:
        return FlankModification()
    values = {name: getattr(data, name) for name, _ in data.specs()}
    del values["profile_map"], values["profile_map_interpolation"]
    lists = ("single_pitch_deviation", "cumulative_pitch_deviation", "wear_depth")
    values |= {name: values[name] or () for name in lists}
    return FlankModification(profile_map=chart, **values)


def gear_pair(gears: Gears, backlash: float | None = None) -> SpurPair:
    """Build the gear pair of a case; its warnings are in :func:`gear_warnings`."""
    return _built(gears, backlash or None, _modifications(gears))[0]


def case_pair(gears: Gears, dynamics: Dynamics) -> SpurPair:
    """Build the gear pair of a case with its backlash, or a usual one where it needs one."""
    from tribodyn.gear.flank_gap import least_gap

    pair = gear_pair(gears, dynamics.backlash)
    play = usual_backlash(gears, dynamics, pair)
    if play is None or pair.backlash + 2.0 * least_gap(pair) >= 0.0:
        return pair
    return gear_pair(gears, play)


def usual_backlash(gears: Gears, dynamics: Dynamics, pair: SpurPair) -> float | None:
    """Return a usual backlash [m]; None where the case or its teeth have one, or a linear mesh."""
    play = min(USUAL_BACKLASH, _MODULES * gears.normal_module)
    is_linear = dynamics.mesh_law not in (None, "force-law")
    return None if is_linear or dynamics.backlash is not None or pair.backlash >= play else play


def has_usual_backlash(case: PairCase) -> bool:
    """Return whether the teeth are thinned for a usual backlash that the case does not give."""
    has_play = case.dynamics.backlash is not None or case.gears.kind != "spur"
    return not has_play and case.gear_pair.pinion.tooth_thinning > 0.0


def gear_warnings(gears: Gears, backlash: float | None = None) -> tuple[ModelWarning, ...]:
    """Return warnings about the geometry of the pair."""
    return _built(gears, backlash or None, _modifications(gears))[1]


class _Modified(NamedTuple):
    """Modifications of pinion and wheel, and their problems."""

    pinion: FlankModification | None
    wheel: FlankModification | None
    problems: tuple[Problem, ...]


def _modifications(gears: Gears) -> _Modified:
    """Build the modifications of both gears; changed files are read again."""
    problems: list[Problem] = []

    def modification(name: str, data: Modification | None) -> FlankModification | None:
        try:
            if data is not None and data.profile_map is not None:
                from tribodyn.measurement.readers.profile_map import read_profile_map

                return flank_modification(
                    data, read_profile_map(data.profile_map, data.profile_map_interpolation)
                )
            return flank_modification(data, None)
        except InputError as error:
            problems.extend(
                replace(problem, where=Argument(f"modification.{place.name}", name))
                if isinstance(place := problem.where, Argument)
                else problem
                for problem in error.problems
            )
            return None

    sides = gears.pinion.modification, gears.wheel.modification
    pinion, wheel = map(modification, ("pinion", "wheel"), sides)
    return _Modified(pinion, wheel, tuple(problems))


@lru_cache(maxsize=16)
def _built(
    gears: Gears, backlash: float | None, modified: _Modified
) -> tuple[SpurPair, tuple[ModelWarning, ...]]:
    problems = list(modified.problems)
    with collected() as warnings:
        try:
            pair = _spur_pair(gears, backlash, modified)
        except InputError as error:
            problems += error.problems
        if problems:
            raise InputError(problems)
    return pair, tuple(warnings)


def _spur_pair(gears: Gears, backlash: float | None, modified: _Modified) -> SpurPair:
    from tribodyn.gear import BasicRack, cylindrical_pair
    from tribodyn.gear.pair_checks import mating_hand

    heights = gears.addendum_coefficient, gears.dedendum_coefficient
    rack = BasicRack.usual(gears.normal_pressure_angle, *heights)
    if (stated := gears.rack_tip_radius_coefficient) is not None:
        rack = BasicRack(*heights, stated)
    other = gears.wheel.hand
    fitting = mating_hand(other, gears.wheel.tooth_count) if other else "right"
    return cylindrical_pair(
        normal_module=gears.normal_module,
        normal_pressure_angle=gears.normal_pressure_angle,
        helix_angle=gears.helix_angle,
        hand=gears.hand or gears.pinion.hand or fitting,
        wheel_hand=other,
        wheel_rim_diameter=gears.wheel.rim_diameter,
        center_distance=gears.center_distance,
        driver=gears.driver,
        backlash=backlash,
        pinion_rack=rack,
        wheel_rack=rack,
        pinion_modification=modified.pinion,
        wheel_modification=modified.wheel,
        misalignment=gears.misalignment,
        **_gear_arguments("pinion", gears.pinion, gears.wheel),
        **_gear_arguments("wheel", gears.wheel, gears.pinion),
    )


def material(data: MaterialData) -> Material:
    """Build the material of the gears."""
    from tribodyn.gear import Material

    return Material(data.youngs_modulus, data.poissons_ratio, data.density)


def thermal_contact_coefficients(case: PairCase) -> tuple[float, float]:
    """Return the thermal contact coefficient ``sqrt(k rho c)`` of each flank."""
    from tribodyn.friction import STEEL_BODIES

    def coefficient(name: str, gear: Gear, steel: float) -> float:
        if gear.thermal_conductivity is None or gear.specific_heat is None:
            return steel
        return math.sqrt(gear.thermal_conductivity * case.density(name) * gear.specific_heat)

    steel, other = STEEL_BODIES
    gears = case.gears
    return coefficient("pinion", gears.pinion, steel), coefficient("wheel", gears.wheel, other)


@lru_cache(maxsize=64)
def lubricant(data: LubricantData, temperature: float | None = None) -> Lubricant:
    """Build the oil at its own or another temperature: by name, data sheet or properties."""
    from tribodyn.lubricant import Lubricant, from_data_sheet, from_library

    temperature = temperature or data.temperature
    if data.name is not None:
        return from_library(data.name, temperature)
    if data.density_at_15 is not None:
        return from_data_sheet(
            temperature or 0.0,
            data.density_at_15,
            viscosity_at_40=data.kinematic_viscosity_at_40,
            viscosity_at_100=data.kinematic_viscosity_at_100,
            index=data.viscosity_index,
            base_oil=data.base_oil,
            pressure_viscosity_coefficient=data.pressure_viscosity_coefficient,
            thermal_conductivity=data.thermal_conductivity,
        )
    properties = (data.dynamic_viscosity, data.density, data.pressure_viscosity_coefficient)
    viscosity, density, coefficient = (float(value or 0.0) for value in properties)
    return Lubricant(
        viscosity,
        density,
        coefficient,
        temperature=data.temperature,
        temperature_viscosity_coefficient=data.temperature_viscosity_coefficient,
        thermal_conductivity=data.thermal_conductivity,
    )


def gearbox(data: Losses) -> Gearbox:
    """Build shafts, seals and oil bath."""
    from tribodyn.losses import Gearbox

    shafts = {name: shaft_parts(getattr(data, name)) for name in ("pinion", "wheel")}
    return Gearbox(**{**vars(data), **shafts})


def shaft_parts(data: Any) -> ShaftParts:
    """Build what turns with a shaft and loses."""
    from tribodyn.losses import BEARINGS, ShaftParts

    return ShaftParts(**{**vars(data), "bearing": data.bearing and BEARINGS[data.bearing]})


def _gearbox_losses(case: PairCase) -> object:
    """Compute the losses of the case without those of its teeth, to find input errors."""
    if case.gearbox is None:
        return None
    from tribodyn.losses import gearbox_losses

    gears = case.gear_pair if case.hypoid_flanks is None else case.hypoid_flanks
    point: Any = {"pinion_torque": case.pinion_torque, "pinion_speed": case.pinion_speed}
    return gearbox_losses(gears, case.gearbox, 0.0, **point, lubricant=case.lubricant_properties)


def mesh_law_of(case: PairCase) -> MeshForce:
    """Return the mesh law of a case: stiffness, tangent of the force law, or force law."""
    return mesh_law(case.dynamics, case.mesh_table, case.spur_pair, case.stiffness.model)


def mesh_law(
    dynamics: Dynamics, table: TableFile | None, pair: SpurPair | None, model: str
) -> MeshForce:
    """Return the mesh law of teeth: of a mesh table, of a cylindrical pair, or of others."""
    from tribodyn.stiffness import MODELS

    if dynamics.mesh_law is not None:
        return cast("MeshForce", dynamics.mesh_law)
    if table is not None:
        return "force-law" if table.has_force_law else "stiffness"
    if pair is None:
        return "stiffness"
    return "force-law" if MODELS[model].coupled or pair.has_modification else "stiffness"


def unused_lubricant() -> Lubricant:
    """Return a placeholder oil for a case whose laws and formulas use none."""
    from tribodyn.lubricant import Lubricant

    return Lubricant(0.1, 900.0, 2e-8, name="unused")


def _argument(problem: Problem) -> Argument | None:
    """Return the argument that a problem refers to."""
    place = problem.where
    if isinstance(place, str) and place.startswith("argument "):
        return Argument(place.removeprefix("argument ").partition(" ")[0])
    return place if isinstance(place, Argument) else None


@lru_cache(maxsize=1)
def _argument_keys() -> dict[str, str]:
    """Map arguments of physics functions to the keys of the case file."""
    return {o.argument: key for key, o in options_of(Section.case_class, "") if o.argument}


def _key(problem: Problem, section: str) -> str:
    """Return the key of the case file for the argument named by a problem of a table."""
    place = _argument(problem)
    if place is None:
        return section
    key = _argument_keys().get(place.name)
    if key is not None:
        return key
    if not place.gear and section == "gears" and place.name in Gear.fields:
        return section
    return f"{section}.{place.gear}.{place.name}" if place.gear else f"{section}.{place.name}"


def _key_in(case: PairCase, problem: Problem) -> str:
    """Return the key of the case that a problem refers to; empty if undetermined."""
    place = problem.where
    if isinstance(place, ModelOption):
        section = getattr(case, place.kind, None)
        if not isinstance(section, Section) or not place.model:
            return ""
        option = place.name if place.name in section.section_keys().keys else section.selector
        return f"{place.kind}.{option}"
    argument = _argument(problem)
    if argument is None:
        return ""
    for name, section in vars(case).items():
        model = section.chosen if isinstance(section, Section) else None
        for option, declared in (model.declared if model else {}).items():
            if argument.name == (declared.argument or option):
                return f"{name}.{option}"
    key = _argument_keys().get(argument.name, "")
    if key == "gears.composite_roughness" and key not in case._user_input:
        heights = [f"gears.pinion.roughness_{kind}" for kind in ("ra", "rms")]
        return next((height for height in heights if height in case._user_input), key)
    return key


@contextmanager
def locate_errors(case: PairCase) -> Iterator[None]:
    """Add file, line and key to the input errors raised inside the block."""
    try:
        yield
    except InputError as error:
        keyed = [(_key_in(case, problem), problem) for problem in error.problems]
        unknown = [problem for key, problem in keyed if not key]
        located = case.source.place((key, problem) for key, problem in keyed if key)
        raise type(error)([*located, *unknown]) from None


def _faults(section: str, build: Callable[[], object]) -> list[tuple[str, Problem]]:
    try:
        build()
    except InputError as error:
        return [(_key(problem, section), problem) for problem in error.problems]
    return []


def mesh_table(gears: Gears) -> TableFile | None:
    """Read the mesh table of another program; a changed file is read again."""
    if gears.kind != "table" or gears.table is None:
        return None
    place = Path(gears.table)
    changed = place.stat().st_mtime_ns if place.is_file() else 0
    return _read_table(gears.table, changed)


@lru_cache(maxsize=16)
def _read_table(path: str, changed: int) -> TableFile:
    from tribodyn.mesh.table_file import read_table_file

    return read_table_file(path)


_NO_PAIR_REASONS = {
    "table": "Its mesh table describes contacts, not gears",
    "hypoid": "Only spur gears have a plane gear pair",
}


def no_gear_pair(kind: str) -> Problem:
    """Return the problem of a computation that needs spur gears the case lacks."""
    what = f'a case with gears.kind = "{kind}" has no gear pair'
    remedy = 'Give the gears with kind = "spur" to use their geometry'
    return Problem(what, "gears.kind", _NO_PAIR_REASONS[kind], remedy)


def contact_models(case: PairCase) -> tuple[str, str]:
    """Return the names of the stiffness and the film model of the tooth contact."""
    from tribodyn.mesh.hypoid.film import ELLIPTICAL

    if case.gears.kind == "hypoid":
        film = case.film.model
        return "contact lines", ELLIPTICAL if film == "none" else film
    stiffness = case.stiffness.model if case.gears.table is None else f"table {case.gears.table}"
    return str(stiffness), str(case.film.model)


def backlash(case: PairCase) -> float:
    """Return the backlash on the line of action that results from the teeth [m]."""
    flanks = case.hypoid_flanks
    if flanks is not None:
        blank = flanks.blank
        outer = blank.outer_cone_distance_wheel * math.sin(blank.pitch_angle_wheel)
        return float(case.gears.outer_backlash * levers(flanks)[1] / outer)
    return 0.0 if case.gears.kind == "table" else case.gear_pair.backlash


def _table_problems(case: PairCase) -> list[tuple[str, Problem]]:
    """Find problems of a mesh table and of its use in the case."""
    problems = _faults("gears.table", lambda: case.mesh_table)
    table = None if problems else case.mesh_table
    if table is None:
        return problems
    if table.gears is not None and table.gears.pair.driver != case.gears.driver:
        why = f"The mesh table was computed for driver = {table.gears.pair.driver}"
        problem = Problem(f"driver = {case.gears.driver}", "", why, "Set the same driver")
        problems.append(("gears.driver", problem))
    coefficient = friction_of_table(case)
    problems += [
        ("operation.torque" if _argument(problem) else "gears.table", problem)
        for _, problem in _faults("gears.table", lambda: _trial(case, table, coefficient))
    ]
    return problems


def _trial(case: PairCase, table: TableFile, coefficient: float | None) -> object:
    return table.table(
        teeth=case.gears.pinion.teeth,
        driver=case.gears.driver,
        pinion_speed=case.pinion_speed,
        pinion_torque=case.pinion_torque,
        friction_coefficient=coefficient,
    )


def friction_of_table(case: PairCase) -> float | None:
    """Return the coefficient that replaces those of a mesh table; None to use the table."""
    return case.friction.coefficient if case.friction.law == "constant" else None


def gear_problems(gears: Gears) -> list[tuple[str, Problem]]:
    """Find problems of the gear pair alone, where other tables are invalid."""
    if gears.kind == "table":
        return _faults("gears.table", lambda: mesh_table(gears))
    if gears.kind == "hypoid":
        return _faults("gears", lambda: hypoid_flanks(gears))
    if gears.pinion.face_width is None and gears.wheel.face_width is None:
        return []
    return _faults("gears", lambda: gear_pair(gears))


def case_problems(case: PairCase) -> list[tuple[str, Problem]]:
    """Find physical contradictions in a formally valid case."""
    if case.gears.kind == "table":
        return _table_problems(case) or _fault_problems(case) or list(rating_problems(case))
    if case.gears.kind == "hypoid":
        problems = _faults("gears", lambda: case.hypoid_flanks)
    else:
        problems = _faults("gears", lambda: case.gear_pair)
    problems += _faults("lubricant", lambda: case.lubricant_properties)
    problems += [] if problems else _faults("lubricant", lambda: case.film_lubricant)
    problems += [] if problems else _faults("losses", lambda: _gearbox_losses(case))
    problems += [] if problems else _fault_problems(case)
    problems += [] if problems else rating_problems(case)
    return problems if case.gears.kind == "hypoid" else problems + _bores(case)


def _fault_problems(case: PairCase) -> list[tuple[str, Problem]]:
    """Find faults that are incomplete or that this pair cannot have."""
    from tribodyn.study.faults.section import check_fault, fault_problems

    problems = fault_problems(case.faults)
    if case.faults is not None and not problems:
        for name, fault in vars(case.faults).items():
            problems += _faults(f"faults.{name}", partial(check_fault, case, fault))
    return problems


def chosen_options(case: PairCase, section: str) -> dict[str, Any]:
    """Return the effective options of the model of a table, by argument name."""
    model, values = getattr(case, section).chosen, case._effective
    arguments = {
        option.argument or name: values[f"{section}.{name}"]
        for name, option in model.declared.items()
        if option.in_case
    }
    return {name: value for name, value in arguments.items() if value is not None}


def _bores(case: PairCase) -> list[tuple[str, Problem]]:
    """Find gears without a bore where the deflection is measured against it."""
    model = case.stiffness.model
    if case.stiffness.reference != "bore":
        return []
    gears = {"pinion": case.gears.pinion, "wheel": case.gears.wheel}
    problem = Problem(
        "bore_diameter = 0 mm",
        why=f'The model "{model}" measures deflection against the bore',
        remedy='Give bore_diameter, or reference = "rim" in [stiffness], without the body',
    )
    return [
        (f"gears.{name}.bore_diameter", problem)
        for name, gear in gears.items()
        if gear.bore_diameter == 0.0 and gear.tooth_count > 0
    ]
