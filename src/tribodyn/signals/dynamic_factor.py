"""Dynamic factor of a mesh force, and how vibration falls on the two directions."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.errors import InputError, Problem, require_positive
from tribodyn.signals.spectrum_input import checked_signal


def dynamic_factor(mesh_force: Any, static_force: float) -> float:
    """Largest dynamic mesh force over the static one.

    Parameters
    ----------
    mesh_force : (n,) array
        Force along the line of action [N].
    static_force : float
        Force along the line of action at rest under the same torque [N].

    Returns
    -------
    float
        Dynamic factor [-]: 1 without vibration; above 2 the teeth may part.

    Raises
    ------
    InputError
        If the force is not finite or the static force not positive.

    Notes
    -----
    The factor K_v of ISO 6336-1 for a computed force: peak over nominal.

    Examples
    --------
    >>> dynamic_factor(1000.0 + 250.0 * np.cos(2 * np.pi * np.arange(32) / 32), 1000.0)
    1.25
    """
    require_positive("static_force", static_force, "N")
    return float(checked_signal(mesh_force, 2, "mesh_force").max()) / static_force


def direction_shares(along: Any, across: Any) -> tuple[float, float]:
    """Parts of the mean square of a vibration along and across the line of action.

    Parameters
    ----------
    along, across : (n,) array
        The same quantity in the two directions at the same samples, in the same unit.

    Returns
    -------
    tuple of two float
        Shares along (LOA) and across (OLOA) the line of action [-], which sum to 1; the means
        do not count. The root of their ratio is
        :func:`tribodyn.analysis.line_of_action_indicator`.

    Raises
    ------
    InputError
        If the signals differ in length, are not finite or do not vibrate at all.

    Examples
    --------
    >>> wave = np.cos(2 * np.pi * np.arange(32) / 32)
    >>> [round(share, 6) for share in direction_shares(2.0 * wave, 5.0 + wave)]
    [0.8, 0.2]
    """
    first = checked_signal(along, 2, "along")
    second = checked_signal(across, 2, "across")
    total = float(np.var(first) + np.var(second))
    if first.size != second.size or total == 0.0:
        raise InputError(
            Problem(
                what=f"{first.size} samples along and {second.size} across, with the variance "
                f"{total:g} together",
                where="arguments along and across",
                why="Both must be sampled alike, and one must vibrate",
            )
        )
    return float(np.var(first)) / total, float(np.var(second)) / total
