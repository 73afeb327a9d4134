"""Tables of the documentation that are written from the package."""

from __future__ import annotations

from collections.abc import Iterable

from tribodyn.model import Option
from tribodyn.scope import Feature, features
from tribodyn.study.case.reference import case_keys
from tribodyn.study.faults.kinds import KINDS, LACKS, keys_in
from tribodyn.study.machine_tables import machine_keys
from tribodyn.study.studies.needs import KINDS as CASES
from tribodyn.study.studies.needs import PARTS, STUDIES, Need

__all__ = [
    "kind_table",
    "machine_tables",
    "needs_table",
    "program_table",
    "reference_tables",
    "scope_table",
]


def reference_tables() -> str:
    """Format all keys of a pair of gears as Markdown tables."""
    return key_tables(case_keys())


def key_tables(keys: Iterable[tuple[str, Option, str]]) -> str:
    """Format keys as Markdown tables, one for each table of the case file."""
    lines: list[str] = []
    table = ""
    for key, spec, default in keys:
        place, _, name = key.rpartition(".")
        if place != table or not lines:
            table = place
            lines += ["", f"### `[{place}]`" if place else "### Top of the file", ""]
            lines += ["| key | symbol | meaning | allowed | default |", "|---|---|---|---|---|"]
        symbol = f"`{spec.symbol}`" if spec.symbol else ""
        row = (f"`{name}`", symbol, spec.meaning, _limits(spec), default)
        lines.append("| " + " | ".join(row) + " |")
    return "\n".join(lines).strip() + "\n"


def machine_tables() -> str:
    """Format the keys of parts as Markdown tables."""
    return key_tables(machine_keys())


def _limits(spec: Option) -> str:
    if spec.names is not None:
        return ", ".join(f"`{name}`" for name in spec.names())
    return f"{spec.allowed()} ({spec.origin})" if spec.origin else spec.allowed()


def kind_table() -> str:
    """Format kinds and their keys in each kind of case as a Markdown table."""
    heads = ("kind", "what it is", *(f"keys in a {case} (optional)" for case in LACKS))
    lines = [heads, ("---",) * len(heads)]
    for name in KINDS:
        keys = [_keys_text(case, name) for case in LACKS]
        repeated = (text != "none" and text in keys[:place] for place, text in enumerate(keys))
        keys = ["the same" if each else text for each, text in zip(repeated, keys, strict=True)]
        lines.append((f"`{name}`", KINDS[name].meaning, *keys))
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def _keys_text(case: str, name: str) -> str:
    if name in LACKS[case]:
        return "none"
    required, optional = keys_in(case, name)
    text = ", ".join(f"`{key}`" for key in required)
    return f"{text}, ({', '.join(f'`{key}`' for key in optional)})" if optional else text


def needs_table() -> str:
    """Format the studies and what they take as a Markdown table."""
    heads = ("study", "it needs", *(f"{kind}s" for kind in CASES))
    lines = [heads, ("---",) * len(heads)]
    for study, need in STUDIES.items():
        what = f"{need.what}. {need.why}" if need.why else need.what
        lines.append((f"`{study}`", what, *(_cell(need, kind) for kind in CASES)))
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def _cell(need: Need, kind: str) -> str:
    if need.of_mesh and kind in PARTS:
        return "`--mesh NAME`"
    return "yes" if kind in need.kinds else "no"


def scope_table() -> str:
    """What is modelled and what is not, by part."""
    lines = ["| part | modelled | not in this version |", "|---|---|---|"]
    for part in dict.fromkeys(each.part for each in features()):
        of_part = [each for each in features() if each.part == part]
        links = [_linked(each) for each in of_part if each.modelled]
        missing = [each.text for each in of_part if not each.modelled]
        lines.append(f"| {part} | {'; '.join(links)} | {'; '.join(missing)} |")
    return "\n".join(lines)


def program_table(program: str) -> str:
    """Table "there | here" for users of another program."""
    lines = [f"| in {program} | here |", "|---|---|"]
    for each in features():
        if program in each.elsewhere:
            answer = _linked(each) if each.modelled else "not in this version"
            lines.append(f"| {each.elsewhere[program]} | {answer} |")
    return "\n".join(lines)


def _linked(feature: Feature) -> str:
    return f"{feature.text} ([more]({feature.page}))"
