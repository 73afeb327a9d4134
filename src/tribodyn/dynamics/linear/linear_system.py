"""A system linearised about its static load, and its response to a harmonic error."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics.equations.grid import system_events, unrepeated
from tribodyn.dynamics.equations.nodes import (
    Nodes,
    carried_load,
    combined,
    force_laws,
    friction_secant,
    friction_tangent,
    lowest_of_each_law,
    push_with_friction,
    sampled,
)
from tribodyn.dynamics.equations.ramps import split_ramps
from tribodyn.dynamics.equations.system import System
from tribodyn.errors import InputError, require_between, require_positive
from tribodyn.record import Record, fact, quantity, record
from tribodyn.types import Array, ComplexArray, Index, Mask

ModePhase = Literal["mean"] | float

#: Steps over which a cycle is averaged, and iterations in which ramps open and close.
_STEPS, _ROUNDS = 256, 50
#: Part of the largest stiffness, or of the longest direction, that is none.
_ZERO = 1e-12


@dataclass(frozen=True)
class LinearSystem:
    """Matrices of a system about its static load."""

    names: tuple[str, ...]  #: names of the coordinates
    mass: Array  #: [kg or kg*m^2, N*s/m, N/m, ...]
    damping: Array  #: [kg or kg*m^2, N*s/m, N/m, ...]
    stiffness: Array  #: [kg or kg*m^2, N*s/m, N/m, ...]
    friction_damping: Array
    friction_stiffness: Array
    contact_stiffness: Array  #: share of each contact in ``stiffness`` [N/m, ...]
    direction: Array  #: [1 or m]
    push: Array  #: [1 or m]
    gyroscopic: Array | None  #: skew matrix of the gyroscopic moments [N*s/m, ...]
    spring: Array  #: stiffness of each contact, mean over the cycle [N/m]
    damper: Array  #: damping of each contact, mean over the cycle [N*s/m]
    bundle: Index  #: number of the force law to which each contact belongs


def linear_system(system: System, phase: ModePhase = "mean") -> LinearSystem:
    """Replace every contact by the spring and the damper that act at the static load; cached."""
    if phase not in system._linear:
        system._linear[phase] = _linearised(split_ramps(system), phase)
    linear: LinearSystem = system._linear[phase]
    return linear


def _linearised(system: System, phase: ModePhase) -> LinearSystem:
    nodes, weight = _rows(system, phase)
    closed, push = _at_rest(system, nodes)
    along, rub = nodes.direction, combined(np.subtract, push, nodes.direction)
    spring = weight[:, :, None] * np.where(closed, nodes.stiffness, 0.0)
    damper = weight[:, :, None] * np.where(closed | system._damped_in_gap, nodes.damping, 0.0)
    contact_stiffness = _over_cycle(spring, along, along)
    return LinearSystem(
        names=tuple(system.names),
        mass=np.asarray(system.mass),
        damping=np.asarray(system.damping) + _over_cycle(damper, along, along).sum(axis=0),
        stiffness=np.asarray(system.stiffness) + contact_stiffness.sum(axis=0),
        friction_damping=_over_cycle(damper, rub, along).sum(axis=0),
        friction_stiffness=_over_cycle(spring, rub, along).sum(axis=0),
        contact_stiffness=contact_stiffness,
        direction=_mean(weight, along),
        push=_mean(weight, push),
        gyroscopic=None if system.gyroscopic is None else np.asarray(system.gyroscopic),
        spring=spring.sum(axis=(0, 1)),
        damper=damper.sum(axis=(0, 1)),
        bundle=force_laws(nodes),
    )


def _mean(weight: Array, directions: Array) -> Array:
    """Mean of directions over the cycle, (contacts, n)."""
    directions = unrepeated(directions, 2)
    weight = weight if directions.shape[:2] == weight.shape else np.ones((1, 1))
    return np.asarray(np.einsum("rs,rsji->ji", weight, directions))


def _over_cycle(factor: Array, rows: Array, columns: Array) -> Array:
    """Sum over the cycle of a factor times two directions, for each contact (contacts, n, n)."""
    rows, columns = unrepeated(rows, 2), unrepeated(columns, 2)
    if rows.shape[:2] == columns.shape[:2] == (1, 1):
        factor = factor.sum(axis=(0, 1), keepdims=True)
    shape = (factor.shape[0] * factor.shape[1], *rows.shape[2:])
    left = (factor[..., None] * rows).reshape(shape).transpose(1, 2, 0)
    if columns.shape[:2] == (1, 1):
        return np.asarray(left.sum(axis=-1, keepdims=True) * columns[0, 0][:, None])
    return np.asarray(
        left @ (columns + np.zeros_like(factor[..., None])).reshape(shape).transpose(1, 0, 2)
    )


def _rows(system: System, phase: ModePhase) -> tuple[Nodes, Array]:
    """Rows of the system with weights of sum 1: over the whole cycle, or at one phase."""
    if phase == "mean":
        _, nodes = sampled(system, max(_STEPS * system.cycles, 4 * len(system_events(system))))
        return nodes, nodes.weight
    if isinstance(phase, str):
        why = '"mean" or a mesh phase in [0, 1)'
        raise InputError(f'phase = "{phase}"', "argument phase", why, "Choose one of the two")
    at = float(phase)
    require_between("phase", at, 0.0, np.nextafter(1.0, 0.0), "")
    clocked = system.clocked_contacts
    contacts = tuple(replace(contact, events=(*contact.events, at)) for contact in clocked)
    marked = replace(system, contacts=contacts, frictions=system.clocked_frictions)
    grid, nodes = sampled(marked, 4 * len(system_events(marked)))
    row = int(np.argmin(np.abs(grid.left - at)))
    single = Nodes(*(part[row : row + 1, :1] for part in nodes))
    return single, np.ones((1, 1))


def _at_rest(system: System, nodes: Nodes) -> tuple[Mask, Array]:
    """Contacts that are closed at rest, and the generalized force per newton with friction."""
    lowest = np.broadcast_to(lowest_of_each_law(nodes), nodes.stiffness.shape)
    push = nodes.force_direction
    if lowest.all() and not system.frictions:
        return np.array(lowest), push
    still, closed = _Rest(system, nodes), np.ones(nodes.stiffness.shape, dtype=bool)
    load = np.zeros((*nodes.stiffness.shape[:2], len(system.frictions)))
    for _ in range(_ROUNDS):
        carrying = np.where(closed, nodes.stiffness, 0.0)
        compression = still.compression(carrying, push)
        updated = lowest | (compression > nodes.gap)
        done = np.array_equal(updated, closed)
        if system.frictions:
            last, load = load, carried_load(system, carrying * (compression - nodes.gap))
            ratio = friction_secant(system, nodes.friction_coefficients, load)
            push = push_with_friction(system, nodes, ratio)
            done &= bool(np.abs(load - last).max() <= 1e-12 * np.abs(load).max())
        if done:
            break
        closed = updated
    tangent = friction_tangent(system, nodes.friction_coefficients, load)
    return closed, push_with_friction(system, nodes, tangent)


class _Rest:
    """Compression of the contacts at rest at every phase; free motions get no displacement."""

    # The structure is inverted once, with its contacts at their mean stiffness. What differs at a
    # phase acts between the few directions of the contacts (the formula of Woodbury).
    def __init__(self, system: System, nodes: Nodes) -> None:
        scale = 1.0 / np.sqrt(np.diag(np.asarray(system.mass)))
        along = unrepeated(nodes.direction, 2) * scale
        upper = np.linalg.qr(along.reshape(-1, system.size), mode="r")
        _, sizes, basis = np.linalg.svd(upper, full_matrices=False)
        basis = basis[sizes > _ZERO * sizes[0]]
        feel = along @ basis.T
        spring = (nodes.weight[..., None] * nodes.stiffness)[..., None] * feel
        mean = np.einsum("rsja,rsjb->ab", spring, feel + np.zeros_like(spring))
        matrix = np.asarray(system.stiffness) * np.outer(scale, scale)
        left, values, right = np.linalg.svd(matrix + basis.T @ mean @ basis)
        nonzero = values > _ZERO * values[0]
        # Motion along the directions of the contacts per force, and the forces that move freely.
        reach = (basis @ right[nonzero].T / values[nonzero]) @ left[:, nonzero].T
        free = left[:, ~nonzero]
        self._nodes, self._feel, self._square = nodes, feel, reach @ reach.T
        self._still, self._lost = np.eye(len(basis)) - reach @ basis.T @ mean, mean.T @ basis @ free
        self._project = scale[:, None] * np.hstack((reach.T, free))

    def compression(self, carrying: Array, push: Array) -> Array:
        """Compressions (rows, stages, contacts) where contacts of a stiffness push."""
        nodes, feel, size = self._nodes, self._feel, len(self._square)
        parts = unrepeated(push, 2) @ self._project
        shift = carrying * (nodes.error + nodes.gap)
        force = nodes.force @ self._project + np.einsum("rsj,rsja->rsa", shift, parts)
        pressed = np.swapaxes(carrying[..., None] * feel, -1, -2) @ parts
        matrix = self._still + np.swapaxes(pressed[..., :size], -1, -2)
        moved, turned = force[..., :size, None], pressed[..., size:] - self._lost
        if turned.any():
            # Forces with friction that accelerate the free motions are left out.
            bent = np.linalg.solve(np.swapaxes(matrix, -1, -2), turned)
            back = np.swapaxes(bent, -1, -2)
            gained = force[..., size:, None] - back @ moved
            share = np.linalg.solve(np.eye(gained.shape[-2]) + back @ self._square @ bent, gained)
            moved = moved + self._square @ bent @ share
        return np.asarray((feel @ np.linalg.solve(matrix, moved))[..., 0] - nodes.error)


@record
class ForcedResponse(Record):
    """Complex amplitudes of the motion that a harmonic error excites.

    A signal is ``Re(amplitude*exp(2 pi i f t))`` where the error is ``Re(error*exp(2 pi i f t))``.

    Parameters
    ----------
    names : tuple of str
        Names of the coordinates.
    frequency : (f,) array
        Frequencies of the error [Hz].
    error : float
        Amplitude of the error [m].
    contact : tuple of int
        The contacts on which the error acts.
    position : (f, n) complex array
        Coordinates [m or rad].
    transmission_error : (f, contacts) complex array
        Approach of the two bodies along the direction of each contact [m].
    deflection : (f, contacts) complex array
        Compression of each contact: the approach less the error [m].
    contact_force : (f, contacts) complex array
        Force of each contact [N].
    structure_force : (f, n) complex array
        Force of the springs and dampers of the structure, bearings and shafts, against each
        coordinate [N or N*m].

    Examples
    --------
    >>> from tribodyn.dynamics import Contact
    >>> pair = Contact([1.0], stiffness=1e8, damping=10.0)
    >>> forced_response(System([[1.0]], [[0.0]], [[0.0]], [1.0], [pair]), [100.0, 1591.5])
    ForcedResponse(2 frequencies, largest mesh force 99804.6 N at 1591.5 Hz)
    """

    names: tuple[str, ...] = quantity("coordinate", axis=True, name="coordinate")
    frequency: Array = quantity("frequency", unit="Hz", axis=True)
    error: float = fact()
    contact: tuple[int, ...]
    position: ComplexArray = quantity("frequency", "coordinate", unit="m or rad")
    transmission_error: ComplexArray = quantity("frequency", "contact", unit="m")
    deflection: ComplexArray = quantity("frequency", "contact", unit="m")
    contact_force: ComplexArray = quantity("frequency", "contact", unit="N")
    structure_force: ComplexArray = quantity("frequency", "coordinate", unit="N or N*m")

    @property
    def mesh_force(self) -> ComplexArray:
        """Force of the contacts on which the error acts together, (f,) [N]."""
        return np.asarray(self.contact_force[:, list(self.contact)].sum(axis=1))

    def peaks(self) -> Array:
        """Frequencies between the first and the last at which the mesh force is largest.

        Returns
        -------
        (m,) array
            Local maxima among the frequencies, rising [Hz].
        """
        size = np.abs(self.mesh_force)
        inner = (size[1:-1] > size[:-2]) & (size[1:-1] >= size[2:])
        return np.asarray(self.frequency[1:-1][inner])

    def __repr__(self) -> str:
        """One line."""
        size = np.abs(self.mesh_force)
        top = int(size.argmax())
        return (
            f"ForcedResponse({self.frequency.size} frequencies, largest mesh force "
            f"{size[top]:.6g} N at {self.frequency[top]:.6g} Hz)"
        )


def forced_response(
    system: System,
    frequency: ArrayLike,
    *,
    contact: int = 0,
    error: float = 1e-6,
    phase: ModePhase = "mean",
    friction: bool = True,
) -> ForcedResponse:
    """Compute the harmonic motion that a displacement error of one mesh excites.

    Parameters
    ----------
    system : System
    frequency : float or (f,) array
        Frequencies of the error [Hz].
    contact : int
        Contact with the error; the other ramps of its force law have the same error.
    error : float
        Amplitude of the error [m].
    phase : "mean" or float
        Contact stiffness: mean over the mesh cycle, or that at one mesh phase in [0, 1).
    friction : bool
        Whether friction follows the contact force.

    Raises
    ------
    InputError
        If a frequency is not positive, there is no such contact, or an undamped mode lies exactly
        at a frequency.

    Notes
    -----
    ``[K - w^2 M + i w C] q = sum_j (h_j + s_j)(k_j + i w c_j) e``: the error acts on the springs
    and dampers of the contacts, the resulting motion changes their compression. The result holds
    while the teeth stay in contact and the stiffness is nearly constant; for the excitation by a
    varying stiffness use ``steady_state``.

    Examples
    --------
    >>> from tribodyn.dynamics import Contact
    >>> pair = Contact([1.0], stiffness=1e8)
    >>> slow = forced_response(System([[1.0]], [[0.0]], [[0.0]], [1.0], [pair]), 1.0)
    >>> float(slow.transmission_error[0, 0].real.round(9))
    1e-06
    """
    require_positive("frequency", frequency, "Hz")
    hertz = np.atleast_1d(np.asarray(frequency, dtype=float))
    linear = linear_system(system, phase)
    count = linear.spring.size
    if not 0 <= contact < count:
        what = f"contact = {contact}"
        why = f"The system has {count} contact{'s' if count != 1 else ''}, counted from 0"
        raise InputError(what, "argument contact", why, "Give the number of one of its contacts")
    members = np.flatnonzero(linear.bundle == linear.bundle[contact])
    contact_error = np.where(np.isin(np.arange(count), members), float(error), 0.0)
    position = _solve(linear, 2.0 * np.pi * hertz, contact_error, friction)
    approach = position @ linear.direction.T
    deflection = approach - contact_error
    omega = 2j * np.pi * hertz[:, None]
    stiffness, damping = np.asarray(system.stiffness), system.rate_matrix
    return ForcedResponse(
        names=linear.names,
        frequency=hertz,
        error=float(error),
        contact=tuple(int(member) for member in members),
        position=position,
        transmission_error=approach,
        deflection=deflection,
        contact_force=(linear.spring + omega * linear.damper) * deflection,
        structure_force=position @ stiffness.T + omega * (position @ damping.T),
    )


def _solve(
    linear: LinearSystem, omega: Array, contact_error: Array, friction: bool
) -> ComplexArray:
    w = omega[:, None, None]
    spring = linear.stiffness + (linear.friction_stiffness if friction else 0.0)
    damper = linear.damping + (linear.friction_damping if friction else 0.0)
    damper = damper if linear.gyroscopic is None else damper + linear.gyroscopic
    push = linear.push if friction else linear.direction
    dynamic = spring - w**2 * linear.mass + 1j * w * damper
    force = (linear.spring + 1j * omega[:, None] * linear.damper) * contact_error @ push
    scale = 1.0 / np.sqrt(np.diag(linear.mass))
    scaled = dynamic * np.outer(scale, scale)
    try:
        solved = np.linalg.solve(scaled, (scale * force)[:, :, None])[:, :, 0]
    except np.linalg.LinAlgError as error:
        what = "an undamped mode lies exactly at one of the frequencies"
        why = "Its motion grows without bounds"
        remedy = "Add damping to the structure or the contact"
        raise InputError(what, "argument frequency", why, remedy) from error
    return np.asarray(scale * solved)
