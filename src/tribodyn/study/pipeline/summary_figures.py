"""Unit, meaning, topic and label of each figure of a summary, of a pair or of a machine's parts."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass, replace
from importlib.resources import files
from typing import Any

from tribodyn.aliases import warn_of_old_name
from tribodyn.errors import Argument, InputError
from tribodyn.machine.planetary.stage_parts import mesh_kinds
from tribodyn.model import Registry
from tribodyn.nomenclature import GEARS, QUANTITIES
from tribodyn.types import Tree
from tribodyn.units import format_quantity

#: Computes a figure in SI of a result, or of a load and the name of a part; None leaves it out.
Measure = Callable[..., float | None]


@dataclass(frozen=True)
class SummaryFigure:
    """One figure of a summary."""

    name: str  #: key in the summary
    unit: str
    display_unit: str
    meaning: str  #: one line
    topic: str = "Other"  #: heading in tables

    def show(self, value: float) -> str:
        """Write the value in the display unit with six digits."""
        if not self.unit:
            return f"{value:.6g}"
        number, _, unit = format_quantity(value, self.unit, self.display_unit).partition(" ")
        return f"{float(number):.6g} {unit}"


def summary_entry(name: str, quantity: str, *meaning_topic: str) -> SummaryFigure:
    """Figure with the unit of its quantity, a pure number where that is empty."""
    entry = QUANTITIES[quantity] if quantity else None
    unit, display_unit = (entry.unit, entry.display_unit) if entry else ("", "")
    return SummaryFigure(name, unit, display_unit, *meaning_topic)


_TABLE = tomllib.loads(
    files("tribodyn.study.pipeline").joinpath("summary.toml").read_text(encoding="utf-8")
)
#: Figures of each kind of part of a machine, and those of a pair that fit on a screen.
PARTS: dict[str, Tree] = _TABLE.pop("parts")
CHIEF: list[str] = _TABLE.pop("chief")
for _part in PARTS.values():
    _part.setdefault("of_pairs", [])
    _part["of_pairs"] += [n for topic in _part.get("of_pairs_by_topic", ()) for n in _TABLE[topic]]
#: All figures of :meth:`tribodyn.Result.summary` and ``tribodyn check`` by name.
SUMMARY: dict[str, SummaryFigure] = {
    name: summary_entry(name, quantity, meaning, topic)
    for topic, rows in _TABLE.items()
    for name, (quantity, meaning) in rows.items()
}
#: Figures of third parties, those of meshes as ``meshes.NAME``, also by entry points of the group.
MEASURES: Registry[Measure] = Registry("summary figure", "tribodyn.summary")


def summary_figure(
    name: str, *, meaning: str, of: str = "", part: str = ""
) -> Callable[[Measure], Measure]:
    """Decorate a function of a result to make it a figure of every summary.

    Parameters
    ----------
    name : str
        Key in the summary.
    meaning : str
        One line.
    of : str
        Its quantity in :data:`tribodyn.nomenclature.QUANTITIES`, which knows its unit; empty for a
        pure number.
    part : str
        Kind of the parts of a machine or a stage that have it: ``"machine"``, ``"meshes"``,
        ``"planets"``, ``"shafts"``, ``"bearings"`` or ``"housing"``; of pairs by default.

    Returns
    -------
    callable
        Decorator that returns the function unchanged. The function takes a
        :class:`tribodyn.Result`, for parts a :class:`tribodyn.study.LoadResult` and the name of the
        part, which the machine itself has not. It returns the figure in SI, or None where there is
        none.

    Raises
    ------
    InputError
        If there is no such kind of part, or the package has a figure of this name.

    Examples
    --------
    >>> @summary_figure("teeth_of_both", meaning="teeth of both gears")  # doctest: +SKIP
    ... def teeth(result):
    ...     return result.case.gears.pinion.teeth + result.case.gears.wheel.teeth
    """
    if part and part not in PARTS:
        why = f"Parts: {', '.join(PARTS)}"
        raise InputError(f'part = "{part}"', Argument("part"), why, "Choose one, or leave it out")
    key = f"{part}.{name}" if part else name
    figures: Tree = PARTS[part]["figures"] if part else SUMMARY
    of_package = name in figures or (part and name in PARTS[part]["of_pairs"])
    if of_package and key not in MEASURES.names():
        why = "A figure of the package keeps its meaning"
        raise InputError(f'"{key}" is a figure', Argument("name"), why, "Choose another name")

    def keep(measure: Measure) -> Measure:
        figures[name] = [of, meaning] if part else summary_entry(name, of, meaning)
        return MEASURES.register(key)(measure)

    return keep


#: Those by which load cases are compared.
_OF_LOADS = ("output_torque", "efficiency", "peak_mesh_force")


#: Figures of which the mean of all planets counts in the deprecated key of their kind of mesh.
_MEAN = ("static_mesh_force", "mean_mesh_force", "friction_power", "mesh_frequency")


class Figures(dict[str, float]):
    """Figures of a summary by key; deprecated keys are read, but are in no list or sum of all."""

    def __missing__(self, key: str) -> float:
        """Value of a deprecated key."""
        if not (keys := self._in_place_of(key)):
            raise KeyError(key)
        warn_of_old_name(f'summary()["{key}"]', " or ".join(f'summary()["{k}"]' for k in keys))
        values, name = [self[each] for each in keys], split_key(keys[0])[3]
        if name in _MEAN:
            return sum(values) / len(values)
        return min(values) if name.startswith("minimum") else max(values)

    def _in_place_of(self, key: object) -> list[str]:
        """Keys that replace a deprecated one; of a lone stage those of all its planets."""
        load, kind, part, name = split_key(str(key))
        name = PARTS[kind].get("deprecated", {}).get(name, name) if kind else name
        start = f"load_cases.{load}." if load else ""
        names, role = [part], mesh_kinds("meshed").get(part)
        meshes = {split_key(each)[2]: None for each in self if each.startswith(f"{start}meshes.")}
        if kind == "meshes" and role and len({each.rpartition("_")[0] for each in meshes}) == 1:
            names = [each for each in meshes if each.rstrip("0123456789").endswith(f"_{role}")]
        keys = [f"{start}{kind}.{each}.{name}" for each in names]
        return [each for each in keys if dict.__contains__(self, each) and each != key]

    def __contains__(self, key: object) -> bool:
        """Whether a key, also a deprecated one, has a value."""
        return super().__contains__(key) or bool(self._in_place_of(key))

    def get(self, key: str, default: Any = None) -> Any:
        """Value of a key, also of a deprecated one."""
        try:
            return self[key]
        except KeyError:
            return default


def is_chief(key: str) -> bool:
    """Whether a figure belongs to the summary that fits on a screen."""
    load, kind, _, name = split_key(key)
    chief = PARTS[kind]["chief"] if kind else CHIEF
    whole_key = f"{kind}.{name}" if kind else name
    return name in (_OF_LOADS if load else chief) or whole_key in MEASURES.names()


def figure_of(key: str) -> SummaryFigure:
    """Unit, meaning and topic of a key of a summary; a KeyError if there is no such figure."""
    if key in SUMMARY:
        return SUMMARY[key]
    load, kind, part, name = split_key(key)
    table = PARTS[kind]
    name = table.get("deprecated", {}).get(name, name)
    topic = (f"{load}: " if load else "") + table["topic"].format(part)
    if name in table["of_pairs"]:
        return replace(SUMMARY[name], name=key, topic=topic)
    return summary_entry(key, *table["figures"][name], topic)


def part_figures() -> dict[str, list[str]]:
    """Names of the figures of each kind of part."""
    return {kind: [*table["figures"], *table["of_pairs"]] for kind, table in PARTS.items()}


def is_figure(key: str) -> bool:
    """Whether a key is one of a summary."""
    try:
        return bool(figure_of(key))
    except KeyError:
        return False


def in_order(names: Iterable[str], first: Collection[str] = SUMMARY) -> list[str]:
    """Names of figures, each once, in the order of those of a pair; others as they come."""
    names = dict.fromkeys(names)
    return [name for name in first if name in names] + [n for n in names if n not in first]


def by_topic(names: Iterable[str]) -> dict[str, list[str]]:
    """Names of figures under their topics."""
    topics: dict[str, list[str]] = {}
    for name in in_order(names):
        topics.setdefault(figure_of(name).topic, []).append(name)
    return topics


def summary_rows(values: Mapping[str, float]) -> list[tuple[str, str, str, str]]:
    """Topic, name, value with unit and meaning of each figure, by topic."""
    return [
        (topic, name, figure_of(name).show(values[name]), figure_of(name).meaning)
        for topic, names in by_topic(values).items()
        for name in names
    ]


_STATISTICS = {
    "peak_to_peak": "peak to peak",
    "mean": "mean",
    "alternating_rms": "alternating rms",
    "rms": "rms",
    "peak": "peak",
    "maximum": "greatest",
    "minimum": "least",
}
#: Labels that do not follow from the parts of the name.
_LABELS = {
    "omega_max_dt": "omega_max dt",
    "minimum_film_over_path": "Minimum film over the path of contact",
    "line_of_action_indicator": "Bearing force across over along the line of action",
    "dynamic_factor_peak": "Dynamic factor, peak",
    "dynamic_factor_rms": "Dynamic factor, rms",
    "iso_mesh_stiffness": "Mesh stiffness of ISO 6336-1",
    "gear_body_share": "Share of the gear bodies in the deflection",
}
_START = re.compile(rf"^({'|'.join(_STATISTICS)})_")
#: End of a name, and its label in a row and in a sentence.
_ENDINGS = (
    (re.compile(r"_nominal_friction$"), "friction of the nominal load", "{}"),
    (re.compile(r"_harmonic_(\d+)$"), "mesh harmonic {}", "in {}"),
    (re.compile(rf"_({'|'.join(GEARS)}|shaft[12])$"), "{}", "of the {}"),
    (re.compile(r"_teeth$"), "teeth alone", "of the {}"),
    (re.compile(r"(?:(?<=_error)|(?<=_stiffness))_film$"), "oil film", "of the {}"),
    (re.compile(r"_(loa)$"), "along the line of action", "{}"),
    (re.compile(r"_(oloa)$"), "across the line of action", "{}"),
    (re.compile(r"_([A-E])$"), "at {}", "{}"),
    (re.compile(r"_(pitch_point)$"), "at the pitch point", "{}"),
)


#: A figure of a part of a machine: load case, kind of part, its name, figure.
_OF_PART = re.compile(
    r"(?:load_cases\.(.+?)\.)?(machine|meshes|planets|shafts|bearings|housing)\.(?:(.+)\.)?([^.]+)"
)
_KINDS = {
    "meshes": "mesh ",
    "planets": "stage ",
    "shafts": "shaft ",
    "bearings": "bearing ",
    "housing": "housing at ",
}


def split_key(name: str) -> tuple[str, str, str, str]:
    """Load case, kind of part, part and figure of a key; the first three are empty of a pair."""
    match = _OF_PART.fullmatch(name)
    if match is None:
        return "", "", "", name
    load, kind, part, figure = match.groups(default="")
    return load, kind, part, figure


def _split(name: str) -> tuple[str, list[str]]:
    """Name of a figure without its part, and the part and the load case in words."""
    load, kind, part, figure = split_key(name)
    where = [f"{_KINDS[kind]}{part}"] if part else []
    return figure, [*where, *([f"load case {load}"] if load else [])]


def _parts(name: str) -> tuple[str, str, list[tuple[str, str]]]:
    """Split a name into statistic, quantity and endings, each as in a row and in a sentence."""
    ends: list[tuple[str, str]] = []
    start = _START.match(name) if name not in QUANTITIES else None
    quantity = name[start.end() :] if start else name
    for pattern, row_form, within in _ENDINGS:
        end = pattern.search(quantity)
        if end:
            quantity = quantity[: end.start()]
            row = row_form.format(*end.groups())
            ends.insert(0, (row, within.format(row)))
    return _STATISTICS[start.group(1)] if start else "", quantity.replace("_", " "), ends


def in_words(name: str) -> str:
    """Return the label of a summary figure for a row, the quantity first."""
    name, where = _split(name)
    if name in _LABELS:
        return ", ".join([_LABELS[name], *where])
    statistic, quantity, ends = _parts(name)
    qualifiers = [statistic, *(row for row, _ in ends), *where]
    return ", ".join([quantity[:1].upper() + quantity[1:], *filter(None, qualifiers)])


def in_a_sentence(name: str) -> str:
    """Return the label of a summary figure within a sentence, the statistic first."""
    name, where = _split(name)
    if name in _LABELS:
        return " of ".join([_LABELS[name][:1].lower() + _LABELS[name][1:], *where])
    statistic, quantity, ends = _parts(name)
    text = " ".join(filter(None, [statistic, quantity, *(within for _, within in ends)]))
    return " of ".join([text, *where])
