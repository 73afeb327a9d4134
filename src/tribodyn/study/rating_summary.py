"""Verdict, lives and factors of a rating as tables and sentences: terminal, report and page."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import product
from typing import TYPE_CHECKING, Any, NamedTuple

from tribodyn.study.rated_parts import LIVES
from tribodyn.types import ByName

if TYPE_CHECKING:
    from tribodyn.study.rated_parts import BearingRating, Verdict
    from tribodyn.study.rating import CaseRating, MeshRating


class RatingTable(NamedTuple):
    """A table of a rating."""

    title: str
    head: tuple[str, ...]
    rows: list[tuple[str, ...]]

    @property
    def numeric(self) -> list[bool]:
        """Whether each column holds numbers."""
        columns = zip(*self.rows, strict=True)
        return [all(not c or c[0] in "+-.0123456789" for c in column) for column in columns]


#: What helps against a mode of failure.
_REMEDIES = {
    "pitting": "a harder flank or a better grade, more face width, finer flanks, thicker oil, or a "
    "lead that lowers K_Hbeta",
    "bending": "a larger module, a larger root fillet, a positive profile shift, or shot peening",
    "scuffing (flash)": "an oil of a higher load stage, tip relief, smoother flanks or cooler oil",
    "scuffing (integral)": "an oil of a higher load stage, tip relief, smoother flanks or cooler "
    "oil",
    "micropitting": "smoother flanks, thicker or cooler oil, tip relief, or an oil of a higher "
    "load stage in the micropitting test",
    "bearing life": "a bearing of a higher load rating, cleaner oil, cooler or thicker oil, or a "
    "bearing further from the mesh",
    "shaft yield": "a larger diameter at the notch, a stronger steel, or a smaller overload",
    "shaft fatigue": "a larger radius or diameter at the notch, a smoother surface, or a stronger "
    "steel",
}
_HEAD = ("factor", "value", "unit", "source", "branch")


def rating_figures(rating: CaseRating) -> dict[str, dict[str, float]]:
    """Safeties and lives as figures of a summary by dotted key, by load."""
    figures: dict[str, dict[str, float | None]] = {}
    for mesh in rating.ratings:
        is_pair = mesh.gears == tuple(mesh.standard.gears)
        start, table = "" if is_pair else f"meshes.{mesh.mesh}.", figures.setdefault(mesh.load, {})
        for name in ("scuffing_safety_flash", "scuffing_safety_integral", "micropitting_safety"):
            table[f"{start}{name}"] = getattr(mesh.standard, name)
        for origin, each in (("", mesh.standard), ("computed_", mesh.computed)):
            parts = {f"_{n}": g for n, g in each.gears.items()} if is_pair else {"": each}
            for mode, (end, part) in product(("pitting", "bending"), parts.items()):
                name = f"{mode}_safety"
                table[f"{start}{origin}{name}{end}"] = getattr(part, name)
    for bearing, life in ((b, life) for b in rating.parts.bearings for life in b.lives):
        lives = {f"bearings.{bearing.bearing}.{name}": getattr(life, name) for name in LIVES}
        figures.setdefault(life.load, {}).update(lives)
    for notch in rating.parts.notches:
        safeties = {"fatigue_safety": notch.safety, "yield_safety": notch.yield_safety}
        table = figures.setdefault(notch.load, {})
        for key, safety in ((f"shafts.{notch.shaft}.{n}", s) for n, s in safeties.items()):
            table[key] = min(table.get(key) or math.inf, safety)
    return {
        load: {k: float(v) for k, v in table.items() if v is not None and math.isfinite(v)}
        for load, table in figures.items()
    }


def verdict_table(rating: CaseRating) -> RatingTable:
    """Safety of each part against each mode of failure, the least margin first."""
    head = (
        *("mode of failure", "part", "safety", "required", "margin", "computed loads", "where"),
        "load",
    )
    return RatingTable("Safeties", head, [_row(verdict) for verdict in rating.verdicts()])


def _row(verdict: Verdict) -> tuple[str, ...]:
    computed = "" if verdict.computed is None else f"{verdict.computed:.3f}"
    margin = f"{100.0 * verdict.margin:+.1f} %"
    numbers = f"{verdict.safety:.3f}", f"{verdict.required:g}", margin, computed
    return verdict.mode, verdict.part, *numbers, verdict.where, verdict.load


def damage_table(rating: CaseRating) -> RatingTable:
    """Damage of each gear by load case and in total, by Miner, with the loads of the pinion."""
    kinds = list(product(("pitting", "bending"), ("pinion", "wheel")))
    loads = ("pinion torque [N*m]", "pinion speed [rpm]", "time [h]")
    head = ("mesh", "load", *loads, *(f"{mode} of {gear}" for mode, gear in kinds))
    rows = []
    for each in rating.spectra:
        damages = [getattr(getattr(each.rating, g), f"{mode}_damage") for mode, g in kinds]
        mesh = f"{each.mesh}: {each.gears[0]}, {each.gears[1]}"
        for case, *parts in zip(each.rating.cases, *damages, strict=True):
            speed = 30.0 / math.pi * case.speed
            numbers = case.torque, speed, case.duration / 3600.0, *parts
            rows.append((mesh, case.name, *(f"{number:.4g}" for number in numbers)))
        hours = sum(case.duration for case in each.rating.cases) / 3600.0
        totals = (f"{number:.4g}" for number in (hours, *map(sum, damages)))
        rows.append((mesh, "total", "", "", *totals))
    return RatingTable("Damage by load case", head, rows)


def bearing_table(rating: CaseRating) -> RatingTable:
    """Lives of all bearings, with the load, the viscosity ratio and a_ISO under each load."""
    head = ("bearing", "load", "basic life", "modified life", "by elements", "P", "kappa", "a_ISO")
    rows = []
    is_rated = any(each.lives for each in rating.parts.bearings)
    for each in rating.parts.bearings if is_rated else ():
        if not each.lives:
            rows.append((each.bearing, each.reason, *[""] * 6))
        for life in each.lives:
            factors = [_number(life.factors, name) for name in ("P", "kappa", "a_ISO")]
            hours = (_hours(getattr(life, name)) for name in LIVES)
            rows.append((each.bearing, life.load, *hours, *factors))
        if len(each.lives) > 1:
            rows.append((each.bearing, "all load cases", *_lives_of(each), *[""] * 3))
    return RatingTable("Bearings: life in hours", head, rows)


def _lives_of(bearing: BearingRating) -> Iterator[str]:
    return (_hours(getattr(bearing, name)) for name in LIVES)


def _hours(life: float | None) -> str:
    return "" if life is None else f"{life / 3600.0:.4g}"


def _number(factors: ByName, name: str) -> str:
    return f"{factors[name]:.4g}{' N' if name == 'P' else ''}" if name in factors else ""


def main_tables(rating: CaseRating) -> list[RatingTable]:
    """Verdict, damage by load case and lives of bearings, as far as there are any."""
    tables = verdict_table(rating), damage_table(rating), bearing_table(rating)
    return [each for each in tables if each.rows]


def factor_tables(rating: CaseRating) -> Iterator[RatingTable]:
    """Every factor with its value, its source and the branch taken, by mesh and part."""
    for each in rating.ratings:
        title = f"{each.mesh}, {each.load}: {' and '.join(each.gears)}"
        yield RatingTable(title, _HEAD, _factors(each))
    for bearing in rating.parts.bearings:
        for life in bearing.lives:
            title = f"bearing {bearing.bearing}, {life.load}"
            yield RatingTable(title, _HEAD, [_factor(n, f) for n, f in life.factors.items()])
    for notch in rating.parts.notches:
        title = f"shaft {notch.shaft}, notch {notch.notch}, {notch.load}"
        yield RatingTable(title, _HEAD, [_factor(n, f) for n, f in notch.factors.items()])


def _factors(rating: MeshRating) -> list[tuple[str, ...]]:
    """Rows of all factors of a mesh, then those of its gears."""
    standard = rating.standard
    rows = [_factor(name, factor) for name, factor in standard.factors.items()]
    for gear, each in zip(rating.gears, standard.gears.values(), strict=True):
        extra = {name: f for name, f in each.factors.items() if standard.factors.get(name) is not f}
        rows += [_factor(f"{name} of {gear}", factor) for name, factor in extra.items()]
    computed = rating.computed
    rows += [
        (f"{name} computed", f"{computed.factors[name]:.6g}", "", "motion and load of the run", "")
        for name in computed.overridden
    ]
    worn = {role: {"wear_depth": depth} for role, depth in rating.wear_depth.items()}
    for source, figures in (
        ("root by finite elements", rating.root_stress),
        ("stress and hardness below the flank", rating.exposure),
        ("Archard with the load of the worn flanks", worn),
    ):
        for role, gear in zip(standard.gears, rating.gears, strict=True):
            for name, value in figures.get(role, {}).items():
                unit = next((u for ending, u in _UNITS.items() if name.endswith(ending)), "")
                label = f"{name.replace('_', ' ')} of {gear}"
                rows.append((label, f"{value:.6g}", unit, source, ""))
    return rows


#: Units of computed figures by the end of their names.
_UNITS = {"stress": "Pa", "depth": "m", "path": "m"}


def _factor(name: str, factor: Any) -> tuple[str, ...]:
    return name, f"{float(factor):.6g}", factor.unit, factor.source, factor.branch


def sentences(rating: CaseRating) -> list[str]:
    """What limits the design and what would help, the life of the bearings, what is not rated."""
    lines = [limits_in_words(rating)] if rating.verdicts() else []
    for mode in ("scuffing", "micropitting"):
        name = f"{mode}_safety{'_flash' if mode == 'scuffing' else ''}"
        if rating.ratings and all(getattr(r.standard, name) is None for r in rating.ratings):
            lines.append(f"{mode.capitalize()} is not rated: state rating.{mode}_load_stage.")
    if (life := rating.system_life) is not None:
        rated = [each for each in rating.parts.bearings if each.life is not None]
        lines.append(f"Life of {len(rated)} bearings together: {_hours(life)} h.")
    reasons: dict[str, list[str]] = {}
    for each in rating.parts.bearings:
        if each.reason:
            reasons.setdefault(each.reason, []).append(each.bearing)
    for reason, names in reasons.items():
        plural = "s" if len(names) > 1 else ""
        lines.append(f"Bearing{plural} {', '.join(names)}: {reason}.")
    return lines


def limits_in_words(rating: CaseRating) -> str:
    """What limits the design, and what would help."""
    verdicts = rating.verdicts()
    first = verdicts[0]
    place = f"{first.mode} of {first.part} under {first.load}"
    lacking = [verdict for verdict in verdicts if verdict.margin < 0.0]
    if not lacking:
        reserve = f"its safety {first.safety:.3f} is {100.0 * first.margin:.1f} % above"
        text = f"{place}: {reserve} the required one."
        return (
            f"All safeties suffice. The design is limited by {text}{_by_computed_loads(verdicts)}"
        )
    text = f"{len(lacking)} of {len(verdicts)} safeties are too low. The design is limited by "
    text += f"{place}: safety {first.safety:.3f}, required {first.required:g}. It would help: "
    return f"{text}{_REMEDIES[first.mode]}."


def _by_computed_loads(verdicts: list[Verdict]) -> str:
    """Sentence on safeties that the standard finds sufficient and computed loads too low."""
    lacking = [v for v in verdicts if v.computed is not None and v.computed < v.required]
    if not lacking:
        return ""
    worst = min(lacking, key=lambda v: (v.computed or 0.0) / v.required)
    return (
        f" By computed loads {len(lacking)} of {len(verdicts)} are too low: {worst.mode} of "
        f"{worst.part} under {worst.load} has {worst.computed:.3f}. It would help: "
        f"{_REMEDIES[worst.mode]}."
    )
