"""Keys, models and warnings with their meanings, for ``explain`` and the documentation."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache
from importlib.resources import files

from tribodyn.model import Model, Option
from tribodyn.study.case.pair import PairCase
from tribodyn.study.case.section import Section, Table, section_at


def case_keys() -> Iterator[tuple[str, Option, str]]:
    """Iterate over all keys of the case file."""
    yield from walk(PairCase, ())


def walk(section: type[Section], path: tuple[str, ...]) -> Iterator[tuple[str, Option, str]]:
    """Iterate over the keys of a table at a path, and of those in it."""
    for name, field in section.section_keys().keys.items():
        if isinstance(field, Table):
            yield from walk(field.kind, (*path, name))
        else:
            declared = name in section.fields
            yield ".".join((*path, name)), field, default_of(field, declared)


def default_of(option: Option, declared: bool = True) -> str:
    """Format the default of a declared key, or of an option of a model."""
    if option.required and declared:
        return "required"
    if option.default is None or option.default is ... or (option.basis and not declared):
        return f"from {option.basis}" if option.basis else "none"
    return option.show(option.default) + ("" if declared else ", of its model")


def start_toml(
    name: str = "start",
    section_of: Callable[[tuple[str, ...]], type[Section] | None] = section_at,
) -> str:
    """Return a short template case file: required keys and recommended models."""
    place = files("tribodyn.study.case").joinpath("texts", f"{name}.toml")
    text = place.read_text(encoding="utf-8")
    lines: list[str] = []
    section: type[Section] | None = PairCase
    for line in text.splitlines():
        pair, _, note = line.partition("  # ")
        if line.startswith("["):
            section = section_of(tuple(line.strip("[]").split(".")))
        name = pair.partition(" = ")[0]
        spec = section.spec(name) if section and not line.startswith("#") else None
        if spec is not None:
            line = f"{pair:<34} # {key_comment(spec, note)}"
        lines.append(line)
    return "\n".join(lines) + "\n"


def key_comment(spec: Option, note: str = "") -> str:
    """Symbol, meaning, and note or limits of a key, as a comment behind its value."""
    # Limits that only guard against typing errors do not help to choose a value.
    limits = "" if note or "guards against" in spec.origin else _choice_or_range(spec)
    text = "; ".join(filter(None, (spec.meaning, limits, note)))
    return f"{spec.symbol}: {text}" if spec.symbol else text


def _choice_or_range(spec: Option) -> str:
    return spec.allowed() if spec.names is not None or math.isfinite(spec.low) else ""


def _models() -> Iterator[tuple[str, Model]]:
    """Iterate over all models that a case can name, with the key that selects each."""
    for table, field in PairCase.fields.items():
        section = field.kind if isinstance(field, Table) else None
        for model in section.section_keys().models.values() if section else ():
            yield f"{table}.{section.selector}", model  # type: ignore[union-attr]


def choice_meanings() -> dict[str, str]:
    """Return the meanings of the models, laws and methods that a case can select."""
    meanings: dict[str, list[str]] = {}
    for _, model in _models():
        meanings.setdefault(model.name, []).append(getattr(model, "meaning", ""))
    for _, option, _ in case_keys():
        for name, meaning in option.meanings.items():
            meanings.setdefault(name, []).append(meaning)
    joined = {
        name: "; ".join(filter(None, dict.fromkeys(texts))) for name, texts in meanings.items()
    }
    return {name: text for name, text in joined.items() if text}


@lru_cache(maxsize=1)
def warning_meanings() -> Mapping[str, str]:
    """Return the meaning of every warning by code."""
    import tomllib

    text = (
        files("tribodyn.study.case").joinpath("texts", "warnings.toml").read_text(encoding="utf-8")
    )
    return tomllib.loads(text)["warnings"]  # type: ignore[no-any-return]


@lru_cache(maxsize=1)
def explanations() -> Mapping[str, Mapping[str, str]]:
    """Return equations, ranges of validity, remedies and pages by name."""
    import tomllib

    place = files("tribodyn.study.case").joinpath("texts", "explanations.toml")
    return tomllib.loads(place.read_text(encoding="utf-8"))


def page_of(key: str) -> str:
    """Return the documentation page of a key of the case file."""
    pages = explanations()["pages"]
    matches = [pages[part] for part in key.split(".") if part in pages]
    return f"docs/{matches[-1] if matches else 'case-file.md'}"
