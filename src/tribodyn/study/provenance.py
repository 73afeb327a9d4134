"""Which values the user gave, which are assumed, and which are defaults: nothing is hidden."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from tribodyn.study.checks import DEFAULT_MARK
from tribodyn.study.derived import BASIS, derived_values
from tribodyn.study.faults import section_at
from tribodyn.study.fields import Spec
from tribodyn.study.foundations import foundations
from tribodyn.study.options import model_options
from tribodyn.study.rig import RIG
from tribodyn.study.stated import same
from tribodyn.study.tooth_contact import mesh_law_of

if TYPE_CHECKING:
    from tribodyn.study.case import Case


_TRANSIENT_CYCLES = 50
#: Keys of a case that are words about it.
_WORDS = ("title", "origin")


@dataclass(frozen=True)
class Assumption:
    """A value that nobody stated, and why it is what it is."""

    key: str  #: dotted key of the case file
    value: str  #: value with unit
    kind: str  #: ``"assumed"`` by whoever wrote the case, or a ``"default"`` of tribodyn
    reason: str  #: why

    def __str__(self) -> str:
        """One line."""
        return f"{self.key} = {self.value} ({self.kind}): {self.reason}"


def spec_of(case: Case, key: str) -> Spec | None:
    """Return the Spec of a dotted key, or None if there is no such plain field."""
    *path, name = key.split(".")
    section = section_at(type(case), tuple(path))
    return section.spec(name) if section and name in section.model_fields else None


def _option_default(case: Case, key: str) -> Any:
    """Default of an option of the chosen film model, stiffness model or friction law."""
    section, _, name = key.rpartition(".")
    if key == "dynamics.mesh_law":
        return mesh_law_of(case)
    if section == "dynamics" and case.dynamics.model == "fzg-12dof":
        return RIG.get(name)
    chosen = {
        "film": case.film.model, "stiffness": case.stiffness.model, "friction": case.friction.law,
    }.get(section)  # fmt: skip
    default = model_options(section, chosen).get(name) if chosen else None
    if key == "stiffness.reference" and default == "bore":
        # A gear without a bore has no shaft seat to measure against.
        bores = (case.gears.pinion.bore_diameter, case.gears.wheel.bore_diameter)
        return "bore" if all(bores) else "rim"
    return default


def effective(case: Case) -> dict[str, Any]:
    """Return all values in force by dotted key, defaults of options and solver filled in."""
    values = {}
    for key, value in case.values():
        values[key] = _option_default(case, key) if value is None else value
    for name in ("mesh_damping", "bearing_damping"):
        if values[f"dynamics.{name}"] is not None:
            values[f"dynamics.{name}_ratio"] = None
    if case.dynamics.model == "torsional":
        values["dynamics.bearing_damping_ratio"] = None
    if case.solver.method == "transient" and values["solver.cycles"] is None:
        values["solver.cycles"] = _TRANSIENT_CYCLES
    return values


def default_of(case: Case, key: str) -> Any:
    """Value of a key where a case like this one does not give it; None if it is derived."""
    *path, name = key.split(".")
    section = section_at(type(case), tuple(path))
    field = section.model_fields.get(name) if section else None
    standard = None if field is None or field.is_required() else field.default
    standard = _option_default(case, key) if standard is None else standard
    return _TRANSIENT_CYCLES if key == "solver.cycles" and standard is None else standard


def changed_keys(case: Case) -> tuple[str, ...]:
    """Keys whose values differ from those that the case began with."""
    values, base = effective(case), case.stated.base
    if any(values.get(key) is None for key in base):
        derived = derived_values(case)
        values = {k: derived.get(k) if v is None else v for k, v in values.items()}
    new = {
        key: default_of(case, key)
        for key in values
        if key in case.given and key not in base and case.assumed.get(key) != DEFAULT_MARK
    }
    before = {**new, **base}
    return tuple(
        key
        for key in (*values, *(key for key in base if key not in values))
        if key in before and key not in _WORDS and not same(before[key], values.get(key))
    )


def _marked(case: Case, key: str, value: Any, changed: tuple[str, ...]) -> str:
    """Origin of a value with a mark in ``[assumed]``."""
    reason = case.assumed[key]
    if reason != DEFAULT_MARK:
        since = [other for other in changed if other in foundations(key)]
        told = f"; stated before {', '.join(since)} changed" if since else ""
        return f"assumed: {reason}{told}"
    standard = default_of(case, key)
    if same(standard, value):
        return DEFAULT_MARK
    spec = spec_of(case, key)
    now = spec.show(standard) if spec and standard is not None else "derived"
    return f"assumed: marked as default in the file, while this version has {now} for this case"


def provenance(case: Case) -> dict[str, str]:
    """Tell the origin of every value in force."""
    origins, changed = {}, changed_keys(case)
    for key, value in effective(case).items():
        if key in case.assumed:
            origins[key] = _marked(case, key, value, changed)
        elif key in case.given:
            origins[key] = "given"
        elif value is not None or key.rpartition(".")[2] in BASIS:
            origins[key] = DEFAULT_MARK
    return origins


def assumptions(case: Case) -> tuple[Assumption, ...]:
    """List everything that the user did not state: assumed values and defaults."""
    values, derived, rows = effective(case), derived_values(case), []
    for key, origin in provenance(case).items():
        kind, _, reason = origin.partition(": ")
        spec = spec_of(case, key)
        if kind == "given" or spec is None:
            continue
        name = key.rpartition(".")[2]
        if key in derived or (values[key] is None and name in BASIS):
            reason = f"derived from {BASIS[name]}"
        value = derived.get(key, values[key])
        shown = "automatic" if value is None else spec.show(value)
        rows.append(Assumption(key, shown, kind, reason or spec.meaning))
    return (*rows, *_oil_assumptions(case))


def _oil_assumptions(case: Case) -> list[Assumption]:
    """What the library assumes about the oil of a case."""
    oil = case.lubricant_properties
    if oil is None:
        return []
    return [Assumption("lubricant", oil.name, "assumed", reason) for reason in oil.assumptions]
