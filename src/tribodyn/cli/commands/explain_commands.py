"""``tribodyn explain``, ``units``, ``cite`` and ``cookbook``."""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from tribodyn.cli.console import say, say_json, table, tell
from tribodyn.cli.settings import Flag
from tribodyn.cookbook import TOPICS, Recipe, find_recipe, recipes, write_skill
from tribodyn.errors import InputError, OutputExistsError, Problem
from tribodyn.study.case.values import Term, find_term, listed_terms
from tribodyn.types import Tree

#: Entries beyond this number are only named.
_MAX_ENTRIES = 8
#: Endings of the files of a recipe.
_WRITTEN = (".py", ".ipynb")

Entries = list[Tree]


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
    query = " ".join((symbol, *more)).strip().strip("[]")
    if not query:
        remedy = "Give a name, for example: tribodyn explain backlash"
        raise InputError("there is nothing to explain", "", "", remedy)
    if query.lower() == "friction":
        _friction_laws(json)
        return
    entries = _entries_by_name(query) or _entries_by_text(query)
    if not entries:
        raise InputError(_unknown(query))
    if json:
        say_json(entries)
        return
    for entry in entries[:_MAX_ENTRIES]:
        say("\n".join(f"{label + ':':<10} {text}" for label, text in entry.items() if text) + "\n")
    if len(entries) > _MAX_ENTRIES:
        names = ", ".join(str(next(iter(entry.values()))) for entry in entries[_MAX_ENTRIES:])
        say(f"{len(entries) - _MAX_ENTRIES} more match: {names}")


def _friction_laws(json: bool) -> None:
    """Compare all friction laws along the path of contact of FZG type A."""
    from tribodyn.cases.load import load_case
    from tribodyn.study.studies.losses import PLACES, friction_laws

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


def _plain_form(name: str) -> str:
    """Return a name in lower case with blanks between its words."""
    return name.lower().replace("_", " ").replace("-", " ")


def _all_entries() -> list[tuple[tuple[str, ...], Tree]]:
    """Return everything that can be explained with its names, the most important first."""
    return [*_choices(), *_warnings(), *_quantities(), *_keys(), *_figures()]


def _entries_by_name(query: str) -> Entries:
    """Return entries with this name: as written, or else ignoring case, hyphens and underscores."""
    from tribodyn.study.pipeline.summary_figures import split_key

    candidates = _all_entries()
    term_entries = [_term_entry(meant)] if (meant := find_term(query)) else []
    exact = [entry for names, entry in candidates if query in names]
    exact = exact or [entry for names, entry in candidates if _of_part(names[0], query)]
    if not exact and (figure := split_key(query)[3]) != query:  # a key of a summary
        exact = [entry for names, entry in candidates if figure in names and "figure" in entry]
    plain_query = _plain_form(query)
    matches = exact or [e for names, e in candidates if plain_query in map(_plain_form, names)]
    return [*term_entries, *matches]


def _of_part(key: str, query: str) -> bool:
    """Whether a key of parts is that of a query with the name of one: bearings.A.clearance."""
    table, of_parts, _ = key.partition(".NAME")
    name = query.rpartition(".")[2]
    return bool(of_parts) and query.startswith(f"{table}.") and key.endswith(f".{name}")


def _entries_by_text(query: str) -> Entries:
    """Return entries with the words in their names (full words first), or else in their meaning."""
    candidates, plain_query = _all_entries(), _plain_form(query)
    ranks: list[Entries] = [[], [], []]
    for names, entry in candidates:
        plain = [_plain_form(name) for name in names if len(name) > 1]
        if any(f" {plain_query} " in f" {name} " for name in plain):
            ranks[0].append(entry)
        elif len(plain_query) > 2 and any(plain_query in name for name in plain):
            ranks[1].append(entry)
        elif f" {plain_query} " in f" {_plain_form(entry['meaning'])} ":
            ranks[2].append(entry)
    return [*ranks[0], *ranks[1]] or ranks[2]


def _term_entry(meant: Term) -> Tree:
    return {"answer": meant.meaning, "meaning": "", "see": meant.key, "page": f"docs/{meant.page}"}


def _quantities() -> Iterator[tuple[tuple[str, ...], Tree]]:
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


def _keys() -> Iterator[tuple[tuple[str, ...], Tree]]:
    from tribodyn.study.case.reference import case_keys, explanations, page_of
    from tribodyn.study.machine_tables import machine_keys

    equations = explanations()["equations"]
    pairs = list(case_keys())
    of_pairs = {id(spec) for _, spec, _ in pairs}
    for number, (key, spec, default) in enumerate((*pairs, *machine_keys())):
        name = key.rpartition(".")[2]
        # What a part shares with a pair is found by its whole key alone.
        shared = number >= len(pairs) and id(spec) in of_pairs
        yield (
            (key,) if shared else (key, name),
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


def _choices() -> Iterator[tuple[tuple[str, ...], Tree]]:
    """Models, laws and methods with their equations, ranges and papers."""
    from tribodyn.study.case.reference import case_keys, choice_meanings, explanations, page_of
    from tribodyn.study.pipeline.citations import sources_of

    texts = explanations()
    choices = [(key, spec.names()) for key, spec, _ in case_keys() if spec.names]
    for name, meaning in choice_meanings().items():
        keys = [key for key, names in choices if name in names]
        yield (
            (name,),
            {
                "choice": name,
                "of": ", ".join(keys),
                "meaning": meaning,
                "equation": texts["equations"].get(name, ""),
                "use": texts["ranges"].get(name, ""),
                "source": " ".join(sources_of(keys[0].partition(".")[0], name)),
                "page": page_of(keys[0]),
            },
        )


def _warnings() -> Iterator[tuple[tuple[str, ...], Tree]]:
    from tribodyn.study.case.reference import explanations, page_of, warning_meanings

    remedies = explanations()["remedies"]
    for code, meaning in warning_meanings().items():
        entry = {"warning": code, "meaning": meaning, "remedy": remedies.get(code, "")}
        yield (code,), {**entry, "page": page_of("warning")}


def _figures() -> Iterator[tuple[tuple[str, ...], Tree]]:
    from tribodyn.nomenclature import QUANTITIES
    from tribodyn.study.case.reference import explanations, page_of
    from tribodyn.study.pipeline.summary_figures import SUMMARY, figure_of, part_figures

    equations = explanations()["equations"]
    of_parts = {n: f"{kind}.NAME.{n}" for kind, names in part_figures().items() for n in names}
    figures = {n: replace(figure_of(key), name=n) for n, key in of_parts.items()} | SUMMARY
    for figure in figures.values():
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
    from tribodyn.study.pipeline.summary_figures import SUMMARY

    symbols = [quantity.symbol for quantity in QUANTITIES.values() if quantity.symbol]
    names = [*choice_meanings(), *warning_meanings(), *(key for key, _, _ in case_keys())]
    names_and_symbols = dict.fromkeys([*QUANTITIES, *symbols, *SUMMARY, *names, *listed_terms()])
    similar = difflib.get_close_matches(symbol, names_and_symbols, n=3)
    remedy = f"Did you mean {' or '.join(similar)}?" if similar else "See: tribodyn units"
    what = f'there is no entry "{symbol}"'
    return Problem(what, why="No quantity, law or key has this name", remedy=remedy)


def units(*, json: Flag = False) -> None:
    """List the units of all quantities and the other spellings that are accepted.

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
        rows = [
            {"si": si, "shown": display_unit, "for": n} for (si, display_unit), n in kinds.items()
        ]
        say_json({"units": rows, "spellings": SPELLINGS})
        return
    say("Display unit, SI unit, and quantities (any unit of the same kind is accepted):")
    say(
        table([[display_unit, si, ", ".join(names)] for (si, display_unit), names in kinds.items()])
    )
    say("\nOther accepted spellings:")
    say(
        table(
            [[spelling, meaning] for spelling, meaning in SPELLINGS.items() if spelling != meaning]
        )
    )


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


def cookbook(
    name: str = "",
    /,
    *,
    out: Path | None = None,
    skill: Path | None = None,
    force: Flag = False,
    json: Flag = False,
) -> None:
    """List the recipes, print one, or write it to a file.

    Parameters
    ----------
    name : str
        Name of a recipe. Without one, all are listed.
    out : Path
        File that the script is written to, or a folder for it; a notebook if it ends in .ipynb.
    skill : Path
        Folder in which to write a skill for coding assistants, with all recipes.
    force : bool
        Overwrite existing files.
    json : bool
        Write one JSON value to stdout.
    """
    if skill is not None:
        if name or out is not None:
            remedy = "Leave out the name and --out, or leave out --skill."
            raise InputError("--skill writes all recipes", "", "", remedy)
        folder = write_skill(skill, force=force)
        say_json({"skill": str(folder)}) if json else tell(f"Skill: {folder / 'SKILL.md'}")
    elif not name:
        if out is not None:
            remedy = "Name one: tribodyn cookbook tip-relief --out my.py. --skill writes all."
            raise InputError("--out needs the name of a recipe", "", "", remedy)
        _list_recipes(json)
    else:
        _show_recipe(find_recipe(name), out, force=force, json=json)


def _list_recipes(json: bool) -> None:
    if json:
        say_json([_as_dict(recipe) for recipe in recipes().values()])
        return
    for topic in TOPICS.values():
        rows = [[r.name, r.question] for r in recipes().values() if r.topic == topic]
        say(f"{topic}\n{table(rows)}\n")
    tell("tribodyn cookbook NAME prints a recipe; --out FILE writes it, ready to run.")


def _show_recipe(recipe: Recipe, out: Path | None, *, force: bool, json: bool) -> None:
    if out is not None:
        path = out / recipe.file_name if out.is_dir() or out.suffix not in _WRITTEN else out
        if path.exists() and not force:
            remedy = "Choose another name, or add --force."
            raise OutputExistsError("this exists already", str(path), "", remedy)
        path.parent.mkdir(parents=True, exist_ok=True)
        is_script = path.suffix != ".ipynb"
        path.write_text(recipe.script if is_script else recipe.notebook, "utf-8")
        tell(f"Run it with: {'python' if is_script else 'jupyter lab'} {path}")
    if json:
        say_json(_as_dict(recipe))
    elif out is None:
        say(recipe.script.rstrip("\n"))


def _as_dict(recipe: Recipe) -> dict[str, str]:
    return {
        "name": recipe.name,
        "topic": recipe.topic,
        "question": recipe.question,
        "notes": recipe.notes,
        "script": recipe.script,
    }
