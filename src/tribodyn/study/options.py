"""Which options belong to the chosen film, stiffness and friction models, and their defaults."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from tribodyn.errors import Problem
from tribodyn.study.given import Given
from tribodyn.study.rig import RIG_KEYS

Found = Iterator[tuple[str, Problem]]

#: Abscissa of a stiffness table -> what its values are called by the model.
TABLE_FORMS = {"phase": "mesh_stiffness", "roll_angle": "pair_stiffness"}

_RECTANGULAR = ("single_pair_stiffness", "double_pair_stiffness")


def model_options(section: str, name: str) -> Mapping[str, Any]:
    """Options of a film model, stiffness model or friction law, with their defaults."""
    if section == "film":
        from tribodyn.ehl import FILM_MODELS

        return FILM_MODELS[name].options
    if section == "friction":
        from tribodyn.friction import LAWS

        return dict(LAWS[name].options)
    from tribodyn.stiffness import MODELS

    if name == "table":
        return {**dict.fromkeys(TABLE_FORMS), "values": None}
    return dict(MODELS[name].options)


def left_behind(given: Given, changes: Mapping[str, Any], choices: Mapping[str, str]) -> set[str]:
    """Options of an earlier choice that a new model, law or method cannot take."""
    return {
        key
        for selector, name in choices.items()
        for key in given.keys(selector.partition(".")[0])
        if key not in changes and key != selector and not _takes(given, selector, name, key)
    }


def foreign_dynamics(model: str) -> tuple[str, ...]:
    """Keys of ``[dynamics]`` that a structure does not take."""
    supports = ("bearing_stiffness", "bearing_damping", "bearing_damping_ratio")
    shafts = () if model == "fzg-12dof" else RIG_KEYS
    return (*supports, *shafts) if model == "torsional" else shafts


def _takes(given: Given, selector: str, name: str, key: str) -> bool:
    section, _, option = key.rpartition(".")
    if key == "film.stiffness":
        return given.value(key) in _film_stiffnesses(name)
    if selector == "dynamics.model":
        return option not in foreign_dynamics(name)
    if selector == "solver.method":
        return name != "steady" or option != "cycles"
    return option in model_options(section, name)


def _foreign(given: Given, section: str, selector: str, name: str) -> Found:
    """Options given that the chosen model does not have."""
    known = model_options(section, name)
    listing = f"Its options are: {', '.join(known)}" if known else "It has no options"
    for key in given.keys(section):
        option = key.rpartition(".")[2]
        if option != selector and option not in known:
            what = f'{given.show(key)} does not belong to {selector} = "{name}"'
            yield key, Problem(what, "", listing, f"Remove it, or choose another {selector}")


def _film_stiffnesses(name: str) -> tuple[str, ...]:
    from tribodyn.ehl import FILM_MODELS

    return FILM_MODELS[name].stiffness_kinds


def film_problems(given: Given, name: str, faulty: set[str]) -> Found:
    """Check the options of the film model."""
    yield from _foreign(given, "film", "model", name)
    key, kinds = "film.stiffness", _film_stiffnesses(name)
    if given.value(key, "none") not in kinds:
        why = f"It has: {', '.join(kinds)}"
        remedy = 'Choose one of these, or model = "newton", which has all'
        what = f'{given.show(key)} does not belong to model = "{name}"'
        yield key, Problem(what, "", why, remedy)
    if "nodes" in model_options("film", name) and not faulty & {"film.nodes", "film.domain"}:
        yield from _grid(given)


def _grid(given: Given) -> Found:
    """Check what nodes, inlet and domain of a solved contact say together."""
    nodes = given.value("film.nodes", 513)
    if nodes - 1 != 1 << (nodes - 1).bit_length() - 1:
        below = 1 << (nodes - 1).bit_length() - 1
        why = "Grids are halved: nodes are a power of two plus one"
        remedy = f"Write nodes = {below + 1} or nodes = {2 * below + 1}"
        yield "film.nodes", Problem(f"nodes = {nodes}", "", why, remedy)
    starved, key = given.value("film.inlet", "flooded") == "zero", "film.domain"
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
    ends = given.value(key)
    if len(ends) != 2 or not (ends[0] <= -1.5 and ends[1] >= 1.1):
        why = "It is two numbers in Hertzian half widths: -1.5 or less, and 1.1 or more"
        yield key, Problem(given.show(key), "", why, "Write for example domain = [-2.5, 1.5]")


def _both(given: Given, one: str, other: str) -> Problem:
    return Problem(
        f"{given.show(one)} and {given.show(other)} are both given", "",
        "They are two ways of saying the same thing", "Keep one of them",
    )  # fmt: skip


def stiffness_problems(given: Given, name: str) -> Found:
    """Check the options of the stiffness model."""
    yield from _foreign(given, "stiffness", "model", name)
    checks = {"rectangular": _rectangular, "table": _table, "fourier": _fourier}
    if name in checks:
        yield from checks[name](given)


def _lacks(key: str, name: str, why: str, remedy: str) -> tuple[str, Problem]:
    return f"stiffness.{key}", Problem(f'{key} is missing for model = "{name}"', "", why, remedy)


def _rectangular(given: Given) -> Found:
    pair = "stiffness.pair_stiffness"
    zones = [f"stiffness.{name}" for name in _RECTANGULAR]
    present = [key for key in zones if key in given]
    if pair in given:
        yield from ((key, _both(given, pair, key)) for key in present)
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
    forms = [f"stiffness.{name}" for name in TABLE_FORMS if f"stiffness.{name}" in given]
    if len(forms) == 2:
        yield forms[0], _both(given, *forms)
    if not forms:
        why = "The stiffness of the mesh needs phase, that of one pair needs roll_angle"
        yield _lacks("phase", "table", why, "Add phase = [...] or roll_angle = [...]")
    if "stiffness.values" not in given:
        why = "A table is two lists of equal length"
        yield _lacks("values", "table", why, 'Add values = ["2e8 N/m", ...]')
    values = given.value("stiffness.values")
    for form in forms:
        abscissa = given.value(form)
        if isinstance(values, list) and isinstance(abscissa, list) and len(values) != len(abscissa):
            short = form.rpartition(".")[2]
            what = f"{short} has {len(abscissa)} entries, values has {len(values)}"
            yield form, Problem(what, "", "A table is two lists of equal length", "Complete it")


def friction_problems(given: Given, name: str) -> Found:
    """Check the options of the friction law."""
    yield from _foreign(given, "friction", "law", name)
    for option, default in model_options("friction", name).items():
        if default is None and f"friction.{option}" not in given:
            what = f'{option} is missing for law = "{name}"'
            remedy = f"Add {option} to [friction], for example {option} = 0.05"
            yield f"friction.{option}", Problem(what, "", "It has no default", remedy)
