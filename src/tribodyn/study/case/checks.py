"""Checks across keys: contradictions, missing partners, and marks on keys that do not exist."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, cast

from tribodyn.errors import Problem, did_you_mean
from tribodyn.model import REQUIRED, Model, Option
from tribodyn.study.case.gears import (
    HYPOID_KEYS,
    heat_of_bodies,
    is_idle,
    ring_problems,
    size_problems,
)
from tribodyn.study.case.section import Choice, SectionKeys, section_at
from tribodyn.study.case.sections import AUTO, BALANCE, THERMAL, lubricant_problems
from tribodyn.study.case.user_input import CONFLICT_REASON, UserInput, conflicting_keys

if TYPE_CHECKING:
    from tribodyn.ehl import FilmModel
    from tribodyn.friction import FrictionLaw

#: The reason that marks a written value as the default of the library that wrote it.
DEFAULT_MARK = "default"

KeyedProblems = Iterator[tuple[str, Problem]]

#: Options of the friction law that need thermal properties of the oil.
_HEAT = ("inlet_heating", "flash_temperature")
#: Tables that annotate values of the other tables.
_METADATA = ("assumed", "based_on")
#: Abscissae of a stiffness table.
_ABSCISSAE = ("phase", "roll_angle")
_RECTANGULAR = ("single_pair_stiffness", "double_pair_stiffness")
#: Alternative keys for the roughness of a flank.
_HEIGHTS = ("roughness_rms", "roughness_ra")


def _roughness(inputs: UserInput) -> KeyedProblems:
    present: dict[str, str] = {}
    for gear in ("pinion", "wheel"):
        keys = [key for name in _HEIGHTS if (key := f"gears.{gear}.{name}") in inputs]
        if keys:
            present[gear] = keys[0]
        if len(keys) == 2:
            yield conflicting_keys(inputs, *keys)
    if "gears.composite_roughness" in inputs:
        for gear, key in present.items():
            what = (
                f"{inputs.show('gears.composite_roughness')} and {inputs.show(key)} "
                f"of the {gear} are both given"
            )
            yield (
                "gears.composite_roughness",
                Problem(what, "", CONFLICT_REASON, "Keep one of them"),
            )
    elif len(present) == 1:
        ((gear, key),) = present.items()
        absent = key.replace(*(("pinion", "wheel") if gear == "pinion" else ("wheel", "pinion")))
        what = f"{absent.split('.')[2]} of the {absent.split('.')[1]} is missing"
        why = f"{inputs.show(key)} of the {gear} needs its counterpart"
        yield absent, Problem(what, "", why, "Add it, or give composite_roughness in [gears]")


#: Kind of gears -> keys restricted to some of their names, these names, and the reason.
_TABLE_HAS = "A mesh table has its films and friction coefficients as columns"
_ALLOWED_NAMES: dict[str, tuple[tuple[str, tuple[str, ...], str], ...]] = {
    "table": (
        ("film.model", ("none",), _TABLE_HAS),
        ("friction.law", ("none", "constant"), _TABLE_HAS),
        ("dynamics.friction_load", ("nominal",), _TABLE_HAS),
    ),
    "hypoid": (("gears.driver", ("pinion",), "The pinion of a hypoid pair must be the driver"),),
}
_NO_BODIES = "A mesh table has no data of the gear bodies"


def _kind(inputs: UserInput) -> KeyedProblems:
    """Check keys against the kind of the gear pair."""
    kind = inputs.get("gears.kind", "spur")
    if not isinstance(kind, str):
        return  # reported where its names are checked
    restrictions = _ALLOWED_NAMES.get(kind, ())
    for key, names, why in restrictions:
        if inputs.get(key, names[0]) not in names:
            remedy = f"Write {' or '.join(names)}"
            if kind == "table":
                remedy += ', or give the gears with kind = "spur"'
            yield key, Problem(inputs.show(key), "", why, remedy)
    if kind == "table" and "losses" in inputs:
        why = f"{_NO_BODIES} that turn in oil"
        yield "losses", Problem("[losses] is given", "", why, "Remove the table")
    for key in inputs.typed:
        if is_idle(key, kind) and key.split(".")[0] in ("gears", "stiffness"):
            yield key, _unused_key(inputs, key, kind)
    if kind == "table":
        yield from _mesh_table(inputs)
    yield from _structure_of(inputs, kind)


def _unused_key(inputs: UserInput, key: str, kind: str) -> Problem:
    if kind == "table":
        why = "The stiffness of the teeth comes from the mesh table"
        return Problem(f"{inputs.show(key)} is not used", "", why, "Remove it")
    if kind == "hypoid":
        why = f"Flanks and compliance of a hypoid pair follow from: {', '.join(HYPOID_KEYS)}"
        return Problem(f"{inputs.show(key)} is not used", "", why, "Remove it")
    owner = "table" if key == "gears.table" else "hypoid"
    why = f'It belongs to kind = "{owner}"'
    return Problem(inputs.show(key), "", why, "Remove it, or change the kind")


def _structure_of(inputs: UserInput, kind: object) -> KeyedProblems:
    """Check that the structure supports the kind of the gear pair."""
    from tribodyn.dynamics import STRUCTURES

    key = "dynamics.model"
    model = inputs.get(key, "spur-6dof")
    if not isinstance(model, str) or model not in list(STRUCTURES):
        return
    gear_kinds = STRUCTURES[model].gears
    if gear_kinds and kind in ("spur", "hypoid") and kind not in gear_kinds:
        others = [name for name in STRUCTURES if kind in (STRUCTURES[name].gears or (kind,))]
        why = f"That structure takes gears of the kind {' or '.join(gear_kinds)}"
        remedy = f"Choose in [dynamics] one of {', '.join(others)}"
        yield key, Problem(f'model = "{model}" for {kind} gears', "", why, remedy)


def _mesh_table(inputs: UserInput) -> KeyedProblems:
    """Check the keys that a mesh table of another program needs."""
    if "gears.table" not in inputs:
        why = 'kind = "table" reads the mesh from a file'
        remedy = 'Add table = "mesh.csv" to [gears]'
        yield "gears", Problem("table is missing", "", why, remedy)
    masses = ["moment_of_inertia"]
    if inputs.get("dynamics.model", "spur-6dof") != "torsional":
        masses.append("mass")
    for key in (f"gears.{gear}.{name}" for name in masses for gear in ("pinion", "wheel")):
        if key not in inputs:
            what = f"{key.rpartition('.')[2]} is missing"
            yield key, Problem(what, "", _NO_BODIES, f"Add it to [{key.rpartition('.')[0]}]")


def _face_width(inputs: UserInput) -> KeyedProblems:
    if inputs.get("gears.kind", "spur") != "spur":
        return
    gears = ("gears.pinion", "gears.wheel")
    if all(gear in inputs and f"{gear}.face_width" not in inputs for gear in gears):
        what, why = "face_width is missing", "At least one gear needs its face width"
        yield "gears.pinion", Problem(what, "", why, 'Add face_width = "20 mm" to [gears.pinion]')


def _lubrication_inputs(inputs: UserInput, law: FrictionLaw | None) -> KeyedProblems:
    """Check that the friction law and the film model have oil and roughness."""
    film = inputs.get("film.model", "none")
    tribological = law is not None and law.needs_oil
    users = [f'law = "{law.name}"'] if law is not None and law.needs_oil else []
    users += [f'film model = "{film}"'] if film != "none" else []
    if users and "lubricant" not in inputs:
        why = f"{users[0]} needs an oil"
        remedy = 'Add [lubricant] with for example name = "80W"'
        yield "lubricant", Problem("the table [lubricant] is missing", "", why, remedy)
    rough = ("composite_roughness", *(f"pinion.{height}" for height in _HEIGHTS))
    if (
        tribological
        and not (law is not None and law.needs_film)
        and not any(f"gears.{name}" in inputs for name in rough)
    ):
        why = f"{users[0]} needs it"
        remedy = 'Add composite_roughness = "0.5 um", or roughness_ra to both gears'
        what = "composite_roughness is missing"
        yield "gears.composite_roughness", Problem(what, "", why, remedy)


def _film_of_friction(
    inputs: UserInput, law: FrictionLaw | None, film: FilmModel | None
) -> KeyedProblems:
    """Check the film model and thermal properties for a law that shears the solved film."""
    if law is None or film is None or not law.needs_film:
        return
    if not film.method:
        what = f'law = "{law.name}" and film model = "{film.name}"'
        why = "The law needs the pressure of a solved film, which this model does not compute"
        yield "friction.law", Problem(what, "", why, 'Set model = "newton" in [film]')
    heated = [key for key in _HEAT if inputs.get(f"friction.{key}")]
    if heated and "lubricant.dynamic_viscosity" in inputs:
        for name in THERMAL:
            if f"lubricant.{name}" not in inputs:
                remedy = f"Add {name}, or set {heated[0]} = false in [friction]"
                why = f"{heated[0]} = true needs it"
                yield f"lubricant.{name}", Problem(f"{name} is missing", "", why, remedy)


def _heated_film(inputs: UserInput, film: FilmModel | None) -> KeyedProblems:
    """Check oil, gears and friction of a film that is solved with its heat."""
    if film is None or not film.heated:
        return
    why = f'film.model = "{film.name}" solves the temperatures of the film'
    if "lubricant.dynamic_viscosity" in inputs:
        for name in (*THERMAL, "temperature"):
            if f"lubricant.{name}" not in inputs:
                remedy = f'Add {name}, name an oil of the library, or set film.model = "newton"'
                yield f"lubricant.{name}", Problem(f"{name} is missing", "", why, remedy)
    for key in _HEAT:
        if inputs.get(f"friction.{key}"):
            what, remedy = f"{key} = true with a heated film", f"Set {key} = false"
            yield f"friction.{key}", Problem(what, "", f"{why}: heat would count twice", remedy)


def _shear(inputs: UserInput, law: FrictionLaw | None) -> KeyedProblems:
    """Find parameters of a shear model other than the selected model."""
    if law is None or "shear_model" not in law.options:
        return
    from tribodyn.ehl import SHEAR_MODELS

    models = SHEAR_MODELS.all()
    name = inputs.get("friction.shear_model", law.options["shear_model"])
    for key in ("carreau_stress", "carreau_exponent", "yasuda_exponent"):
        if f"friction.{key}" in inputs and key not in models[str(name)].options:
            owner = next(other for other in models if key in models[other].options)
            what = f'{inputs.show(f"friction.{key}")} does not belong to shear_model = "{name}"'
            why = "It is a parameter of another shear model"
            remedy = f'Remove it, or write shear_model = "{owner}"'
            yield f"friction.{key}", Problem(what, "", why, remedy)


def _dampings(inputs: UserInput) -> KeyedProblems:
    for name in ("mesh_damping", "bearing_damping"):
        value, ratio = f"dynamics.{name}", f"dynamics.{name}_ratio"
        if value in inputs and ratio in inputs:
            yield conflicting_keys(inputs, value, ratio)


def _friction_load(inputs: UserInput) -> KeyedProblems:
    key = "dynamics.friction_load"
    if inputs.get(key) == "dynamic" and inputs.get("friction.law") == "none":
        what = f"{inputs.show(key)} without friction"
        why = 'friction.law = "none": there is no friction to follow the load'
        yield key, Problem(what, "", why, "Choose a friction law, or leave the key out")


def _solver(inputs: UserInput) -> KeyedProblems:
    if "solver.cycles" in inputs and inputs.get("solver.method", "steady") == "steady":
        what = f'{inputs.show("solver.cycles")} does not belong to method = "steady"'
        why = "A steady state is computed directly, not over a number of cycles"
        yield "solver.cycles", Problem(what, "", why, 'Remove it, or choose "transient"')
    if inputs.get("solver.engine") == BALANCE and inputs.get("solver.method") == "transient":
        what = " and ".join(inputs.show(f"solver.{name}") for name in ("engine", "method"))
        why = "Harmonic balance finds periodic motions only"
        yield "solver.engine", Problem(what, "", why, f'Choose engine = "{AUTO}" or another one')


#: Kinds of gears for which load, film and friction are not coupled.
_UNCOUPLED = {
    "table": ("table", "A mesh table of another program has no film model"),
}


def _coupling(inputs: UserInput) -> KeyedProblems:
    key = "solver.coupling"
    kind = inputs.get(key, "none")
    if kind == "none":
        return
    clashes = {
        "gears.kind": _UNCOUPLED.get(str(inputs.get("gears.kind")), ("table", "")),
        "dynamics.friction_load": (
            "dynamic",
            "The coupling already makes friction follow the load",
        ),
    }
    if kind == "dynamic":
        clashes["solver.method"] = ("transient", "The coupling needs the load of the steady motion")
    for other, (value, why) in clashes.items():
        if inputs.get(other) == value:
            what = f"{inputs.show(key)} and {inputs.show(other)}"
            yield key, Problem(what, "", why, "Leave one of them out")


def _assumed(inputs: UserInput, faulty: set[str]) -> KeyedProblems:
    marks = inputs.get("assumed", {})
    for key, reason in marks.items() if isinstance(marks, Mapping) else ():
        absent = key not in inputs or isinstance(inputs.get(key), Mapping)
        recorded = isinstance(reason, Mapping) and "value" in reason
        if absent and reason != DEFAULT_MARK and not recorded:
            candidates = [
                k for k in inputs.typed if k not in faulty and k.split(".")[0] not in _METADATA
            ]
            why = "[assumed] may mark only values that this case gives"
            remedy = did_you_mean(key, candidates, f"Give {key}, or remove the mark")
            yield f"assumed.{key}", Problem(f'no value is given for "{key}"', "", why, remedy)


def case_options(section: str, name: str) -> Mapping[str, Option]:
    """Return the options of a named model that are keys of the case file."""
    table = section_at((section,))
    model = table.model_named(name) if table else None
    return model.case_options if model else {}


def _keys_of_table(inputs: UserInput, table: str) -> list[str]:
    """Return the dotted keys of all values of a table."""
    return [key for key in inputs.typed if key.startswith(f"{table}.")]


def _model_problems(
    inputs: UserInput, section: str, choice: Choice, faulty: set[str]
) -> KeyedProblems:
    """Check the options of the model that a table names."""
    selector, model = choice.selector, choice.model
    if model is None or f"{section}.{selector}" in faulty:
        return
    yield from _foreign_options(inputs, section, selector, model, choice.keys)
    if section == "film":
        yield from _film(inputs, cast("FilmModel", model), faulty)
    if section == "stiffness" and model.name in _STIFFNESS_CHECKS:
        yield from _STIFFNESS_CHECKS[model.name](inputs)
    for name, option in model.declared.items():
        key = f"{section}.{name}"
        if option.default is REQUIRED and key not in inputs:
            yield key, _missing_option(section, selector, model, name, option)


def _missing_option(
    section: str, selector: str, model: Model, name: str, option: Option
) -> Problem:
    if name == "bearing_stiffness":
        what, why = f"{name} is missing", f'model = "{model.name}" supports each gear'
        remedy = f'Add {name} = {option.example} to [dynamics], or choose "torsional"'
        return Problem(what, "", why, remedy)
    what = f'{name} is missing for {selector} = "{model.name}"'
    remedy = f"Add {name} to [{section}], for example {name} = {option.example or 1.0}"
    return Problem(what, "", "It has no default", remedy)


def _foreign_options(
    inputs: UserInput, section: str, selector: str, model: Model, keys: SectionKeys
) -> KeyedProblems:
    """Find options that the chosen model does not have."""
    options, owners = model.case_options, keys.owners
    listing = f"Its options are: {', '.join(options)}" if options else "It has no options"
    for key in _keys_of_table(inputs, section):
        option = key.rpartition(".")[2]
        if option not in options and option in owners:
            what = f'{inputs.show(key)} does not belong to {selector} = "{model.name}"'
            first = owners[option][0]
            why = keys.models[first].case_options[option].absent
            other = f'"{first}"' if why else f"another {selector}"
            yield key, Problem(what, "", why or listing, f"Remove it, or choose {other}")


def _film(inputs: UserInput, model: FilmModel, faulty: set[str]) -> KeyedProblems:
    """Check the options of the film model."""
    key, name = "film.stiffness", model.name
    if key in inputs and inputs[key] not in model.stiffness_kinds:
        why = model.why_not(inputs[key])
        remedy = 'Choose one of these, or model = "newton", which has all'
        what = f'{inputs.show(key)} does not belong to model = "{name}"'
        yield key, Problem(what, "", why, remedy)
    if "nodes" in model.case_options and not faulty & {"film.nodes", "film.domain"}:
        yield from _grid(inputs)


def _grid(inputs: UserInput) -> KeyedProblems:
    """Check nodes, inlet and domain of a solved contact against each other."""
    nodes = inputs.get("film.nodes", 513)
    if nodes - 1 != 1 << (nodes - 1).bit_length() - 1:
        below = 1 << (nodes - 1).bit_length() - 1
        why = "The grid is halved repeatedly: nodes must be a power of two plus one"
        remedy = f"Write nodes = {below + 1} or nodes = {2 * below + 1}"
        yield "film.nodes", Problem(f"nodes = {nodes}", "", why, remedy)
    starved, key = inputs.get("film.inlet", "flooded") == "zero", "film.domain"
    if starved and key not in inputs:
        why = 'inlet = "zero" starves the contact at the inlet of a domain that must be given'
        remedy = "Add domain = [-2.5, 1.5], in Hertzian half widths"
        yield key, Problem('domain is missing for inlet = "zero"', "", why, remedy)
    if key not in inputs:
        return
    if not starved:
        what = f'{inputs.show(key)} does not belong to inlet = "flooded"'
        why = "The domain of a flooded contact is chosen automatically"
        yield key, Problem(what, "", why, 'Remove it, or add inlet = "zero"')
    ends = inputs[key]
    if len(ends) != 2 or not (ends[0] <= -1.5 and ends[1] >= 1.1):
        why = "It is two numbers in Hertzian half widths: -1.5 or less, and 1.1 or more"
        yield key, Problem(inputs.show(key), "", why, "Write for example domain = [-2.5, 1.5]")


def _missing_key(key: str, name: str, why: str, remedy: str) -> tuple[str, Problem]:
    return f"stiffness.{key}", Problem(f'{key} is missing for model = "{name}"', "", why, remedy)


def _rectangular(inputs: UserInput) -> KeyedProblems:
    pair = "stiffness.pair_stiffness"
    zones = [f"stiffness.{name}" for name in _RECTANGULAR]
    present = [key for key in zones if key in inputs]
    if pair in inputs:
        yield from ((key, conflicting_keys(inputs, pair, key)[1]) for key in present)
    elif not present:
        why = "It needs pair_stiffness, or both single_pair_stiffness and double_pair_stiffness"
        yield _missing_key("pair_stiffness", "rectangular", why, 'Add pair_stiffness = "2e8 N/m"')
    elif len(present) == 1:
        absent = next(key for key in zones if key not in inputs).rpartition(".")[2]
        why = f"{inputs.show(present[0])} needs its counterpart"
        yield _missing_key(absent, "rectangular", why, f'Add {absent} = "2e8 N/m"')


def _fourier(inputs: UserInput) -> KeyedProblems:
    if "stiffness.mean_stiffness" not in inputs:
        why = "The harmonics vary about a mean"
        yield _missing_key("mean_stiffness", "fourier", why, 'Add mean_stiffness = "2.5e8 N/m"')


def _table(inputs: UserInput) -> KeyedProblems:
    forms = [f"stiffness.{name}" for name in _ABSCISSAE if f"stiffness.{name}" in inputs]
    if len(forms) == 2:
        yield conflicting_keys(inputs, *forms)
    if not forms:
        why = "The stiffness of the mesh needs phase, that of one pair needs roll_angle"
        yield _missing_key("phase", "table", why, "Add phase = [...] or roll_angle = [...]")
    if "stiffness.values" not in inputs:
        why = "A table is two lists of equal length"
        yield _missing_key("values", "table", why, 'Add values = ["2e8 N/m", ...]')
    values = inputs.get("stiffness.values")
    for form in forms:
        abscissa = inputs.get(form)
        if isinstance(values, list) and isinstance(abscissa, list) and len(values) != len(abscissa):
            short = form.rpartition(".")[2]
            what = f"{short} has {len(abscissa)} entries, values has {len(values)}"
            yield form, Problem(what, "", "A table is two lists of equal length", "Complete it")


_STIFFNESS_CHECKS = {"rectangular": _rectangular, "table": _table, "fourier": _fourier}


_CHECKS: tuple[Callable[[UserInput], KeyedProblems], ...] = (
    _kind, _roughness, heat_of_bodies, _face_width, size_problems, ring_problems,
    lubricant_problems, _dampings, _friction_load, _solver, _coupling,
)  # fmt: skip


def cross_problems(
    inputs: UserInput, chosen: Mapping[str, Choice], faulty: set[str]
) -> list[tuple[str, Problem]]:
    """Check the keys of a case against each other."""
    law = cast("FrictionLaw | None", chosen["friction"].model)
    film = cast("FilmModel | None", chosen["film"].model)
    problems = [problem for check in _CHECKS for problem in check(inputs)]
    problems += [
        *_lubrication_inputs(inputs, law),
        *_film_of_friction(inputs, law, film),
        *_heated_film(inputs, film),
        *_assumed(inputs, faulty),
    ]
    if "friction.shear_model" not in faulty:
        problems += _shear(inputs, law)
    for section, choice in chosen.items():
        problems += _model_problems(inputs, section, choice, faulty)
    return [(key, problem) for key, problem in problems if key not in faulty]
