"""Summary figures for a report: label, value in display unit and in SI, meaning."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from tribodyn.plot.theme.labels import display_unit, displayed, engineering, readable, significant
from tribodyn.study.machine.modes import MODES_HEAD, axial_notes, nearest_first
from tribodyn.study.machine.modes import mode_rows as part_rows
from tribodyn.study.pipeline.assembly import ORDERS
from tribodyn.study.pipeline.summary_figures import by_topic, figure_of, in_words, split_key
from tribodyn.study.studies.modes import Mode, mode_rows
from tribodyn.study.studies.needs import PAIRS, kind_of
from tribodyn.units import convert

#: Summary figures on the cards at the top, in order of importance; of parts those of each.
HEADLINES = (
    "pitch_line_velocity",
    "line_load",
    "maximum_hertz_pressure",
    "transverse_contact_ratio",
    "contact_ratio_under_load",
    "mesh_frequency",
    "mesh_natural_frequency",
    "resonance_speed",
    "dynamic_factor_peak",
    "peak_to_peak_static_transmission_error",
    "peak_to_peak_dynamic_transmission_error",
    "rms_bearing_force_loa_pinion",
    "contact_loss_share",
    "efficiency",
    "mean_friction_coefficient",
    "oil_viscosity",
    "minimum_film_ratio",
)
_HEADLINES_OF_PARTS = (
    "input_power",
    "efficiency",
    "load_factor",
    "mesh_frequency",
    "dynamic_factor_peak",
    "transmission_error_peak_to_peak",
    "static_transmission_error_peak_to_peak",
)
_MOST_CARDS = 12
#: Prefixes of units, and the part of the largest value of a row that is rounding.
_PREFIXES, _ROUNDING = {"": 1.0, "k": 1e3, "M": 1e6, "G": 1e9}, 1e-9


@dataclass(frozen=True)
class Number:
    """One summary figure, formatted for printing."""

    name: str  #: key in the summary
    label: str  #: name of the quantity
    value: str  #: in the display unit
    unit: str
    si: str
    si_unit: str
    meaning: str  #: one line
    topic: str  #: heading of its rows


def describe(name: str, value: float, digits: int = 5) -> Number:
    """Format a summary figure with label, units and meaning."""
    figure = figure_of(name)
    value_in_unit = convert(float(value), figure.unit, figure.display_unit)
    return Number(
        name,
        in_words(name),
        *engineering(value_in_unit, readable(figure.display_unit), digits),
        f"{value:.6g}",
        readable(figure.unit),
        figure.meaning,
        figure.topic,
    )


def headlines(summary: Mapping[str, float]) -> list[Number]:
    """Format the headline figures that a summary has; of equal planets one."""
    if all("." not in name for name in summary):
        return [describe(name, summary[name], digits=4) for name in HEADLINES if name in summary]
    keys: dict[tuple[str, object], str] = {}
    for figure in _HEADLINES_OF_PARTS:
        for key in summary:
            load, kind, _, name = split_key(key)
            if name == figure and not load and kind in ("machine", "meshes", "planets"):
                # The meshes of all planets have one frequency.
                shared = figure == "mesh_frequency"
                keys.setdefault((figure, summary[key] if shared else key), key)
    cards = [describe(key, summary[key], digits=4) for key in list(keys.values())[:_MOST_CARDS]]
    return [
        replace(card, label=in_words(split_key(card.name)[3]))
        if card.name.startswith("machine.")
        else card
        for card in cards
    ]


@dataclass(frozen=True)
class NumberRow:
    """A summary figure of all parts of one kind."""

    figure: Number  #: of the first part
    values: tuple[str, ...]  #: of each part, in the unit of the first


@dataclass(frozen=True)
class NumberTable:
    """Summary figures of one kind of part; of a pair all figures, without parts."""

    title: str
    parts: tuple[str, ...]
    rows: tuple[NumberRow, ...]
    load: str = ""  #: load case, in addition to the operating point

    def cells(self) -> tuple[list[str], list[list[str]]]:
        """Head and rows as text, with the unit after the values."""
        if not self.parts:
            head = ["Topic", "Quantity", "Value", "Meaning"]
            numbers = [row.figure for row in self.rows]
            return head, [
                [n.topic, n.label, f"{n.value} {n.unit}".strip(), n.meaning] for n in numbers
            ]
        rows = [[r.figure.label, *r.values, r.figure.unit, r.figure.meaning] for r in self.rows]
        return ["Quantity", *self.parts, "Unit", "Meaning"], rows


def number_tables(summary: Mapping[str, float]) -> list[NumberTable]:
    """Format all figures of a summary: one table for each kind of part under each load."""
    tables: dict[tuple[str, str], dict[str, dict[str, str]]] = {}
    for key in (name for names in by_topic(summary).values() for name in names):
        load, kind, part, figure = split_key(key)
        tables.setdefault((kind, load), {}).setdefault(figure, {})[part or kind] = key
    ordered = sorted(tables.items(), key=lambda each: each[0][1] != "")  # the operation first
    return [_number_table(*place, rows, summary) for place, rows in ordered]


def _number_table(
    kind: str, load: str, figures: Mapping[str, Mapping[str, str]], summary: Mapping[str, float]
) -> NumberTable:
    title = f"{kind[:1].upper()}{kind[1:]}{f', load case {load}' if load else ''}"
    parts = tuple(dict.fromkeys(part for keys in figures.values() for part in keys))
    rows = []
    for figure, keys in figures.items():
        largest = max(keys.values(), key=lambda key: abs(summary[key]))
        number = describe(largest, summary[largest])
        values = {part: _like(number, float(summary[key])) for part, key in keys.items()}
        label = in_words(figure) if title else number.label
        cells = tuple(values.get(part, "–") for part in parts)
        rows.append(NumberRow(replace(number, name=figure, label=label), cells))
    return NumberTable(title, parts if title else (), tuple(rows), load)


def _like(largest: Number, value: float) -> str:
    """A figure in the unit of the largest of its row; 0 where it is rounding against that."""
    if abs(value) <= _ROUNDING * abs(float(largest.si)):
        return "0"
    figure = figure_of(largest.name)
    prefix = largest.unit.removesuffix(readable(figure.display_unit))
    value_in_unit = convert(value, figure.unit, figure.display_unit) / _PREFIXES[prefix]
    text = significant(value_in_unit, 5)
    return text.rstrip("0").rstrip(".") if "." in text and "e" not in text else text


_ENDING = "_nominal_friction"


@dataclass(frozen=True)
class Compared:
    """One summary figure with coupled and with nominal friction."""

    coupled: Number  #: friction follows the dynamic load
    nominal: Number  #: friction of the nominal load
    change: str  #: change of the former from the latter, with its sign [%]


def compared_friction(summary: Mapping[str, float]) -> list[Compared]:
    """Format the figures that have a value with nominal friction."""
    comparisons = []
    for name, nominal in summary.items():
        coupled_name = name.removesuffix(_ENDING)
        if coupled_name != name and coupled_name in summary:
            comparisons.append(
                Compared(
                    describe(coupled_name, summary[coupled_name]),
                    describe(name, nominal),
                    _change(float(summary[coupled_name]), float(nominal)),
                )
            )
    return comparisons


def _change(coupled: float, nominal: float) -> str:
    """Format the relative change; a dash if the nominal value is zero."""
    return f"{100.0 * (coupled - nominal) / abs(nominal):+.3f} %" if nominal else "–"


#: Modes in the table of a report; the others are folded away.
MOST_MODES = 10
#: Head of the table of modes, in reports and in the terminal.
HEAD = (
    "Mode",
    f"Frequency [{display_unit('frequency')}]",
    "Damping [%]",
    "Moves",
    "Strained",
    *(f"{display_unit('speed')} at harmonic {order}" for order in ORDERS),
)


def cells(mode: Mode) -> list[str]:
    """Format a mode as a table row."""
    speeds = (significant(float(displayed("speed", speed)), 4) for speed in mode.speeds)
    damping = significant(100.0 * mode.damping_ratio, 3)
    return [
        str(mode.number),
        significant(mode.frequency, 4),
        damping,
        mode.moves,
        mode.strains,
        *speeds,
    ]


def modes_table(result: Any) -> list[list[str]]:
    """Table rows of all elastic modes of a result, those nearest to a mesh harmonic first."""
    mesh_frequency = result.mesh.mesh_frequency
    rows = mode_rows(result.natural_modes, result.case, mesh_frequency)
    harmonics = mesh_frequency * np.array(ORDERS)
    distances = [np.min(np.abs(harmonics / row.frequency - 1.0)) for row in rows]
    return [cells(row) for row in nearest_first(rows, distances)]


_OF_PAIR = (
    "Linearized about the static load with the mean mesh stiffness. For each mode: the moving "
    "bodies, the strained springs, and the speed of the {0} at which a mesh harmonic excites it."
)
_OF_PARTS = (
    "About the static load, at the speed of the case, with the mean stiffness of the meshes. For "
    "each mode: which parts move, and where its energy is."
)


class ModesTable(NamedTuple):
    """Natural modes of a result as a table, and how they were found."""

    head: tuple[str, ...]
    rows: list[list[str]]
    text: str


def modes_of(result: Any) -> ModesTable:
    """Natural modes of a result of any kind; without rows where there are none."""
    if kind_of(result.case) in PAIRS:
        rows = modes_table(result) if "natural_frequency_1" in result.summary() else []
        return ModesTable(HEAD, rows, _OF_PAIR.format(result.case.operation.speed_of))
    text = " ".join([_OF_PARTS, *axial_notes(result.modes)])
    return ModesTable(MODES_HEAD, part_rows(result.modes), text)
