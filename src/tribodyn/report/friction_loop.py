"""What friction that follows the dynamic load changes, beside friction of the nominal load."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from tribodyn.report.numbers import Number, describe

_ENDING = "_nominal_friction"


@dataclass(frozen=True)
class Compared:
    """One figure with friction in the loop and without."""

    own: Number
    nominal: Number
    change: str  #: change of the former from the latter, with its sign [%]


def compared_friction(summary: Mapping[str, float]) -> list[Compared]:
    """Put the comparison with nominal friction into words."""
    found = []
    for name, nominal in summary.items():
        own = name.removesuffix(_ENDING)
        if own != name and own in summary:
            found.append(
                Compared(describe(own, summary[own]), describe(name, nominal),
                         _change(float(summary[own]), float(nominal)))
            )  # fmt: skip
    return found


def _change(own: float, nominal: float) -> str:
    """Write the relative change, or a dash where there is nothing to relate it to."""
    return f"{100.0 * (own - nominal) / abs(nominal):+.3f} %" if nominal else "–"
