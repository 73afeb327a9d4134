"""What is modelled and what is not: the one table that pages and messages take it from."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass, field
from functools import cache
from importlib.resources import files

#: Programs whose users have a page, with its name.
PROGRAMS = {"KISSsoft": "kisssoft", "LDP": "ldp", "MASTA": "masta", "ROSS": "ross"}


@dataclass(frozen=True)
class Feature:
    """Something that gear programs compute."""

    part: str  #: what it is a part of
    text: str
    page: str = ""  #: page of the documentation; empty: not modelled
    evidence: tuple[str, ...] = ()  #: what exists because of it
    absent: tuple[str, ...] = ()  #: words that no key has, because it is not modelled
    terms: tuple[str, ...] = ()  #: terms by which users look for it
    elsewhere: dict[str, str] = field(default_factory=dict)  #: its names in other programs

    @property
    def modelled(self) -> bool:
        """Whether this version computes it."""
        return bool(self.page)


@cache
def _table() -> dict[str, object]:
    return tomllib.loads(files(__name__).joinpath("scope.toml").read_text(encoding="utf-8"))


def statement(name: str) -> str:
    """Sentence of the table: ``summary``, what is computed, or ``gears``, of which gears."""
    return str(_table()[name])


@cache
def features() -> tuple[Feature, ...]:
    """All features, in the order of the page."""
    rows: list[dict[str, object]] = _table()["features"]  # type: ignore[assignment]
    lists = ("evidence", "absent", "terms")
    return tuple(
        Feature(**{k: tuple(v) if k in lists else v for k, v in row.items()})  # type: ignore[arg-type]
        for row in rows
    )


def not_modelled() -> dict[str, str]:
    """Terms that users look for in vain, with the answer."""
    return {
        term: f"Not in this version: {each.text}"
        for each in features()
        if not each.modelled
        for term in each.terms
    }
