"""Mesh harmonics of a periodic quantity on evenly spaced phases."""

from __future__ import annotations

import numpy as np

from tribodyn.errors import Argument, InputError, Problem
from tribodyn.types import Array


def harmonic_amplitudes(phase: Array, values: Array, mesh_cycles: int, count: int) -> Array:
    """Peak amplitudes of the orders 1, 2, ... of the mesh frequency."""
    even = np.arange(phase.size) * (mesh_cycles / phase.size) + phase[0]
    if not np.allclose(phase, even, rtol=0.0, atol=1e-9):
        raise InputError(
            Problem(
                what="mesh phases that are not evenly spaced",
                where=Argument("phases"),
                why="Harmonics need evenly spaced phases over whole mesh cycles",
                remedy="Give the number of phases of a mesh cycle instead",
            )
        )
    if not 1 <= count < phase.size / (2 * mesh_cycles):
        raise InputError(
            Problem(
                what=f"count = {count}",
                where=Argument("count"),
                why=f"{phase.size // mesh_cycles} phases of a mesh cycle have less than half as "
                "many harmonics",
                remedy="Give more phases, for example phases=64",
            )
        )
    spectrum = 2.0 * np.abs(np.fft.rfft(values, axis=-1)) / phase.size
    return np.asarray(spectrum[..., mesh_cycles * np.arange(1, count + 1)])
