"""Gears whose friction follows the load of the teeth instead of that of the nominal torque."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.dynamics.equations.system import LoadFriction, System
from tribodyn.errors import InputError
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.mesh import MeshFriction


#: Coordinates across the line of action, as the models name them.
_ACROSS = ("x", "v")


def follow_load(system: System, friction: MeshFriction) -> System:
    """Let friction follow the dynamic load of the teeth.

    Parameters
    ----------
    system : System
        Of one gear pair, its coordinates named ``pinion_theta``, ``wheel_theta`` and, where the
        gears move across the line of action, ``pinion_x`` and ``wheel_x`` (or ``_v``).
    friction : MeshFriction
        Friction of the same mesh over phase and load.

    Returns
    -------
    System
        The same without the friction of its contacts, which all belong to this mesh: friction
        coefficients and load shares are those of the sum of their forces.

    Raises
    ------
    InputError
        If the coordinates are not named like those of a gear pair.

    Notes
    -----
    Friction acts on the pinion against its sliding over the wheel, whichever gear drives, and with
    the lever of its radius of curvature. Load shares are those of the loads at rest.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> from tribodyn.dynamics import torsional
    >>> flat = SimpleNamespace(stiffness=lambda p: 3e8 + 0 * p, friction_sum=lambda p: 0 * p,
    ...     friction_moment_pinion=lambda p: 0 * p, friction_moment_wheel=lambda p: 0 * p,
    ...     event_phases=(0.0,))
    >>> pair = torsional(
    ...     flat, moment_of_inertia=1e-3, base_radius=(0.03, 0.05), torque=(90.0, 150.0))
    >>> rubbing = SimpleNamespace(load=3000.0, limit=3.0, grid=SimpleNamespace(event_phases=(0.0,)),
    ...     channel=lambda name: [2e-3, 1e-4])
    >>> [each.direction.tolist() for each in follow_load(pair, rubbing).frictions]
    [[1.0, 0.0], [0.0, -1.0]]
    """
    events = tuple(friction.grid.event_phases)
    everyone = tuple(range(len(system.contacts)))
    frictions = [
        LoadFriction(
            direction=direction,
            coefficients=friction.channel(name),
            load=friction.load,
            contacts=everyone,
            limit=friction.limit,
            events=events,
        )
        for name, direction in _directions(tuple(system.names)).items()
        if direction.any()
    ]
    contacts = [
        replace(contact, friction=None, events=tuple(sorted({*contact.events, *events})))
        for contact in system.contacts
    ]
    return replace(system, contacts=contacts, frictions=(*system.frictions, *frictions))


def _directions(names: tuple[str, ...]) -> dict[str, Array]:
    """How each friction sum of the mesh acts on the coordinates."""
    missing = [name for name in ("pinion_theta", "wheel_theta") if name not in names]
    if missing:
        raise InputError(
            f"no coordinate is named {missing[0]}",
            where="argument system",
            why=f"Friction has to find the gears among {', '.join(names)}",
            remedy="Name the coordinates, or give LoadFriction to the system yourself",
        )
    unit = dict(zip(names, np.eye(len(names)), strict=True))
    nothing = np.zeros(len(names))
    across = nothing
    for axis in _ACROSS:
        across = across + unit.get(f"pinion_{axis}", nothing) - unit.get(f"wheel_{axis}", nothing)
    return {
        "friction_sum": across,
        "friction_moment_pinion": unit["pinion_theta"],
        "friction_moment_wheel": nothing - unit["wheel_theta"],
    }
