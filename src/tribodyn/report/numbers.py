"""The figures of a summary in words: name, value in its display unit, value in SI, meaning."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

from tribodyn.nomenclature import QUANTITIES
from tribodyn.plot.look.labels import readable
from tribodyn.study.pipeline.summary import SUMMARY
from tribodyn.units import convert

#: Summary figures shown on cards at the top, most wanted first.
HEADLINES = (
    "transverse_contact_ratio",
    "mesh_frequency",
    "peak_mesh_force",
    "peak_to_peak_dynamic_transmission_error",
    "rms_acceleration_loa_pinion",
    "rms_bearing_force_loa_pinion",
    "mean_friction_coefficient",
    "contact_loss_share",
    "central_film_pitch_point",
    "minimum_film_over_path",
    "minimum_film_ratio",
    "oil_film_stiffness_pitch_point",
)

_STATISTICS = {
    "peak_to_peak": "peak to peak",
    "mean": "mean",
    "rms": "rms",
    "peak": "peak",
    "maximum": "greatest",
    "minimum": "least",
}
#: Names whose words do not follow from their parts.
_WORDS = {
    "omega_max_dt": "omega_max dt",
    "minimum_film_over_path": "Minimum film over the path of contact",
    "line_of_action_indicator": "Bearing force across over along the line of action",
}
_START = re.compile(rf"^({'|'.join(_STATISTICS)})_")
_ENDINGS = (
    (re.compile(r"_harmonic_(\d+)$"), "mesh harmonic {}"),
    (re.compile(r"_(pinion|wheel|shaft[12])$"), "{}"),
    (re.compile(r"_(loa)$"), "along the line of action"),
    (re.compile(r"_(oloa)$"), "across the line of action"),
    (re.compile(r"_([A-E])$"), "at {}"),
    (re.compile(r"_(pitch_point)$"), "at the pitch point"),
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


def in_words(name: str) -> str:
    """Write the name of a summary figure in words, the quantity first."""
    if name in _WORDS:
        return _WORDS[name]
    said: list[str] = []
    rest = name
    start = _START.match(rest) if rest not in QUANTITIES else None
    if start:
        rest = rest[start.end() :]
    for pattern, words in _ENDINGS:
        end = pattern.search(rest)
        if end:
            rest = rest[: end.start()]
            said.insert(0, words.format(end.group(1)))
    if start:
        said.insert(0, _STATISTICS[start.group(1)])
    rest = rest.replace("_", " ")
    return ", ".join([rest[:1].upper() + rest[1:], *said])


def describe(name: str, value: float, digits: int = 5) -> Number:
    """Put one figure of a summary into words."""
    figure = SUMMARY[name]
    return Number(
        name,
        in_words(name),
        f"{convert(float(value), figure.unit, figure.display_unit):.{digits}g}",
        readable(figure.display_unit),
        f"{value:.6g}",
        readable(figure.unit),
        figure.meaning,
    )


def table(summary: Mapping[str, float]) -> list[Number]:
    """Put a whole summary into words."""
    return [describe(name, value) for name, value in summary.items()]


def headlines(summary: Mapping[str, float]) -> list[Number]:
    """Pick the figures that everybody asks for first."""
    return [describe(name, summary[name], digits=4) for name in HEADLINES if name in summary]
