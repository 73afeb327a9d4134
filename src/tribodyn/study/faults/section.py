"""The ``[faults.NAME]`` tables of a case, and the faults that they state."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeVar

from tribodyn.errors import Argument, InputError, Problem, no_such
from tribodyn.faults.cracked_tooth import GREATEST_TANGENT, LEAST_TANGENT
from tribodyn.model import REQUIRED, choice, file_path, integer, number, numbers, text
from tribodyn.study.case.section import NamedTables, Section, table
from tribodyn.study.case.values import KeyedProblems
from tribodyn.study.faults.kinds import KINDS, LACKS, keys_in, kinds_in
from tribodyn.types import Tree

if TYPE_CHECKING:
    from tribodyn.faults import BearingDefect, Fault, ShaftExcitation
    from tribodyn.faults.turning_table import BevelGear
    from tribodyn.mesh import MeshTable

T = TypeVar("T")
_TURN = 2.0 * math.pi
_GUARD = "guards against a wrong unit"
_PART = "a share"


def _length(meaning: str, high: float, example: str) -> Any:
    return number(
        None, 0.0, high, _GUARD, unit="m", display_unit="um" if high < 0.01 else "mm",
        meaning=meaning, example=example,
    )  # fmt: skip


def _share(meaning: str) -> Any:
    return number(None, 0.0, 1.0, _PART, meaning=meaning, example="0.5")


class FaultTable(Section):
    """A ``[faults.NAME]`` table: kind, gear, place and size."""

    needed = ("kind", "gear")
    kind: str = choice(
        REQUIRED, {name: kind.meaning for name, kind in KINDS.items()}, meaning="what it is"
    )
    gear: str | None = choice(None, ("pinion", "wheel"), meaning="gear, or shaft of it")
    tooth: int | None = integer(
        None, 1, 1000, "from 1 in the order of contact", meaning="number of the tooth", example="1"
    )
    depth: float | None = _length("depth of a spall or of a crack", 1.0, '"1 mm"')
    angle: float | None = number(
        None, math.pi / 4.0, math.pi / 2.0, "cracks run into the body or square to the tooth",
        unit="rad", display_unit="deg",
        meaning="angle of a crack to the centre line of its tooth; 90 deg by default",
        example='"70 deg"',
    )  # fmt: skip
    root_tangent: float | None = number(
        None, LEAST_TANGENT, GREATEST_TANGENT,
        "any fillet lies in it, that of a tooth from its involute to its foot", unit="rad",
        display_unit="deg",
        meaning="tangent of the fillet to the centre line where a crack begins; by default at "
        "the foot, where the fillet is 45 deg steep over the circle",
        example='"30 deg"',
    )  # fmt: skip
    start: float | None = _share("lower end of a spall on the used flank, from its lowest point")
    end: float | None = _share("upper end of a spall on the used flank; 1 is the tip")
    face_share: float | None = _share("part of the face width that is damaged; all by default")
    face_length: float | None = _length("length of a crack along the face", 10.0, '"8 mm"')
    face_position: float | None = number(
        None, -10.0, 10.0, _GUARD, unit="m", display_unit="mm", example='"6 mm"',
        meaning="middle of a crack along the face, from the middle of the face",
    )  # fmt: skip
    remaining: float | None = _share("part of the used flank that is left; none by default")
    amplitude: float | None = _length("eccentricity, or amplitude of a wave", 1e-3, '"10 um"')
    order: int | None = integer(
        None, 1, 100_000, "waves in a turn of the gear", meaning="order of a wave", example="97"
    )
    phase: float | None = number(
        None, -_TURN, _TURN, "one turn", unit="rad", display_unit="deg",
        meaning="phase where tooth 1 comes into contact", example='"90 deg"',
    )  # fmt: skip
    lead_angle: float | None = number(
        None, -1.5, 1.5, "inclined crests", unit="rad", display_unit="deg",
        meaning="angle of the crests to the line of contact", example='"5 deg"',
    )  # fmt: skip
    accuracy_class: int | None = integer(
        None, 1, 11, "classes of ISO 1328-1", meaning="accuracy class", example="6"
    )
    profile_slopes: tuple[float, ...] | None = numbers(
        -5e-4, 5e-4, _GUARD, unit="m", display_unit="um", example='["4 um", "-3 um", "0 um"]',
        meaning="slope of the profile of each tooth in the order of contact: material taken away "
        "at the tip",
    )  # fmt: skip
    helix_slopes: tuple[float, ...] | None = numbers(
        -5e-4, 5e-4, _GUARD, unit="m", display_unit="um", example='["4 um", "-3 um", "0 um"]',
        meaning="slope of the helix of each tooth: material taken away at one end of the face",
    )  # fmt: skip
    file: str | None = file_path(
        meaning="CSV file with the deviations of the flanks of measured teeth: a profile map with "
        "a column tooth",
        example='"teeth.csv"',
    )
    other_teeth: str | None = choice(
        None, ("nominal", "nearest"),
        meaning="flanks of the teeth that were not measured: without deviation, or as the nearest "
        "measured one",
    )  # fmt: skip
    interpolation: str | None = choice(
        None, ("linear", "cubic"), meaning="how the maps are read between their points"
    )
    seed: int | None = integer(
        None, 0, 10**9, "any whole number", meaning="number of the random draw", example="1"
    )
    place: str | None = choice(
        None, ("outer", "inner", "element"), meaning="ring or element of a bearing with a defect"
    )
    rolling_elements: int | None = integer(
        None, 3, 1000, "a bearing has at least three", meaning="number of elements", example="9"
    )
    element_diameter: float | None = _length("diameter of a rolling element", 1.0, '"7.94 mm"')
    pitch_diameter: float | None = _length("diameter of the circle of elements", 10.0, '"39 mm"')
    contact_angle: float | None = number(
        None, 0.0, 1.2, "bearings lie below 60 deg", unit="rad", display_unit="deg",
        meaning="contact angle of a bearing", example='"15 deg"',
    )  # fmt: skip
    acceleration: float | None = number(
        None,
        0.0,
        1e6,
        _GUARD,
        unit="m/s^2",
        meaning="largest acceleration of an impact at a sensor",
    )
    resonance: float | None = number(
        None, 1.0, 1e6, _GUARD, unit="Hz", meaning="natural frequency that an impact excites",
        example='"3000 Hz"',
    )  # fmt: skip
    damping_ratio: float | None = number(
        None, 1e-4, 0.9, "over the critical damping", meaning="damping of that resonance"
    )
    slip: float | None = number(
        None, 0.0, 0.2, "scatter over the mean", meaning="scatter of the intervals of impacts"
    )
    orders: tuple[float, ...] | None = numbers(
        1e-3, 1e5, "periods in a turn of the shaft", meaning="orders of a torque or a speed",
        example="[1, 2, 4]",
    )  # fmt: skip
    torques: tuple[float, ...] | None = numbers(
        0.0, 1e7, _GUARD, unit="N*m", meaning="amplitude of the torque at each order",
        example='["5 N*m", "20 N*m", "8 N*m"]',
    )  # fmt: skip
    fluctuations: tuple[float, ...] | None = numbers(
        0.0, 0.2, "a speed with a mean", meaning="amplitude of the speed over its mean at each "
        "order", example="[0.01, 0.02, 0.005]",
    )  # fmt: skip
    phases: tuple[float, ...] | None = numbers(
        -_TURN, _TURN, "one turn", unit="rad", display_unit="deg",
        meaning="phase of each order where tooth 1 comes into contact; zero by default",
        example='["0 deg", "90 deg", "0 deg"]',
    )  # fmt: skip
    torque: float | None = number(
        None, 0.0, 1e6, _GUARD, unit="N*m", meaning="root mean square of a random torque"
    )
    frequencies: tuple[float, ...] | None = numbers(
        0.0, 1e5, _GUARD, unit="Hz", example='["20 Hz", "200 Hz"]',
        meaning="ends of the band of a random torque, or corners of its density",
    )  # fmt: skip
    densities: tuple[float, ...] | None = numbers(
        0.0, 1e12, _GUARD, unit="N^2*m^2/Hz", example='["0.1 N^2*m^2/Hz", "0.1 N^2*m^2/Hz"]',
        meaning="power spectral density of a random torque at each corner",
    )  # fmt: skip
    duration: float | None = number(
        None, 1e-3, 1e3, _GUARD, unit="s", example='"1 s"',
        meaning="time after which a random torque repeats; 1 s by default",
    )  # fmt: skip


class PartFaultTable(FaultTable):
    """A ``[faults.NAME]`` table of a case whose parts have names: a fault of any of them."""

    gear: str | None = text(None, meaning="gear that has it", example='"z1"')  # type: ignore[assignment]
    planet: int | None = integer(
        None, 1, 24, "in the order of the angles", example="1",
        meaning="number of the planet, of a planetary stage",
    )  # fmt: skip
    shaft: str | None = text(None, meaning="shaft that is driven or loaded so", example='"input"')
    bearing: str | None = text(None, meaning="bearing that has it", example='"A"')
    impact_force: float | None = number(
        None, 0.0, 1e7, _GUARD, unit="N", example='"200 N"',
        meaning="greatest force of an impact in a bearing",
    )  # fmt: skip
    impact_duration: float | None = number(
        None, 1e-7, 0.1, _GUARD, unit="s", display_unit="ms", example='"0.1 ms"',
        meaning="duration of an impact, 0.1 ms by default",
    )  # fmt: skip
    stiffness_share: float | None = number(
        None, 0.0, 1.0, _PART, example="0.3",
        meaning="radial stiffness of a lifted seat over that of the pressed one",
    )  # fmt: skip
    press_angle: float | None = number(
        None, -_TURN, _TURN, "one turn", unit="rad", display_unit="deg", example='"-90 deg"',
        meaning="direction from y towards z in which the shaft presses on a loose seat; that of "
        "its mean load by default",
    )  # fmt: skip


class Faults(NamedTables, inner=table(FaultTable, "a fault")):
    """The ``[faults]`` table."""


def _stated(fault: FaultTable) -> Tree:
    return {
        name: value for name, value in vars(fault).items() if name != "kind" and value is not None
    }


def fault_tables(faults: Faults | Mapping[str, FaultTable] | None) -> Mapping[str, FaultTable]:
    """Tables by name."""
    return vars(faults) if isinstance(faults, Faults) else faults or {}


def fault_problems(
    faults: Faults | Mapping[str, FaultTable] | None,
    case: str = "pair",
    parts: Mapping[str, Sequence[str]] | None = None,
) -> KeyedProblems:
    """Report kinds that a case lacks, missing and further keys, and names of no part."""
    problems: KeyedProblems = []
    for name, fault in fault_tables(faults).items():
        if why := LACKS[case].get(fault.kind):
            remedy = f"The kinds of a {case} are {', '.join(kinds_in(case))}"
            wrong = [("kind", Problem(f'kind = "{fault.kind}"', "", why, remedy))]
        else:
            wrong = [*_key_problems(name, fault, case), *_name_problems(fault, parts or {})]
        problems += [(f"faults.{name}.{key}", problem) for key, problem in wrong]
    return problems


def _key_problems(name: str, fault: FaultTable, case: str) -> KeyedProblems:
    """Report missing keys, and keys that this kind of fault does not have."""
    (required, optional), stated = keys_in(case, fault.kind), _stated(fault)
    why = f'A fault of the kind "{fault.kind}" has: {", ".join((*required, *optional))}'
    problems: KeyedProblems = []
    for key in required:
        if key not in stated:
            example = getattr(fault.spec(key), "example", "")
            remedy = f"Add for example {key} = {example} to [faults.{name}]"
            problems.append((key, Problem(f"{key} is missing", "", why, remedy)))
    either = KINDS[fault.kind].either
    if either and (count := sum(key in stated for key in either)) != 1:
        what = f"{' and '.join(either)} are {'both given' if count else 'missing'}"
        problem = Problem(what, "", "One of them states the size", "Give one of them")
        problems.append((either[0], problem))
    for key in sorted(stated.keys() - {*required, *optional}):
        problems.append((key, Problem(f"{key} is given", "", why, "Remove it")))
    return problems


def _name_problems(fault: FaultTable, parts: Mapping[str, Sequence[str]]) -> KeyedProblems:
    """Report names of gears, bearings and shafts that a case does not have."""
    problems: KeyedProblems = []
    for key, names in parts.items():
        reference = getattr(fault, key)
        if reference is not None and part_of(reference) not in names:
            problems.append((key, no_such(key, reference, names, "", "Correct the name")))
    return problems


def part_of(reference: str | None) -> str:
    """Name of a part, which may be written as ``gears.z1``."""
    group, _, name = (reference or "").partition(".")
    return name if group in ("gears", "shafts", "bearings") else reference or ""


def read_fault(fault: FaultTable, **changes: Any) -> Fault | BearingDefect | ShaftExcitation:
    """The fault that a table states."""
    from tribodyn import faults

    values = {**_stated(fault), **changes}
    for key in ("shaft", "planet"):
        values.pop(key, None)
    if fault.kind == "eccentricity":
        values["order"] = 1
    if fault.kind == "bearing-defect":
        values.pop("gear")
    if fault.kind == "random-load" and "torque" in values:
        return faults.RandomLoad.of_rms(values.pop("torque"), values.pop("frequencies"), **values)
    if fault.kind == "flank-topographies":
        from tribodyn.measurement.readers.profile_map import read_tooth_maps

        maps = read_tooth_maps(values.pop("file"), values.pop("interpolation", "linear"))
        values |= {"teeth": tuple(maps), "maps": tuple(maps.values())}
    result: Fault | BearingDefect | ShaftExcitation = getattr(faults, KINDS[fault.kind].model)(
        **values
    )
    return result


@contextmanager
def located_in(fault: FaultTable) -> Iterator[None]:
    """Name the key of the file in problems of measured flanks."""
    try:
        yield
    except InputError as error:
        if fault.kind != "flank-topographies":
            raise
        raise InputError([replace(p, where=Argument("file")) for p in error.problems]) from None


def check_fault(case: Any, fault: FaultTable, **changes: Any) -> None:
    """Raise InputError if the pair of a case cannot have a fault."""
    from tribodyn.faults import Fault
    from tribodyn.faults.turning_table import check_hypoid_fault

    require_teeth(case)
    with located_in(fault):
        stated = read_fault(fault, **changes)
        if isinstance(stated, Fault) and case.gears.kind == "hypoid":
            check_hypoid_fault(stated)
        elif isinstance(stated, Fault):
            stated._check(case.gear_pair)
            stated._check_model(case.gear_pair, case.stiffness.model)


def require_teeth(case: Any) -> None:
    """Raise InputError if the gears are those of a table."""
    if case.gears.kind == "table":
        why = "Faults act on cylindrical and hypoid pairs, whose teeth are known"
        raise InputError("the gears are a table pair", "gears.kind", why, "Remove [faults]")


def bevel_gears(case: Any, table: MeshTable) -> dict[str, BevelGear]:
    """Both gears of a hypoid pair, with the levers of the mesh force."""
    from tribodyn.faults.turning_table import BevelGear

    blank = case.hypoid_flanks.blank
    levers = abs(table.grid.mean(table.direction[:, [4, 10]]))
    return {
        name: BevelGear(
            getattr(blank, f"teeth_{name}"),
            0.5 * getattr(blank, f"mean_pitch_diameter_{name}"),
            blank.mean_normal_module,
            float(lever),
        )
        for name, lever in zip(("pinion", "wheel"), levers, strict=True)
    }


def _faults_of(case: Any, kind: type[T]) -> dict[str, T]:
    """Faults of one class, by name."""
    faults = {name: read_fault(fault) for name, fault in fault_tables(case.faults).items()}
    return {name: fault for name, fault in faults.items() if isinstance(fault, kind)}


def gear_faults(case: Any) -> dict[str, Fault]:
    """Faults of the gears of a case, by name."""
    from tribodyn.faults import Fault

    return _faults_of(case, Fault)


def excitations(case: Any) -> dict[str, ShaftExcitation]:
    """Torques and speeds of the shafts of a case that vary, by name."""
    from tribodyn.faults import ShaftExcitation

    return _faults_of(case, ShaftExcitation)
