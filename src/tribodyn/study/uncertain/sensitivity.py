"""Which tolerance of a case the spread of its figures comes from: Sobol indices of the summary."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.errors import Argument, ComputationError, InputError, did_you_mean
from tribodyn.nomenclature import require_whole
from tribodyn.nonlinear.parameter_map import SCALES
from tribodyn.progress import SILENT, Progress
from tribodyn.record import Record, fact, quantity, record
from tribodyn.study.pipeline.summary_figures import SUMMARY, in_order, is_figure
from tribodyn.study.studies.sweep_result import OF_PARTS, SHOWN
from tribodyn.study.uncertain.lanes import distributions_of, points_of_values, successful
from tribodyn.types import Array, Texts, Tree
from tribodyn.uncertainty import sobol_indices as indices_of

if TYPE_CHECKING:
    from tribodyn.study.machine.case import AnyCase

#: Probability of the intervals of the indices.
_LEVEL = 0.95
#: Spread of a figure relative to its size that counts as none.
_STILL = 1e-12


@record
class CaseSensitivity(Record):
    """Shares of the variance of figures of a case by key.

    Parameters
    ----------
    figure : (m,) array of str
        Figures of the summary.
    input : (k,) array of str
        Keys of the case that have tolerances.
    first_order : (m, k) array
        Share that the key causes alone [-].
    total_order : (m, k) array
        Share that would be gone if the key had no tolerance, interactions included [-].
    first_order_band, total_order_band : (m, 2, k) array
        Lower and upper end of 95 % bootstrap intervals of both [-].
    mean, standard_deviation : (m,) array
        Of each figure over the samples, in SI.
    value : (n, k) array
        What was drawn, in SI.
    sample : (n, m) array
        Figures of every sample, in SI.
    seed : int
        Of the sample.
    title : str
        Title of the case.
    """

    figure: Texts = quantity("figure", axis=True, unit="", name="figure")
    input: Texts = quantity("input", axis=True, unit="", name="input")
    first_order: Array = quantity("figure", "input", unit="1")
    total_order: Array = quantity("figure", "input", unit="1")
    first_order_band: Array = quantity("figure", "end", "input", unit="1")
    total_order_band: Array = quantity("figure", "end", "input", unit="1")
    mean: Array = quantity("figure", unit="")
    standard_deviation: Array = quantity("figure", unit="")
    value: Array = quantity("variant", "input", unit="")
    sample: Array = quantity("variant", "figure", unit="")
    seed: int = fact()
    title: str = fact()

    def __repr__(self) -> str:
        """One line."""
        largest = [str(self.input[int(row.argmax())]) for row in self.total_order]
        drivers = ", ".join(f"{n}: {k}" for n, k in zip(self.figure, largest, strict=True))
        return f"CaseSensitivity({len(self.value)} variants; most of the spread: {drivers})"


def sobol_indices(
    case: AnyCase,
    figures: str | Sequence[str] | None = None,
    distributions: Mapping[str, object] | None = None,
    size: int = 64,
    *,
    seed: int,
    progress: Progress = SILENT,
) -> CaseSensitivity:
    """Share the variance of summary figures of a case among its keys with tolerances.

    Parameters
    ----------
    case : Case
        From :func:`tribodyn.load_case`.
    figures : str or sequence of str, optional
        Figures of the summary; by default those that a sweep shows, as far as they vary.
    distributions : mapping, optional
        Keys with their tolerances, as :func:`tribodyn.uncertainty.sample` reads them:
        ``{"operation.torque": "90 N*m +- 5 %"}``. By default those that the case itself spreads.
    size : int
        Size of the Sobol sequence, a power of two: the case is computed ``size`` times the number
        of keys and two more.
    seed : int
        The same seed gives the same indices.
    progress : Progress
        Receives the number of finished variants; silent by default.

    Returns
    -------
    CaseSensitivity

    Raises
    ------
    InputError
        If fewer than two keys are spread, a key or a figure is unknown, or the size is no power of
        two.
    ComputationError
        If a variant cannot be computed, or a requested figure does not vary.

    Notes
    -----
    :func:`tribodyn.uncertainty.sobol_indices` of every figure, over the same runs.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("time-varying-friction")
    >>> case = case.replace({"friction.law": "constant", "friction.coefficient": 0.05})
    >>> spread = {"operation.torque": "80 N*m +- 2 %", "friction.coefficient": "0.05 +- 2 %"}
    >>> found = sobol_indices(case, "mean_friction_power", spread, 8, seed=1)
    >>> found.total_order.shape, len(found.value)
    ((1, 2), 32)
    """
    spread = dict(case.uncertain if distributions is None else distributions)
    if not spread:
        remedy = 'Give {"operation.torque": "90 N*m +- 5 %"}, or write such a text into the case'
        why = "Shares of a variance need keys with tolerances"
        raise InputError("nothing is spread", Argument("distributions"), why, remedy)
    if len(spread) == 1:
        what, why = f"only {next(iter(spread))} is spread", "All of the variance comes from it"
        remedy = "Spread two keys or more; an ensemble draws bands of one"
        raise InputError(what, Argument("distributions"), why, remedy)
    if factors := [key for key in spread if key in SCALES]:
        what, why = f"{', '.join(factors)} cannot be spread", "Every variant is a case of its own"
        raise InputError(what, Argument("distributions"), why, "Spread keys of the case")
    requested = [figures] if isinstance(figures, str) else list(figures or ())
    for name in requested:
        if not is_figure(name):
            why, remedy = "Figures are those of the summary", "See summary.json of a run"
            remedy = did_you_mean(name, list(SUMMARY), remedy)
            raise InputError(f'there is no figure "{name}"', Argument("figures"), why, remedy)
    runs = _Runs(case, distributions_of(case, spread), progress)
    progress.start("Variants", require_whole("size", size, 2) * (len(spread) + 2))
    first = indices_of(runs.numbers, runs.distributions, size, seed=seed)
    progress.finish()
    names = _varying(runs, requested)
    shares = [
        indices_of(runs.figure(name), runs.distributions, size, seed=seed, level=_LEVEL)
        for name in names
    ]
    sample = np.array([[figures[name] for name in names] for figures in runs.summaries.values()])
    return CaseSensitivity(
        figure=np.array(names),
        input=first.name,
        first_order=np.stack([each.first_order for each in shares]),
        total_order=np.stack([each.total_order for each in shares]),
        first_order_band=np.stack([np.asarray(each.first_order_band) for each in shares]),
        total_order_band=np.stack([np.asarray(each.total_order_band) for each in shares]),
        mean=sample.mean(axis=0),
        standard_deviation=sample.std(axis=0, ddof=1),
        value=np.array(list(runs.summaries)),
        sample=sample,
        seed=int(seed),
        title=case.title,
    )


class _Runs:
    """Summaries of a case by the values of its keys, each computed once."""

    def __init__(self, case: AnyCase, distributions: Tree, progress: Progress) -> None:
        self.case, self.distributions, self.progress = case, distributions, progress
        self.summaries: dict[tuple[float, ...], Mapping[str, float]] = {}

    def numbers(self, values: dict[str, Array]) -> Array:
        """Compute what is new; return numbers that vary."""
        rows = _rows(values)
        new = [row for row in dict.fromkeys(rows) if row not in self.summaries]
        columns = np.array(new).reshape(len(new), len(values)).T
        sampled = dict(zip(values, columns, strict=True))
        points = points_of_values(self.case, sampled, self.progress) if new else []
        why = "Shares of a variance need every variant"
        points = successful(points, "variants", "tolerances", len(points), why)
        self.summaries |= {row: point.figures for row, point in zip(new, points, strict=True)}
        return np.arange(len(rows), dtype=float)

    def figure(self, name: str) -> Callable[[dict[str, Array]], Array]:
        """Function of the values that returns one figure of the variants."""

        def values_of(values: dict[str, Array]) -> Array:
            return np.array([self.summaries[row][name] for row in _rows(values)])

        return values_of


def _rows(values: dict[str, Array]) -> list[tuple[float, ...]]:
    return [tuple(map(float, row)) for row in zip(*values.values(), strict=True)]


def _varying(runs: _Runs, requested: Sequence[str]) -> list[str]:
    """Figures that were requested; otherwise those of a sweep that vary, or all that do."""
    summaries = list(runs.summaries.values())
    shared = [name for name in in_order(summaries[0]) if all(name in s for s in summaries)]
    values = {name: np.array([each[name] for each in summaries]) for name in shared}
    vary = [
        name for name, each in values.items()
        if np.all(np.isfinite(each)) and np.ptp(each) > _STILL * float(np.abs(each).max())
    ]  # fmt: skip
    for name in requested:
        if name not in vary:
            kind = "does not vary" if name in shared else "is not in every summary"
            why = f"Figures that vary: {', '.join(vary)}"
            raise ComputationError(f"{name} {kind}", "", why, "Choose one of these")
    parts = [name for name in vary if name.rpartition(".")[2] in OF_PARTS]
    names = list(requested) or [name for name in SHOWN if name in vary] or parts or vary
    if not names:
        what, why = "no figure of the summary varies", "Shares of a variance need one above zero"
        raise ComputationError(what, "", why, "Widen the tolerances, or spread other keys")
    return names
