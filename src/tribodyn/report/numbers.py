"""Summary figures for a report: label, value in display unit and in SI, meaning."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from tribodyn.plot.theme.labels import display_unit, displayed, engineering, readable, significant
from tribodyn.study.pipeline.summary_figures import by_topic, figure_of
from tribodyn.study.pipeline.summary_labels import in_words
from tribodyn.study.studies.modes import ORDERS, Mode, mode_rows
from tribodyn.units import convert

#: Summary figures on the cards at the top, in order of importance.
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


def table(summary: Mapping[str, float]) -> list[Number]:
    """Format all figures of a summary, grouped by topic."""
    return [describe(n, summary[n]) for names in by_topic(summary).values() for n in names]


def headlines(summary: Mapping[str, float]) -> list[Number]:
    """Format the headline figures that a summary has."""
    return [describe(name, summary[name], digits=4) for name in HEADLINES if name in summary]


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
    """Table rows of all elastic modes of a result."""
    rows = mode_rows(result.natural_modes, result.case, result.mesh.mesh_frequency)
    return [cells(row) for row in rows]
