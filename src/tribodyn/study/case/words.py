"""Words that engineers use for what is called otherwise here, or is not in this version."""

from __future__ import annotations

from functools import lru_cache
from importlib.resources import files
from typing import NamedTuple


class Word(NamedTuple):
    """What is said of a word."""

    meaning: str
    key: str = ""  #: last part of the key, or the quantity, that is meant
    page: str = ""  #: where the documentation says more


@lru_cache(maxsize=1)
def _words() -> dict[str, Word]:
    import tomllib

    text = files("tribodyn.study.case").joinpath("words.toml").read_text(encoding="utf-8")
    entries = tomllib.loads(text).values()
    return {word: Word(**{k: v for k, v in entry.items() if k != "words"})
            for entry in entries for word in entry["words"]}  # fmt: skip


def word(text: str) -> Word | None:
    """What is said of a word, whatever its case and its underscores; None if nothing is."""
    lowered = text.strip().lower()
    return _words().get(lowered) or _words().get(lowered.replace("_", " ").replace("-", " "))


def listed() -> list[str]:
    """All words."""
    return list(_words())
