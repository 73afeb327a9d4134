"""Figures of built-in cases that moved since they were first published, as the table of the notes.

``python tests/freeze/moved_figures.py`` prints it; ``write_snapshot.py --figures WHY`` adds to it.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from itertools import groupby
from pathlib import Path
from typing import NamedTuple

PATH = Path(__file__).resolve().parent / "snapshot" / "moved.json"


class Moved(NamedTuple):
    """A figure of a case before and after a change, in SI, and the reason."""

    case: str
    why: str
    figure: str
    before: float
    after: float

    @property
    def change(self) -> float:
        """Change relative to the value before."""
        return abs(self.after - self.before) / max(abs(self.before), abs(self.after))


def moved_figures() -> list[Moved]:
    """All figures that moved, by case and reason."""
    return sorted(Moved(*entry) for entry in json.loads(PATH.read_text("utf-8")))


def add_moved(entries: Sequence[Moved]) -> None:
    """Write figures that moved into the list; the first value of a figure is its value before."""
    known = {(entry.case, entry.figure): entry for entry in moved_figures()}
    for entry in entries:
        first = known.get((entry.case, entry.figure), entry)
        known[entry.case, entry.figure] = entry._replace(before=first.before)
    lines = ",\n ".join(json.dumps(entry) for entry in sorted(known.values()))
    PATH.write_text(f"[{lines}]\n", "utf-8")


def markdown() -> str:
    """Table of cases and reasons, with the figure that moved furthest."""
    rows = ["| case | figures | furthest (SI) | before | after | why |"]
    rows.append("|---|---|---|---|---|---|")
    for (case, why), group in groupby(moved_figures(), lambda entry: entry[:2]):
        entries = list(group)
        far = max(entries, key=lambda entry: entry.change)
        values = f"{far.before:.6g} | {far.after:.6g}"
        rows.append(f"| `{case}` | {len(entries)} | `{far.figure}` | {values} | {why} |")
    return "\n".join(rows)


if __name__ == "__main__":
    print(markdown())
