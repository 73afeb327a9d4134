"""The papers behind the models of a case, as text and as BibTeX."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any

import tribodyn
from tribodyn.errors import InputError, Problem
from tribodyn.study.provenance import changed_keys

if TYPE_CHECKING:
    from tribodyn.study.case import Case


STYLES = ("text", "bibtex")

#: Section and chosen name -> papers; the empty name holds for every choice.
_BEHIND: dict[tuple[str, str], tuple[str, ...]] = {
    ("stiffness", "fe2d"): ("weber-banaschek", "conry-seireg"),
    ("stiffness", "analytic"): ("weber-banaschek", "conry-seireg"),
    ("stiffness", "weber"): ("weber-banaschek",),
    ("stiffness", "potential-energy"): ("sainsot", "weber-banaschek"),
    ("stiffness", "iso6336"): ("iso-6336-1",),
    ("stiffness", "rectangular"): ("kahraman-singh",),
    ("stiffness", "fourier"): ("kahraman-singh",),
    ("friction", "benedict-kelly"): ("benedict-kelley",),
    ("friction", "xu-2007"): ("xu",),
    ("friction", "ehl"): ("johnson-tevaarwerk", "conry-wang-cusano"),
    ("film", "newton"): ("dowson-higginson-book", "roelands", "saad-schultz"),
    ("film", "multigrid"): ("dowson-higginson-book", "roelands", "venner-lubrecht"),
    ("film", "dowson-higginson"): ("dowson", "dowson-toyoda"),
    ("film", "pan-hamrock"): ("pan-hamrock",),
    ("film", "moes"): ("moes",),
    ("dynamics", "spur-6dof"): ("he-gunda-singh",),
    ("dynamics", "torsional"): ("kahraman-singh",),
    ("solver", "steady"): ("anderson",),
}


#: Changed values that a citation names.
_NAMED = 12


@lru_cache(maxsize=1)
def _library() -> dict[str, dict[str, Any]]:
    import tomllib
    from importlib.resources import files

    text = files("tribodyn.study").joinpath("citations.toml").read_text(encoding="utf-8")
    return tomllib.loads(text)


def papers(case: Case) -> dict[str, dict[str, Any]]:
    """Papers behind the models that a case uses, each once."""
    chosen = {
        "stiffness": case.stiffness.model,
        "friction": case.friction.law,
        "film": case.film.model,
        "dynamics": case.dynamics.model,
        "solver": case.solver.method,
    }
    keys = ["iso-21771", "hertz"]
    for pair in chosen.items():
        keys += _BEHIND.get(pair, ())
    if case.friction.variant == "he-singh":
        keys.append("he-gunda-singh")
    own = {
        "type": "misc",
        "author": "The tribodyn developers",
        "title": f"tribodyn {tribodyn.__version__}: gear tribo-dynamics",
    }
    return (
        {"tribodyn": own}
        | _data_sources(case)
        | {key: _library()[key] for key in dict.fromkeys(keys)}
    )


def _data_sources(case: Case) -> dict[str, dict[str, Any]]:
    """Where the values of a case and those of its oil come from."""
    oil = case.lubricant_properties
    found = {}
    if case.origin:
        found["case"] = _origin(case)
    if oil is not None and oil.source:
        found["oil"] = {"type": "misc", "title": f"Oil {oil.name}: {oil.source}"}
    return found


def _origin(case: Case) -> dict[str, Any]:
    """The document behind the values of a case, and the values that differ from its own."""
    changed = changed_keys(case)
    if not changed:
        return {"type": "misc", "title": f"Values of the case: {case.origin}"}
    named = ", ".join(changed[:_NAMED])
    more = f" and {len(changed) - _NAMED} more" if len(changed) > _NAMED else ""
    plural = "s" if len(changed) > 1 else ""
    note = f"{len(changed)} value{plural} of the case differ{'' if plural else 's'}: {named}{more}"
    return {"type": "misc", "title": f"Based on: {case.origin}", "note": note}


def sources_of(section: str, name: str) -> list[str]:
    """Name the papers behind one choice.

    Parameters
    ----------
    section : str
        Table of the case file.
    name : str
        Model, law or method.

    Returns
    -------
    list of str
        One line for each paper.

    Examples
    --------
    >>> len(sources_of("friction", "xu-2007"))
    1
    """
    return [_text(_library()[key]) for key in _BEHIND.get((section, name), ())]


def _text(entry: dict[str, Any]) -> str:
    authors = entry.get("author", "").replace(" and ", ", ")
    year = f" ({entry['year']})" if "year" in entry else ""
    home = entry.get("journal") or entry.get("booktitle") or entry.get("publisher", "")
    volume = " ".join(entry[part] for part in ("volume",) if part in entry)
    home = " ".join(part for part in (home, volume) if part)
    pages = f", {entry['pages']}" if "pages" in entry else ""
    doi = f", doi:{entry['doi']}" if "doi" in entry else ""
    head = f"{authors}{year}: " if authors else ""
    note = f" {entry['note']}." if "note" in entry else ""
    return f"{head}{entry['title'].rstrip('.')}." + (f" {home}{pages}{doi}." if home else "") + note


def _bibtex(key: str, entry: dict[str, Any]) -> str:
    entry = {**entry, "note": entry["note"].replace("_", r"\_")} if "note" in entry else entry
    fields = [f"  {name} = {{{value}}}" for name, value in entry.items() if name != "type"]
    return f"@{entry['type']}{{{key},\n" + ",\n".join(fields) + "\n}"


def cite(case: Case, style: str = "text") -> str:
    """Write the papers behind a case."""
    found = papers(case)
    if style == "bibtex":
        return "\n\n".join(_bibtex(key, entry) for key, entry in found.items())
    if style == "text":
        return "\n".join(_text(entry) for entry in found.values())
    raise InputError(
        Problem(f'style = "{style}"', "argument style", f"Known: {', '.join(STYLES)}", "Choose one")
    )
