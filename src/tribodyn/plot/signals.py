"""Signals of a result on the fine samples of its response: three a step, jumps on both sides."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tribodyn.study import record

__all__ = ["acceleration", "bearing_force", "mesh_force", "transmission_error"]

Array = NDArray[np.float64]


def mesh_force(result: Any) -> Array:
    """Dynamic force along the line of action, all ramps of a force law together.

    Parameters
    ----------
    result : Result
        What :func:`tribodyn.run` returns.

    Returns
    -------
    array, shape (3 s,)
        Force [N].
    """
    return record.mesh_force(result.response.fine)


def transmission_error(result: Any) -> Array:
    """Dynamic transmission error, counted from first contact of the driving flank.

    Parameters
    ----------
    result : Result
        What :func:`tribodyn.run` returns.

    Returns
    -------
    array, shape (3 s,)
        Compression of the mesh, prescribed error included [m].
    """
    return record.transmission_error(result, result.response.fine)


def acceleration(result: Any, gear: str, axis: str) -> Array:
    """Acceleration of a gear's centre.

    Parameters
    ----------
    result : Result
        What :func:`tribodyn.run` returns.
    gear : str
        ``"pinion"`` or ``"wheel"``.
    axis : str
        ``"y"`` along the line of action, ``"x"`` across it.

    Returns
    -------
    array, shape (3 s,)
        Acceleration [m/s^2].
    """
    column = record.centre_column(result.response.names, gear, axis)
    return np.asarray(result.response.fine.acceleration[:, column])


def bearing_force(result: Any, gear: str, axis: str) -> Array:
    """Force of a gear on its support, from spring and damper together.

    Parameters
    ----------
    result : Result
        What :func:`tribodyn.run` returns.
    gear : str
        ``"pinion"`` or ``"wheel"``.
    axis : str
        ``"y"`` along the line of action, ``"x"`` across it.

    Returns
    -------
    array, shape (3 s,)
        Force [N].
    """
    column = record.centre_column(result.response.names, gear, axis)
    return record.support_forces(result.system, result.response.fine)[:, column]
