"""Probability that a part fails where the values of a case scatter: safeties of many variants."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.errors import Argument, InputError
from tribodyn.nomenclature import require_whole
from tribodyn.progress import SILENT, Progress
from tribodyn.record import Record, fact, quantity, record
from tribodyn.study.pipeline.summary_figures import split_key
from tribodyn.study.rated_parts import LIVES, SHAFT_SAFETY
from tribodyn.study.uncertain.lanes import draw, points_of_values, successful
from tribodyn.types import Array, Texts

if TYPE_CHECKING:
    from tribodyn.study.machine.case import AnyCase

#: Fewest variants.
_FEWEST = 8


@record
class FailureProbability(Record):
    """Safeties and lives of variants of a case against what is required.

    Parameters
    ----------
    figure : (m,) array of str
        Keys of safeties and lives in the summary.
    required : (m,) array
        Required safety, or required life [s].
    sample : (n, m) array
        Figures of the variants, in SI.
    share : (m,) array
        Share of the variants below what is required [-].
    probability : (m,) array
        Probability below it of the lognormal distribution of the sample [-].
    seed : int
        Of the sample.
    title : str
        Title of the case.
    """

    figure: Texts = quantity("figure", axis=True, unit="", name="figure")
    required: Array = quantity("figure", unit="")
    sample: Array = quantity("variant", "figure", unit="")
    share: Array = quantity("figure", unit="1")
    probability: Array = quantity("figure", unit="1")
    seed: int = fact()
    title: str = fact()

    def __repr__(self) -> str:
        """One line."""
        worst = int(np.argmax(self.probability))
        value = f"{self.figure[worst]} {100.0 * self.probability[worst]:.3g} %"
        return f"FailureProbability({len(self.sample)} variants; greatest: {value})"


def failure_probability(
    case: AnyCase,
    distributions: Mapping[str, object] | None = None,
    size: int = 64,
    *,
    seed: int,
    progress: Progress = SILENT,
) -> FailureProbability:
    """Probability that safeties and lives of a case fall below what is required.

    Parameters
    ----------
    case : Case
        With ``[rating]``; a machine is rated at its operating point.
    distributions : mapping, optional
        Keys with their tolerances, as :func:`tribodyn.uncertainty.sample` reads them, such as
        ``{"materials.steel.pitting_limit": "1500 MPa +- 4 %"}``. By default those that the case
        itself spreads.
    size : int
        Variants, drawn by Latin hypercube.
    seed : int
        The same seed gives the same variants.
    progress : Progress
        Receives the number of finished variants; silent by default.

    Returns
    -------
    FailureProbability

    Raises
    ------
    InputError
        If the case has no ``[rating]``, or nothing is spread.
    ComputationError
        If too few variants can be computed.

    Notes
    -----
    The strengths of ISO 6336-5 are those of 1 % damage: a sample about them is conservative.
    """
    if not case.is_rated:
        why = "Safeties need materials and the oil"
        raise InputError("the case has no table [rating]", Argument("case"), why, "Add [rating]")
    spread = dict(case.uncertain if distributions is None else distributions)
    if not spread:
        remedy = 'Give {"operation.torque": "90 N*m +- 5 %"}, or write such a text into the case'
        raise InputError("nothing is spread", Argument("distributions"), "", remedy)
    count = require_whole("size", size, _FEWEST)
    values = draw(case, spread, count, method="latin-hypercube", seed=seed)
    progress.start("Variants", count)
    points = points_of_values(case, values, progress)
    progress.finish()
    good = [p.figures for p in successful(points, "variants", "tolerances", _FEWEST)]
    limits = {key: _required(case, key) for key in good[0] if all(key in each for each in good)}
    required = {key: limit for key, limit in limits.items() if limit is not None}
    sample = np.array([[figures[key] for key in required] for figures in good])
    below = np.array(list(required.values()))
    return FailureProbability(
        figure=np.array(list(required)),
        required=below,
        sample=sample,
        share=(sample < below).mean(axis=0),
        probability=_lognormal(sample, below),
        seed=int(seed),
        title=case.title,
    )


def _required(case: Any, key: str) -> float | None:
    """Least value of a figure of a rating; None of other figures."""
    from tribodyn.rating import RatingConditions

    rating, name = case.rating if case.lumped else case.rated_parts.rating, split_key(key)[3]
    if name in LIVES:
        required_life: float | None = rating.required_life
        return required_life
    if name in ("fatigue_safety", "yield_safety"):
        return rating.minimum_safety or SHAFT_SAFETY
    mode = name.removeprefix("computed_").partition("_safety")[0]
    default = getattr(RatingConditions(), f"{mode}_safety", None) if "_safety" in name else None
    return None if default is None else float(rating.minimum_safety or default)


def _lognormal(sample: Array, required: Array) -> Array:
    """Probability of a lognormal distribution with the moments of the sample below a value."""
    from scipy.stats import norm

    logarithms = np.log(sample)
    spread = logarithms.std(axis=0, ddof=1)
    distance = np.log(required) - logarithms.mean(axis=0)
    still = spread < 1e-12
    steps = distance / np.where(still, 1.0, spread)
    return np.asarray(np.where(still, distance > 0.0, norm.cdf(steps)), dtype=float)
