"""Planes of starts: two components of the state, or the transmission error and its rate.

The transmission error is the compression of a contact, its error included, counted from
where the driving flank first touches. Its plane holds the states that a push at the contact leads
to: displacements and velocities along ``M^-1 h``, with the direction ``h`` of the contact at the
mesh phase 0, which give free rotations no momentum.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.dynamics.equations.system import System
from tribodyn.errors import InputError
from tribodyn.types import Array

#: Coordinates of a plane across a contact.
MESH_PLANE = ("dynamic_transmission_error", "dynamic_transmission_error_rate")
#: Ending of the name of a velocity.
VELOCITY = "_velocity"


@dataclass(frozen=True)
class StartPlane:
    """Plane of states through a state at rest."""

    names: tuple[str, str]
    units: tuple[str, str]
    project: Array  #: coordinates of a state (2, 2 n)
    offset: Array  #: taken off them (2,)
    lift: Array  #: change of the state for a change of each coordinate (2 n, 2)
    columns: tuple[int, ...] = ()  #: components of the state, where the coordinates are such

    def section(self, states: Array) -> Array:
        """Coordinates of states (..., 2 n) in the plane."""
        return np.asarray(states @ self.project.T - self.offset)

    def starts(self, axes: tuple[Array, Array], rest_state: Array) -> Array:
        """States of all starts, the second axis varying fastest."""
        values = np.stack([each.ravel() for each in np.meshgrid(*axes, indexing="ij")], axis=1)
        starts = rest_state + (values - self.section(rest_state)) @ self.lift.T
        for number, column in enumerate(self.columns):
            starts[:, column] = values[:, number]
        return np.asarray(starts)


def start_plane(
    compiled: Compiled, mesh_frequency: float, names: tuple[str, str] | None, contact: int = 0
) -> StartPlane:
    """Plane of starts over two coordinates; by default the first of the system and its velocity."""
    system = compiled.system
    names = names or (system.names[0], system.names[0] + VELOCITY)
    if tuple(names) == MESH_PLANE and system.contacts:
        return _across_mesh(compiled, mesh_frequency, contact)
    columns = _columns(system, names)
    rows = np.eye(2 * system.size)[list(columns)]
    units = (_unit(names[0]), _unit(names[1]))
    return StartPlane((names[0], names[1]), units, rows, np.zeros(2), rows.T, columns)


def _across_mesh(compiled: Compiled, mesh_frequency: float, contact: int) -> StartPlane:
    nodes = compiled.nodes
    along, turning = (
        nodes.direction[0, 0, contact],
        mesh_frequency * nodes.direction_slope[0, 0, contact],
    )
    push = np.linalg.solve(np.asarray(compiled.system.mass), along)
    push = push / (along @ push)
    still = np.zeros_like(along)
    lift = np.concatenate((push, -(turning @ push) * push)), np.concatenate((still, push))
    return StartPlane(
        MESH_PLANE,
        ("m", "m/s"),
        np.vstack((np.concatenate((along, still)), np.concatenate((turning, along)))),
        np.array([float(nodes.gap[..., contact].min()), 0.0]),
        np.stack(lift, axis=1),
    )


def _columns(system: System, names: tuple[str, str]) -> tuple[int, int]:
    components = [*system.names, *(name + VELOCITY for name in system.names)]
    if len(names) != 2 or names[0] == names[1] or not set(names) <= set(components):
        mesh = f", or {' and '.join(MESH_PLANE)}" if system.contacts else ""
        what, why = f"coordinates = {names!r}", f"Two of {', '.join(components)}{mesh}"
        raise InputError(what, "argument coordinates", why, "Choose two different ones of these")
    return components.index(names[0]), components.index(names[1])


def _unit(name: str) -> str:
    angle = "theta" in name
    if name.endswith(VELOCITY):
        return "rad/s" if angle else "m/s"
    return "rad" if angle else "m"
