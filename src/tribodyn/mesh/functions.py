"""What the dynamics reads from the mesh: a few functions of the mesh phase."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["MeshFunctions"]

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class MeshFunctions:
    """What a dynamic model reads from the mesh: smooth functions of phase between the events.

    Parameters
    ----------
    stiffness : callable
        Mesh stiffness [N/m].
    friction_sum : callable
        Sum over the pairs of sliding direction, friction coefficient and load share.
    friction_moment_pinion, friction_moment_wheel : callable
        The same sum, each pair with its lever, the radius of curvature of that gear [m].
    event_phases : tuple of float
        Phases at which the functions jump; they return the value after the jump.
    """

    stiffness: Callable[[FloatArray | float], FloatArray]
    friction_sum: Callable[[FloatArray | float], FloatArray]
    friction_moment_pinion: Callable[[FloatArray | float], FloatArray]
    friction_moment_wheel: Callable[[FloatArray | float], FloatArray]
    event_phases: tuple[float, ...]
