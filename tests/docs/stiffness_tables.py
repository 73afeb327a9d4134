"""Write the tables of docs/stiffness.md: ``python tests/docs/stiffness_tables.py``."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterable
from functools import cache
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from known_pairs import pair_of, standard, type_c
from tribodyn.contact import path_of_contact
from tribodyn.gear import Material, SpurPair
from tribodyn.stiffness import MODELS, LoadedContact, loaded_contact
from tribodyn.stiffness.loaded.contact import compliance_of
from tribodyn.stiffness.loaded.problem import contact_places

PAGE = Path(__file__).resolve().parents[2] / "docs" / "stiffness.md"

PAIRS: dict[str, tuple[SpurPair, float]] = {
    "FZG type A, 90 N m": (pair_of(), 90.0),
    "FZG type C, 90 N m": (type_c(), 90.0),
    "z 20/60, m 4, 300 N m": (standard((20, 60)), 300.0),
    "z 40/40, m 4, 400 N m": (standard((40, 40), 60e-3), 400.0),
}
#: Model and reference.
MODELS_COMPARED = (
    ("fe2d", "bore"), ("analytic", "bore"), ("potential-energy", "bore"), ("fe2d", "rim"),
    ("weber", "rim"), ("iso6336", "rim"),
)  # fmt: skip


@cache
def mesh(name: str, model: str, reference: str) -> LoadedContact:
    """Loaded contact of a pair by a model; the literature has no contact of tip corners."""
    pair, torque = PAIRS[name]
    coupled = model in ("fe2d", "analytic")
    return loaded_contact(
        pair, torque, provider=model, reference=reference, phases=256, extended_contact=coupled
    )


@cache
def single_pair(name: str, model: str, reference: str) -> float:
    """Mean over the path of the stiffness of one pair that carries the whole load."""
    pair, torque = PAIRS[name]
    phase = (np.arange(64) + 0.5) / 64
    places = contact_places(path_of_contact(pair), phase, extended=False)
    force, width = torque / pair.pinion.base_radius, pair.common_face_width
    options = {"reference": reference} if "reference" in MODELS[model].options else {}
    parts = compliance_of(pair, Material(), places, force, MODELS[model], options)
    self_part = np.diagonal(parts.structure, axis1=1, axis2=2)
    local = parts.local - parts.logarithm * np.log(force / width)
    return float(np.mean((width / (self_part + local))[places.on_path]))


def row(cells: Iterable[str]) -> str:
    """One line of a table."""
    return f"| {' | '.join(cells)} |"


def comparison() -> list[str]:
    """Single pair, mean mesh stiffness and transmission error of every model and pair."""
    lines = [
        row(["pair", "model", "one pair [1e8 N/m]", "mesh, mean [1e8 N/m]", "peak to peak [um]"]),
        "|---|---|---|---|---|",
    ]
    for name in PAIRS:
        for model, reference in MODELS_COMPARED:
            computed = mesh(name, model, reference)
            swing = 1e6 * float(computed.peak_to_peak_transmission_error)
            lines.append(
                row([
                    name, f"`{model}`, {reference}",
                    f"{single_pair(name, model, reference) / 1e8:.3f}",
                    f"{computed.mesh_stiffness_secant.mean() / 1e8:.3f}", f"{swing:.2f}",
                ])
            )  # fmt: skip
    return lines


TABLES: dict[str, Callable[[], list[str]]] = {"comparison": comparison}


def on_page(name: str, text: str) -> str:
    """The table between its two marks."""
    match = re.search(rf"<!-- {name} -->\n(.*?)\n<!-- /{name} -->", text, re.DOTALL)
    assert match is not None, f"docs/stiffness.md has no table {name}"
    return match.group(1)


def main() -> None:
    """Put the tables into the page."""
    text = PAGE.read_text("utf-8")
    for name, make in TABLES.items():
        table = "\n".join(make())
        marks = f"<!-- {name} -->\n", f"\n<!-- /{name} -->"
        text = text.replace(on_page(name, text).join(marks), table.join(marks))
    PAGE.write_text(text, "utf-8")


if __name__ == "__main__":
    main()
