"""Where a search begins: the static equilibrium at mean stiffness."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tribodyn.dynamics.march import Compiled

__all__ = ["static_start"]


def static_start(compiled: Compiled) -> NDArray[np.float64]:
    """State at rest under the mean loads, every contact on its driving flank.

    Parameters
    ----------
    compiled : Compiled

    Returns
    -------
    (2 n,) array
        Position and zero velocity; free motions are left at zero.

    Examples
    --------
    >>> from tribodyn.dynamics import Contact, System
    >>> from tribodyn.dynamics.march import compile_for
    >>> pair = Contact([1.0], stiffness=2.0, gap=1.0)
    >>> static_start(compile_for(System([[1.0]], [[0.0]], [[0.0]], [0.5], [pair]), 1.0, 8))
    array([1.25, 0.  ])
    """
    system, nodes = compiled.system, compiled.nodes
    weight = nodes.weight
    outer = np.einsum("rsji,rsjk->rsjik", nodes.force_direction, nodes.direction)
    stiffness = system.stiffness + np.einsum("rs,rsj,rsjik->ik", weight, nodes.stiffness, outer)
    shift = nodes.stiffness * (nodes.error + nodes.gap)
    force = np.einsum("rs,rsi->i", weight, nodes.force)
    force = force + np.einsum("rs,rsj,rsji->i", weight, shift, nodes.force_direction)
    # Least squares in mass-weighted coordinates: free motions get no displacement.
    scale = 1.0 / np.sqrt(np.diag(np.asarray(system.mass)))
    matrix = stiffness * np.outer(scale, scale)
    position = scale * np.linalg.lstsq(matrix, scale * force, rcond=1e-12)[0]
    return np.concatenate((position, np.zeros(system.size)))
