"""Every figure of a summary once: its name, its quantity in the nomenclature, its meaning."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from importlib.resources import files
from typing import TYPE_CHECKING

from tribodyn.model import Registry
from tribodyn.nomenclature import QUANTITIES
from tribodyn.units import format_quantity

if TYPE_CHECKING:
    from tribodyn.study.pipeline.result import Result

#: Computes a figure of a result in SI; None leaves it out.
Measure = Callable[["Result"], float | None]


@dataclass(frozen=True)
class SummaryFigure:
    """One figure of a summary."""

    name: str  #: key in the summary
    unit: str
    display_unit: str
    meaning: str  #: one line

    def show(self, value: float) -> str:
        """Write the value in the display unit with six digits."""
        if not self.unit:
            return f"{value:.6g}"
        number, _, unit = format_quantity(value, self.unit, self.display_unit).partition(" ")
        return f"{float(number):.6g} {unit}"


def _figure(name: str, quantity: str, meaning: str) -> SummaryFigure:
    known = QUANTITIES[quantity] if quantity else None
    unit, shown = (known.unit, known.display_unit) if known else ("", "")
    return SummaryFigure(name, unit, shown, meaning)


def _read() -> dict[str, SummaryFigure]:
    text = files("tribodyn.study.pipeline").joinpath("summary.toml").read_text(encoding="utf-8")
    rows = tomllib.loads(text).items()
    return {name: _figure(name, quantity, meaning) for name, (quantity, meaning) in rows}


#: All figures of :meth:`tribodyn.Result.summary` and ``tribodyn check`` by name.
SUMMARY: dict[str, SummaryFigure] = _read()
#: Figures of third parties: functions of a result, open through the entry points of this group.
MEASURES: Registry[Measure] = Registry("summary figure", "tribodyn.summary")


def summary_figure(name: str, *, meaning: str, of: str = "") -> Callable[[Measure], Measure]:
    """Decorate a function of a result to make it a figure of every summary.

    Parameters
    ----------
    name : str
        Key in the summary.
    meaning : str
        One line.
    of : str
        Its quantity in :data:`tribodyn.nomenclature.QUANTITIES`, which knows its unit; empty for a
        pure number.

    Returns
    -------
    callable
        Decorator that returns the function unchanged. The function takes a
        :class:`tribodyn.Result` and returns the figure in SI, or None where there is none.

    Examples
    --------
    >>> @summary_figure("teeth_of_both", meaning="teeth of both gears")  # doctest: +SKIP
    ... def teeth(result):
    ...     return result.case.gears.pinion.teeth + result.case.gears.wheel.teeth
    """

    def keep(measure: Measure) -> Measure:
        SUMMARY[name] = _figure(name, of, meaning)
        return MEASURES.register(name)(measure)

    return keep
