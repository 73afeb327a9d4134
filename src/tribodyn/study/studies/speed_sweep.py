"""Steady motions of a case over its speed, upwards and downwards."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.errors import InputError, collected
from tribodyn.progress import SILENT, Progress
from tribodyn.study.case.derive import placed
from tribodyn.study.studies.axes import read_axes
from tribodyn.study.studies.run_up import speed_systems, supports

if TYPE_CHECKING:
    from tribodyn.dynamics import SpeedSweep
    from tribodyn.study.case.case import Case

_SPEED = "operation.speed"


def speed_sweep(
    case: Case,
    between: tuple[Any, Any],
    points: int = 60,
    *,
    tables: int = 4,
    progress: Progress = SILENT,
    **options: Any,
) -> SpeedSweep:
    """Follow the steady motion of a case over its speed, up and down, with its jumps.

    Parameters
    ----------
    case : Case
        From :func:`tribodyn.load_case`.
    between : tuple
        Lowest and highest value of ``operation.speed``: floats in rad/s, or text with a unit.
    points : int
        Speeds, evenly spaced, the ends included.
    tables : int
        Speeds, evenly spaced in the logarithm, at which the tooth contact is computed; film and
        friction follow the speed between them in straight lines.
    progress : Progress
        Told how far the study has come; silent by default.
    **options : object
        ``directions``, ``steps``, ``periods``, ``patience`` and ``tolerance`` of
        :func:`tribodyn.dynamics.speed_sweep`.

    Returns
    -------
    SpeedSweep
        Its speed is that of the gear whose speed the case gives; bearing forces are outputs.

    Raises
    ------
    InputError
        If a speed is out of range, or the case cannot be computed there.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("fzg-roughness").replace({"stiffness.model": "analytic"})
    >>> found = speed_sweep(case, ("2000 rpm", "2100 rpm"), 2, tables=1)
    >>> (found.speed * 30 / np.pi).round(6).tolist()
    [2000.0, 2100.0]
    """
    from tribodyn.dynamics import speed_sweep as compute

    if int(tables) != tables or tables < 1:
        raise InputError(f"tables = {tables}", "argument tables", "A whole number >= 1")
    (axis,) = read_axes(case, {_SPEED: (*between, points)})
    speeds = np.array(axis.values, dtype=float)
    nodes = np.geomspace(speeds[0], speeds[-1], tables) if tables > 1 else [speeds.mean()]
    with placed(case), collected():
        systems, per_speed = speed_systems(case, nodes, progress)
        first = next(iter(systems.values()))
        return compute(
            systems if tables > 1 else first,
            per_speed * speeds,
            teeth=round(2.0 * np.pi * per_speed),
            outputs=supports(first),
            progress=progress,
            **options,
        )
