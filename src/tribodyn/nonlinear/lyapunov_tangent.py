"""Matrices that carry a small disturbance of a motion over one integration step.

Between two changes of contact a structure is linear in its state, so that these matrices depend
on the mesh phase and on which contacts carry, not on the motion. They are exponentials of the
Magnus series of fourth order (Blanes, Casas, Oteo and Ros, Physics Reports 470, 2009), whose
determinant is exact. Disturbances are taken in the coordinates in which an orbit closes: the free
rotation of the whole drive has no part in them.
"""

from __future__ import annotations

import math

import numpy as np

from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.dynamics.equations.motion import quadratic
from tribodyn.dynamics.equations.nodes import Nodes
from tribodyn.dynamics.load_friction import push_with_friction
from tribodyn.dynamics.orbits.coordinates import orbit_coordinates
from tribodyn.errors import InputError, Problem
from tribodyn.types import Array, Index, Mask

#: Terms of the exponential series of a matrix no larger than a quarter: exact to rounding.
_TAYLOR = 12


class TangentTables:
    """Matrices of the disturbances of one system on its grid."""

    def __init__(self, compiled: Compiled, mesh_frequency: float) -> None:
        system, nodes = compiled.system, _with_friction(compiled)
        self.compiled = compiled
        self.nodes = nodes
        self.mesh_frequency = mesh_frequency
        self.coordinates = orbit_coordinates(compiled, mesh_frequency)
        self.width = compiled.grid.width / mesh_frequency
        self.dead = np.asarray(np.any(nodes.gap > 0.0, axis=(0, 1)))
        free = [contact.damping_in_gap for contact in system.contacts]
        self.in_gap = np.array(free, dtype=bool)
        c = self.coordinates
        inverse = np.linalg.inv(c.lower)
        place, speed = inverse.T @ c.elastic / c.rate, inverse.T @ c.moving
        self.size = place.shape[1] + speed.shape[1]
        still = np.zeros((*nodes.stiffness.shape, speed.shape[1]))
        self._rigid = np.zeros((self.size, self.size))
        count = place.shape[1]
        self._rigid[:count, count:] = c.rate * c.elastic.T @ c.moving
        self._rigid[count:, :count] = -speed.T @ np.asarray(system.stiffness) @ place
        self._rigid[count:, count:] = -speed.T @ np.asarray(system.damping) @ speed
        #: How the compression of each contact feels a disturbance, (steps, 3, contacts, k).
        self.feel = np.concatenate((nodes.direction @ place, still), axis=-1)
        rate = np.concatenate(
            (mesh_frequency * nodes.direction_slope @ place, nodes.direction @ speed), axis=-1
        )
        self._spring = nodes.stiffness[..., None] * self.feel
        #: How its damping force does, and what a force does to the disturbance.
        self.damp = nodes.damping[..., None] * rate
        none = np.zeros((*nodes.stiffness.shape, count))
        self.push = np.concatenate((none, nodes.force_direction @ speed), axis=-1)
        self._known: dict[int, tuple[Array, Array]] = {}

    def rate_matrix(self, push: Array, spring: Array, damp: Array, touching: Mask) -> Array:
        """Matrix of the equations of a disturbance."""
        carried = touching[..., None] * spring + (touching | self.in_gap)[..., None] * damp
        return np.asarray(self._rigid - np.swapaxes(push, -1, -2) @ carried)

    def whole_steps(self, touching: Mask) -> tuple[Array, Array]:
        """Matrices of all steps of a mesh cycle for one set of contacts that carry."""
        key = int(sum(1 << j for j in np.flatnonzero(touching)))
        if key not in self._known:
            wide = np.broadcast_to(touching, self.push.shape[:3])
            rates = self.rate_matrix(self.push, self._spring, self.damp, wide)
            self._known[key] = _propagate(rates, self.width)
        return self._known[key]

    def part_steps(
        self, steps: Index, begin: Array, end: Array, touching: Mask
    ) -> tuple[Array, Array]:
        """Matrices of parts of steps."""
        taus = np.stack((begin, 0.5 * (begin + end), end), axis=1)
        push, spring, damp = (
            within(item, steps, taus) for item in (self.push, self._spring, self.damp)
        )
        wide = np.broadcast_to(touching[:, None], (*taus.shape, touching.shape[1]))
        return _propagate(
            self.rate_matrix(push, spring, damp, wide), self.width[steps] * (end - begin)
        )


def _with_friction(compiled: Compiled) -> Nodes:
    """Rows in which the frictions that are proportional to the load belong to the contacts."""
    system, nodes = compiled.system, compiled.nodes
    coefficients = nodes.friction_coefficients
    if not system.frictions:
        return nodes
    if np.any(coefficients[..., 1:]):
        bent = int(np.flatnonzero(np.any(coefficients[..., 1:], axis=(0, 1, 3)))[0])
        raise InputError(
            Problem(
                what=f"frictions[{bent}] has {coefficients.shape[-1]} coefficients",
                where=f"System.frictions[{bent}].coefficients",
                why="The tangent method carries disturbances with matrices that know only which "
                "contacts carry, and a coefficient that follows the load changes with the motion",
                remedy="Use a single coefficient, for example its value at the mean load, or look "
                "at the Floquet multipliers of steady_state, which include the whole friction",
            )
        )
    return nodes._replace(force_direction=push_with_friction(system, nodes, coefficients[..., 0]))


def within(values: Array, steps: Index, taus: Array) -> Array:
    """Interpolate rows quadratically within their steps, as the integrator does."""
    return quadratic(values, steps[:, None], taus)


def _propagate(rates: Array, width: Array) -> tuple[Array, Array]:
    """Matrix of a step from those of the equations (m, 3, k, k); integral of their trace."""
    h = width[:, None, None]
    first, middle, last = rates[:, 0], rates[:, 1], rates[:, 2]
    mean = h / 6.0 * (first + 4.0 * middle + last)
    matrix = _exponential(mean - h * h / 12.0 * (first @ last - last @ first))
    return matrix, np.trace(mean, axis1=-2, axis2=-1)


def _exponential(matrices: Array) -> Array:
    """Exponentials of matrices (m, k, k) by scaling, Taylor series and squaring."""
    size = float(np.abs(matrices).sum(axis=-1).max(initial=0.0))
    halvings = max(0, math.ceil(math.log2(max(size, 1e-300) / 0.25)))
    small = matrices / 2.0**halvings
    unit = np.eye(matrices.shape[-1])
    result = np.broadcast_to(unit, matrices.shape)
    for order in range(_TAYLOR, 0, -1):
        result = unit + small @ result / order
    for _ in range(halvings):
        result = result @ result
    return np.asarray(result)
