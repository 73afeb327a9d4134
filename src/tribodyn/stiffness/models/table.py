"""Stiffness from a table: of the mesh over its phase, or of one pair over the roll angle."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from tribodyn.contact import path_of_contact
from tribodyn.errors import InputError, ModelOption, Problem, require_positive
from tribodyn.model import numbers
from tribodyn.monotone import monotone_cubic
from tribodyn.stiffness.model import MODELS, MeshState, share_equally
from tribodyn.types import Array

#: Roll angles of a table may fall short of A..E by this much [rad] (rounding in print).
_COVERAGE_TOLERANCE = 1e-6


def tabulated_stiffness(
    abscissa: Sequence[float] | Array,
    stiffness: Sequence[float] | Array,
    at: Array,
    *,
    name: str = "abscissa",
    unit: str = "",
) -> Array:
    """Interpolate a stiffness table without overshoot.

    Parameters
    ----------
    abscissa, stiffness : array (m,) [unit], [N/m]
        Strictly increasing, at least two values; positive values.
    at : array [unit]
        Where to evaluate; clipped to the table within rounding.
    name, unit : str
        Name and unit of the abscissa in messages.

    Returns
    -------
    array [N/m]
        Shape of ``at``.

    Raises
    ------
    InputError
        If the lengths differ, a value is not finite, the abscissa does not increase, a stiffness
        is not positive or the table does not cover ``at``.

    Notes
    -----
    A monotone piecewise cubic, Fritsch and Carlson (1980), SIAM J. Numer. Anal. 17, 238-246.
    Source: the user's table.

    Examples
    --------
    >>> tabulated_stiffness([0.0, 0.5, 1.0], [1e8, 2e8, 1e8], np.array([0.0, 0.5]))
    array([1.e+08, 2.e+08])
    """
    x = np.asarray(abscissa, dtype=float)
    y = np.asarray(stiffness, dtype=float)
    problems = [*(_shape_problems(x, y, name) or _order_problems(x, name, unit))]
    if problems:
        raise InputError(problems)
    require_positive("stiffness of the table", y, "N/m")
    low, high = float(np.min(at)), float(np.max(at))
    if low < x[0] - _COVERAGE_TOLERANCE or high > x[-1] + _COVERAGE_TOLERANCE:
        raise InputError(
            f"the table covers {name} {x[0]:.6g} to {x[-1]:.6g} {unit}".rstrip(),
            where=ModelOption("stiffness", "table", name),
            why=f"The mesh needs {low:.6g} to {high:.6g} {unit}".rstrip(),
            remedy="Extend the table to the whole contact; nothing is extrapolated",
        )
    return monotone_cubic(x, y)(np.clip(at, x[0], x[-1]))


def _shape_problems(x: Array, y: Array, name: str) -> list[Problem]:
    if x.ndim == 1 and x.shape == y.shape and x.size >= 2:
        return []
    return [
        Problem(
            what=f"{name} has shape {x.shape}, the stiffness has shape {y.shape}",
            where=ModelOption("stiffness", "table"),
            why="A table is two lists of equal length with at least two values",
            remedy="Give one stiffness for every entry of the abscissa",
        )
    ]


def _order_problems(x: Array, name: str, unit: str) -> list[Problem]:
    bad = np.flatnonzero(~np.isfinite(x))
    if bad.size:
        return [
            Problem(
                what=f"entry {bad[0] + 1} of {name} is {x[bad[0]]}",
                where=ModelOption("stiffness", "table", name),
                why="Every entry must be a finite number",
                remedy="Remove or correct the row",
            )
        ]
    falling = np.flatnonzero(np.diff(x) <= 0.0)
    if falling.size:
        first = falling[0]
        text = f"{x[first]:.6g} is followed by {x[first + 1]:.6g} {unit}".rstrip()
        return [
            Problem(
                what=f"{text} at entry {first + 2} of {name}",
                where=ModelOption("stiffness", "table", name),
                why=f"{name} must increase strictly",
                remedy="Sort the table and remove repeated rows",
            )
        ]
    return []


def _named_values(options: dict[str, Any]) -> dict[str, Any]:
    """Call bare values by what their abscissa makes of them."""
    options = dict(options)
    values = options.pop("values", None)
    if values is not None:
        name = "mesh_stiffness" if options.get("phase") is not None else "pair_stiffness"
        options[name] = values
    return options


def _over_roll_angle(state: MeshState, options: dict[str, Any]) -> Array:
    pair, path, in_contact = state.pair, state.path, state.in_contact
    ends = path_of_contact(pair).roll_angles
    radius = pair.driving.base_radius
    from_tangent_point = path if pair.driver == "pinion" else pair.line_of_action_length - path
    needed = np.concatenate(([ends["A"], ends["E"]], from_tangent_point[in_contact] / radius))
    values = tabulated_stiffness(
        options["roll_angle"], options["pair_stiffness"], needed, name="roll_angle", unit="rad"
    )
    stiffness = np.zeros(path.shape)
    stiffness[in_contact] = values[2:]
    return stiffness


_STIFFNESS = (0.0, 1e13, "guards against a wrong unit")
_OPTIONS = {
    "phase": numbers(
        0.0, 1.0, "one mesh cycle", of="mesh_phase", meaning="mesh phases of the table"
    ),
    "roll_angle": numbers(
        0.0, 2.0 * np.pi, "less than one turn", of="roll_angle", meaning="roll angles of the table"
    ),
    "values": numbers(*_STIFFNESS, of="mesh_stiffness", meaning="stiffness values of the table"),
    # What the values are called where a program gives them with their abscissa.
    "mesh_stiffness": numbers(*_STIFFNESS, of="mesh_stiffness", in_case=False),
    "pair_stiffness": numbers(*_STIFFNESS, of="pair_stiffness", in_case=False),
}


@MODELS.define(
    "table",
    options=_OPTIONS,
    meaning="stiffness given as a table over the mesh phase or the roll angle",
)
def _model(*mesh: Any, **options: Any) -> Array:
    state, options = MeshState(*mesh), _named_values(options)
    given = {name for name, value in options.items() if value is not None}
    if given == {"phase", "mesh_stiffness"}:
        whole_cycle = np.concatenate(([0.0, 1.0], state.phase))
        total = tabulated_stiffness(
            options["phase"], options["mesh_stiffness"], whole_cycle, name="phase"
        )
        return share_equally(total[2:], state.in_contact)
    if given == {"roll_angle", "pair_stiffness"}:
        return _over_roll_angle(state, options)
    raise InputError(
        f"given: {', '.join(sorted(given)) or 'nothing'}",
        where=ModelOption("stiffness", "table"),
        why="A table is phase with mesh_stiffness, or roll_angle (of the driving gear) with "
        "pair_stiffness",
        remedy="Give one of the two forms, complete and alone",
    )
