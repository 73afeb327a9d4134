"""What the user sees: data on stdout, everything else on stderr."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from tribodyn.errors import ModelWarning, Problem

if TYPE_CHECKING:
    from tribodyn.checkpoints import Checkpoints


def say(text: str) -> None:
    """Write a line of data to stdout."""
    sys.stdout.write(text + "\n")


def say_json(data: object) -> None:
    """Write one JSON value to stdout."""
    every = (getattr(sys.stdout, "encoding", None) or "utf-8").lower().startswith("utf")
    say(json.dumps(data, indent=2, ensure_ascii=not every, allow_nan=False))


def tell(text: str) -> None:
    """Write a line to stderr."""
    sys.stderr.write(text + "\n")


def show_problems(problems: Sequence[Problem]) -> None:
    """Write problems to stderr, one paragraph each."""
    for problem in problems:
        tell(f"error: {problem}")
    if len(problems) > 1:
        tell(f"{len(problems)} faults found.")


def show_resumed(checkpoints: Checkpoints) -> None:
    """Report on stderr how much of a study an earlier process has finished."""
    if count := len(checkpoints):
        tell(f"{count} finished parts of this study were stored and are not computed again.")


def show_warnings(warnings: Iterable[ModelWarning]) -> None:
    """Write model warnings to stderr."""
    for warning in warnings:
        tell(f"warning [{warning.code}]: {warning.message}")


def figures(rows: Iterable[Sequence[str]]) -> str:
    """Lay out summary figures by topic: rows of topic, name, value and meaning."""
    listed = list(rows)
    lines = table([row[1:] for row in listed]).splitlines()
    topics = dict.fromkeys(row[0] for row in listed)
    for row, line in zip(listed, lines, strict=True):
        topics[row[0]] = f"{topics[row[0]] or row[0]}\n{line}"
    return "\n".join(str(text) for text in topics.values())


def table(rows: Sequence[Sequence[str]], *, indent: str = "  ") -> str:
    """Lay out rows in left-aligned columns."""
    widths = [max((len(row[i]) for row in rows), default=0) for i in range(len(rows[0]))]
    lines = ("  ".join(c.ljust(w) for c, w in zip(row, widths, strict=True)) for row in rows)
    return "\n".join((indent + line).rstrip() for line in lines)
