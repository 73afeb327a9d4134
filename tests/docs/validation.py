"""Write docs/validation.md by computing: ``python tests/docs/validation.py`` (half a minute)."""

from __future__ import annotations

import math
import sys
import warnings
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import numpy as np
from pages import ROOT

import tribodyn as td
from known_pairs import pair_of
from known_systems import MESH_FREQUENCY, hysteresis_system, reference_system
from references import (
    backlash_orbits,
    film_cases,
    friction_table,
    gear_compliance,
    gear_pair_orbits,
)
from tribodyn import analysis, contact, dynamics, ehl, exchange, friction, losses, stiffness
from tribodyn.gear import Material
from tribodyn.lubricant import Lubricant

PAGE = ROOT / "docs" / "validation.md"
STEEL = Material(210e9, 0.3)


class Row(NamedTuple):
    """One figure and its reference; the tolerance is relative."""

    what: str
    reference: float
    computed: float
    tolerance: float

    @property
    def deviation(self) -> float:
        return self.computed / self.reference - 1.0


def geometry() -> Iterator[Row]:
    pair = pair_of()
    for what, expected, value, digit in (
        ("tip diameter of the pinion [mm]", 88.593, 1e3 * pair.pinion.tip_diameter, 5e-4),
        ("tip diameter of the wheel [mm]", 112.228, 1e3 * pair.wheel.tip_diameter, 6e-4),
        ("operating pressure angle [rad]", 0.391631, pair.operating_pressure_angle, 5e-7),
        ("transverse contact ratio", 1.326952, pair.transverse_contact_ratio, 5e-7),
        ("gear loss factor, zone by zone", 0.303076, losses.gear_loss_factor(pair), 3e-6),
    ):
        yield Row(what, expected, value, digit / expected)


def gearbox() -> Iterator[Row]:
    model = exchange.read_rexs(ROOT / "tests" / "references" / "rexs" / "two_stages.rexs")
    for stage, angle, shift in zip(
        model.stages, (22.8062, 21.7751), (0.46283, 0.30148), strict=True
    ):
        angle_degrees = math.degrees(stage.operating_pressure_angle)
        yield Row(
            f"operating pressure angle, stage {stage.id} [deg]", angle, angle_degrees, 5e-5 / angle
        )
        yield Row(f"sum of profile shifts, stage {stage.id}", shift, stage.shift_sum, 5e-6 / shift)


def tooth_contact() -> Iterator[Row]:
    pair = pair_of()
    path = contact.path_of_contact(pair)
    modulus = contact.effective_modulus(STEEL, STEEL)
    for point, expected in zip(("A", "B", "the middle", "E"), friction_table.TABLE, strict=True):
        roll, share, sliding, entrainment, ratio, radius, pressure, xu, benedict = expected
        motion = path.kinematics(roll * pair.pinion.base_radius, 30.0 * math.pi)
        load = share * 90.0 / pair.pinion.base_radius / 20e-3
        hertz = contact.hertz_line(load, motion.equivalent_radius, modulus)
        ones = np.ones(1)
        state = friction.TribologicalContact(
            load * ones, hertz.maximum_pressure * ones, sliding * ones, entrainment * ones,
            ratio * ones, 1e-3 * radius * ones, friction_table.VISCOSITY, 0.53e-6,
        )  # fmt: skip
        yield Row(f"sliding speed at {point} [m/s]", sliding, float(motion.sliding_speed), 1e-5)
        computed = 1e-9 * float(hertz.maximum_pressure)
        yield Row(f"Hertz pressure at {point} [GPa]", pressure, computed, 2e-6)
        for name, value in (("xu-2007", xu), ("benedict-kelly", benedict)):
            computed = float(friction.LAWS[name](state)[0])
            yield Row(f"friction coefficient at {point}, {name}", value, computed, 3e-5)


def film() -> Iterator[Row]:
    for name, (M, L, compressible, central, minimum, _) in film_cases.MOES.items():
        solved = ehl.solve_line_contact_moes(M, L, compressible=compressible, nodes=8193)
        film_thickness = solved.central_film_extrapolated
        yield Row(f"central film of {name} [b^2/R]", central, film_thickness, 3e-5)
        yield Row(f"least film of {name} [b^2/R]", minimum, solved.minimum_film, 4e-4)
    oil = Lubricant(0.082, 880.0, 2.19e-8)
    for torque, (load, _, _, central, minimum) in film_cases.FZG.items():
        solved = ehl.solve_line_contact(
            load, film_cases.RADIUS, film_cases.SPEED, oil, film_cases.MODULUS
        )
        yield Row(f"central film at {torque} N*m [um]", central, 1e6 * solved.central_film, 1e-3)
        yield Row(f"least film at {torque} N*m [um]", minimum, 1e6 * solved.minimum_film, 5e-3)


def teeth() -> Iterator[Row]:
    pair = pair_of(pinion_bore_diameter=30e-3, wheel_bore_diameter=30e-3)
    torques = np.array(gear_compliance.TORQUES)
    for roll, expected in gear_compliance.DEFLECTIONS.items():
        path = roll * pair.pinion.base_radius
        force = torques / pair.pinion.base_radius
        by_energy = force / stiffness.single_pair_stiffness(pair, Material(), path, force)
        for torque, value, computed in zip(torques, expected, 1e6 * by_energy, strict=True):
            what = f"deflection at {roll} rad, {torque:g} N*m, energy method [um]"
            yield Row(what, value, float(computed), 0.06)
        phase = (path - contact.path_of_contact(pair).A) / pair.base_pitch
        solved = stiffness.loaded_contact(pair, torques, provider="fe2d", phases=np.array([phase]))
        for torque, value, error in zip(
            torques, expected, solved.transmission_error[:, 0], strict=True
        ):
            what = f"deflection at {roll} rad, {torque:g} N*m, fe2d [um]"
            yield Row(what, value, 1e6 * float(error), 0.01)


def orbits() -> Iterator[Row]:
    for coefficient, expected in gear_pair_orbits.ORBITS.items():
        motion = dynamics.steady_state(reference_system(coefficient), MESH_FREQUENCY, steps=4096)
        fine = motion.fine
        deflection, force = fine.deflection[:, 0], fine.contact_force[:, 0]
        computed = (
            1e6 * fine.mean(deflection),
            1e6 * analysis.peak_to_peak(deflection),
            fine.mean(force),
            analysis.rms(fine, force),
            analysis.extremes(force)[1],
            analysis.rms(fine, fine.acceleration[:, 1]),
        )
        names = ("mean deflection [um]", "span of the deflection [um]", "mean force [N]",
                 "rms force [N]", "peak force [N]", "rms acceleration [m/s^2]")  # fmt: skip
        for name, value, computed_value in zip(names, expected, computed, strict=True):
            yield Row(f"{name}, friction {coefficient}", value, float(computed_value), 2e-6)
    frequency = backlash_orbits.SPEED / (2.0 * math.pi)
    for start, value, name in (
        (([1.5], [0.0]), backlash_orbits.LOW, "quiet"),
        (([2.2], [0.3]), backlash_orbits.HIGH, "loud"),
    ):
        motion = dynamics.steady_state(hysteresis_system(), frequency, start=start, steps=512)
        computed_value = float(analysis.alternating_rms(motion.fine, motion.fine.position[:, 0]))
        yield Row(f"rms of the {name} motion behind a backlash", value, computed_value, 3e-6)


#: Heading, what the reference is, and the rows.
GROUPS = (
    ("Geometry", "FZG type A by hand, ISO 21771", geometry),
    ("Gearbox of another program", "data sheet of its REXS file", gearbox),
    ("Speeds, pressure and friction", "FZG type A by hand, printed formulas", tooth_contact),
    ("Oil film", "another scheme (Okamura; Houpert and Hamrock)", film),
    ("Teeth", "plane finite elements of whole gears, written apart from those of tribodyn", teeth),
    ("Motion", "periodic orbits found by SciPy alone", orbits),
)  # fmt: skip

_HEAD = """# How far tribodyn is from its references

Every figure here is computed by `python tests/docs/validation.py`. A reference is something that
cannot be tuned: a closed form, another scheme written for this alone (`tests/references`), another
program, a printed figure. The tolerance is what the tests demand; each row is computed anew in the
tests and has to be as printed here.

| references | figures | largest deviation | of |
|---|---|---|---|
"""
_PRINTED = """## Printed figures

What the sources of the built-in cases print, computed by `tribodyn paper --all`: [what the verdicts
mean](papers.md), and [where each content of the sources is](coverage.md). A `value` is met within
the tolerance of its row, a `trend` runs the same way, and the rest cannot be had from what is
printed. The last column is the largest deviation among the rows of the verdict `value`.

| source | table | figures | value | trend | cannot be reproduced | value: largest deviation [%] |
|---|---|---|---|---|---|---|
"""


def rows_of(group: Any) -> list[Row]:
    """Rows of one group, computed."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", td.ModelWarning)
        return list(group())


def line(row: Row) -> str:
    """One row as printed on the page."""
    figures = f"{row.reference:.7g} | {row.computed:.7g} | {100.0 * row.deviation:+.2g}"
    return f"| {row.what} | {figures} | {100.0 * row.tolerance:.2g} |"


def printed_line(case: str, table: str, rows: list[dict[str, Any]]) -> str:
    """One table as printed on the page."""
    counts = Counter(row["verdict"] for row in rows)
    met = [abs(row["deviation"] or 0.0) for row in rows if row["verdict"] == "value"]
    worst = f"{100.0 * max(met):.2g}" if met else ""
    kinds = " | ".join(str(counts[name]) for name in ("value", "trend", "cannot-reproduce"))
    return f"| `{case}` | {table} | {len(rows)} | {kinds} | {worst} |"


def by_table(rows: tuple[dict[str, Any], ...]) -> dict[tuple[str, str], list[dict[str, Any]]]:
    """Rows by source and table."""
    tables: dict[tuple[str, str], list[dict[str, Any]]] = {}
    for row in rows:
        tables.setdefault((row["case"], row["table"]), []).append(row)
    return tables


def page() -> str:
    """The whole page."""
    head, body = _HEAD, ""
    for heading, origin, group in GROUPS:
        rows = rows_of(group)
        worst = max(rows, key=lambda row: abs(row.deviation))
        summary = f"{100.0 * abs(worst.deviation):.2g} % | {worst.what}"
        anchor = heading.lower().replace(" ", "-").replace(",", "")
        head += f"| [{heading}](#{anchor}) | {len(rows)} | {summary} |\n"
        body += f"\n## {heading}\n\nReference: {origin}.\n\n"
        body += "| figure | reference | tribodyn | deviation [%] | tolerance [%] |\n"
        body += "|---|---|---|---|---|\n"
        body += "\n".join(map(line, rows)) + "\n"
    tables = by_table(td.cases.compare_with_paper().rows)
    printed = "\n".join(printed_line(*key, rows) for key, rows in tables.items())
    return f"{head}{body}\n{_PRINTED}{printed}\n"


if __name__ == "__main__":
    PAGE.write_text(page(), "utf-8")
