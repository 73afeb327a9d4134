"""Every figure of a summary once: its name, its quantity in the nomenclature, its meaning."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from importlib.resources import files

from tribodyn.nomenclature import QUANTITIES
from tribodyn.units import format_quantity


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


def _read() -> dict[str, SummaryFigure]:
    text = files("tribodyn.study.pipeline").joinpath("summary.toml").read_text(encoding="utf-8")
    figures = {}
    for name, (quantity, meaning) in tomllib.loads(text).items():
        known = QUANTITIES[quantity] if quantity else None
        unit, shown = (known.unit, known.display_unit) if known else ("", "")
        figures[name] = SummaryFigure(name, unit, shown, meaning)
    return figures


#: All figures of :meth:`tribodyn.Result.summary` and ``tribodyn check`` by name.
SUMMARY: dict[str, SummaryFigure] = _read()
