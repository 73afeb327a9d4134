"""Labels of summary figures: as the head of a row, and within a sentence."""

from __future__ import annotations

import re

from tribodyn.nomenclature import GEARS, QUANTITIES

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
