"""Names of summary figures in words: as the head of a row, and within a sentence."""

from __future__ import annotations

import re

from tribodyn.nomenclature import QUANTITIES

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
    "dynamic_factor_peak": "Dynamic factor, peak",
    "dynamic_factor_rms": "Dynamic factor, rms",
    "iso_mesh_stiffness": "Mesh stiffness of ISO 6336-1",
    "gear_body_share": "Share of the gear bodies in the deflection",
}
_START = re.compile(rf"^({'|'.join(_STATISTICS)})_")
#: End of a name, its words in a row and in a sentence.
_ENDINGS = (
    (re.compile(r"_nominal_friction$"), "friction of the nominal load", "{}"),
    (re.compile(r"_harmonic_(\d+)$"), "mesh harmonic {}", "in {}"),
    (re.compile(r"_(pinion|wheel|shaft[12])$"), "{}", "of the {}"),
    (re.compile(r"_teeth$"), "teeth alone", "of the {}"),
    (re.compile(r"(?:(?<=_error)|(?<=_stiffness))_film$"), "oil film", "of the {}"),
    (re.compile(r"_(loa)$"), "along the line of action", "{}"),
    (re.compile(r"_(oloa)$"), "across the line of action", "{}"),
    (re.compile(r"_([A-E])$"), "at {}", "{}"),
    (re.compile(r"_(pitch_point)$"), "at the pitch point", "{}"),
)


def _parts(name: str) -> tuple[str, str, list[tuple[str, str]]]:
    """Statistic, quantity and endings, each of these in both ways."""
    ends: list[tuple[str, str]] = []
    start = _START.match(name) if name not in QUANTITIES else None
    rest = name[start.end() :] if start else name
    for pattern, words, within in _ENDINGS:
        end = pattern.search(rest)
        if end:
            rest = rest[: end.start()]
            row = words.format(*end.groups())
            ends.insert(0, (row, within.format(row)))
    return _STATISTICS[start.group(1)] if start else "", rest.replace("_", " "), ends


def in_words(name: str) -> str:
    """Write the name of a summary figure in words, the quantity first."""
    if name in _WORDS:
        return _WORDS[name]
    statistic, rest, ends = _parts(name)
    said = [statistic, *(row for row, _ in ends)]
    return ", ".join([rest[:1].upper() + rest[1:], *filter(None, said)])


def in_a_sentence(name: str) -> str:
    """Write the name of a summary figure as it stands within a sentence, the statistic first."""
    if name in _WORDS:
        return _WORDS[name][:1].lower() + _WORDS[name][1:]
    statistic, rest, ends = _parts(name)
    return " ".join(filter(None, [statistic, rest, *(within for _, within in ends)]))
