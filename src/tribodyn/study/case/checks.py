"""Checks across keys: contradictions, missing partners, and marks on keys that do not exist."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, cast

from tribodyn.errors import Problem
from tribodyn.model import REQUIRED, Model, Option
from tribodyn.study.case.gears import HYPOID_KEYS, heat_of_bodies, is_idle
from tribodyn.study.case.given import TWO_WAYS, Given, both_given
from tribodyn.study.case.section import Choice, Known, choices, section_at
from tribodyn.study.case.sections import THERMAL, lubricant_problems

if TYPE_CHECKING:
    from tribodyn.ehl import FilmModel
    from tribodyn.friction import FrictionLaw

#: The reason that marks a written value as the default of the library that wrote it.
DEFAULT_MARK = "default"

Found = Iterator[tuple[str, Problem]]

#: Options of the friction of the film, and the properties that only they need.
_HEAT = ("inlet_heating", "flash_temperature")
#: Tables about values of the other tables.
_ABOUT = ("assumed", "based_on")
#: Abscissae of a stiffness table.
_ABSCISSAE = ("phase", "roll_angle")
_RECTANGULAR = ("single_pair_stiffness", "double_pair_stiffness")
#: Roughness of one flank, in one way or the other.
_HEIGHTS = ("roughness_rms", "roughness_ra")


def _roughness(given: Given) -> Found:
    present: dict[str, str] = {}
    for gear in ("pinion", "wheel"):
        keys = [key for name in _HEIGHTS if (key := f"gears.{gear}.{name}") in given]
        if keys:
            present[gear] = keys[0]
        if len(keys) == 2:
            yield both_given(given, *keys)
    if "gears.composite_roughness" in given:
        for gear, key in present.items():
            what = (
                f"{given.show('gears.composite_roughness')} and {given.show(key)} "
                f"of the {gear} are both given"
            )
            yield "gears.composite_roughness", Problem(what, "", TWO_WAYS, "Keep one of them")
    elif len(present) == 1:
        ((gear, key),) = present.items()
        absent = key.replace(*(("pinion", "wheel") if gear == "pinion" else ("wheel", "pinion")))
        what = f"{absent.split('.')[2]} of the {absent.split('.')[1]} is missing"
        why = f"{given.show(key)} of the {gear} needs its counterpart"
        yield absent, Problem(what, "", why, "Add it, or give composite_roughness in [gears]")


#: Kind of gears -> keys that take few of their names, those names, and why.
_TABLE_HAS = "A mesh table has its films and friction coefficients as columns"
_CELLS_HAVE = "The contact lines of a hypoid pair have their own films and compliance"
_NARROW: dict[str, tuple[tuple[str, tuple[str, ...], str], ...]] = {
    "table": (
        ("film.model", ("none",), _TABLE_HAS),
        ("friction.law", ("none", "constant"), _TABLE_HAS),
        ("dynamics.friction_load", ("nominal",), _TABLE_HAS),
    ),
    "hypoid": (
        ("film.model", ("none",), _CELLS_HAVE),
        ("gears.driver", ("pinion",), "The pinion of a hypoid pair drives"),
        ("dynamics.friction_load", ("nominal",), "Friction of a hypoid pair belongs to its torque"),
    ),
}
_NO_BODIES = "A mesh table knows no gear bodies"


def _kind(given: Given) -> Found:
    """What a kind of gear pair needs, and what it cannot have."""
    kind = given.get("gears.kind", "spur")
    if not isinstance(kind, str):
        return  # which is told where its names are checked
    narrow = _NARROW.get(kind, ())
    for key, names, why in narrow:
        if given.get(key, names[0]) not in names:
            remedy = f"Write {' or '.join(names)}"
            if kind == "table":
                remedy += ', or give the gears with kind = "spur"'
            yield key, Problem(given.show(key), "", why, remedy)
    if narrow and "losses" in given:
        why = (
            f"{_NO_BODIES} that turn in oil" if kind == "table" else "They are those of spur gears"
        )
        yield "losses", Problem("[losses] is given", "", why, "Remove the table")
    for key in given.typed:
        if is_idle(key, kind) and key.split(".")[0] in ("gears", "stiffness"):
            yield key, _idle(given, key, kind)
    if kind == "table":
        yield from _mesh_table(given)
    yield from _structure_of(given, kind)


def _idle(given: Given, key: str, kind: str) -> Problem:
    if kind == "table":
        why = "A mesh table has the stiffness of the teeth, whatever their shape"
        return Problem(f"{given.show(key)} is not used", "", why, "Remove it")
    if kind == "hypoid":
        why = f"Flanks and compliance of a hypoid pair follow from: {', '.join(HYPOID_KEYS)}"
        return Problem(f"{given.show(key)} is not used", "", why, "Remove it")
    owner = "table" if key == "gears.table" else "hypoid"
    why = f'It belongs to kind = "{owner}"'
    return Problem(given.show(key), "", why, "Remove it, or change the kind")


def _structure_of(given: Given, kind: Any) -> Found:
    """A structure for gears in a plane takes none whose axes cross, and the other way round."""
    from tribodyn.dynamics import STRUCTURES

    key = "dynamics.model"
    model = given.get(key, "spur-6dof")
    if not isinstance(model, str) or model not in list(STRUCTURES):
        return
    takes = STRUCTURES[model].gears
    if takes and kind in ("spur", "hypoid") and kind not in takes:
        others = [each for each in STRUCTURES if kind in (STRUCTURES[each].gears or (kind,))]
        why = f"That structure takes gears of the kind {' or '.join(takes)}"
        remedy = f"Choose in [dynamics] one of {', '.join(others)}"
        yield key, Problem(f'model = "{model}" for {kind} gears', "", why, remedy)


def _mesh_table(given: Given) -> Found:
    """What a mesh table of another program needs."""
    if "gears.table" not in given:
        why, remedy = (
            'kind = "table" reads the mesh from a file',
            'Add table = "mesh.csv" to [gears]',
        )
        yield "gears", Problem("table is missing", "", why, remedy)
    masses = ["moment_of_inertia"]
    if given.get("dynamics.model", "spur-6dof") != "torsional":
        masses.append("mass")
    for key in (f"gears.{gear}.{name}" for name in masses for gear in ("pinion", "wheel")):
        if key not in given:
            what = f"{key.rpartition('.')[2]} is missing"
            yield key, Problem(what, "", _NO_BODIES, f"Add it to [{key.rpartition('.')[0]}]")


def _face_width(given: Given) -> Found:
    if given.get("gears.kind", "spur") != "spur":
        return
    gears = ("gears.pinion", "gears.wheel")
    if all(gear in given and f"{gear}.face_width" not in given for gear in gears):
        what, why = "face_width is missing", "At least one gear needs its face width"
        yield "gears.pinion", Problem(what, "", why, 'Add face_width = "20 mm" to [gears.pinion]')


def _size(given: Given) -> Found:
    pinion, wheel = (given.get(f"gears.{gear}.teeth") for gear in ("pinion", "wheel"))
    if type(pinion) is int and type(wheel) is int and pinion > wheel:
        what = f"teeth = {pinion} of the pinion and teeth = {wheel} of the wheel"
        why = "The pinion is the smaller gear, whichever drives"
        remedy = "Exchange the two tables, speed_of and driver"
        yield "gears.pinion.teeth", Problem(what, "", why, remedy)


def _needs(given: Given, law: FrictionLaw | None) -> Found:
    """What the friction law and the film model need to know."""
    film = given.get("film.model", "none")
    tribological = law is not None and law.needs_oil
    users = [f'law = "{law.name}"'] if law is not None and law.needs_oil else []
    users += [f'film model = "{film}"'] if film != "none" else []
    if users and "lubricant" not in given:
        why = f"{users[0]} needs an oil"
        remedy = 'Add [lubricant] with for example name = "80W"'
        yield "lubricant", Problem("the table [lubricant] is missing", "", why, remedy)
    rough = ("composite_roughness", *(f"pinion.{height}" for height in _HEIGHTS))
    if (
        tribological
        and not (law is not None and law.needs_film)
        and not any(f"gears.{name}" in given for name in rough)
    ):
        why = f"{users[0]} needs it"
        remedy = 'Add composite_roughness = "0.5 um" to [gears], or roughness_ra to both gears'
        what = "composite_roughness is missing"
        yield "gears.composite_roughness", Problem(what, "", why, remedy)


def _film_of_friction(given: Given, law: FrictionLaw | None, film: FilmModel | None) -> Found:
    """What a law that shears the solved film needs besides an oil."""
    if law is None or film is None or not law.needs_film:
        return
    if given.get("gears.kind") == "hypoid":
        why, remedy = "The film of a hypoid pair is that of a formula", 'Choose law = "mixed-ehl"'
        yield "friction.law", Problem(f'law = "{law.name}" for a hypoid pair', "", why, remedy)
        return
    if not film.method:
        what = f'law = "{law.name}" and film model = "{film.name}"'
        why = "That law shears the solved film, and this model gives no pressure"
        yield "friction.law", Problem(what, "", why, 'Set model = "newton" in [film]')
    heated = [key for key in _HEAT if given.get(f"friction.{key}")]
    if heated and "lubricant.dynamic_viscosity" in given:
        for name in THERMAL:
            if f"lubricant.{name}" not in given:
                remedy = f"Add {name}, or set {heated[0]} = false in [friction]"
                why = f"{heated[0]} = true needs it"
                yield f"lubricant.{name}", Problem(f"{name} is missing", "", why, remedy)


def _shear(given: Given, law: FrictionLaw | None) -> Found:
    """Numbers of another shear model than the one that is named."""
    if law is None or "shear_model" not in law.options:
        return
    from tribodyn.ehl import SHEAR_MODELS

    models = SHEAR_MODELS.all()
    name = given.get("friction.shear_model", law.options["shear_model"])
    for key in ("carreau_stress", "carreau_exponent", "yasuda_exponent"):
        if f"friction.{key}" in given and key not in models[name].options:
            first = next(other for other in models if key in models[other].options)
            what = f'{given.show(f"friction.{key}")} does not belong to shear_model = "{name}"'
            why = "It is a number of another one"
            remedy = f'Remove it, or write shear_model = "{first}"'
            yield f"friction.{key}", Problem(what, "", why, remedy)


def _dampings(given: Given) -> Found:
    for name in ("mesh_damping", "bearing_damping"):
        value, ratio = f"dynamics.{name}", f"dynamics.{name}_ratio"
        if value in given and ratio in given:
            yield both_given(given, value, ratio)


def _friction_load(given: Given) -> Found:
    key = "dynamics.friction_load"
    if given.get(key) == "dynamic" and given.get("friction.law") == "none":
        what = f"{given.show(key)} without friction"
        why = 'friction.law = "none": nothing follows the load'
        yield key, Problem(what, "", why, "Choose a friction law, or leave the key out")


def _solver(given: Given) -> Found:
    if "solver.cycles" in given and given.get("solver.method", "steady") == "steady":
        what = f'{given.show("solver.cycles")} does not belong to method = "steady"'
        why = "A steady state is found directly, without counting cycles"
        yield "solver.cycles", Problem(what, "", why, 'Remove it, or choose "transient"')


#: Kinds of gears whose load, film and friction are not found together.
_UNCOUPLED = {
    "table": ("table", "The teeth of another program have no film here"),
    "hypoid": ("hypoid", "Its films belong to the load at rest"),
}


def _coupling(given: Given) -> Found:
    key = "solver.coupling"
    kind = given.get(key, "none")
    if kind == "none":
        return
    clashes = {
        "gears.kind": _UNCOUPLED.get(str(given.get("gears.kind")), ("table", "")),
        "dynamics.friction_load": ("dynamic", "The coupling already lets friction follow the load"),
    }
    if kind == "dynamic":
        clashes["solver.method"] = ("transient", "It asks for the load of the steady motion")
    for other, (value, why) in clashes.items():
        if given.get(other) == value:
            what = f"{given.show(key)} and {given.show(other)}"
            yield key, Problem(what, "", why, "Leave one of them out")


def _assumed(given: Given, faulty: set[str]) -> Found:
    marks = given.get("assumed", {})
    for key, reason in marks.items() if isinstance(marks, Mapping) else ():
        absent = key not in given or isinstance(given.get(key), Mapping)
        recorded = isinstance(reason, Mapping) and "value" in reason
        if absent and reason != DEFAULT_MARK and not recorded:
            known = [k for k in given.typed if k not in faulty and k.split(".")[0] not in _ABOUT]
            near = difflib.get_close_matches(key, known, n=1)
            why = "[assumed] marks values that this case gives"
            remedy = f'Did you mean "{near[0]}"?' if near else f"Give {key}, or remove the mark"
            yield f"assumed.{key}", Problem(f'no value is given for "{key}"', "", why, remedy)


def left_behind(given: Given, changes: Mapping[str, Any], choices: Mapping[str, str]) -> set[str]:
    """Options of an earlier choice that a new model, law or method cannot take."""
    return {
        key
        for selector, name in choices.items()
        for key in _below(given, selector.partition(".")[0])
        if key not in changes and key != selector and not _takes(given, selector, name, key)
    }


def case_options(section: str, name: str) -> Mapping[str, Option]:
    """Options of a model by name that are keys of the case file."""
    table = section_at((section,))
    model = table.model_named(name) if table else None
    return model.case_options if model else {}


def _below(given: Given, table: str) -> list[str]:
    """Dotted keys of all values of a table."""
    return [key for key in given.typed if key.startswith(f"{table}.")]


def _takes(given: Given, selector: str, name: str, key: str) -> bool:
    section, _, option = key.rpartition(".")
    if key == "film.stiffness":
        return given.get(key) in _film_stiffnesses(name)
    if selector == "solver.method":
        return name != "steady" or option != "cycles"
    known = choices({selector: name})[section].known
    return option not in known.owners or option in case_options(section, name)


def _model_problems(given: Given, section: str, choice: Choice, faulty: set[str]) -> Found:
    """Check the options of the model that a table names."""
    selector, model = choice.selector, choice.model
    if model is None or f"{section}.{selector}" in faulty:
        return
    yield from _foreign(given, section, selector, model, choice.known)
    if section == "film":
        yield from _film(given, cast("FilmModel", model), faulty)
    if section == "stiffness" and model.name in _STIFFNESS_CHECKS:
        yield from _STIFFNESS_CHECKS[model.name](given)
    for name, option in model.declared.items():
        key = f"{section}.{name}"
        if option.default is REQUIRED and key not in given:
            yield key, _lacking(section, selector, model, name, option)


def _lacking(section: str, selector: str, model: Model, name: str, option: Option) -> Problem:
    if name == "bearing_stiffness":
        what, why = f"{name} is missing", f'model = "{model.name}" supports each gear'
        remedy = f'Add {name} = {option.example} to [dynamics], or choose "torsional"'
        return Problem(what, "", why, remedy)
    what = f'{name} is missing for {selector} = "{model.name}"'
    remedy = f"Add {name} to [{section}], for example {name} = {option.example or 1.0}"
    return Problem(what, "", "It has no default", remedy)


def _foreign(given: Given, section: str, selector: str, model: Model, all_known: Known) -> Found:
    """Options given that the chosen model does not have."""
    known, owners = model.case_options, all_known.owners
    listing = f"Its options are: {', '.join(known)}" if known else "It has no options"
    for key in _below(given, section):
        option = key.rpartition(".")[2]
        if option not in known and option in owners:
            what = f'{given.show(key)} does not belong to {selector} = "{model.name}"'
            first = owners[option][0]
            why = all_known.models[first].case_options[option].absent
            other = f'"{first}"' if why else f"another {selector}"
            yield key, Problem(what, "", why or listing, f"Remove it, or choose {other}")


def _film_stiffnesses(name: str) -> tuple[str, ...]:
    from tribodyn.ehl import FILM_MODELS

    return FILM_MODELS[name].stiffness_kinds


def _film(given: Given, model: FilmModel, faulty: set[str]) -> Found:
    """Check the options of the film model."""
    key, name = "film.stiffness", model.name
    if key in given and given[key] not in model.stiffness_kinds:
        why = model.why_not(given[key])
        remedy = 'Choose one of these, or model = "newton", which has all'
        what = f'{given.show(key)} does not belong to model = "{name}"'
        yield key, Problem(what, "", why, remedy)
    if "nodes" in model.case_options and not faulty & {"film.nodes", "film.domain"}:
        yield from _grid(given)


def _grid(given: Given) -> Found:
    """Check what nodes, inlet and domain of a solved contact say together."""
    nodes = given.get("film.nodes", 513)
    if nodes - 1 != 1 << (nodes - 1).bit_length() - 1:
        below = 1 << (nodes - 1).bit_length() - 1
        why = "Grids are halved: nodes are a power of two plus one"
        remedy = f"Write nodes = {below + 1} or nodes = {2 * below + 1}"
        yield "film.nodes", Problem(f"nodes = {nodes}", "", why, remedy)
    starved, key = given.get("film.inlet", "flooded") == "zero", "film.domain"
    if starved and key not in given:
        why = 'inlet = "zero" starves the contact from the beginning of a stated domain on'
        remedy = "Add domain = [-2.5, 1.5], in Hertzian half widths"
        yield key, Problem('domain is missing for inlet = "zero"', "", why, remedy)
    if key not in given:
        return
    if not starved:
        what = f'{given.show(key)} does not belong to inlet = "flooded"'
        why = "A flooded contact has the domain that its film demands"
        yield key, Problem(what, "", why, 'Remove it, or add inlet = "zero"')
    ends = given[key]
    if len(ends) != 2 or not (ends[0] <= -1.5 and ends[1] >= 1.1):
        why = "It is two numbers in Hertzian half widths: -1.5 or less, and 1.1 or more"
        yield key, Problem(given.show(key), "", why, "Write for example domain = [-2.5, 1.5]")


def _lacks(key: str, name: str, why: str, remedy: str) -> tuple[str, Problem]:
    return f"stiffness.{key}", Problem(f'{key} is missing for model = "{name}"', "", why, remedy)


def _rectangular(given: Given) -> Found:
    pair = "stiffness.pair_stiffness"
    zones = [f"stiffness.{name}" for name in _RECTANGULAR]
    present = [key for key in zones if key in given]
    if pair in given:
        yield from ((key, both_given(given, pair, key)[1]) for key in present)
    elif not present:
        why = "It needs pair_stiffness, or both single_pair_stiffness and double_pair_stiffness"
        yield _lacks("pair_stiffness", "rectangular", why, 'Add pair_stiffness = "2e8 N/m"')
    elif len(present) == 1:
        absent = next(key for key in zones if key not in given).rpartition(".")[2]
        why = f"{given.show(present[0])} needs its counterpart"
        yield _lacks(absent, "rectangular", why, f'Add {absent} = "2e8 N/m"')


def _fourier(given: Given) -> Found:
    if "stiffness.mean_stiffness" not in given:
        why = "The harmonics vary about a mean"
        yield _lacks("mean_stiffness", "fourier", why, 'Add mean_stiffness = "2.5e8 N/m"')


def _table(given: Given) -> Found:
    forms = [f"stiffness.{name}" for name in _ABSCISSAE if f"stiffness.{name}" in given]
    if len(forms) == 2:
        yield both_given(given, *forms)
    if not forms:
        why = "The stiffness of the mesh needs phase, that of one pair needs roll_angle"
        yield _lacks("phase", "table", why, "Add phase = [...] or roll_angle = [...]")
    if "stiffness.values" not in given:
        why = "A table is two lists of equal length"
        yield _lacks("values", "table", why, 'Add values = ["2e8 N/m", ...]')
    values = given.get("stiffness.values")
    for form in forms:
        abscissa = given.get(form)
        if isinstance(values, list) and isinstance(abscissa, list) and len(values) != len(abscissa):
            short = form.rpartition(".")[2]
            what = f"{short} has {len(abscissa)} entries, values has {len(values)}"
            yield form, Problem(what, "", "A table is two lists of equal length", "Complete it")


_STIFFNESS_CHECKS = {"rectangular": _rectangular, "table": _table, "fourier": _fourier}


_CHECKS: tuple[Callable[[Given], Found], ...] = (
    _kind, _roughness, heat_of_bodies, _face_width, _size, lubricant_problems, _dampings,
    _friction_load, _solver, _coupling,
)  # fmt: skip


def cross_problems(
    given: Given, chosen: Mapping[str, Choice], faulty: set[str]
) -> list[tuple[str, Problem]]:
    """Check the keys of a case against each other."""
    law = cast("FrictionLaw | None", chosen["friction"].model)
    film = cast("FilmModel | None", chosen["film"].model)
    found = [problem for check in _CHECKS for problem in check(given)]
    found += [*_needs(given, law), *_film_of_friction(given, law, film), *_assumed(given, faulty)]
    if "friction.shear_model" not in faulty:
        found += _shear(given, law)
    for section, choice in chosen.items():
        found += _model_problems(given, section, choice, faulty)
    return [(key, problem) for key, problem in found if key not in faulty]
