"""Write the snapshot anew and say what changed: ``python tests/freeze/write_snapshot.py``.

Names and figures that are new come in by this, figures with ``--figures "why they moved"``. What is
gone or differs is printed: such a change breaks what users wrote. Figures that moved go into the
table of the release notes.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

from frozen_figures import case_figures, differences
from frozen_surface import losses, surface
from moved_figures import Moved, add_moved, markdown

FOLDER = Path(__file__).resolve().parent / "snapshot"


def read(name: str) -> Any:
    """One part of the snapshot; nothing if it was not written yet."""
    path = FOLDER / f"{name}.json"
    return json.loads(path.read_text("utf-8")) if path.exists() else {}


def write(name: str, data: Any) -> None:
    """Write one part of the snapshot."""
    FOLDER.mkdir(exist_ok=True)
    text = json.dumps(data, indent=1, ensure_ascii=False, sort_keys=True)
    (FOLDER / f"{name}.json").write_text(text + "\n", "utf-8")


def main() -> None:
    """Write the names, with ``--figures`` the figures of the cases too; print what differs."""
    old = read("surface")
    new = surface(old.get("pages"))
    for line in losses(old, new):
        print("-", line)
    for line in losses(new, old):
        print("+", line.replace(": gone", ""))
    write("surface", new)
    if "--figures" not in sys.argv:
        return
    why = sys.argv[sys.argv.index("--figures") + 1]
    old_figures, new_figures = read("figures"), case_figures()
    moved: list[Moved] = []
    for case, values in old_figures.items():
        before, after = values["summary"], new_figures.get(case, {}).get("summary", {})
        for line in differences(case, before, after):
            print("*", line)
        moved += [
            Moved(case, why, name, before[name], after[name])
            for name in before.keys() & after.keys()
            if differences(case, {name: before[name]}, after)
        ]
    add_moved(moved)
    print(markdown())
    write("figures", new_figures)


if __name__ == "__main__":
    main()
