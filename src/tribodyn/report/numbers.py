"""The figures of a summary in words: name, value in its display unit, value in SI, meaning."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from tribodyn.plot.look.labels import engineering, readable
from tribodyn.study.pipeline.summary import SUMMARY, by_topic
from tribodyn.study.pipeline.words import in_words
from tribodyn.units import convert

#: Summary figures shown on cards at the top, most wanted first.
HEADLINES = (
    "pitch_line_velocity",
    "line_load",
    "maximum_hertz_pressure",
    "transverse_contact_ratio",
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
