"""``tribodyn rate``."""

from __future__ import annotations

import warnings
from typing import Annotated, Any

from cyclopts import Parameter

from tribodyn.cli.console import say, say_json, show_warnings, table
from tribodyn.cli.settings import CaseName, Flag, Settings, changed_any_case
from tribodyn.errors import InputError, ModelWarning
from tribodyn.study.rating_summary import RatingTable, factor_tables, main_tables, sentences


def rate(
    case: CaseName,
    /,
    *,
    set_: Settings = None,
    all_: Annotated[bool, Parameter(name="--all", negative="")] = False,
    json: Flag = False,
    variants: int = 0,
    seed: int = 0,
) -> None:
    """Rate gears, bearings and shafts of a case: ISO 6336, ISO 281, ISO/TS 16281, DIN 743.

    Parameters
    ----------
    all_ : bool
        Print every factor with its value, source and the branch taken.
    json : bool
        Write safeties and factors in SI as one JSON object to stdout.
    variants : int
        Print the probability of failure over so many variants of the tolerances of the case.
    seed : int
        The same seed gives the same variants.
    """
    from tribodyn.cases.load import run as compute
    from tribodyn.cli.progress_bar import progress_bar

    ready = changed_any_case(case, set_ or [])
    if not ready.is_rated:
        remedy = 'Add [rating] with required_life = "20000 h", and strengths in [materials.NAME]'
        raise InputError("the case has no table [rating]", case, "", remedy)
    if variants:
        _probabilities(ready, variants, seed, json=json)
        return
    with progress_bar() as progress, warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        rating = compute(ready, progress).rating
        progress.finish()
    if rating is None:
        why = "Cylindrical gears with computed teeth, bearings and shafts are rated"
        remedy = "Give bearings dynamic_load_rating or shafts notches, or remove [rating]"
        raise InputError("nothing of the case can be rated", case, why, remedy)
    if json:
        say_json(rating.to_dict())
        return
    conditions = rating.ratings[0].standard.conditions if rating.ratings else None
    say(f"{ready.title}{f': ISO 6336:{conditions.edition}' if conditions else ''}")
    for each in main_tables(rating):
        _say(each)
    for line in sentences(rating):
        say(line)
    for each in factor_tables(rating) if all_ else ():
        _say(each)
    show_warnings(rating.warnings)


def _probabilities(ready: Any, variants: int, seed: int, *, json: bool) -> None:
    """Print the probability that each safety or life is too small."""
    from tribodyn.cli.progress_bar import progress_bar
    from tribodyn.study.pipeline.summary_figures import figure_of, in_words
    from tribodyn.study.uncertain.failure_probability import failure_probability

    with progress_bar() as progress, warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        result = failure_probability(ready, size=variants, seed=seed, progress=progress)
    columns = result.required, result.sample.mean(axis=0), result.share, result.probability
    names = "required", "mean", "share_below", "probability"
    table_of = {
        str(key): dict(zip(names, map(float, row), strict=True))
        for key, *row in zip(result.figure, *columns, strict=True)
    }
    if json:
        say_json(table_of)
        return
    rows: list[tuple[str, ...]] = [
        ("figure", "required", "mean", "share below", "probability of failure")
    ]
    for key, each in table_of.items():
        values = (figure_of(key).show(each[name]) for name in names[:2])
        # the tail of a fitted distribution says no more than that it is rare
        rare = "below 1e-6 %" if 0.0 < each["probability"] < 1e-8 else ""
        shares = (f"{100.0 * each[name]:.3g} %" for name in names[2:])
        share, probability = shares
        rows.append((in_words(key), *values, share, rare or probability))
    say(table(rows))


def _say(each: RatingTable) -> None:
    """Print a table under its title."""
    say(f"\n{each.title}")
    say(table([each.head, *each.rows]))
