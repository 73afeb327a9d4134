"""What the names that appear in cases and warnings mean, in one line each."""

from __future__ import annotations

import tomllib
from functools import lru_cache
from importlib.resources import files


@lru_cache(maxsize=1)
def _words() -> dict[str, dict[str, str]]:
    text = files("tribodyn.study").joinpath("words.toml").read_text(encoding="utf-8")
    return tomllib.loads(text)


def warning_meanings() -> dict[str, str]:
    """Meaning of every warning by its code."""
    return dict(_words()["warnings"])


def choice_meanings() -> dict[str, str]:
    """Meaning of the models, laws and methods that a case chooses among."""
    return dict(_words()["choices"])
