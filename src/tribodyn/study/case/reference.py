"""All keys, models and warnings with their meaning: what ``explain`` and the pages are made of."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from functools import lru_cache
from importlib.resources import files

from tribodyn.model import Model, Option
from tribodyn.study.case.case import Case
from tribodyn.study.case.section import Section, Table, section_at


def case_keys() -> Iterator[tuple[str, Option, str]]:
    """Walk over all keys of the case file."""
    yield from _walk(Case, ())


def _walk(section: type[Section], path: tuple[str, ...]) -> Iterator[tuple[str, Option, str]]:
    for name, field in section.available().keys.items():
        if isinstance(field, Table):
            yield from _walk(field.kind, (*path, name))
        else:
            own = name in section.fields
            yield ".".join((*path, name)), field, _default(field, own)


def _default(option: Option, own: bool) -> str:
    """Default of a key of every case; an option of a model has that of the model."""
    if option.required and own:
        return "required"
    if option.default is None or not own:
        return f"from {option.basis}" if option.basis else "none"
    return option.show(option.default)


def reference_tables() -> str:
    """Write all keys as Markdown tables, one for each table of the case file."""
    lines: list[str] = []
    table = ""
    for key, spec, default in case_keys():
        place, _, name = key.rpartition(".")
        if place != table or not lines:
            table = place
            lines += ["", f"### `[{place}]`" if place else "### Top of the file", ""]
            lines += ["| key | symbol | meaning | allowed | default |", "|---|---|---|---|---|"]
        symbol = f"`{spec.symbol}`" if spec.symbol else ""
        row = (f"`{name}`", symbol, spec.meaning, _limits(spec), default)
        lines.append("| " + " | ".join(row) + " |")
    return "\n".join(lines).strip() + "\n"


def start_toml() -> str:
    """Write a short case file of no particular gears: required keys and recommended models."""
    text = files("tribodyn.study.case").joinpath("texts", "start.toml").read_text(encoding="utf-8")
    lines: list[str] = []
    section: type[Section] | None = Case
    for line in text.splitlines():
        pair, _, note = line.partition("  # ")
        if line.startswith("["):
            section = section_at(tuple(line.strip("[]").split(".")))
        name = pair.partition(" = ")[0]
        spec = section.spec(name) if section and not line.startswith("#") else None
        if spec is not None:
            # What a limit only guards against is no help to who fills in a value.
            limits = "" if note or "guards against" in spec.origin else _choice_or_range(spec)
            told = "; ".join(filter(None, (spec.meaning, limits, note)))
            line = f"{pair:<34} # {f'{spec.symbol}: ' if spec.symbol else ''}{told}"
        lines.append(line)
    return "\n".join(lines) + "\n"


def _choice_or_range(spec: Option) -> str:
    return spec.allowed() if spec.names is not None or math.isfinite(spec.low) else ""


def _limits(spec: Option) -> str:
    if spec.names is not None:
        return ", ".join(f"`{name}`" for name in spec.names())
    return f"{spec.allowed()} ({spec.origin})" if spec.origin else spec.allowed()


def _models() -> Iterator[tuple[str, Model]]:
    """All models that a case can name, each with the key that names it."""
    for table, field in Case.fields.items():
        section = field.kind if isinstance(field, Table) else None
        for model in section.available().models.values() if section else ():
            yield f"{table}.{section.selector}", model  # type: ignore[union-attr]


def choice_meanings() -> dict[str, str]:
    """Meaning of the models, laws and methods that a case chooses among."""
    told: dict[str, list[str]] = {}
    for _, model in _models():
        told.setdefault(model.name, []).append(getattr(model, "meaning", ""))
    for _, option, _ in case_keys():
        for name, meaning in option.meanings.items():
            told.setdefault(name, []).append(meaning)
    joined = {name: "; ".join(filter(None, dict.fromkeys(texts))) for name, texts in told.items()}
    return {name: text for name, text in joined.items() if text}


@lru_cache(maxsize=1)
def warning_meanings() -> Mapping[str, str]:
    """Meaning of every warning by its code."""
    import tomllib

    text = (
        files("tribodyn.study.case").joinpath("texts", "warnings.toml").read_text(encoding="utf-8")
    )
    return tomllib.loads(text)["warnings"]  # type: ignore[no-any-return]


@lru_cache(maxsize=1)
def explanations() -> Mapping[str, Mapping[str, str]]:
    """Equations, ranges of use, remedies and pages by name."""
    import tomllib

    place = files("tribodyn.study.case").joinpath("texts", "explanations.toml")
    return tomllib.loads(place.read_text(encoding="utf-8"))


def page_of(key: str) -> str:
    """Page of the documentation on a key of the case file."""
    pages = explanations()["pages"]
    found = [pages[part] for part in key.split(".") if part in pages]
    return f"docs/{found[-1] if found else 'case-file.md'}"
