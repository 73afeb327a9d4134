"""References of the models of a case, as text and as BibTeX."""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import tribodyn
from tribodyn.errors import InputError
from tribodyn.model import Model
from tribodyn.nomenclature import GEARS
from tribodyn.study.case.gears import is_idle
from tribodyn.study.case.provenance import changed_keys
from tribodyn.study.case.section import section_at
from tribodyn.types import Tree

if TYPE_CHECKING:
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.machine.case import AnyCase, MachineCase


STYLES = ("text", "bibtex")

#: Methods of the solver and the papers behind them.
_METHODS = {"steady": ("anderson",)}
#: Keys of what loses power, and the papers behind them.
_LOSSES = {"bearing": "skf", "seal_diameter": "iso-14179", "immersion": "changenet-velex"}
#: Changed values that a citation names.
_NAMED = 12


@lru_cache(maxsize=1)
def _library() -> dict[str, Tree]:
    import tomllib
    from importlib.resources import files

    text = files("tribodyn.study.pipeline").joinpath("citations.toml").read_text(encoding="utf-8")
    return tomllib.loads(text)


def papers(case: AnyCase) -> dict[str, Tree]:
    """Papers behind the models that a case uses, each once."""
    if not case.lumped:
        entries = _package() | _values_source(case)
        for _, pair, _ in case.mesh_pairs():
            entries |= _papers_of_pair(pair, ("stiffness", "friction", "film"))
        return entries | {key: _library()[key] for key in _papers_of_parts(case)}
    tables = ("stiffness", "friction", "film", "dynamics", "solver")
    entries = _papers_of_pair(case, tables)
    return entries | {key: _library()[key] for key in _METHODS.get(case.solver.method, ())}


def _papers_of_pair(case: PairCase, tables: tuple[str, ...]) -> dict[str, Tree]:
    """Papers behind the models of some tables of a pair, and behind its teeth and losses."""
    from tribodyn.ehl import SHEAR_MODELS

    keys, unlisted = ["iso-21771", "hertz"], dict[str, Tree]()
    for table in tables:
        if is_idle(table, case.gears.kind):
            continue
        model = getattr(case, table).chosen
        keys += model.papers
        if not model.papers and model.source and not _is_built_in(model):
            title = f"{model.name}: {model.source}"
            unlisted[model.name] = {"type": "misc", "title": title}
    if case.friction.shear_model is not None:
        keys += SHEAR_MODELS[case.friction.shear_model].papers
        if case.friction.limiting_stress or case.friction.limiting_stress_slope is not None:
            keys.append("evans-johnson")
    if case.friction.variant == "he-singh":
        keys.append("he-gunda-singh")
    shafts = [getattr(case.losses, gear) for gear in GEARS] if case.losses else []
    keys += _loss_papers(case.lubricant, case.losses, shafts)
    return (
        _package()
        | _data_sources(case)
        | {key: _library()[key] for key in dict.fromkeys(keys)}
        | unlisted
    )


def _package() -> dict[str, Tree]:
    title = f"tribodyn {tribodyn.__version__}: gear tribo-dynamics"
    return {"tribodyn": {"type": "misc", "author": "The tribodyn developers", "title": title}}


def _papers_of_parts(case: MachineCase) -> list[str]:
    """Keys of the papers behind shafts, bearings, reduction and planets."""
    planets = ["lin-parker", "parker-lin"]
    keys = planets if case.stages else []
    keys += ["cowper"] if any(not shaft.is_rigid for shaft in case.shafts.values()) else []
    keys += ["craig-bampton"] if case.motion.frequency_limit is not None else []
    rolling = any(bearing.rolling is not None for bearing in case.bearings.values())
    keys += ["harris-kotzalas", "iso-16281"] if rolling else []
    groups = () if case.losses is None else (case.losses.shafts, case.losses.bearings)
    parts = [part for group in groups for part in vars(group).values()]
    return [*keys, *_loss_papers(case.heat, case.losses, parts)]


def _loss_papers(oil: Any, losses: Any, parts: Iterable[Any]) -> list[str]:
    """Keys of the papers behind a heat balance, and behind the losses of some parts."""
    names = {k for part in parts for k, value in vars(part).items() if value}
    used = ["changenet-oviedo-velex"] if oil and oil.gear_heat_transfer else []
    used += [paper for name, paper in _LOSSES.items() if losses and name in names]
    return [*used, "anderson-loewenthal"] if losses and losses.windage else used


def _is_built_in(model: Model) -> bool:
    """Whether a model belongs to the package, whose bibliography has its source."""
    parts = (getattr(model, "function", None), getattr(model, "central", None))
    homes = {getattr(part, "__module__", "") for part in parts if part is not None}
    return not homes or any(home.startswith("tribodyn.") for home in homes)


def _data_sources(case: PairCase) -> dict[str, Tree]:
    """Sources of the values of a case and of its oil."""
    oil = case.lubricant_properties
    sources = _values_source(case)
    if oil is not None and oil.source:
        sources["oil"] = {"type": "misc", "title": f"Oil {oil.name}: {oil.source}"}
    return sources


def _values_source(case: AnyCase) -> dict[str, Tree]:
    """The document behind the values of a case, and the values that differ from its own."""
    if not case.origin:
        return {}
    changed = changed_keys(case)
    if not changed:
        return {"case": {"type": "misc", "title": f"Values of the case: {case.origin}"}}
    named = ", ".join(changed[:_NAMED])
    more = f" and {len(changed) - _NAMED} more" if len(changed) > _NAMED else ""
    plural = "s" if len(changed) > 1 else ""
    note = f"{len(changed)} value{plural} of the case differ{'' if plural else 's'}: {named}{more}"
    return {"case": {"type": "misc", "title": f"Based on: {case.origin}", "note": note}}


def sources_of(section: str, name: str) -> list[str]:
    """Name the papers behind one choice."""
    kind = section_at((section,))
    model = kind.model_named(name) if kind else None
    if model is None and section == "friction":
        from tribodyn.ehl import SHEAR_MODELS

        model = SHEAR_MODELS.all().get(name)
    keys = model.papers if model else _METHODS.get(name, ())
    unlisted = [model.source] if model and not keys and model.source else []
    return [*(_text(_library()[key]) for key in keys), *unlisted]


def bibliography() -> dict[str, str]:
    """All sources by key, as they are cited, ordered by author and title."""
    references = {key: _text(entry) for key, entry in _library().items()}
    return dict(sorted(references.items(), key=lambda item: item[1].casefold()))


def _text(entry: Tree) -> str:
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


def _bibtex(key: str, entry: Tree) -> str:
    entry = {**entry, "note": entry["note"].replace("_", r"\_")} if "note" in entry else entry
    fields = [f"  {name} = {{{value}}}" for name, value in entry.items() if name != "type"]
    return f"@{entry['type']}{{{key},\n" + ",\n".join(fields) + "\n}"


def cite(case: AnyCase, style: str = "text") -> str:
    """Write the papers behind a case."""
    entries = papers(case)
    if style == "bibtex":
        return "\n\n".join(_bibtex(key, entry) for key, entry in entries.items())
    if style == "text":
        return "\n".join(_text(entry) for entry in entries.values())
    raise InputError(
        f'style = "{style}"', "argument style", f"Known: {', '.join(STYLES)}", "Choose one"
    )
