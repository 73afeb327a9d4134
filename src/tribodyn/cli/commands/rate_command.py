"""``tribodyn rate``."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from tribodyn.cli.console import say, say_json, show_warnings, table
from tribodyn.cli.settings import CaseName, Flag, Settings, changed_any_case
from tribodyn.errors import InputError, ModelWarning

if TYPE_CHECKING:
    from tribodyn.study.rating import CaseRating, Verdict


def rate(
    case: CaseName,
    /,
    *,
    set_: Settings = None,
    all_: Annotated[bool, Parameter(name="--all", negative="")] = False,
    json: Flag = False,
) -> None:
    """Rate the gears of a case: pitting, bending, scuffing and micropitting by ISO 6336.

    Parameters
    ----------
    all_ : bool
        Print every factor with its value, source and the branch taken.
    json : bool
        Write safeties and factors in SI as one JSON object to stdout.
    """
    from tribodyn.cases.load import run as compute
    from tribodyn.cli.progress_bar import progress_bar

    ready = changed_any_case(case, set_ or [])
    if not ready.is_rated:
        remedy = 'Add [rating] with required_life = "20000 h", and strengths in [materials.NAME]'
        raise InputError("the case has no table [rating]", case, "", remedy)
    with progress_bar() as progress, warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        rating = compute(ready, progress).rating
        progress.finish()
    if rating is None:
        why = "Only meshes of cylindrical gears with computed teeth are rated"
        raise InputError("no mesh of the case can be rated", case, why, "Remove [rating]")
    if json:
        say_json(rating.to_dict())
        return
    verdicts = rating.verdicts()
    head = ("mode of failure", "part", "safety", "required", "margin", "computed loads", "load")
    say(f"{ready.title}: ISO 6336:{rating.ratings[0].standard.conditions.edition}")
    say(table([head, *(_row(verdict) for verdict in verdicts)]))
    say(limits_in_words(rating))
    if all_:
        for each in rating.ratings:
            say(f"\n{each.mesh}, {each.load}: {' and '.join(each.gears)}")
            say(table([("factor", "value", "unit", "source", "branch"), *_factors(each)]))
    show_warnings([warning for each in rating.ratings for warning in each.standard.warnings])


def _row(verdict: Verdict) -> tuple[str, ...]:
    computed = "" if verdict.computed is None else f"{verdict.computed:.3f}"
    margin = f"{100.0 * verdict.margin:+.1f} %"
    numbers = f"{verdict.safety:.3f}", f"{verdict.required:g}", margin, computed
    return verdict.mode, verdict.part, *numbers, verdict.load


def _factors(rating: Any) -> list[tuple[str, ...]]:
    """Rows of all factors of a mesh, then those of its gears."""
    standard = rating.standard
    rows = [_factor(name, factor) for name, factor in standard.factors.items()]
    for gear, each in zip(rating.gears, standard.gears.values(), strict=True):
        own = {name: f for name, f in each.factors.items() if standard.factors.get(name) is not f}
        rows += [_factor(f"{name} of {gear}", factor) for name, factor in own.items()]
    computed = rating.computed
    rows += [
        (f"{name} computed", f"{computed.factors[name]:.6g}", "", "motion and load of the run", "")
        for name in computed.overridden
    ]
    for role, gear in zip(standard.gears, rating.gears, strict=True):
        for name, value in rating.root_stress.get(role, {}).items():
            unit = "Pa" if name.endswith("stress") else ""
            label = f"{name.replace('_', ' ')} of {gear}"
            rows.append((label, f"{value:.6g}", unit, "root by finite elements", "beside Y_F Y_S"))
    return rows


def _factor(name: str, factor: Any) -> tuple[str, ...]:
    return name, f"{float(factor):.6g}", factor.unit, factor.source, factor.branch


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
}


def limits_in_words(rating: CaseRating) -> str:
    """What limits the design, and what would help."""
    verdicts = rating.verdicts()
    first = verdicts[0]
    place = f"{first.mode} of {first.part} under {first.load}"
    lacking = [verdict for verdict in verdicts if verdict.margin < 0.0]
    if not lacking:
        reserve = f"its safety {first.safety:.3f} is {100.0 * first.margin:.1f} % above"
        return (
            f"All safeties suffice. The design is limited by {place}: {reserve} the required one."
        )
    text = f"{len(lacking)} of {len(verdicts)} safeties are too low. The design is limited by "
    text += f"{place}: safety {first.safety:.3f}, required {first.required:g}. It would help: "
    return f"{text}{_REMEDIES[first.mode]}."
