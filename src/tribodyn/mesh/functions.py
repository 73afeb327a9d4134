"""What the dynamics reads from the mesh: a few functions of the mesh phase."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.errors import InputError, Problem
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.mesh.force_law import MeshForceLaw


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
    tangent_stiffness : callable, optional
        Slope of the force law at the nominal load [N/m].
    static_transmission_error : callable, optional
        Deflection under the nominal load at rest [m].
    total_normal_force : float, optional
        Nominal load along the line of action [N].
    force_law : MeshForceLaw, optional
        Force over deflection at every phase.
    """

    stiffness: Callable[[Array | float], Array]
    friction_sum: Callable[[Array | float], Array]
    friction_moment_pinion: Callable[[Array | float], Array]
    friction_moment_wheel: Callable[[Array | float], Array]
    event_phases: tuple[float, ...]
    tangent_stiffness: Callable[[Array | float], Array] | None = None
    static_transmission_error: Callable[[Array | float], Array] | None = None
    total_normal_force: float | None = None
    force_law: MeshForceLaw | None = None

    def tangent_error(self, phase: Array | float) -> Array:
        """Error that makes the tangent stiffness deflect like the force law at the nominal load.

        Parameters
        ----------
        phase : float or array
            Mesh phase.

        Returns
        -------
        array [m]
            Static transmission error less the load over the tangent stiffness: the tangent to the
            force law meets zero force at this deflection.

        Raises
        ------
        InputError
            If the mesh has no force law.
        """
        tangent, static = self.tangent_stiffness, self.static_transmission_error
        if tangent is None or static is None or self.total_normal_force is None:
            raise InputError(
                Problem(
                    what="this mesh has no tangent stiffness",
                    where="argument mesh_force",
                    why="Tangent stiffness and static transmission error come from a loaded tooth "
                    "contact",
                    remedy='Take such a stiffness model, or mesh_force = "stiffness"',
                )
            )
        return np.asarray(static(phase) - self.total_normal_force / np.asarray(tangent(phase)))
