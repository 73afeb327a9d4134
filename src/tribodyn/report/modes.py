"""The table of natural frequencies and critical speeds."""

from __future__ import annotations

from typing import Any

from tribodyn.plot.look.labels import display_unit, displayed, significant
from tribodyn.study.studies.modes import ORDERS, Mode, mode_rows

#: Head of the table, in reports and on the screen.
HEAD = (
    "Mode", f"Frequency [{display_unit('frequency')}]", "Damping [%]", "Moves", "Strained",
    *(f"{display_unit('speed')} at harmonic {order}" for order in ORDERS),
)  # fmt: skip


def cells(mode: Mode) -> list[str]:
    """One mode as it is printed."""
    speeds = (significant(float(displayed("speed", speed)), 4) for speed in mode.speeds)
    damping = significant(100.0 * mode.damping_ratio, 3)
    return [str(mode.number), significant(mode.frequency, 4), damping, mode.moves, mode.strains,
            *speeds]  # fmt: skip


def modes_table(result: Any) -> list[list[str]]:
    """All elastic modes of a result."""
    rows = mode_rows(result.natural_modes, result.case, result.mesh.mesh_frequency)
    return [cells(row) for row in rows]
