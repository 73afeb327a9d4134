"""Static loads of the planets with errors of pins and teeth."""

from __future__ import annotations

from dataclasses import dataclass
from inspect import signature
from typing import Any

import numpy as np

from tribodyn.dynamics.equations.entry import entry_values
from tribodyn.dynamics.equations.system import System
from tribodyn.errors import Argument, ComputationError, InputError, Problem, did_you_mean
from tribodyn.machine.planetary.double_planets import force_ratios
from tribodyn.machine.planetary.plane_model import CENTRAL, planetary_plane_model
from tribodyn.types import Array, Mask, Tree

#: Weak springs to the last position, over the largest stiffness; iterations, and the change of
#: forces over the mean at which they end.
_WEAK, _ROUNDS, _DONE = 1e-11, 200, 1e-11
#: Phases of the mean over a mesh cycle.
_PHASES = np.arange(256) / 256.0


@dataclass(frozen=True, eq=False)
class LoadShares:
    """Static loads of the planets of a stage.

    Parameters
    ----------
    force : (N,) array
        Force of the sun mesh of every planet along the line of action, which its ring mesh
        transmits too, that of stepped planets over ``radius_ratio``; negative while the stage is
        driven backwards [N].
    share : (N,) array
        Force over the mean of all planets.
    displacement : mapping of str to (float, float)
        Displacement of carrier, ring and sun along x and y [m]. Where a floating member
        can move without any force, its position is one of many.
    """

    force: Array
    share: Array
    displacement: dict[str, tuple[float, float]]

    @property
    def load_factor(self) -> float:
        """Mesh load factor K_gamma: greatest load of a planet over the mean."""
        return float(self.share.max())

    @property
    def unloaded(self) -> tuple[int, ...]:
        """Planets without load, counted from 1."""
        return tuple((np.flatnonzero(self.share == 0.0) + 1).tolist())


def load_shares(**stage: Any) -> LoadShares:
    """Compute the static loads of the planets of a stage; planets may lose contact.

    Parameters
    ----------
    **stage
        Arguments of :func:`planetary_plane_model`, with ``force_per_planet`` [N], and
        ``pin_errors`` or ``thickness_errors`` [m]. Of functions of the mesh phase the mean counts.

    Raises
    ------
    InputError
        If an argument is wrong or ``force_per_planet`` is 0.
    ComputationError
        If no equilibrium exists within the iterations.

    Notes
    -----
    The rotation of a planet, on which nothing acts but its meshes, gives the ratio of their forces:
    a planet, or a pair of planets, is one spring between the members that only presses. Weights and
    centrifugal forces are not included.

    Examples
    --------
    >>> data = dict(
    ...     carrier_mass=5.43, carrier_inertia=6.29, ring_mass=2.35, ring_inertia=3.0,
    ...     sun_mass=0.4, sun_inertia=0.39, planet_mass=0.66, planet_inertia=0.61,
    ...     sun_mesh_stiffness=5e8, ring_mesh_stiffness=5e8, pin_stiffness=1e8,
    ...     carrier_support=1e8, ring_support=1e8, sun_support=1e3, ring_torsional_support=1e9,
    ...     sun_pressure_angle=np.radians(24.6), ring_pressure_angle=np.radians(24.6))
    >>> shares = load_shares(planets=4, pin_errors=[30e-6, 0.0, 0.0, 0.0], force_per_planet=3000.0,
    ...                      **data)
    >>> shares.share.round(3), round(shares.load_factor, 3)
    (array([0.877, 1.123, 0.877, 1.123]), 1.123)
    """
    _check_names(stage)
    load = stage.get("force_per_planet", 0.0)
    system = planetary_plane_model(**stage)
    if not load:
        what, why = "force_per_planet is 0", "Shares are those of a load"
        remedy = "Give the mean force of a mesh along its line of action in N"
        raise InputError(what, Argument("force_per_planet"), why, remedy)
    spring, along, error = _planet_springs(system, stage)
    # Backwards the opposite flanks press.
    sense = 1.0 if load > 0.0 else -1.0
    parts = spring, sense * along, sense * error
    force, position = _equilibrium(np.asarray(system.stiffness), np.asarray(system.force), *parts)
    central = position[:9].reshape(3, 3)
    displacement = {
        name: (float(row[0]), float(row[1])) for name, row in zip(CENTRAL, central, strict=True)
    }
    return LoadShares(sense * force + 0.0, force / force.mean(), displacement)


def sampled_shares(pin_errors: Array, thickness_errors: Array, **stage: Any) -> Array:
    """Shares of the planets of many stages (m, N) that differ in their errors (m, N) [m]."""
    system = planetary_plane_model(**stage)
    spring, along, error = _planet_springs(system, stage)
    thick = 0.5 + 0.5 * [*force_ratios(stage.get("double_planets")).values()][-1]
    sense = 1.0 if stage["force_per_planet"] > 0.0 else -1.0
    stiffness, load = np.asarray(system.stiffness), np.asarray(system.force)
    units = np.eye(spring.size)  # what a pin that is 1 m ahead adds to the forces
    pushed = [planetary_plane_model(**stage, pin_errors=0.1 * unit).force for unit in units]
    ahead = 10.0 * (np.array(pushed) - load)
    forces = [
        _equilibrium(
            stiffness, load + pins @ ahead, spring, sense * along, sense * (error - thick * excess)
        )
        for pins, excess in zip(pin_errors, thickness_errors, strict=True)
    ]
    loads = np.array([force for force, _ in forces])
    return np.asarray(loads / loads.mean(axis=1, keepdims=True))


def _check_names(stage: Tree) -> None:
    """Refuse unknown and missing arguments of the plane model."""
    arguments = signature(planetary_plane_model).parameters
    needed = [name for name, each in arguments.items() if each.default is each.empty]
    why = "load_shares takes the arguments of planetary_plane_model"
    problems = [
        Problem(
            f"{name} is unknown", Argument(name), why, did_you_mean(name, arguments, "Remove it")
        )
        for name in stage
        if name not in arguments
    ]
    if missing := [name for name in needed if name not in stage]:
        what = f"{', '.join(missing)} {'is' if len(missing) == 1 else 'are'} missing"
        problems.append(Problem(what, "load_shares()", why, "Give them by their names"))
    if problems:
        raise InputError(problems)


def _planet_springs(system: System, stage: Tree) -> tuple[Array, Array, Array]:
    """Stiffness, direction and error of every planet between its members."""
    ratios = force_ratios(stage.get("double_planets"))
    count = len(system.contacts) // len(ratios)
    meshes = [f"{mesh}_mesh" for mesh in ratios for _ in range(count)]
    compliance, along, error = np.zeros(count), np.zeros((count, system.size)), np.zeros(count)
    for i, (mesh, contact) in enumerate(zip(meshes, system.contacts, strict=True)):
        stiffness, shift = (
            entry_values(f"{mesh}_{name}", getattr(contact, name), _PHASES, 1).mean()
            for name in ("stiffness", "error")
        )
        planet, ratio = i % count, [*ratios.values()][i // count]
        compliance[planet] += ratio**2 / stiffness
        along[planet] += ratio * np.asarray(contact.direction)
        error[planet] += ratio * shift
    return 1.0 / compliance, along, error


def _equilibrium(
    matrix: Array, load: Array, spring: Array, along: Array, error: Array
) -> tuple[Array, Array]:
    """Forces of the planets and the position at rest."""
    # The energy is convex. Weak springs to the last position hold what is free to move; their
    # forces vanish as the position settles.
    # The rotation of a planet does nothing in the sum of its meshes.
    size = load.size
    free = [i for i in range(load.size) if i < 9 or i % 3 != 2]
    matrix, load, along = matrix[np.ix_(free, free)], load[free], along[:, free]
    weak = _WEAK * float(np.diag(matrix).max()) * np.eye(len(free))
    position, last = np.zeros(len(free)), np.full(spring.size, np.inf)
    for _ in range(_ROUNDS):
        position = _loaded_position(matrix + weak, load + weak @ position, spring, along, error)
        force = spring * np.maximum(along @ position - error, 0.0)
        rounding = 1e-14 * float(spring.max() * np.abs(position).max())
        if np.abs(force - last).max() <= _DONE * force.mean() + rounding:
            break
        last = force
    else:
        what, why = "the loads of the planets do not settle", f"{_ROUNDS} iterations were made"
        raise ComputationError(what, "load_shares", why, "Check the supports and the errors")
    full = np.zeros(size)
    full[free] = position
    return force, full


def _loaded_position(
    matrix: Array, load: Array, spring: Array, along: Array, error: Array
) -> Array:
    """Position of least energy, by Newton's method with halved steps over the set in contact."""
    every = spring > 0.0
    position = _solved(*_linear(matrix, load, spring, along, error, every))

    def energy(at: Array) -> float:
        pressed = np.maximum(along @ at - error, 0.0)
        return float(0.5 * at @ matrix @ at - load @ at + 0.5 * spring @ pressed**2)

    for _ in range(_ROUNDS):
        closed = along @ position > error
        target = _solved(*_linear(matrix, load, spring, along, error, closed))
        if np.array_equal(along @ target > error, closed):
            return np.asarray(target)
        step, start = 1.0, energy(position)
        while energy(position + step * (target - position)) >= start and step > 1e-9:
            step *= 0.5
        if step <= 1e-9:  # a flank that touches without force
            break
        position = position + step * (target - position)
    return np.asarray(position)


def _solved(matrix: Array, load: Array) -> Array:
    """Position under a load, refined once, as what weak springs hold is sensitive to rounding."""
    position = np.linalg.solve(matrix, load)
    return np.asarray(position + np.linalg.solve(matrix, load - matrix @ position))


def _linear(
    matrix: Array, load: Array, spring: Array, along: Array, error: Array, closed: Mask
) -> tuple[Array, Array]:
    """Stiffness matrix and load with the springs of the loaded planets."""
    active = spring * closed
    return matrix + (along.T * active) @ along, load + (active * error) @ along
