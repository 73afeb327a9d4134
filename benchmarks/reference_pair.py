"""The gear pair that every benchmark runs: FZG type A with six degrees of freedom.

Reference case D2: 16/24 teeth, module 4.5 mm, pinion at 900 rpm and 90 N*m, 2e8 N/m per tooth pair
and a friction coefficient of 0.1 whose sign changes at the pitch point. Its entries are piecewise
constant or linear in the mesh phase, so that every contender can integrate exactly the same
equations: ours through :class:`~tribodyn.dynamics.System`, the others piece by piece.
"""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass, replace
from functools import cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from tribodyn.contact import PathOfContact, path_of_contact
from tribodyn.dynamics import System, spur6
from tribodyn.errors import ModelWarning
from tribodyn.gear import spur_pair
from tribodyn.mesh import MeshFunctions

__all__ = [
    "D2",
    "WITH_BACKLASH",
    "Pair",
    "Piece",
    "elastic",
    "lanes",
    "path",
    "pieces",
    "starting_state",
    "system",
]

Array = NDArray[np.float64]

#: Stiffness of one tooth pair [N/m].
PAIR_STIFFNESS = 2e8


@dataclass(frozen=True)
class Pair:
    """What varies between the variants of the reference pair.

    Parameters
    ----------
    friction : float
        Friction coefficient [-].
    mesh_damping : float
        Damping along the line of action, acting in contact [N*s/m].
    gap : float
        Half the play along the line of action [m]; zero makes the mesh linear.
    torque : float
        Torque of the pinion [N*m]; that of the wheel is 1.5 times as large.
    mesh_frequency : float
        In Hz.
    """

    friction: float = 0.1
    mesh_damping: float = 900.0
    gap: float = 0.0
    torque: float = 90.0
    mesh_frequency: float = 240.0

    mass = (0.676, 1.084)
    moment_of_inertia = (407e-6, 1168e-6)
    bearing_stiffness = 3.5e9
    bearing_damping = 4e3


#: The linear reference case.
D2 = Pair()
#: Lightly loaded and lightly damped near resonance: the teeth separate in every cycle.
WITH_BACKLASH = Pair(mesh_damping=300.0, gap=30e-6, torque=30.0, mesh_frequency=5200.0)


@cache
def path() -> PathOfContact:
    """Path of contact of the pair.

    Returns
    -------
    PathOfContact
    """
    with warnings.catch_warnings():
        # Pointed pinion and slightly undercut wheel: so is FZG type A.
        warnings.simplefilter("ignore", ModelWarning)
        pair = spur_pair(
            pinion_teeth=16,
            wheel_teeth=24,
            normal_module=4.5e-3,
            normal_pressure_angle=math.radians(20.0),
            pinion_face_width=20e-3,
            center_distance=91.5e-3,
            pinion_profile_shift_coefficient=0.8635,
            wheel_profile_shift_coefficient=-0.5103,
        )
    return path_of_contact(pair)


@dataclass(frozen=True)
class Piece:
    """One piece of the mesh cycle between two events, with exact entries.

    Parameters
    ----------
    begin, end : float
        Mesh phases [-].
    stiffness : float
        Mesh stiffness [N/m].
    friction, friction_slope : (6,) array
        Friction direction at the beginning [1 or m] and its change per mesh phase.
    """

    begin: float
    end: float
    stiffness: float
    friction: Array
    friction_slope: Array


@cache
def pieces(pair: Pair) -> tuple[Piece, ...]:
    """Pieces of the mesh cycle.

    Parameters
    ----------
    pair : Pair

    Returns
    -------
    tuple of Piece
    """
    contact = path()
    edges = (*contact.event_phases(), 1.0)
    return tuple(_piece(pair, begin, end) for begin, end in pairwise(edges))


def _piece(pair: Pair, begin: float, end: float) -> Piece:
    contact = path()
    length, pitch = contact.pair.line_of_action_length, contact.pair.base_pitch
    paths, inside = (part[0] for part in contact.pair_paths(0.5 * (begin + end)))
    share = pair.friction * contact.sliding_direction(paths) * inside / inside.sum()
    at_begin = paths - 0.5 * (end - begin) * pitch
    across = share.sum()
    pinion, wheel = share @ at_begin, share @ (length - at_begin)
    return Piece(
        begin,
        end,
        PAIR_STIFFNESS * int(inside.sum()),
        np.array([across, 0.0, pinion, -across, 0.0, -wheel]),
        np.array([0.0, 0.0, across * pitch, 0.0, 0.0, across * pitch]),
    )


def _functions(pair: Pair) -> MeshFunctions:
    parts = pieces(pair)
    edges = np.array([piece.begin for piece in parts])
    stiffness = np.array([piece.stiffness for piece in parts])
    friction = np.array([piece.friction for piece in parts])
    slope = np.array([piece.friction_slope for piece in parts])

    def index(phase: Array | float) -> NDArray[np.intp]:
        return np.searchsorted(edges, np.asarray(phase), side="right") - 1

    def component(phase: Array | float, column: int) -> Array:
        i = index(phase)
        return np.asarray(friction[i, column] + slope[i, column] * (phase - edges[i]))

    return MeshFunctions(
        stiffness=lambda phase: stiffness[index(phase)],
        friction_sum=lambda phase: component(phase, 0),
        friction_moment_pinion=lambda phase: component(phase, 2),
        friction_moment_wheel=lambda phase: -component(phase, 5),
        event_phases=tuple(edges),
    )


def system(pair: Pair) -> System:
    """Structure and contact as tribodyn takes them.

    Parameters
    ----------
    pair : Pair

    Returns
    -------
    System
        Coordinates (x, y, theta) of the pinion, then of the wheel.
    """
    gears = path().pair
    return spur6(
        _functions(pair),
        mass=pair.mass,
        moment_of_inertia=pair.moment_of_inertia,
        base_radius=(gears.pinion.base_radius, gears.wheel.base_radius),
        torque=(pair.torque, 1.5 * pair.torque),
        bearing_stiffness=pair.bearing_stiffness,
        bearing_damping=pair.bearing_damping,
        mesh_damping=pair.mesh_damping,
        backlash=2.0 * pair.gap,
        torque_balance="both",
    )


def starting_state(pair: Pair) -> tuple[Array, Array]:
    """Rest under the load, at the stiffness of two tooth pairs and without friction.

    Parameters
    ----------
    pair : Pair

    Returns
    -------
    tuple of two (6,) arrays
        Position and velocity.
    """
    radius = path().pair.pinion.base_radius
    force = pair.torque / radius
    give = force / pair.bearing_stiffness
    deflection = force / (2.0 * PAIR_STIFFNESS) + pair.gap
    position = np.array([0.0, -give, (deflection + 2.0 * give) / radius, 0.0, give, 0.0])
    return position, np.zeros(6)


def elastic(position: Array) -> Array:
    """Displacements that load the structure, without the free rotation of the pair.

    Parameters
    ----------
    position : (..., 6) array
        Coordinates [m or rad].

    Returns
    -------
    (..., 5) array
        x and y of both gears and the deflection of the mesh, all in m.
    """
    gears = path().pair
    direction = np.array([0, 1, gears.pinion.base_radius, 0, -1, -gears.wheel.base_radius])
    return np.concatenate((position[..., [0, 1, 3, 4]], (position @ direction)[..., None]), -1)


def lanes(pair: Pair, count: int) -> list[Pair]:
    """Variants that differ in mesh frequency and torque by up to ten percent.

    Parameters
    ----------
    pair : Pair
    count : int

    Returns
    -------
    list of Pair
        The first is the pair itself.
    """
    spread = np.linspace(0.0, 0.1, count)
    return [
        replace(
            pair, mesh_frequency=pair.mesh_frequency * (1.0 + s), torque=pair.torque * (1.0 - s)
        )
        for s in spread
    ]
