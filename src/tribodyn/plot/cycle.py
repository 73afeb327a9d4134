"""The mesh table as curves: two mesh cycles, the life of one tooth pair, and the events.

Everything here reads the mesh table alone, so that a table draws itself without its case.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tribodyn.plot.labels import axis_label
from tribodyn.plot.sharing import further_changes

__all__ = [
    "CYCLES",
    "cycles",
    "driving_roll_angle",
    "mesh_events",
    "pair_life",
    "pair_lives",
    "positions",
    "roll_angle_label",
    "roll_angle_positions",
]

#: Mesh cycles drawn, so that the transition from one cycle to the next is seen.
CYCLES = 2

Curve = tuple[NDArray[np.float64], NDArray[np.float64]]


def cycles(phase: NDArray[np.float64], values: NDArray[np.float64], repeats: int = CYCLES) -> Curve:
    """Repeat one mesh cycle side by side.

    A phase that occurs twice carries the values before and after a jump, which is then drawn as
    a vertical line.

    Parameters
    ----------
    phase : array, shape (n,)
        Mesh phase from 0 to 1.
    values : array, shape (n,)
        One value for each phase.
    repeats : int
        Mesh cycles to draw.

    Returns
    -------
    tuple of array, each of shape (repeats * n,)
        Mesh phase and values.

    Examples
    --------
    >>> phase, values = cycles(np.array([0.0, 1.0]), np.array([3.0, 4.0]))
    >>> phase.tolist(), values.tolist()
    ([0.0, 1.0, 1.0, 2.0], [3.0, 4.0, 3.0, 4.0])
    """
    shifted = [phase + cycle for cycle in range(repeats)]
    return np.concatenate(shifted), np.tile(values, repeats)


def pair_life(mesh: Any, column: str) -> Curve:
    """Follow one tooth pair from where it enters to where it leaves.

    Parameters
    ----------
    mesh : MeshTable
        Its columns have the shape (n, pairs); pair ``i`` entered ``i`` cycles before phase 0.
    column : str
        Name of the column.

    Returns
    -------
    tuple of array, each of shape (k,)
        Age of the pair in mesh cycles, and the column in SI.
    """
    values = getattr(mesh, column)
    ages = mesh.phase[:, None] + np.arange(values.shape[1])
    touching = mesh.in_contact.T
    return ages.T[touching], values.T[touching]


def pair_lives(mesh: Any, column: str) -> list[Curve]:
    """Follow every tooth pair that touches within the cycles drawn, from zero and back to zero.

    Parameters
    ----------
    mesh : MeshTable
        Its columns have the shape (n, pairs).
    column : str
        Name of a column that is zero outside contact, such as ``"stiffness"``.

    Returns
    -------
    list of tuple of array
        Mesh phase and the column in SI, one entry for each tooth pair.
    """
    age, values = pair_life(mesh, column)
    age = np.concatenate((age[:1], age, age[-1:]))
    values = np.concatenate(([0.0], values, [0.0]))
    lives = []
    for start in range(1 - mesh.in_contact.shape[1], CYCLES):
        seen = (age + start >= 0.0) & (age + start <= CYCLES)
        lives.append((age[seen] + start, values[seen]))
    return lives


def _driving(mesh: Any) -> tuple[NDArray[np.float64], float]:
    """Radius of curvature of the driving flank along a pair's life, and its base radius [m]."""
    radius = pair_life(mesh, f"{mesh.driver}_curvature_radius")[1]
    return radius, getattr(mesh, f"base_radius_{mesh.driver}")


def driving_roll_angle(mesh: Any) -> NDArray[np.float64]:
    """Roll angle of the driving gear along the life of one tooth pair.

    Parameters
    ----------
    mesh : MeshTable
        One mesh cycle.

    Returns
    -------
    array, shape (k,)
        Roll angle [rad], for the same samples as :func:`pair_life`.
    """
    radius, base_radius = _driving(mesh)
    return radius / base_radius


def roll_angle_label(mesh: Any) -> str:
    """Label of an axis of roll angles.

    Parameters
    ----------
    mesh : MeshTable
        One mesh cycle.

    Returns
    -------
    str
    """
    return axis_label("roll_angle", f"Roll angle of the driving gear ({mesh.driver})")


def positions(mesh: Any) -> dict[str, float]:
    """Ages at which a tooth pair passes the positions A to E and further changes of sharing.

    Parameters
    ----------
    mesh : MeshTable
        One mesh cycle.

    Returns
    -------
    dict of str to float
        Mesh cycles since the pair entered at A. The pair before it leaves at B, the pair after
        it enters at D; C, the pitch point, may lie anywhere, also outside the contact. Further
        positions where the number of pairs changes follow; see :func:`further_changes`.
    """
    radius, base_radius = _driving(mesh)
    line_of_action = mesh.pinion_curvature_radius[0, 0] + mesh.wheel_curvature_radius[0, 0]
    share = base_radius / (mesh.base_radius_pinion + mesh.base_radius_wheel)
    base_pitch = abs(mesh.path[-1, 0] - mesh.path[0, 0])
    pitch_point = (share * line_of_action - radius[0]) / base_pitch
    ratio = mesh.transverse_contact_ratio
    letters = {"A": 0.0, "B": ratio - 1.0, "C": float(pitch_point), "D": 1.0, "E": ratio}
    return letters | further_changes(ratio)


def roll_angle_positions(mesh: Any) -> dict[str, float]:
    """Roll angles of the driving gear at the positions A to E and further changes of sharing.

    Parameters
    ----------
    mesh : MeshTable
        One mesh cycle.

    Returns
    -------
    dict of str to float
        Roll angles [rad].
    """
    radius, base_radius = _driving(mesh)
    base_pitch = abs(mesh.path[-1, 0] - mesh.path[0, 0])
    return {
        name: float((radius[0] + age * base_pitch) / base_radius)
        for name, age in positions(mesh).items()
    }


def mesh_events(mesh: Any, repeats: int = CYCLES) -> list[tuple[str, float]]:
    """Name the phases at which a tooth pair enters, leaves or rolls without sliding.

    Parameters
    ----------
    mesh : MeshTable
        One mesh cycle.
    repeats : int
        Mesh cycles to mark.

    Returns
    -------
    list of tuple
        Name and mesh phase.
    """
    age = positions(mesh)
    marks = [("enters", 0.0), ("leaves", age["E"] % 1.0)]
    if 0.0 <= age["C"] < age["E"]:
        marks.append(("C", age["C"] % 1.0))
    marked = [(name, phase + cycle) for cycle in range(repeats) for name, phase in marks]
    return [*marked, ("enters", float(repeats))]
