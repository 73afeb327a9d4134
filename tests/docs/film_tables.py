"""Write the tables of docs/film.md from solved contacts: ``python tests/docs/film_tables.py``."""

from __future__ import annotations

import math
import re
import warnings
from collections.abc import Callable, Iterable
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from tribodyn.ehl import solve_line_contact, solve_line_contact_moes
from tribodyn.errors import ModelWarning
from tribodyn.lubricant import Lubricant

PAGE = Path(__file__).resolve().parents[2] / "docs" / "film.md"

NODES = (257, 513, 1025, 2049, 4097, 8193, 16385)
ENGINES = ("newton", "multigrid")
TORQUES, SPEEDS = (50, 150, 300), (800, 1400, 1800, 3000)
OIL = Lubricant(0.082, 880.0, 2.19e-8)


def gear_contact(torque: float, rpm: float, **options: Any) -> Any:
    """Pitch point of the pair of the first source: 24 teeth drive, one pair carries the load."""
    base_radius, width, curvature = 50.7434e-3, 20e-3, 20.9552e-3
    load, speed = torque / (base_radius * width), rpm * math.pi / 30.0 * curvature
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)  # the inlet is starved on purpose
        return solve_line_contact(load, 8e-3, speed, OIL, 2.2e11, **options)


#: Name, solver of nodes and method, and what its films are multiplied by.
CASES: dict[str, tuple[Callable[..., Any], float]] = {
    "M 20, L 10": (lambda **o: solve_line_contact_moes(20.0, 10.0, **o), 1.0),
    "M 5, L 5": (lambda **o: solve_line_contact_moes(5.0, 5.0, **o), 1.0),
    "150 N m, 1400 rpm [um]": (lambda **o: gear_contact(150, 1400, **o), 1e6),
}


@cache
def central_film(case: str, nodes: int, method: str) -> float:
    """Central film on one grid, converged far beyond its digits."""
    solve, factor = CASES[case]
    tight = {"newton": 1e-9, "multigrid": 1e-6}[method]
    return factor * float(
        solve(nodes=nodes, method=method, tolerance=1e-8, flux_tolerance=tight).central_film
    )


def row(cells: Iterable[str]) -> str:
    """One line of a table."""
    return f"| {' | '.join(cells)} |"


def convergence() -> list[str]:
    """Central film over the grid, by both engines."""
    lines = [row(["nodes", *(f"{case}, `{name}`" for case in CASES for name in ENGINES)])]
    lines.append("|" + "---|" * (1 + len(CASES) * len(ENGINES)))
    for nodes in NODES:
        films = (central_film(case, nodes, name) for case in CASES for name in ENGINES)
        lines.append(row([str(nodes), *(f"{film:.7f}" for film in films)]))
    return lines


def ratios(case: str) -> list[float]:
    """Difference of two grids over that of the next two."""
    films = [central_film(case, nodes, "newton") for nodes in NODES]
    steps = [after - before for before, after in pairwise(films)]
    return [before / after for before, after in pairwise(steps)]


def extrapolated(case: str, nodes: int) -> float:
    """Richardson's value from a grid and the one half as fine."""
    fine = central_film(case, nodes, "newton")
    return fine + (fine - central_film(case, (nodes + 1) // 2, "newton")) / 3.0


def order() -> list[str]:
    """Ratios of successive differences, and the extrapolated film."""
    lines = [row(["finest of three grids", *(f"{case}: ratio" for case in CASES),
                  *(f"{case}: extrapolated" for case in CASES)])]  # fmt: skip
    lines.append("|" + "---|" * (1 + 2 * len(CASES)))
    for number, nodes in enumerate(NODES[2:]):
        cells = [f"{ratios(case)[number]:.2f}" for case in CASES]
        cells += [f"{extrapolated(case, nodes):.6f}" for case in CASES]
        lines.append(row([str(nodes), *cells]))
    return lines


@cache
def source_figure(torque: float, rpm: float, starved: bool) -> Any:
    """One curve of the figures of the first source."""
    if starved:
        return gear_contact(torque, rpm, nodes=4097, inlet="zero", domain=(-2.5, 1.5))
    return gear_contact(torque, rpm, nodes=4097)


def peak(contact: Any) -> tuple[float, float]:
    """Height [p_h] and place [b] of the greatest pressure behind the centre."""
    behind = np.where(contact.position > 0.15 * contact.half_width, contact.pressure, 0.0)
    at = int(behind.argmax())
    return behind[at] / contact.hertz_pressure, contact.position[at] / contact.half_width


def single(contact: Any) -> bool:
    """Whether the pressure rises to its maximum, and falls from there."""
    top = int(contact.pressure.argmax())
    steps = np.diff(contact.pressure)
    return bool(np.all(steps[:top] >= 0.0) and np.all(steps[top:] <= 0.0))


def _peak(contact: Any) -> str:
    height, place = peak(contact)
    alone = ", alone" if single(contact) else ""
    return f"{height:.2f} at {place:.3f}{alone}"


def operating_points(points: Iterable[tuple[int, int]]) -> list[str]:
    """Films and spikes at operating points, flooded and in the domain of the source."""
    head = ["torque, speed", "p_h [GPa]"]
    head += [f"{name} [um]" for name in ("h_c", "h_min")] + ["spike [p_h] at [b]"]
    head += [f"{name}, starved [um]" for name in ("h_c", "h_min")] + ["spike, starved"]
    lines = [row(head), "|" + "---|" * len(head)]
    for torque, rpm in points:
        full, starved = (source_figure(torque, rpm, cut) for cut in (False, True))
        cells = [f"{torque} N m, {rpm} rpm", f"{1e-9 * full.hertz_pressure:.4f}"]
        for contact in (full, starved):
            cells += [f"{1e6 * contact.central_film:.4f}", f"{1e6 * contact.minimum_film:.4f}"]
            cells.append(_peak(contact))
        lines.append(row(cells))
    return lines


TABLES: dict[str, Callable[[], list[str]]] = {
    "convergence": convergence,
    "order": order,
    "torque": lambda: operating_points((torque, 1400) for torque in TORQUES),
    "speed": lambda: operating_points((150, rpm) for rpm in SPEEDS),
}


def on_page(name: str, text: str) -> str:
    """Table of a name as printed on the page.

    >>> on_page("a", "<!-- a -->\\n| 1 |\\n\\nwords")
    '| 1 |'
    """
    match = re.search(rf"<!-- {name} -->\n((?:\|.*\n)*)", text + "\n")
    return match.group(1).rstrip("\n") if match else ""


def numbers(table: str) -> list[tuple[float, float]]:
    """All numbers of a table, each with the value of its last digit.

    >>> numbers("| 1.25 | 3 |")
    [(1.25, 0.01)]
    """
    digits = re.findall(r"-?\d+\.(\d+)", table)
    values = re.findall(r"-?\d+\.\d+", table)
    return [(float(v), 10.0 ** -len(d)) for v, d in zip(values, digits, strict=True)]


def written(text: str) -> str:
    """Page with its tables computed anew."""
    for name, make in TABLES.items():
        table = "\n".join(make()) + "\n"
        text = re.sub(rf"(<!-- {name} -->\n)(?:\|.*\n)*", lambda m, t=table: m.group(1) + t, text)
    return text


if __name__ == "__main__":
    PAGE.write_text(written(PAGE.read_text("utf-8")), "utf-8")
