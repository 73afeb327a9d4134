"""``tribodyn explain``, ``tribodyn units`` and ``tribodyn cite``."""

from __future__ import annotations

import difflib
import math
from pathlib import Path
from typing import Annotated, Any

from cyclopts import Parameter

from tribodyn.cli.screen import say, say_json, table
from tribodyn.errors import InputError, Problem


def explain(symbol: str, /, *, json: Annotated[bool, Parameter(negative="")] = False) -> None:
    """Explain a symbol, quantity, key, model, law, warning code or summary figure.

    Parameters
    ----------
    symbol : str
        For example "epsilon_alpha", "backlash", "gears.center_distance" or "xu-2007"; "friction"
        compares all friction laws.
    json : bool
        Write one JSON array to stdout.
    """
    symbol = symbol.strip()
    if not symbol:
        remedy = "Give a name, for example: tribodyn explain backlash"
        raise InputError(Problem("there is nothing to explain", "", "", remedy))
    if symbol == "friction":
        _friction_laws(json)
        return
    found = [*_choices(symbol), *_warnings(symbol)]
    found = found or [*_quantities(symbol), *_keys(symbol), *_figures(symbol)]
    if not found:
        raise InputError(_unknown(symbol))
    if json:
        say_json(found)
        return
    for entry in found:
        say("\n".join(f"{label + ':':<10} {text}" for label, text in entry.items() if text) + "\n")


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


def _quantities(symbol: str) -> list[dict[str, Any]]:
    from tribodyn.nomenclature import find

    return [
        {
            "quantity": quantity.name,
            "symbol": quantity.symbol,
            "meaning": quantity.meaning,
            "unit": quantity.display_unit,
            "si": quantity.unit,
        }
        for quantity in find(symbol)
    ]


def _keys(symbol: str) -> list[dict[str, Any]]:
    from tribodyn.study.case.reference import case_keys

    wanted = symbol.lower()
    return [
        {
            "key": key,
            "symbol": spec.symbol,
            "meaning": spec.meaning,
            "allowed": spec.allowed(),
            "default": default,
        }
        for key, spec, default in case_keys()
        if wanted in (key, key.rpartition(".")[2])
    ]


def _choices(symbol: str) -> list[dict[str, Any]]:
    """Models, laws and methods with the papers behind them."""
    from tribodyn.study.case.reference import case_keys, choice_meanings
    from tribodyn.study.pipeline.citations import sources_of

    meaning = choice_meanings().get(symbol)
    if meaning is None:
        return []
    keys = [key for key, spec, _ in case_keys() if spec.names and symbol in spec.names()]
    return [
        {
            "choice": symbol,
            "of": ", ".join(keys),
            "meaning": meaning,
            "source": " ".join(sources_of(keys[0].partition(".")[0], symbol)),
        }
    ]


def _warnings(symbol: str) -> list[dict[str, Any]]:
    from tribodyn.study.case.reference import warning_meanings

    meaning = warning_meanings().get(symbol.strip("[]"))
    return [] if meaning is None else [{"warning": symbol, "meaning": meaning}]


def _figures(symbol: str) -> list[dict[str, Any]]:
    from tribodyn.study.pipeline.summary import SUMMARY

    figure = SUMMARY.get(symbol)
    if figure is None:
        return []
    return [
        {
            "figure": figure.name,
            "meaning": figure.meaning,
            "unit": figure.display_unit,
            "si": figure.unit,
        }
    ]


def _unknown(symbol: str) -> Problem:
    from tribodyn.nomenclature import QUANTITIES
    from tribodyn.study.case.reference import case_keys, choice_meanings, warning_meanings
    from tribodyn.study.pipeline.summary import SUMMARY

    symbols = [quantity.symbol for quantity in QUANTITIES.values() if quantity.symbol]
    names = [*choice_meanings(), *warning_meanings(), *(key for key, _, _ in case_keys())]
    known = dict.fromkeys([*QUANTITIES, *symbols, *SUMMARY, *names])
    near = difflib.get_close_matches(symbol, known, n=3)
    remedy = f"Did you mean {' or '.join(near)}?" if near else "See: tribodyn units"
    return Problem(f'nothing is known of "{symbol}"', remedy=remedy)


def units(*, json: Annotated[bool, Parameter(negative="")] = False) -> None:
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


def cite(
    result: Path,
    /,
    *,
    bibtex: Annotated[bool, Parameter(negative="")] = False,
    json: Annotated[bool, Parameter(negative="")] = False,
) -> None:
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
        raise InputError(Problem("this is no result", str(result), why, remedy))
    case = load_case(file)
    if json:
        say_json([{"key": key, **entry} for key, entry in papers(case).items()])
    else:
        say(write_citations(case, "bibtex" if bibtex else "text"))
