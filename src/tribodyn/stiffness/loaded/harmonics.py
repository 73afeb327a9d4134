"""Mesh harmonics of a periodic quantity on evenly spaced phases."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tribodyn.errors import InputError, Problem

__all__ = ["harmonic_amplitudes"]

FloatArray = NDArray[np.float64]


def harmonic_amplitudes(
    phase: FloatArray, values: FloatArray, mesh_cycles: int, count: int
) -> FloatArray:
    """Peak amplitudes of the orders 1, 2, ... of the mesh frequency.

    Parameters
    ----------
    phase : array (p,)
        Evenly spaced mesh phases over ``mesh_cycles`` cycles.
    values : array (..., p)
        What is analysed, in any unit.
    mesh_cycles : int
        Mesh cycles of one period.
    count : int
        Number of harmonics.

    Returns
    -------
    array (..., count)
        In the unit of the values.

    Raises
    ------
    InputError
        If there are too few phases, or they are not evenly spaced.

    Examples
    --------
    >>> phase = np.arange(16) / 16
    >>> harmonic_amplitudes(phase, 3.0 + 2.0 * np.cos(4.0 * np.pi * phase), 1, 3).round(12)
    array([0., 2., 0.])
    """
    even = np.arange(phase.size) * (mesh_cycles / phase.size) + phase[0]
    if not np.allclose(phase, even, rtol=0.0, atol=1e-9):
        raise InputError(
            Problem(
                what="mesh phases that are not evenly spaced",
                where="argument phases",
                why="Harmonics need evenly spaced phases over whole mesh cycles",
                remedy="Give the number of phases of a mesh cycle instead",
            )
        )
    if not 1 <= count < phase.size / (2 * mesh_cycles):
        raise InputError(
            Problem(
                what=f"count = {count}",
                where="argument count",
                why=f"{phase.size // mesh_cycles} phases of a mesh cycle have less than half as "
                "many harmonics",
                remedy="Give more phases, for example phases=64",
            )
        )
    spectrum = 2.0 * np.abs(np.fft.rfft(values, axis=-1)) / phase.size
    return np.asarray(spectrum[..., mesh_cycles * np.arange(1, count + 1)])
