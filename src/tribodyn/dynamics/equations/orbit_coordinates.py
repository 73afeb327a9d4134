"""Reduced coordinates of a periodic orbit: all but the free rotation of the drive.

With friction the two torques of a gear pair do not balance, the whole drive speeds up or slows
down, and no periodic orbit exists in the absolute angle. Nothing depends on that angle, so the
orbit is computed in the remaining coordinates. They are orthogonal in the mass metric, where the
free motion and the others do not exchange momentum. A search starts from the static equilibrium at
mean stiffness.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple, Protocol

import numpy as np

from tribodyn.arrays.linear_algebra import each_times
from tribodyn.arrays.memory import Memo
from tribodyn.dynamics.equations.balanced import balanced_position
from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.dynamics.equations.grid import unrepeated
from tribodyn.dynamics.equations.motion import compression, forces, has_gap
from tribodyn.dynamics.equations.nodes import (
    Nodes,
    carried_load,
    friction_secant,
    lowest_of_each_law,
    push_with_friction,
    spanned_coordinates,
    springs,
)
from tribodyn.dynamics.equations.system import System
from tribodyn.errors import InputError, warn
from tribodyn.types import Array, Mask

_RANK = 1e-9
#: Part of a singular value below which a direction depends on others, every which is taken for a
#: first basis, and number of random directions that test all others.
_DEPENDENT, _SAMPLED, _PROBES = 1e-10, 31, 8
#: Share of the acceleration by the forces in free motions above which a warning is issued.
_UNBALANCED = 1e-3
#: Part of the friction at rest that is not balanced, but may be in motion, without a warning.
_ROUGH = 0.5


@dataclass(frozen=True)
class OrbitCoordinates:
    """Conversion between a state and the reduced vector in which an orbit is periodic."""

    lower: Array  #: cholesky factor of the mass matrix
    elastic: Array  #: orthonormal basis, in the mass metric, of positions that matter
    moving: Array  #: the same for velocities
    free: Array  #: free motions: neither position nor velocity matters
    rate: float | Array  #: weight of positions against velocities [rad/s]
    along: Array  #: orthonormal basis, in the mass metric, of the directions of contacts

    @cached_property
    def inverse(self) -> Array:
        """Inverse of ``lower``."""
        return np.asarray(np.linalg.inv(self.lower))

    @cached_property
    def rotations(self) -> Array:
        """Free motions of the drive, whose position no spring or contact feels (n, r)."""
        return _complement(self.elastic)

    @cached_property
    def braked(self) -> Array:
        """Those of them whose velocity a damper feels, in the basis ``moving`` (v, b)."""
        return _complement(self.moving.T @ self.elastic)

    @cached_property
    def reducing(self) -> Array:
        """Matrix (2 n, e + v) that reduces a state; one per rate for several rates (..., 1, 1)."""
        (size, count), rate = self.elastic.shape, np.asarray(self.rate)
        matrix = np.zeros((*rate.shape[:-2], 2 * size, count + self.moving.shape[1]))
        matrix[..., :size, :count] = rate * (self.lower @ self.elastic)
        matrix[..., size:, count:] = self.lower @ self.moving
        return matrix

    def reduce(self, state: Array) -> Array:
        """State (..., 2 n) to reduced vector (..., e + v)."""
        return np.asarray(state @ self.reducing)

    def expand(self, reduced: Array) -> Array:
        """Reduced vector (..., e + v) to state (..., 2 n), with the free motions at rest."""
        count = self.elastic.shape[1]
        q = reduced[..., :count] @ self.elastic.T / self.rate
        v = reduced[..., count:] @ self.moving.T
        return np.concatenate((q @ self.inverse, v @ self.inverse), axis=-1)

    @cached_property
    def resting(self) -> Array | None:
        """Matrix (2 n, 2 n) that stops the free motions in a state; None where there are none."""
        size = self.lower.shape[0]
        if self.elastic.shape[1] == self.moving.shape[1] == size:
            return None
        matrix = np.zeros((2 * size, 2 * size))
        for part, basis in ((slice(size), self.elastic), (slice(size, None), self.moving)):
            matrix[part, part] = self.lower @ basis @ basis.T @ self.inverse
        return matrix


class Balance(NamedTuple):
    """The torque that balances a free motion of the drive."""

    direction: Array  #: the free motion that it drives
    force: Array  #: force for a gain of 1 m/s in 1 s [N or N*m]
    strength: float
    momentum: Array  #: mass times the free motion (n, 1)

    @classmethod
    def of(cls, system: System, coordinates: OrbitCoordinates) -> Balance | None:
        """Balance of a system, None without one."""
        if system.balance is None:
            return None
        force = np.asarray(system.balance)
        push = coordinates.free.T @ np.linalg.solve(coordinates.lower, force)
        strength = float(np.linalg.norm(push))
        if strength < 1e-12 * float(np.linalg.norm(np.linalg.solve(coordinates.lower, force))):
            what = "balance does not drive any free motion"
            why = "The structure supports the drive, so no torque needs balancing"
            raise InputError(what, "System.balance", why, "Leave balance out")
        direction = push / strength
        momentum = coordinates.lower @ coordinates.free @ direction[:, None]
        return cls(direction, force / strength, strength, momentum)

    def gain(self, states: Array) -> Array:
        """Velocity of the free motion in states (..., 2 n), in the mass metric."""
        return each_times(states[..., len(self.momentum) :], self.momentum)[..., 0]

    def torque(self, gain: Array, span: Array) -> Array:
        """Force (lanes, n) that makes a gain (lanes,) [m/s] in a time (lanes,) [s]."""
        return np.asarray(gain[:, None] * self.force / np.asarray(span)[:, None])


def orbit_coordinates(compiled: Compiled, mesh_frequency: float) -> OrbitCoordinates:
    """Reduced coordinates of a system at a mesh frequency."""
    shared = structure_coordinates(compiled)
    warn_of_unbalanced(compiled, shared)
    return replace(shared, rate=2.0 * np.pi * mesh_frequency)


def structure_coordinates(compiled: Sampled) -> OrbitCoordinates:
    """Reduced coordinates of a system at 1 rad/s."""
    system, nodes = compiled.system, compiled.nodes
    onto = spanned_coordinates(system, nodes)
    matrices = np.asarray(system.mass), np.asarray(system.stiffness)
    content = *matrices, *(unrepeated(part, 2) for part in (nodes.direction, nodes.direction_slope))
    content = *content, np.array([_cycles(system)]), *([] if onto is None else [onto])
    shared, restoring = _coordinates_cache.get(content, lambda: _coordinates(compiled, *matrices))
    moving = _row_space([*restoring, shared.inverse @ system.rate_matrix @ shared.inverse.T])
    return replace(shared, moving=moving, free=_complement(moving))


def _along(compiled: Sampled, inverse: Array) -> tuple[Array, Array]:
    """Basis (n, r) in which contacts are compressed, and directions with the same span."""
    nodes, onto = compiled.nodes, _over_mass(compiled, inverse)
    parts = [(nodes.direction, onto)], nodes.direction_slope, _cycles(compiled.system)
    basis, rows = direction_basis(*parts)
    used, spanned = np.concatenate(rows), spanned_coordinates(compiled.system, nodes)
    return basis, used if spanned is None else used @ spanned


def _cycles(system: System) -> int:
    """Most cycles of a contact on one clock."""
    counts = [each.cycles for each in system.contacts]
    return max((count for count in counts if isinstance(count, int)), default=1)


def _over_mass(compiled: Sampled, inverse: Array) -> Array:
    """Directions of the contacts in coordinates of unit mass (c, n)."""
    onto = spanned_coordinates(compiled.system, compiled.nodes)
    return inverse.T if onto is None else onto @ inverse.T


#: Coordinates of the last systems at 1 rad/s without their dampers and gyroscopic moments: a study
#: builds the same structure many times, at many speeds.
_coordinates_cache: Memo[tuple[OrbitCoordinates, list[Array]]] = Memo(4)


def _coordinates(
    compiled: Sampled, mass: Array, stiffness: Array
) -> tuple[OrbitCoordinates, list[Array]]:
    """Coordinates of a system without dampers, and the rows of its springs and contacts."""
    lower = np.asarray(np.linalg.cholesky(mass), dtype=float)
    inverse = np.linalg.inv(lower)
    along, used = _along(compiled, inverse)
    if len(used) > len(mass):
        used = np.asarray(np.linalg.qr(used, mode="r"))  # of the same lengths
    restoring = [inverse @ stiffness @ inverse.T, used @ inverse.T]
    elastic = _row_space(restoring)
    return OrbitCoordinates(lower, elastic, elastic, elastic[:, :0], 1.0, along), restoring


def warn_of_unbalanced(compiled: Compiled, coordinates: OrbitCoordinates) -> None:
    """Warn if loads and friction accelerate a free motion of the drive that no torque balances."""
    system, nodes = compiled.system, compiled.nodes
    inverse, free = coordinates.inverse, coordinates.free
    if system.balance is not None or not 0 < free.shape[1] < system.size:
        return
    force = np.einsum("rs,rsi->i", nodes.weight, nodes.force)
    pushed = inverse @ force
    driven = free.T @ pushed
    if np.linalg.norm(driven) <= _UNBALANCED * np.linalg.norm(pushed):
        return
    if system.frictions or nodes.force_direction is not nodes.direction:
        still = np.broadcast_to(static_start(compiled)[: system.size], nodes.force.shape)
        moved = forces(system, nodes, 0.0, still, 0.0 * still).acceleration
        total = free.T @ coordinates.lower.T @ np.einsum("rs,rsi->i", nodes.weight, moved)
        if np.linalg.norm(total) <= _ROUGH * np.linalg.norm(total - driven):
            return
        driven = total
    gained = driven @ free.T @ inverse
    most = int(np.argmax(np.abs(gained) * np.sqrt(np.diag(np.asarray(system.mass)))))
    warn(
        "unbalanced-drive",
        "loads and friction of the system do not balance: the whole drive speeds up, "
        f"{system.names[most]} by {gained[most]:.4g} rad/s^2 (m/s^2 for a translation), and the "
        "orbit leaves this out. Check magnitudes and signs in System.force, or give "
        "System.balance, the direction of a balancing torque",
        stacklevel=5,
    )


def refuse_disconnected(compiled: Compiled) -> None:
    """Refuse a coordinate without a spring, damper or contact."""
    system, nodes = compiled.system, compiled.nodes
    onto = spanned_coordinates(system, nodes)
    connected = np.zeros(system.size, dtype=bool)
    for name in ("stiffness", "damping"):
        matrix = np.asarray(getattr(system, name))
        connected |= np.any(matrix != 0.0, axis=0) | np.any(matrix != 0.0, axis=1)
    coupled = np.asarray(system.mass) - np.diag(np.diag(np.asarray(system.mass)))
    connected |= np.any(coupled != 0.0, axis=0)
    pushes = nodes.force_direction, nodes.friction_direction
    for part in (nodes.direction, nodes.direction_slope, *pushes):
        moved = np.any(unrepeated(part, 2) != 0.0, axis=(0, 1, 2))
        connected |= moved if onto is None else np.any(onto[moved], axis=0)
    if connected.all() or not connected.any():
        return
    names = [system.names[int(i)] for i in np.flatnonzero(~connected)]
    plural = len(names) > 1
    raise InputError(
        f"the coordinate{'s' if plural else ''} {', '.join(names)} "
        f"{'are' if plural else 'is'} not connected to anything",
        where="System.stiffness",
        why="A coordinate without spring, damper or contact moves freely and has no periodic orbit",
        remedy="Add the missing shaft, bearing or contact, or remove the coordinate",
    )


def direction_basis(
    parts: Sequence[tuple[Array, Array]], slope: Array | None = None, cycles: int = 1
) -> tuple[Array, list[Array]]:
    """Basis (n, r) of directions (..., c), and some of them (m, c) that have the same span."""
    # parts: with the matrix (c, n) into the metric of the mass, in which the basis is orthonormal
    # slope: numerical derivatives of the first part over so many cycles, exact against its length
    rows = [unrepeated(part, 1).reshape(-1, len(matrix)) for part, matrix in parts]
    into, least = [matrix for _, matrix in parts], [0.0] * len(parts)
    size = into[0].shape[1]
    if slope is not None:
        lengths = np.linalg.norm(rows[0][::_SAMPLED] @ into[0], axis=1)
        rows.append(unrepeated(slope, 1).reshape(-1, len(into[0])))
        into.append(into[0])
        least.append(cycles * float(lengths.max(initial=0.0)))
    some = [part[::_SAMPLED] for part in rows]
    basis = _span([_counted(*each) for each in zip(some, least, into, strict=True)])
    # Most rows repeat what some span; components along random directions show those that do not.
    random = np.random.default_rng(0).standard_normal((size, _PROBES)) / np.sqrt(_PROBES)
    probes = np.concatenate((random, random - basis @ (basis.T @ random)), axis=1)
    outside = []
    for part, short, matrix in zip(rows, least, into, strict=True):
        parts_along = (part @ (matrix @ probes)).reshape(-1, 2, _PROBES)
        length, left = np.linalg.norm(parts_along, axis=2).T
        outside.append(part[left > _DEPENDENT * np.maximum(length, short)])
    others = [_counted(*each) for each in zip(outside, least, into, strict=True)]
    return _span([basis.T, *others]), [*some, *outside]


def _counted(rows: Array, least: float, into: Array) -> Array:
    """Rows in the mass metric, each over its length, or over the least one that counts fully."""
    rows = rows @ into
    length = np.maximum(np.linalg.norm(rows, axis=1), least)
    return np.asarray(rows[length > 0.0] / length[length > 0.0, None])


def _span(parts: Sequence[Array]) -> Array:
    """Orthonormal basis (n, r) of rows (m, n)."""
    rows = np.concatenate(parts)
    if not len(rows):
        return np.zeros((rows.shape[1], 0))
    _, values, basis = np.linalg.svd(np.linalg.qr(rows, mode="r"), full_matrices=False)
    return np.ascontiguousarray(basis[values > _DEPENDENT * values[0]].T)


def _complement(basis: Array) -> Array:
    """Orthonormal basis of the complement of the columns of an orthonormal basis."""
    full, _ = np.linalg.qr(basis, mode="complete") if basis.shape[1] else (np.eye(len(basis)), None)
    return np.ascontiguousarray(full[:, basis.shape[1] :])


def _row_space(matrices: list[Array]) -> Array:
    scaled = [matrix / norm for matrix in matrices if (norm := np.linalg.norm(matrix)) > 0.0]
    size = matrices[0].shape[1]
    if not scaled:
        return np.zeros((size, 0))
    _, values, rows = np.linalg.svd(np.vstack(scaled), full_matrices=False)
    return np.ascontiguousarray(rows[values > _RANK * values[0]].T)


#: Force of a contact at rest that is none, over the largest one or that of a dead zone.
_UNLOADED = 1e-9
#: Iterations in which the ramps of a force law open and close, one ramp per iteration at least.
#: The same number is enough for load-dependent friction.
_ROUNDS = 50


class Sampled(Protocol):
    """A system and its entries at phases of the mesh cycle."""

    @property
    def system(self) -> System:
        """The system."""

    @property
    def nodes(self) -> Nodes:
        """Its entries."""


@dataclass(frozen=True)
class OverBases:
    """A system whose contacts have the components of their directions along bases of them."""

    system: System
    nodes: Nodes
    coordinates: OrbitCoordinates
    along: Array  #: basis of compressions (n, r), orthonormal in the mass metric
    push: Array  #: basis of forces (n, s)

    @classmethod
    def of(
        cls,
        compiled: Sampled,
        extra: Array | None = None,
        coordinates: OrbitCoordinates | None = None,
    ) -> OverBases:
        """The same for a system on which further forces (m, n) may act."""
        system, nodes = compiled.system, compiled.nodes
        if coordinates is None:
            coordinates = structure_coordinates(compiled)
            inverse, along = coordinates.inverse, coordinates.along
        else:  # of a part of the contacts
            inverse = coordinates.inverse
            along = _along(compiled, inverse)[0]
        onto, of_loads = _over_mass(compiled, inverse), [nodes.force[..., None, :]]
        of_loads += [] if extra is None else [extra]
        if system.balance is not None:
            of_loads.append(np.asarray(system.balance)[None])
        pushes = [(part, onto) for part in (nodes.force_direction, nodes.friction_direction)]
        push = direction_basis([*pushes, *((part, inverse.T) for part in of_loads)])[0]
        into = {"direction": along, "force_direction": push, "friction_direction": push}
        parts = {n: _components(getattr(nodes, n), onto @ b) for n, b in into.items()}
        return cls(system, nodes._replace(**parts), coordinates, along, push)

    @property
    def bases(self) -> tuple[Array, Array]:
        """Both bases as directions of the system (n, r) and (n, s)."""
        return self.coordinates.lower @ self.along, self.coordinates.lower @ self.push


def _components(directions: Array, into: Array) -> Array:
    """Components of directions (..., contacts, n); equal ones of two contacts are equal."""
    distinct = unrepeated(directions, 2)
    parts = [distinct[..., j, :] @ into for j in range(distinct.shape[-2])]
    joined = np.stack(parts, axis=-2) if parts else np.zeros((*distinct.shape[:-1], into.shape[1]))
    return np.broadcast_to(joined, (*directions.shape[:-1], into.shape[1]))


def _compressed(compiled: Sampled, position: Array) -> Array:
    """Compression of every contact at a position (n,)."""
    bases = _bases(compiled)
    return compression(compiled.nodes, position if bases is None else position @ bases[0])


def _bases(compiled: Sampled) -> tuple[Array, Array] | None:
    """Bases of compressions and pushes over which directions are, if these are not plain."""
    if isinstance(compiled, OverBases):
        return compiled.bases
    onto = spanned_coordinates(compiled.system, compiled.nodes)
    return None if onto is None else (onto.T, onto.T)


def static_start(compiled: Sampled) -> Array:
    """State at rest under the mean loads, every contact on its driving flank."""
    position = _on_flanks(compiled, np.ones(compiled.nodes.gap.shape[-1]))
    return np.concatenate((position, np.zeros(compiled.system.size)))


def _loaded(compiled: OverBases) -> Array:
    """Position at rest (n,) with contacts on the flanks that the mean loads press."""
    position = _on_flanks(compiled, np.ones(compiled.nodes.gap.shape[-1]))
    force, most = _carried(compiled, position)
    pulled = has_gap(compiled.nodes) & (force < -_UNLOADED * most.max(initial=0.0))
    if pulled.any():
        other = _on_flanks(compiled, np.where(pulled, -1.0, 1.0))
        if (side_of(compiled, other)[pulled] < 0.0).all():
            return other
    return position


def _on_flanks(compiled: Sampled, side: Array) -> Array:
    """Position at rest (n,), each contact on a side of its dead zone (contacts,)."""
    nodes = compiled.nodes
    lowest = lowest_of_each_law(nodes)[:, None]
    stiffness, gap = springs(nodes)
    lowest = np.pad(lowest, ((0, 0), (0, stiffness.shape[-1] - 1)))  # no ramp is the lowest
    carrying, edge = stiffness, side[:, None] * gap
    position = _equilibrium(compiled, carrying, edge)
    for _ in range(0 if lowest.all() else _ROUNDS):
        beyond = (side * _compressed(compiled, position))[..., None] > gap
        closed = np.where(lowest | beyond, stiffness, 0.0)
        if np.array_equal(closed, carrying):
            break
        carrying = closed
        position = _equilibrium(compiled, carrying, edge)
    return position


def side_of(compiled: Sampled, position: Array) -> Array:
    """Side (contacts,) of the dead zone on which a position (n,) holds each contact, or 1."""
    weight, nodes = compiled.nodes.weight, compiled.nodes
    place, gap = (np.einsum("rs,rsj->j", weight, np.broadcast_to(part, nodes.gap.shape))
                  for part in (_compressed(compiled, position), nodes.gap))  # fmt: skip
    return np.where(has_gap(nodes) & (place < -gap), -1.0, 1.0)


class Rest(NamedTuple):
    """A system at rest under the mean loads."""

    position: Array  #: (n,)
    floating: Mask  #: contacts that carry nothing, in the middle of their dead zones


def at_rest(compiled: OverBases) -> Rest:
    """Static equilibrium; a body that nothing loads is in the middle between its flanks."""
    nodes, loaded = compiled.nodes, _loaded(compiled)
    lowest = lowest_of_each_law(nodes) & nodes.stiffness.any(axis=(0, 1))
    floating, position = has_gap(nodes) & lowest & _unloaded(compiled, loaded), loaded
    while floating.any():
        middle = replace(compiled, nodes=nodes._replace(gap=np.where(floating, 0.0, nodes.gap)))
        position = _loaded(middle)
        free = floating & _unloaded(middle, position)
        if np.array_equal(free, floating):
            break
        floating, position = free, loaded
    return Rest(position, floating)


def _unloaded(compiled: OverBases, position: Array) -> Mask:
    """Contacts without a mean force at rest, where those lowest of a force law are closed."""
    force, most = _carried(compiled, position)
    return np.asarray(np.abs(force) <= _UNLOADED * most.max(initial=0.0))


def _carried(compiled: Sampled, position: Array) -> tuple[Array, Array]:
    """Mean force of each contact at a position on its driving flank, and the size of its parts."""
    nodes = compiled.nodes
    stiffness, gap = springs(nodes)
    pressed = _compressed(compiled, position)[..., None] - gap
    closed = pressed > 0.0
    closed[..., 0] |= lowest_of_each_law(nodes)
    force, most = (
        np.einsum("rs,rsjm->j", nodes.weight, stiffness * np.where(closed, part, 0.0))
        for part in (pressed, np.abs(pressed) + gap)
    )
    return force, most


def _equilibrium(compiled: Sampled, carrying: Array, gap: Array) -> Array:
    """Position at rest with the stiffness (steps, 3, contacts, m) of the closed springs."""
    system, nodes = compiled.system, compiled.nodes
    if carrying.shape[-1] > 1:  # one spring per contact that carries what all of them do
        pressed, carrying = (carrying * gap).sum(axis=-1), carrying.sum(axis=-1)
        nodes = nodes._replace(gap=pressed / np.where(carrying > 0.0, carrying, 1.0))
    else:
        nodes, carrying = nodes._replace(gap=gap[..., 0]), carrying[..., 0]
    bases = _bases(compiled)
    position = balanced_position(system, nodes, carrying, nodes.force_direction, bases)
    for _ in range(_ROUNDS if system.frictions else 0):
        load = carried_load(system, carrying * (_compressed(compiled, position) - nodes.gap))
        ratio = friction_secant(system, nodes.friction_coefficients, load)
        last, push = position, push_with_friction(system, nodes, ratio)
        position = balanced_position(system, nodes, carrying, push, bases)
        if np.abs(position - last).max() <= 1e-12 * np.abs(position).max():
            break
    return position
