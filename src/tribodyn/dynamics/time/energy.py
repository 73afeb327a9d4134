"""Energy audit of a motion: supplied, stored and dissipated energy.

A stiffness prescribed over the mesh phase does work on the motion, and so do a varying error and
a varying direction: the drive that prescribes the phase supplies it. An audit that includes this
work closes to the accuracy of the integration. Where a contact opens or closes, the samples before
and after belong to different sides, and the rows of the table are evaluated at these samples.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics.equations.compiled import Compiled, compile_for
from tribodyn.dynamics.equations.grid import Grid, RowEvaluator
from tribodyn.dynamics.equations.motion import quadratic, sides, within_steps
from tribodyn.dynamics.equations.nodes import friction_force
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.time.response import Response
from tribodyn.types import Array

#: Mesh phases closer than this are the same; one-sided values lie slightly off an event.
_SAME = 1e-9


@dataclass(frozen=True)
class EnergyAudit:
    """Energies of a motion over its record [J].

    Parameters
    ----------
    external : float
        Work of the external forces [J].
    parametric : float
        Work of the prescribed stiffness, error and gap [J].
    dissipated : float
        Loss in structural and contact dampers, positive [J].
    friction : float
        Loss by sliding along the friction directions, in the motion of the structure [J].
    stored : float
        Gain of kinetic and elastic energy [J].
    """

    external: float
    parametric: float
    dissipated: float
    friction: float
    stored: float

    @property
    def imbalance(self) -> float:
        """Residual of the energy balance over the sum of the magnitudes of all terms."""
        terms = (self.external, self.parametric, self.dissipated, self.friction, self.stored)
        residual = self.external + self.parametric - self.dissipated - self.friction - self.stored
        size = sum(abs(term) for term in terms)
        return abs(residual) / size if size > 0.0 else 0.0


def energy_audit(system: System, response: Response) -> EnergyAudit:
    """Audit a motion computed with symmetric structural matrices.

    Parameters
    ----------
    system : System
    response : Response
        From :func:`~tribodyn.dynamics.simulate` or :func:`~tribodyn.dynamics.steady_state`.

    Notes
    -----
    Energies: ``v.M v / 2 + q.K q / 2 + sum k g^2 / 2`` with ``g`` the compression beyond the gap.
    Their rate is balanced by the external power, the dampers, the friction ``N s.v``, and the
    parametric power ``k' g^2 / 2 - k g (e' + gap')``, plus the energy that jumps at events.

    Examples
    --------
    >>> from tribodyn.dynamics import simulate
    >>> free = System([[1.0]], [[0.1]], [[4.0]], [0.0])
    >>> audit = energy_audit(free, simulate(free, 1.0, 3, ([1.0], [0.0]), steps=512))
    >>> audit.imbalance < 1e-9, audit.dissipated > 0.0
    (True, True)
    """
    steps = response.time.size // (response.periods * system.cycles)
    compiled = compile_for(system, response.mesh_frequency, steps)
    fine, beat = response.fine, response.mesh_frequency
    q, v, d, n = (
        part.reshape(part.shape[0] // 3, 3, part.shape[-1])
        for part in (fine.position, fine.velocity, fine.deflection, fine.contact_force)
    )
    rows = _Rows(compiled, fine.phase.reshape(-1, 3))
    stiffness, gap, direction = rows.of("stiffness"), rows.of("gap"), rows.of("direction")
    # The middle determines the side of a part: its ends may lie at the edge of the dead zone.
    side = sides(d, gap, gap > 0.0)
    side = np.where(rows.moved[:, None, None] & (gap > 0.0), side[:, 1:2], side)
    g = np.abs(side) * (d - side * gap)
    rate = np.einsum("tsji,tsi->tsj", direction, v)
    moved = np.einsum("tsji,tsi->tsj", rows.of("direction_slope"), q) - rows.of("error_slope")
    stiffness_slope, gap_slope = (rows.at(part) for part in _slopes(system, compiled.grid))
    parametric = 0.5 * stiffness_slope * g**2
    parametric = parametric + stiffness * g * (moved - side * gap_slope)
    elastic = 0.5 * stiffness * g**2
    sliding = np.einsum("tsji,tsi->tsj", rows.of("force_direction") - direction, v)
    rubbed = (n * sliding).sum(axis=-1)
    if system.frictions:
        rub = friction_force(system, rows.of("friction_coefficients"), n)
        rubbed = rubbed + np.einsum("tsfi,tsi,tsf->ts", rows.of("friction_direction"), v, rub)
    lost = _form(system.damping, v)
    # The contact damper dissipates its force times the full rate, which includes the varying error;
    # the error then supplies the total force, not only the spring force, times its rate.
    damper = n - stiffness * g
    lost = lost + (damper * (rate + beat * moved)).sum(axis=-1)
    parametric = parametric + damper * moved
    kinetic = 0.5 * _form(system.mass, v)
    strain = 0.5 * _form(system.stiffness, q)
    total = kinetic + strain + elastic.sum(axis=-1)
    weight = fine.weight.reshape(-1, 3) * response.duration

    def work(power: Array) -> float:
        return float((weight * power).sum())

    return EnergyAudit(
        external=work(np.einsum("tsi,tsi->ts", v, rows.of("force") + response.extra_force)),
        parametric=work(beat * parametric.sum(axis=-1)) + _jumps(elastic.sum(axis=-1)),
        dissipated=work(lost),
        friction=work(rubbed),
        stored=float(total[-1, 2] - total[0, 0]),
    )


class _Rows:
    """Rows of the table at triples of samples, on full steps or on parts of them."""

    def __init__(self, compiled: Compiled, phase: Array) -> None:
        self._nodes, grid = compiled.nodes, compiled.grid
        self._step = np.arange(phase.shape[0]) % grid.steps
        cycle = np.arange(phase.shape[0]) // grid.steps
        offset = phase - cycle[:, None] - self._nodes.phase[self._step]
        #: Triples that are not a full step.
        self.moved = np.any(np.abs(offset) > _SAME, axis=1)
        self._number, self._tau = within_steps(grid, cycle[self.moved], phase[self.moved])

    def at(self, rows: Array) -> Array:
        """Evaluate rows of shape (steps, 3, ...) at the samples."""
        values = rows[self._step]
        values[self.moved] = quadratic(rows, self._number, self._tau)
        return values

    def of(self, name: str) -> Array:
        """Evaluate the rows called ``name`` at the samples."""
        return self.at(getattr(self._nodes, name))


def _form(matrix: ArrayLike, x: Array) -> Array:
    """Quadratic form at every sample."""
    return np.asarray(np.einsum("tsi,ik,tsk->ts", x, np.asarray(matrix), x))


def _slopes(system: System, grid: Grid) -> tuple[Array, Array]:
    """Derivatives of stiffness and gap with respect to phase, (steps, 3, contacts)."""
    rows = RowEvaluator(grid)

    def slope(name: str) -> Array:
        columns = [
            rows.derivatives(f"contacts[{j}].{name}", getattr(contact, name))[..., 0]
            for j, contact in enumerate(system.clocked_contacts)
        ]
        return np.stack(columns, axis=-1) if columns else np.zeros((grid.steps, 3, 0))

    return slope("stiffness"), slope("gap")


def _jumps(energy: Array) -> float:
    """Energy that appears or vanishes between the end of a step and the start of the next."""
    return float((energy[1:, 0] - energy[:-1, 2]).sum())
