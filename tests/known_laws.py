"""Known force laws of a mesh, and the gear pair of the reference cases on them."""

from __future__ import annotations

import numpy as np

from known_systems import BASE_RADIUS
from tribodyn.dynamics import spur6, torsional
from tribodyn.mesh import MeshForceLaw, MeshFunctions, PhaseFunction, phase_grid

#: Nominal load of the reference pair [N].
LOAD = 90.0 / BASE_RADIUS[0]
EVENTS = (0.0, 0.25)
GRID = phase_grid(EVENTS, 256)


def constant_law(place, stiffness):
    """The same ramps at every phase."""
    count = GRID.phase.size
    return MeshForceLaw(GRID, np.tile(place, (count, 1)), np.tile(stiffness, (count, 1)))


def wavy_law(ramps, reach=40e-6):
    """A law that hardens, with a stiffness and a first touch that move with the phase."""
    phase = GRID.phase[:, None]
    deflection = np.linspace(0.0, reach, ramps + 1)
    stiffness = 2.3e8 * (1.0 + 0.25 * np.cos(2 * np.pi * phase))
    force = stiffness * 1e-5 * (deflection / 1e-5) ** 1.1
    touch = 1e-6 * (1.0 + np.sin(2 * np.pi * phase))
    return MeshForceLaw.through(GRID, deflection + touch, force)


def mesh_functions(law, friction=0.0, load=LOAD):
    """Functions of a mesh with this law; friction changes its direction at the event."""
    sign = np.where(GRID.middle < EVENTS[1], -1.0, 1.0)
    lever = 14e-3 + 13e-3 * GRID.phase
    # At an event a law returns the value after it: look a hair into the segment of the knot.
    phase = GRID.phase + 1e-12 * np.sign(GRID.middle - GRID.phase)
    static = law.deflection(phase, load)

    def table(values):
        return PhaseFunction(GRID, values)

    return MeshFunctions(
        table(load / static),
        table(friction * sign),
        table(friction * sign * lever),
        table(friction * sign * (36e-3 - lever)),
        EVENTS,
        table(law.tangent(phase, static)),
        table(static),
        load,
        law,
    )


def gear_pair(law, *, model="spur6", friction=0.0, **options):
    """The reference pair on a force law, or on the functions of a mesh."""
    shared = {
        "moment_of_inertia": (407e-6, 1168e-6),
        "base_radius": BASE_RADIUS,
        "torque": (90.0, 135.0),
        "mesh_damping": 900.0,
        "mesh_force": "force-law",
        "backlash": 1e-4,
    } | options
    mesh = mesh_functions(law, friction) if isinstance(law, MeshForceLaw) else law
    if model == "torsional":
        return torsional(mesh, **shared)
    return spur6(mesh, mass=(0.676, 1.084), bearing_stiffness=3.5e9, bearing_damping=4e3, **shared)


def total_force(motion):
    """Force of all ramps together."""
    return motion.fine.contact_force.sum(axis=1)
