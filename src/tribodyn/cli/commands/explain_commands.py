"""``tribodyn explain``, ``tribodyn units`` and ``tribodyn cite``."""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from tribodyn.cli.screen import say, say_json, table
from tribodyn.cli.settings import Flag
from tribodyn.errors import InputError, Problem
from tribodyn.study.case.values import Word, listed, word

#: Entries beyond this are named, not told.
_MOST = 8

Entries = list[dict[str, Any]]


def explain(symbol: str, /, *more: str, json: Flag = False) -> None:
    """Explain a symbol, quantity, key, model, law, warning code or summary value.

    Parameters
    ----------
    symbol : str
        For example "epsilon_alpha", "tip relief", "gears.center_distance" or "xu-2007"; "friction"
        compares all friction laws.
    more : str
        Further words of it.
    json : bool
        Write one JSON array to stdout.
    """
    asked = " ".join((symbol, *more)).strip().strip("[]")
    if not asked:
        remedy = "Give a name, for example: tribodyn explain backlash"
        raise InputError("there is nothing to explain", "", "", remedy)
    if asked.lower() == "friction":
        _friction_laws(json)
        return
    found = _named(asked) or _holding(asked)
    if not found:
        raise InputError(_unknown(asked))
    if json:
        say_json(found)
        return
    for entry in found[:_MOST]:
        say("\n".join(f"{label + ':':<10} {text}" for label, text in entry.items() if text) + "\n")
    if len(found) > _MOST:
        names = ", ".join(str(next(iter(entry.values()))) for entry in found[_MOST:])
        say(f"{len(found) - _MOST} more have these words: {names}")


def _friction_laws(json: bool) -> None:
    """Compare all friction laws along the path of contact of FZG type A."""
    from tribodyn.cases.load import load_case
    from tribodyn.study.studies.friction_laws import PLACES, friction_laws

    laws = friction_laws(load_case("fzg-roughness"))
    if json:
        say_json([{**law, "places": PLACES} for law in laws])
        return
    for law in laws:
        options = f" Options: {law['options']}." if law["options"] else ""
        say(f"{law['law']}: {law['meaning']}.{options} {law['source']}\n")
    rows = [["FZG type A", *PLACES, ""]]
    for law in laws:
        values = [f"{value:.4f}" for value in law["coefficients"] or [math.nan] * len(PLACES)]
        remark = "*" if law["in_range"] is False else law["missing"]
        rows.append([law["law"], *(value.replace("nan", "-") for value in values), remark])
    say("Friction coefficient at 90 N*m, 900 rpm, 82 mPa*s, 0.53 um; * outside of the law's range:")
    say(table(rows))


def _plainly(name: str) -> str:
    """A name without its case and what joins its words."""
    return name.lower().replace("_", " ").replace("-", " ")


def _all() -> list[tuple[tuple[str, ...], dict[str, Any]]]:
    """Everything that can be explained, with its names; those of most weight first."""
    return [*_choices(), *_warnings(), *_quantities(), *_keys(), *_figures()]


def _named(asked: str) -> Entries:
    """What is called so: as written, or else in any case and joined in any way."""
    known = _all()
    said = [_of_word(meant)] if (meant := word(asked)) else []
    exact = [entry for names, entry in known if asked in names]
    wanted = _plainly(asked)
    found = exact or [e for names, e in known if wanted in map(_plainly, names)]
    return [*said, *found]


def _holding(asked: str) -> Entries:
    """What has the words in its name, as whole words before parts of words; or in its meaning."""
    known, wanted = _all(), _plainly(asked)
    ranks: list[Entries] = [[], [], []]
    for names, entry in known:
        plain = [_plainly(name) for name in names if len(name) > 1]
        if any(f" {wanted} " in f" {name} " for name in plain):
            ranks[0].append(entry)
        elif len(wanted) > 2 and any(wanted in name for name in plain):
            ranks[1].append(entry)
        elif f" {wanted} " in f" {_plainly(entry['meaning'])} ":
            ranks[2].append(entry)
    return [*ranks[0], *ranks[1]] or ranks[2]


def _of_word(meant: Word) -> dict[str, Any]:
    return {"answer": meant.meaning, "meaning": "", "see": meant.key, "page": f"docs/{meant.page}"}


def _quantities() -> Iterator[tuple[tuple[str, ...], dict[str, Any]]]:
    from tribodyn.nomenclature import QUANTITIES
    from tribodyn.study.case.reference import explanations

    equations = explanations()["equations"]
    for quantity in QUANTITIES.values():
        yield (
            (quantity.name, quantity.symbol),
            {
                "quantity": quantity.name,
                "symbol": quantity.symbol,
                "meaning": quantity.meaning,
                "equation": equations.get(quantity.name, ""),
                "unit": quantity.display_unit,
                "si": quantity.unit,
                "page": "docs/nomenclature.md",
            },
        )


def _keys() -> Iterator[tuple[tuple[str, ...], dict[str, Any]]]:
    from tribodyn.study.case.reference import case_keys, explanations, page_of

    equations = explanations()["equations"]
    for key, spec, default in case_keys():
        name = key.rpartition(".")[2]
        yield (
            (key, name),
            {
                "key": key,
                "symbol": spec.symbol,
                "meaning": spec.meaning,
                "equation": equations.get(key, equations.get(name, "")),
                "allowed": f"{spec.allowed()} ({spec.origin})" if spec.origin else spec.allowed(),
                "default": default,
                "page": page_of(key),
            },
        )


def _choices() -> Iterator[tuple[tuple[str, ...], dict[str, Any]]]:
    """Models, laws and methods with their equations, ranges and papers."""
    from tribodyn.study.case.reference import case_keys, choice_meanings, explanations, page_of
    from tribodyn.study.pipeline.citations import sources_of

    told = explanations()
    named = [(key, spec.names()) for key, spec, _ in case_keys() if spec.names]
    for name, meaning in choice_meanings().items():
        keys = [key for key, names in named if name in names]
        yield (
            (name,),
            {
                "choice": name,
                "of": ", ".join(keys),
                "meaning": meaning,
                "equation": told["equations"].get(name, ""),
                "use": told["ranges"].get(name, ""),
                "source": " ".join(sources_of(keys[0].partition(".")[0], name)),
                "page": page_of(keys[0]),
            },
        )


def _warnings() -> Iterator[tuple[tuple[str, ...], dict[str, Any]]]:
    from tribodyn.study.case.reference import explanations, page_of, warning_meanings

    remedies = explanations()["remedies"]
    for code, meaning in warning_meanings().items():
        entry = {"warning": code, "meaning": meaning, "remedy": remedies.get(code, "")}
        yield (code,), {**entry, "page": page_of("warning")}


def _figures() -> Iterator[tuple[tuple[str, ...], dict[str, Any]]]:
    from tribodyn.nomenclature import QUANTITIES
    from tribodyn.study.case.reference import explanations, page_of
    from tribodyn.study.pipeline.summary import SUMMARY

    equations = explanations()["equations"]
    for figure in SUMMARY.values():
        if figure.name not in QUANTITIES:
            entry = {
                "figure": figure.name,
                "meaning": figure.meaning,
                "equation": equations.get(figure.name, ""),
                "unit": figure.display_unit,
                "si": figure.unit,
                "page": page_of("figure"),
            }
            yield (figure.name,), entry


def _unknown(symbol: str) -> Problem:
    from tribodyn.nomenclature import QUANTITIES
    from tribodyn.study.case.reference import case_keys, choice_meanings, warning_meanings
    from tribodyn.study.pipeline.summary import SUMMARY

    symbols = [quantity.symbol for quantity in QUANTITIES.values() if quantity.symbol]
    names = [*choice_meanings(), *warning_meanings(), *(key for key, _, _ in case_keys())]
    known = dict.fromkeys([*QUANTITIES, *symbols, *SUMMARY, *names, *listed()])
    near = difflib.get_close_matches(symbol, known, n=3)
    remedy = f"Did you mean {' or '.join(near)}?" if near else "See: tribodyn units"
    what = f'nothing is known of "{symbol}"'
    return Problem(what, why="No quantity, law or key has this name", remedy=remedy)


def units(*, json: Flag = False) -> None:
    """List the units of all quantities and the spellings that are understood besides.

    Parameters
    ----------
    json : bool
        Write one JSON object to stdout.
    """
    from tribodyn.nomenclature import QUANTITIES
    from tribodyn.units import SPELLINGS

    kinds: dict[tuple[str, str], list[str]] = {}
    for quantity in QUANTITIES.values():
        if quantity.unit:
            kinds.setdefault((quantity.unit, quantity.display_unit), []).append(quantity.name)
    if json:
        listed = [{"si": si, "shown": shown, "for": n} for (si, shown), n in kinds.items()]
        say_json({"units": listed, "spellings": SPELLINGS})
        return
    say("Shown as, in SI, and what for (any unit of the same kind is understood):")
    say(table([[shown, si, ", ".join(names)] for (si, shown), names in kinds.items()]))
    say("\nSpellings understood besides the usual ones:")
    say(table([[spelling, meant] for spelling, meant in SPELLINGS.items() if spelling != meant]))


def cite(result: Path, /, *, bibtex: Flag = False, json: Flag = False) -> None:
    """Print the papers behind a result.

    Parameters
    ----------
    result : Path
        Directory that "tribodyn run" wrote.
    bibtex : bool
        Write BibTeX entries.
    json : bool
        Write one JSON array to stdout.
    """
    from tribodyn.cases.load import load_case
    from tribodyn.study.pipeline.citations import cite as write_citations
    from tribodyn.study.pipeline.citations import papers

    file = result / "case.toml"
    if not file.is_file():
        why = "It holds no case.toml" if result.is_dir() else "There is no such directory"
        remedy = "Give the directory that tribodyn run wrote"
        raise InputError("this is no result", str(result), why, remedy)
    case = load_case(file)
    if json:
        say_json([{"key": key, **entry} for key, entry in papers(case).items()])
    else:
        say(write_citations(case, "bibtex" if bibtex else "text"))
