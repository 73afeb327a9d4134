"""Tables of load capacity: ``[rating]``, ``[materials.NAME]``, keys of bearings and of shafts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from tribodyn.errors import InputError, Problem, collected, no_such
from tribodyn.model import REQUIRED, choice, file_path, flag, integer, number, numbers, text
from tribodyn.study.case.section import NamedTables, Section, table

if TYPE_CHECKING:
    from tribodyn.rating import GearMaterial, ShaperCutter, SpectrumLoad
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.case.sections import LubricantData

_STRENGTH = "strengths of metals in N/mm2; guards against a wrong unit"


def _kinds() -> list[str]:
    from tribodyn.rating.materials import KINDS

    return list(KINDS)


def _strength(symbol: str, meaning: str) -> Any:
    return number(
        None, 10e6, 5e9, _STRENGTH, unit="Pa", display_unit="MPa", symbol=symbol, meaning=meaning,
        example='"1500 MPa"',
    )  # fmt: skip


class StrengthTable(Section):
    """A ``[materials.NAME]`` table: strength of the material of a gear by ISO 6336-5."""

    kind: str = choice("Eh", _kinds, meaning="type of material of ISO 6336-5")
    grade: str = choice("MQ", ("ML", "MQ", "ME"), meaning="grade of quality")
    hardness: float | None = number(
        None, 50.0, 1200.0, "hardness numbers of metals", meaning="HBW of St and cast iron, HV of "
        "the flank of the others; needed where the strength depends on it", example="720.0",
    )  # fmt: skip
    core_hardness: float = number(
        25.0, 25.0, 50.0, "HRC of carburized cores", meaning="HRC of the core of Eh MQ",
    )  # fmt: skip
    hardenable: bool = flag(True, meaning="whether the core of Eh MQ has 28 HRC at Jominy 12 mm")
    pitting_limit: float | None = _strength("sigma_Hlim", "allowable contact stress number")
    bending_limit: float | None = _strength("sigma_Flim", "nominal stress number in bending")
    yield_strength: float | None = _strength("sigma_S", "yield strength of St and V")
    tensile_strength: float | None = _strength("sigma_B", "tensile strength of GG")
    peened: bool = flag(False, meaning="whether the roots are shot-peened")
    profile_depth: tuple[float, ...] | None = numbers(
        0.0, 0.1, "case depths are millimetres", unit="m", display_unit="mm",
        meaning="depths below the surface of both profiles, rising",
        example='["0 mm", "0.5 mm", "2 mm"]',
    )  # fmt: skip
    hardness_profile: tuple[float, ...] | None = numbers(
        50.0, 1200.0, "hardness numbers of metals", example="[720.0, 650.0, 420.0]",
        meaning="HV at these depths, for the exposure below the surface",
    )  # fmt: skip
    residual_stress_profile: tuple[float, ...] | None = numbers(
        -3e9, 3e9, _STRENGTH, unit="Pa", display_unit="MPa",
        meaning="residual stress along the surface at these depths, compression negative",
        example='["-300 MPa", "-200 MPa", "0 MPa"]',
    )  # fmt: skip


class Materials(
    NamedTables, inner=table(StrengthTable, "strength of the material of gears that name it")
):
    """The ``[materials]`` table: materials by the names that ``gears.*.material`` gives."""


def _roughness(default: float, meaning: str) -> Any:
    return number(
        default, 0.1e-6, 200e-6, "honed to rough flanks", unit="m", display_unit="um", symbol="Rz",
        meaning=meaning, example='"4 um"',
    )  # fmt: skip


class RatingTable(Section):
    """The ``[rating]`` table: load capacity of the gears by ISO 6336."""

    required_life: float | None = number(
        None, 1.0, 1e11, "one second to 3000 years", unit="s", display_unit="h",
        meaning="required running time; endurance limits without it", example='"20000 h"',
    )  # fmt: skip
    application_factor: float = number(
        1.0, 0.1, 10.0, "ISO 6336-1 has 1 to 2.25", symbol="K_A",
        meaning="loads from outside; 1 where load cases contain them", example="1.25",
    )  # fmt: skip
    mesh_load_factor: float | None = number(
        None, 1.0, 3.0, "planets share unevenly", symbol="K_gamma",
        meaning="greatest load of a planet over the mean", basis="the number of planets",
    )  # fmt: skip
    minimum_safety: float | None = number(
        None, 0.1, 10.0, "safeties in use lie between 1 and 3", meaning="required safety of all "
        "modes of failure", basis="1 pitting and micropitting, 1.4 bending, 1.5 scuffing",
    )  # fmt: skip
    edition: int = integer(
        2019, 2006, 2019, "editions 2006 and 2019", meaning="edition of ISO 6336", example="2019"
    )
    accuracy_grade: int = integer(
        6, 0, 12, "grades of ISO 1328-1:1995", meaning="accuracy grade of both gears", example="6"
    )
    flank_roughness: float = _roughness(4e-6, "roughness Rz of the flanks")
    root_roughness: float = _roughness(16e-6, "roughness Rz of the roots")
    kinematic_viscosity_at_40: float | None = number(
        None, 7e-6, 0.1, "mineral oils; guards against a wrong unit", unit="m^2/s",
        display_unit="mm^2/s", symbol="nu_40", meaning="viscosity of the oil at 40 degC where "
        "lubricant has that of the working temperature alone", example='"220 mm^2/s"',
    )  # fmt: skip
    scuffing_load_stage: int | None = integer(
        None, 1, 14, "stages of the test A/8.3/90",
        meaning="failure load stage of the oil in the FZG scuffing test", example="12",
    )  # fmt: skip
    micropitting_load_stage: int | None = integer(
        None, 5, 10, "stages of the test C-GF/8.3",
        meaning="failure load stage of the oil in the FZG micropitting test", example="9",
    )  # fmt: skip
    wear_coefficient: float | None = number(
        None, 1e-22, 1e-10, "1e-18 to 1e-15 m2/N of lubricated steel", unit="1/Pa",
        meaning="wear coefficient of Archard, volume over load and sliding distance: depth of "
        "wear after the required life", example="1e-18",
    )  # fmt: skip
    lubrication: str = choice(
        "dip", ("dip", "spray", "submerged"), meaning="how the oil reaches the gears"
    )
    torque_history: str | None = file_path(
        meaning="recording of the torque of [operation] over the required life, CSV or another "
        "format of recordings, which becomes load classes by ISO 6336-6",
        example='"torque.csv"',
    )
    torque_column: str | None = text(
        None, meaning="its column of torques", basis="torque", example='"torque"'
    )
    torque_unit: str | None = text(
        None, meaning="unit of these torques", basis="that in the file", example='"N*m"'
    )
    speed_column: str | None = text(
        None, meaning="its column of speeds", basis="the speed of [operation]", example='"speed"'
    )
    speed_unit: str | None = text(
        None, meaning="unit of these speeds", basis="that in the file", example='"rpm"'
    )
    load_classes: int | None = integer(
        None, 1, 1000, "each class of a machine is a run", basis="16", example="16",
        meaning="classes from no load to the greatest torque, for each sign",
    )  # fmt: skip


#: Keys of ``[rating]`` about the history of the torque.
HISTORY = (
    "torque_history", "torque_column", "torque_unit", "speed_column", "speed_unit", "load_classes",
)  # fmt: skip


class CutterTable(Section):
    """A ``[gears.NAME.cutter]`` table: gear-shaped cutter that made a gear, for its root."""

    teeth: int = integer(REQUIRED, 5, 500, "shaping cutters", symbol="z_0",
                         meaning="number of teeth", example="25")  # fmt: skip
    profile_shift_coefficient: float = number(
        0.0, -2.0, 2.0, "new to worn cutters", symbol="x_0", meaning="profile shift of the cutter"
    )
    tip_radius_coefficient: float = number(
        0.2, 0.0, 1.0, "round tips", meaning="radius of its tip round over the module"
    )


def _load(meaning: str, example: str) -> Any:
    return number(
        None, 1.0, 1e9, "catalogues of rolling bearings", unit="N", display_unit="kN",
        meaning=meaning, example=f'"{example} kN"',
    )  # fmt: skip


def _length(default: object, meaning: str, basis: str = "", unit: str = "mm") -> Any:
    return number(
        default, 0.0, 100.0, "guards against a wrong unit", unit="m", display_unit=unit,
        meaning=meaning, basis=basis, example=f'"40 {unit}"',
    )  # fmt: skip


class BearingCatalogue(Section):
    """Catalogue values of a rolling bearing, for its life."""

    dynamic_load_rating: float | None = _load("C of the catalogue, for the life", "55.3")
    static_load_rating: float | None = _load("C_0 of the catalogue", "31.5")
    fatigue_load_limit: float | None = number(
        None, 0.1, 1e8, "catalogues of rolling bearings", unit="N", display_unit="kN",
        meaning="C_u of the catalogue", basis="C_0/22 of balls, C_0/8.2 of rollers",
        example='"1.34 kN"',
    )  # fmt: skip
    elements: str = choice("ball", ("ball", "roller"), meaning="what rolls in a bearing of no type")
    pitch_diameter: float | None = number(
        None, 1e-3, 10.0, "guards against a wrong unit", unit="m", display_unit="mm",
        meaning="D_pw of a bearing of no type, for the viscosity that it needs",
        example='"72.5 mm"',
    )  # fmt: skip


def _cleanliness() -> list[str]:
    from tribodyn.rating.elements.bearing_life import CLEANLINESS

    return list(CLEANLINESS)


class PartRating(Section):
    """Keys of ``[rating]`` of the bearings of a machine."""

    cleanliness: str = choice(
        "bath -/17/14", _cleanliness, meaning="filter or bath with the class of ISO 4406, or grease"
    )
    reliability: float = number(
        90.0, 90.0, 99.95, "a_1 of ISO 281", meaning="percent of the bearings that last",
        example="99.0",
    )  # fmt: skip


class ShaftStrength(Section):
    """Strength of a shaft at the reference diameter of 16 mm, by DIN 743."""

    tensile_strength: float | None = _strength("sigma_B", "tensile strength of the shaft")
    yield_strength: float | None = _strength("sigma_S", "yield strength of the shaft")
    heat_treatment: str = choice(
        "quenched", ("quenched", "structural", "carburized CrNiMo", "carburized"),
        meaning="kind of steel, for the influence of size",
    )  # fmt: skip
    hard_surface: bool = flag(False, meaning="whether the surface is hardened")
    treated_diameter: float | None = number(
        None, 1e-3, 10.0, "guards against a wrong unit", unit="m", display_unit="mm",
        symbol="d_eff", meaning="diameter of the shaft at its heat treatment",
        basis="the diameter of the notch", example='"60 mm"',
    )  # fmt: skip


class NotchTable(Section):
    """A ``[shafts.NAME.notches.PLACE]`` table: a notched section, by DIN 743."""

    position: float = _length(REQUIRED, "position on the shaft")
    kind: str = choice(
        "shoulder", ("shoulder", "groove", "key", "two keys", "press fit", "given"),
        meaning="kind of notch; given has notch_factors",
    )  # fmt: skip
    diameter: float | None = _length(None, "d of the notched section", "the thinner section")
    large_diameter: float | None = _length(
        None, "D of the thicker section at the notch", "the thicker section"
    )
    radius: float | None = _length(None, "r of a shoulder or groove")
    roughness: float = _length(5e-6, "roughness Rz of the surface", unit="um")
    notch_factors: tuple[float, ...] | None = numbers(
        1.0, 20.0, "notch factors", meaning="beta of tension, bending and torsion",
        example="[1.5, 1.8, 1.4]",
    )  # fmt: skip
    surface_factor: float = number(
        1.0, 1.0, 3.0, "DIN 743", symbol="K_V", meaning="strengthening of the surface"
    )


def gear_material(case: PairCase, role: str) -> GearMaterial:
    """Strength of the material of a gear; Eh MQ where it names none."""
    from tribodyn.rating import GearMaterial

    name = getattr(case.gears, role).material
    stated = {} if name is None else vars(getattr(case.materials, name))
    values = {k: v for k, v in stated.items() if not k.startswith("_")}
    values |= {k: v or () for k, v in values.items() if "profile" in k}
    elastic = case.material_properties
    return GearMaterial(
        youngs_modulus=elastic.youngs_modulus,
        poissons_ratio=elastic.poissons_ratio,
        density=case.density(role),
        **values,
    )


def shaper_cutter(case: PairCase, role: str) -> ShaperCutter | None:
    """Cutter that made a gear; None where its case has none."""
    from tribodyn.rating import ShaperCutter

    stated = getattr(case.gears, role).cutter
    return (
        None if stated is None else ShaperCutter(**{k: getattr(stated, k) for k in stated.fields})
    )


def history_classes(rating: Any, speed: float) -> tuple[SpectrumLoad, ...]:
    """Load classes of the history of ``[rating]``, durations as shares; empty without one."""
    if rating is None or rating.torque_history is None:
        return ()
    from tribodyn.measurement.load_history import read_load_classes

    names = ("torque_column", "torque_unit", "speed_column", "speed_unit")
    stated = {name: getattr(rating, name) for name in names if getattr(rating, name) is not None}
    return read_load_classes(
        rating.torque_history, speed, classes=rating.load_classes or 16, **stated
    )


def history_problems(rating: Any, speed: float | None) -> Iterator[tuple[str, Problem]]:
    """Problems of the history of the torque, by dotted key."""
    if rating is None:
        return
    stated = [name for name in HISTORY if getattr(rating, name) is not None]
    if stated and rating.torque_history is None:
        what, why = f"{stated[0]} has no effect here", "There is no torque_history"
        yield f"rating.{stated[0]}", Problem(what, "", why, "Add it, or remove this key")
    elif stated and rating.required_life is None:
        what, why = "torque_history has no effect here", "Its classes are parts of a running time"
        yield "rating.torque_history", Problem(what, "", why, "Add required_life, or remove it")
    elif stated and speed is not None:
        try:
            history_classes(rating, speed)
        except InputError as error:
            for problem in error.problems:
                key = getattr(problem.where, "name", "")
                if key not in HISTORY:  # a fault of the file itself
                    key, what = "torque_history", f"{rating.torque_history} {problem.what}"
                    problem = replace(problem, what=what)
                yield f"rating.{key}", problem


def _wear_problems(case: PairCase) -> Iterator[tuple[str, Problem]]:
    assert case.rating is not None
    if case.rating.wear_coefficient is None:
        return
    if case.rating.required_life is None:
        what, why = "wear_coefficient has no effect here", "Wear goes on for the required life"
        problem = Problem(what, "", why, "Add required_life, or remove it")
        yield "rating.wear_coefficient", problem


def has_viscosity_at_40(oil: LubricantData) -> bool:
    """Whether an oil has a viscosity at 40 degC, stated or on its line over temperature."""
    if oil.name is not None or oil.density_at_15 is not None or oil.temperature is None:
        return oil.name is not None or oil.density_at_15 is not None
    at_40 = math.isclose(oil.temperature, 313.15, abs_tol=1e-6)
    return at_40 or oil.temperature_viscosity_coefficient is not None


def _viscosity_problems(oil: LubricantData, at_40: float | None) -> Iterator[tuple[str, Problem]]:
    if has_viscosity_at_40(oil):
        if at_40 is not None:
            what, why = "kinematic_viscosity_at_40 has no effect here", "[lubricant] gives it"
            yield "rating.kinematic_viscosity_at_40", Problem(what, "", why, "Remove it")
    elif at_40 is None:
        what = "the viscosity of the oil at 40 degC is not known"
        why = "Ratings need it, and properties at one other temperature do not give it"
        remedy = (
            "State it as rating.kinematic_viscosity_at_40; or give lubricant.name, the figures of "
            "a data sheet with density_at_15, or temperature and temperature_viscosity_coefficient"
        )
        yield "rating", Problem(what, "", why, remedy)
    elif oil.temperature is not None:
        viscosity = float(oil.dynamic_viscosity or 0.0) / float(oil.density or 1.0)
        if (viscosity - at_40) * (oil.temperature - 313.15) >= 0.0:
            what = f"kinematic_viscosity_at_40 = {1e6 * at_40:g} mm2/s"
            why = f"The oil has {1e6 * viscosity:.4g} mm2/s at {oil.temperature - 273.15:g} degC"
            remedy = "An oil is thinner where it is warmer: correct one of them"
            yield "rating.kinematic_viscosity_at_40", Problem(what, "", why, remedy)


def rating_problems(case: PairCase) -> Iterator[tuple[str, Problem]]:
    """Problems of materials and of the rating, by dotted key."""
    from tribodyn.rating.bending import rim_factor, slip_layer
    from tribodyn.rating.root_section import root_section
    from tribodyn.rating.tolerances import gear_tolerances

    names = [] if case.materials is None else [n for n in vars(case.materials) if n[0] != "_"]
    if case.rating is None:
        if names:
            what, why = "materials has no effect here", "Only a rating needs strengths"
            yield "materials", Problem(what, "", why, "Add [rating], or remove it")
        for role in ("pinion", "wheel"):
            gear = getattr(case.gears, role)
            why = "Only a rating needs it"
            remedy = "Add [rating], or remove it"
            if (name := gear.material) is not None:
                what = f'material = "{name}" has no effect here'
                yield f"gears.{role}.material", Problem(what, "", why, remedy)
            if gear.cutter is not None:
                what = "cutter has no effect here"
                yield f"gears.{role}.cutter", Problem(what, "", why, remedy)
        return
    if case.gears.kind != "spur":
        what, why = "rating has no effect here", "Cylindrical gears are rated, others are not"
        yield "rating", Problem(what, "", why, "Remove it")
        return
    if case.rating.edition not in (2006, 2019):
        what, why = f"edition = {case.rating.edition}", "ISO 6336 is computed as of 2006 and 2019"
        yield "rating.edition", Problem(what, "", why, "Choose one of these")
    yield from _wear_problems(case)
    yield from history_problems(case.rating, case.operation.speed)
    if case.lubricant is None:
        what, why = "the table [lubricant] is missing", "Ratings need the viscosity at 40 degC"
        yield "rating", Problem(what, "", why, "Add it with a name, or the figures of a data sheet")
    else:
        yield from _viscosity_problems(case.lubricant, case.rating.kinematic_viscosity_at_40)
    materials = [getattr(case.gears, role).material for role in ("pinion", "wheel")]
    for name in (name for name in names if name not in materials):
        what, remedy = f"{name} has no effect here", "Name it as material of a gear, or remove it"
        yield f"materials.{name}", Problem(what, "", "No gear names it", remedy)
    for role, name in (("pinion", materials[0]), ("wheel", materials[1])):
        if name is not None and name not in names:
            problem = no_such("material", name, names, "", f"Add [materials.{name}]")
            yield f"gears.{role}.material", problem
            continue
        try:
            with collected():
                if role == "pinion" or name != materials[0]:  # reported with the pinion
                    slip_layer(gear_material(case, role))
                gear = getattr(case.gear_pair, role)
                root_section(gear, shaper_cutter(case, role), case.rating.edition)
                rim_factor(gear, role)
                gear_tolerances(gear, case.rating.accuracy_grade)
        except InputError as error:
            for problem in error.problems:
                key = getattr(problem.where, "name", "")
                table = f"materials.{name}" if key in StrengthTable.fields else f"gears.{role}"
                yield f"{'gears' if key == 'normal_module' else table}.{key}".rstrip("."), problem
