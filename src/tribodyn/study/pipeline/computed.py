"""Computed mesh, system and motion of a case, from which series and figures are derived."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tribodyn.record import Record, fact, quantity, record
from tribodyn.study.pipeline.assembly import static_error
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.dynamics import Response, System
    from tribodyn.errors import ModelWarning
    from tribodyn.mesh import MeshFriction, MeshTable
    from tribodyn.stiffness import LoadedContact
    from tribodyn.study.case.case import Case
    from tribodyn.study.heat_balance import HeatBalance
    from tribodyn.study.pipeline.assembly import Damping


@record
class Coupling(Record):
    """Convergence of load, film, friction and stiffness of a case.

    Parameters
    ----------
    iteration : array (passes,)
        Number of each pass.
    load_change, share_change, film_change, friction_change, stiffness_change, oil_change
        Greatest change in each pass, over the nominal force, the whole load, the film itself, the
        greatest coefficient, the mean stiffness and the viscosity (passes,).
    phase : array (n,)
        Mesh phase.
    loading : array (n,)
        Force of all tooth pairs at that phase, over that of the torque alone.
    kind : str
        ``"static"`` or ``"dynamic"``.
    tolerance : float
        Change below which all of them agree.
    """

    iteration: Array = quantity("iteration", unit="1", axis=True)
    load_change: Array = quantity("iteration", unit="1")
    share_change: Array = quantity("iteration", unit="1")
    film_change: Array = quantity("iteration", unit="1")
    friction_change: Array = quantity("iteration", unit="1")
    stiffness_change: Array = quantity("iteration", unit="1")
    oil_change: Array = quantity("iteration", unit="1")
    phase: Array = quantity("knot", unit="1", axis=True)
    loading: Array = quantity("knot", unit="1")
    kind: str = fact()
    tolerance: float = fact()

    @property
    def contraction(self) -> float:
        """Part of the change of the load that the next pass leaves; of the last two passes."""
        last = self.load_change[-2:]
        return float(last[-1] / last[0]) if last.size > 1 and last[0] > 0.0 else 0.0


@record
class Computed(Record):
    """A case with its computed mesh, system and motion, and the warnings of the models."""

    case: Case
    mesh: MeshTable
    system: System
    response: Response
    damping: Damping
    warnings: tuple[ModelWarning, ...]
    friction: MeshFriction | None = None
    nominal_friction_response: Response | None = None
    coupling: Coupling | None = None
    heat: HeatBalance | None = None

    @property
    def half_backlash(self) -> float:
        """Half of the play on the line of action [m]; zero is a linear mesh."""
        return 0.5 * self.case.backlash

    def static_error(self, phase: Array | float) -> Array:
        """Transmission error without load: prescribed, or a column of the mesh table."""
        mesh_error, phase = self.mesh.functions().error, np.asarray(phase, dtype=float)
        return static_error(self.case.dynamics, phase) + (
            0.0 if mesh_error is None else mesh_error(phase)
        )

    def transmission_error_at_rest(self, phase: Array | float | None = None) -> Array:
        """Lag of the driven gear under load at rest [m], with the prescribed error of the case."""
        if phase is None:
            error = static_error(self.case.dynamics, self.mesh.phase)
            return np.asarray(self.mesh.transmission_error_at_rest + error)
        loaded = self.mesh.at("transmission_error_at_rest", phase)
        return np.asarray(loaded + static_error(self.case.dynamics, phase))

    def loaded_contact(self) -> LoadedContact:
        """Loaded contact at rest, without oil film: a turn of each gear whose teeth differ."""
        from tribodyn.study.pipeline.tooth_contact import loaded_contact, phases_of_turns

        return loaded_contact(self.case, phases=phases_of_turns(self.case))
