"""Form of a case file as data, from the options of the models."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import Any, NamedTuple

from tribodyn.model import Option
from tribodyn.study.case.checks import DEFAULT_MARK
from tribodyn.study.case.gears import is_idle
from tribodyn.study.case.provenance import effective, provenance
from tribodyn.study.case.reference import choice_meanings, explanations, start_toml
from tribodyn.study.case.section import Section, Table, table_in
from tribodyn.study.machine.tables import SHARED
from tribodyn.study.pipeline.citations import sources_of
from tribodyn.types import ByName, Tree
from tribodyn.units import UnitProblemError, convert, split, usual_units

#: Typed text by key that is not part of the case yet.
Typed = Mapping[str, str]

#: Greek letters of symbols.
_GREEK = {
    "alpha": "α", "beta": "β", "gamma": "γ", "delta": "δ", "epsilon": "ε", "zeta": "ζ",
    "eta": "η", "theta": "θ", "lambda": "λ", "Lambda": "Λ", "mu": "µ", "nu": "ν", "rho": "ρ",
    "sigma": "σ", "tau": "τ", "phi": "φ", "omega": "ω", "Delta": "Δ",
}  # fmt: skip
_TITLES = {"dynamics": "Structure and motion", "operation": "Speed and load"}
#: Tables that are expanded at first.
_OPEN = ("gears", "lubricant", "operation")  # of a machine the last


def key_label(key: str) -> str:
    """Label of a key: its last part with spaces, capitalised."""
    text = key.rpartition(".")[2].replace("_", " ")
    return text[:1].upper() + text[1:]


def symbol(text: str) -> list[str]:
    """Letter and index of a symbol as printed."""
    head, _, index = text.partition("_")
    return [_GREEK.get(head, head), " ".join(_GREEK.get(p, p) for p in index.split("_"))]


@lru_cache(maxsize=1)
def essential() -> frozenset[str]:
    """Keys of the short case file to start from."""

    def walk(table: Mapping[str, object], prefix: str) -> Iterator[str]:
        for name, value in table.items():
            if isinstance(value, Mapping):
                yield from walk(value, f"{prefix}{name}.")
            else:
                yield f"{prefix}{name}"

    # The centre distance is not in the short file, but is essential as well.
    return frozenset({*walk(tomllib.loads(start_toml()), ""), "gears.center_distance"})


def field_of(
    key: str, option: Option, text: str = "", default: object = None, unit: str = ""
) -> Tree:
    """Data of one form field: ``text`` as typed, ``default`` in SI for an empty field."""
    units = usual_units(option.unit) if option.unit else []
    if option.display_unit and option.display_unit not in units:
        units.append(option.display_unit)
    chosen = unit or option.display_unit
    if option.kind == "number" and text:
        text, chosen = _parted(text, option, unit)
        units += [] if chosen in units or not option.unit else [chosen]
    return {
        "key": key,
        "label": key_label(key),
        "symbol": symbol(option.symbol) if option.symbol else [],
        "kind": "choice" if option.names or option.kind == "flag" else option.kind,
        "value": text,
        "unit": chosen if option.kind == "number" else "",
        "units": units if option.kind == "number" else [],
        "names": _names(option, default),
        "placeholder": _placeholder(option, default, chosen),
        "required": option.required,
        "help": _help(key, option),
    }


def _parted(text: str, option: Option, unit: str) -> tuple[str, str]:
    """Split a text into number and unit; return the full text if it is no quantity."""
    try:
        number, written = split(text)
        if not written or not option.unit:
            return text, unit or option.display_unit
        if unit and unit != written:
            value = convert(number, written, unit)
            return f"{value:.10g}", unit
    except UnitProblemError:
        return text, unit or option.display_unit
    return text[: len(text) - len(written)].strip(), written


def _names(option: Option, default: Any) -> list[list[str]]:
    """Values of a choice with their labels; the empty value is the default."""
    if option.kind == "flag":
        choices = {"true": "yes", "false": "no"}
        default_label = {None: "not given", True: "yes", False: "no"}[default]
    elif option.names is not None:
        choices = {name: name for name in option.names()}
        default_label = "not given" if default is None else str(default)
    else:
        return []
    first = (
        []
        if option.required
        else [["", f"{default_label} (default)" if default is not None else default_label]]
    )
    return [*first, *([name, text] for name, text in choices.items())]


def _placeholder(option: Option, default: object, unit: str) -> str:
    if option.required:
        return "needed"
    if isinstance(default, int | float) and not isinstance(default, bool) and option.unit:
        return f"{convert(float(default), option.unit, unit):.6g}"
    if default is not None:
        return option.show(default)
    return f"from {option.basis}" if option.basis else "not given"


def _help(key: str, option: Option) -> str:
    """Help text of a field: meaning, range with its origin, and equation."""
    equations = explanations()["equations"]
    limits = ""
    if option.names is None and option.kind in ("number", "numbers", "integer"):
        limits = f"Allowed: {option.allowed()}" + (f" ({option.origin})" if option.origin else "")
    basis = f"Where it is left empty: from {option.basis}" if option.basis else ""
    equation = equations.get(key, equations.get(key.rpartition(".")[2], ""))
    parts = (option.meaning[:1].upper() + option.meaning[1:], limits, basis, equation)
    return ". ".join(part for part in parts if part)


class _Place(NamedTuple):
    """A table of a case, with its values as typed."""

    key: str
    section: type[Section]
    data: ByName
    meaning: str

    @property
    def fields(self) -> Mapping[str, Option | Table]:
        """Its keys, without those of the model that it names."""
        return self.section.keys_for(self.data)

    def inside(self, name: str) -> str:
        """Dotted key of what is in it."""
        return f"{self.key}.{name}" if self.key else name


class CaseForm:
    """Form of a case by its tables, with typed text that is not part of the case yet."""

    def __init__(self, case: Any, typed: Typed, units: Mapping[str, str]) -> None:
        self.case, self.typed, self.units = case, typed, units
        self._effective, self._derived = effective(case), case._derived_values()
        self._origins, self._meanings = provenance(case), choice_meanings()
        pairs = () if case.lumped else case.mesh_pairs()
        #: Pair of gears whose models stand for those of all meshes.
        self._pair = case if case.lumped else next((pair for _, pair, _ in pairs), None)

    def groups(self) -> list[Tree]:
        """All tables with their fields: the essential ones first, the others collapsed."""
        root = _Place("", self.case.root, self.case.user_input.data, "")
        top = [self._group(root, []), *map(self._table_group, self._inside(root))]
        return [group for group in top if _is_filled(group)]

    def options(self) -> dict[str, Option]:
        """All options of the case by key."""
        places = [_Place("", self.case.root, self.case.user_input.data, "")]
        for place in places:
            places += self._inside(place)
        return {key: option for place in places for key, option in self._options(place)}

    def _inside(self, place: _Place) -> list[_Place]:
        """Tables in a table: those that may be given, and of a part those of models that are."""
        declared = place.section.fields
        return [
            _Place(key, field.kind, table_in(place.data, name), field.meaning)
            for name, field in place.fields.items()
            if isinstance(field, Table)
            and (name in declared or name in place.data)
            # tables of gears are filtered by key
            and ((key := place.inside(name)).startswith("gears") or not self._idle(key))
        ]

    def _idle(self, key: str) -> bool:
        """Whether a key has no effect in this case."""
        group, part, name = (*key.split(".", 2), "", "")[:3]
        if group == "gears" and not self.case.lumped:
            of_stage = self.case.lone_stage is not None or part in self.case.planet_names
            return of_stage and name in ("shaft", "position")
        if self._pair is None:
            return group in SHARED
        return is_idle(key, self._chosen("gears.kind"))

    def _chosen(self, key: str) -> Any:
        return self.typed.get(key) or self._effective.get(key) or self._of_pair(key)

    def _of_pair(self, key: str) -> Any:
        return None if self._pair is None else self._pair._effective.get(key)

    def _options(self, place: _Place) -> Iterator[tuple[str, Option]]:
        """Options of a table and of the model that it names."""
        options = {n: o for n, o in place.fields.items() if isinstance(o, Option)}
        if selector := place.section.selector:
            model = place.section.model_named(self._chosen(place.inside(selector)))
            options |= model.case_options if model is not None else {}
        for name, option in options.items():
            if option.kind != "list" and not self._idle(key := place.inside(name)):
                yield key, option

    def _table_group(self, place: _Place) -> Tree:
        """A table with the tables in it."""
        inner = map(self._table_group, self._inside(place))
        return self._group(place, [group for group in inner if _is_filled(group)])

    def _group(self, place: _Place, inner: list[Tree]) -> Tree:
        key, selector = place.key, place.section.selector
        fields = [(name, self._field(name, option)) for name, option in self._options(place)]
        chosen = f"{key}.{selector}" if selector else ""
        filled = [name for name, field in fields if field["value"]]
        first = {*essential(), *filled, chosen, *(n for n, f in fields if f["required"])}
        is_open = _OPEN if self.case.lumped else _OPEN[-1:]
        return {
            "key": key or "case",
            "title": _TITLES.get(key, key_label(key) if key else "Case"),
            "meaning": place.meaning,
            "note": str(self._chosen(chosen)) if chosen else "",
            "values": len({*filled} - {chosen}) + sum(group["values"] for group in inner),
            "open": key.partition(".")[0] in is_open
            and not key.endswith(("modification", "cutter")),
            "fields": [field for name, field in fields if name in first],
            "more": [field for name, field in fields if name not in first],
            "groups": inner,
        }

    def _field(self, key: str, option: Option) -> Tree:
        default = self._effective.get(key)
        default = self._derived.get(key, self._of_pair(key)) if default is None else default
        if default is None and not option.required:
            default = option.default
        unit = self.units.get(key, "")
        field = field_of(key, option, self._text(key, option), default, unit)
        if key in self.typed and option.kind == "number":
            field["value"], field["unit"] = self._as_typed(key, unit or field["unit"])
        if field["kind"] == "choice":
            field["help"] = ". ".join(filter(None, (field["help"], self._choice_help(key))))
        return field

    def _as_typed(self, key: str, unit: str) -> tuple[str, str]:
        """The typed text without its unit, and the chosen unit."""
        text = self.typed[key]
        return (text.removesuffix(unit).strip() if unit else text), unit

    def _text(self, key: str, option: Option) -> str:
        """Value as text: typed, or as the case file has it; empty where it has a default."""
        if key in self.typed:
            return self.typed[key]
        value = self.case.uncertain.get(key, self.case.user_input.get(key))
        if value is None or isinstance(value, Mapping) or self._origins.get(key) == DEFAULT_MARK:
            return ""
        if isinstance(value, bool):
            return str(value).lower()
        if isinstance(value, list | tuple):
            return ", ".join(str(item) for item in value)
        return f"{value:.12g} {option.unit}".strip() if isinstance(value, float) else str(value)

    def _choice_help(self, key: str) -> str:
        """Meaning and sources of the chosen name."""
        name = str(self._chosen(key))
        sources = sources_of(key.partition(".")[0], name)
        text = f"{name}: {self._meanings.get(name, '')}".rstrip(": ")
        return " ".join(filter(None, (text, *sources)))


def _is_filled(group: Mapping[str, object]) -> bool:
    """Whether a group shows anything."""
    return bool(group["fields"] or group["more"] or group["groups"])
