"""The figures of a summary in words: name, value in its display unit, value in SI, meaning."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from tribodyn.plot.theme.labels import display_unit, displayed, engineering, readable, significant
from tribodyn.study.pipeline.summary import SUMMARY, by_topic
from tribodyn.study.pipeline.words import in_words
from tribodyn.study.studies.modes import ORDERS, Mode, mode_rows
from tribodyn.units import convert

#: Summary figures shown on cards at the top, most wanted first.
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
    """One figure ready to be printed."""

    name: str  #: key in the summary
    words: str  #: the same in words
    shown: str
    unit: str
    si: str
    si_unit: str
    meaning: str  #: one line
    topic: str  #: heading of its rows


def describe(name: str, value: float, digits: int = 5) -> Number:
    """Put one figure of a summary into words."""
    figure = SUMMARY[name]
    shown = convert(float(value), figure.unit, figure.display_unit)
    return Number(
        name,
        in_words(name),
        *engineering(shown, readable(figure.display_unit), digits),
        f"{value:.6g}",
        readable(figure.unit),
        figure.meaning,
        figure.topic,
    )


def table(summary: Mapping[str, float]) -> list[Number]:
    """Put a whole summary into words, the rows of a topic together."""
    return [describe(n, summary[n]) for names in by_topic(summary).values() for n in names]


def headlines(summary: Mapping[str, float]) -> list[Number]:
    """Pick the figures that everybody asks for first."""
    return [describe(name, summary[name], digits=4) for name in HEADLINES if name in summary]


_ENDING = "_nominal_friction"


@dataclass(frozen=True)
class Compared:
    """One figure with friction in the loop and without."""

    own: Number
    nominal: Number
    change: str  #: change of the former from the latter, with its sign [%]


def compared_friction(summary: Mapping[str, float]) -> list[Compared]:
    """Put the comparison with nominal friction into words."""
    found = []
    for name, nominal in summary.items():
        own = name.removesuffix(_ENDING)
        if own != name and own in summary:
            found.append(
                Compared(
                    describe(own, summary[own]),
                    describe(name, nominal),
                    _change(float(summary[own]), float(nominal)),
                )
            )
    return found


def _change(own: float, nominal: float) -> str:
    """Write the relative change, or a dash where there is nothing to relate it to."""
    return f"{100.0 * (own - nominal) / abs(nominal):+.3f} %" if nominal else "–"


#: Head of the table, in reports and on the screen.
HEAD = (
    "Mode",
    f"Frequency [{display_unit('frequency')}]",
    "Damping [%]",
    "Moves",
    "Strained",
    *(f"{display_unit('speed')} at harmonic {order}" for order in ORDERS),
)


def cells(mode: Mode) -> list[str]:
    """One mode as it is printed."""
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
    """All elastic modes of a result."""
    rows = mode_rows(result.natural_modes, result.case, result.mesh.mesh_frequency)
    return [cells(row) for row in rows]
