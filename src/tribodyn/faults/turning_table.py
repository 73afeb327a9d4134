"""Mesh of hypoid pairs over whole turns: deviations of the flanks as transmission errors.

Waves run on from tooth to tooth, so that all pairs in contact have the same error. Of teeth that
differ the error is the mean of the pairs, weighted with their shares of the load, as of springs in
parallel; the shares are those of the sound mesh.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from tribodyn.errors import Argument, InputError
from tribodyn.faults.deviations import PitchDeviations, Waviness
from tribodyn.faults.fault import Fault
from tribodyn.faults.turning import TurningMesh
from tribodyn.mesh import MeshForceLaw, MeshTable, PhaseFunction, PhaseGrid
from tribodyn.types import Array

#: Distance of a phase from an event that is rounding [mesh cycles].
_ROUNDING = 1e-9


class BevelGear(NamedTuple):
    """A hypoid or bevel gear as its deviations see it."""

    teeth: int
    reference_radius: float  #: mean pitch radius [m]
    normal_module: float  #: mean normal module [m]
    lever: float  #: torque over the force between the flanks [m]


def check_hypoid_fault(fault: Fault) -> None:
    """Raise InputError for damage, and for deviations that vary along the teeth."""
    if isinstance(fault, PitchDeviations):
        return
    if not isinstance(fault, Waviness):
        raise InputError(
            "the gears are a hypoid pair",
            Argument("kind"),
            "Its teeth are computed for one mesh cycle, and this fault changes the contact of one "
            "tooth or along the teeth",
            "Kinds of hypoid pairs are eccentricity, waviness, pitch-deviations, torque-ripple, "
            "speed-fluctuation, random-load and bearing-defect",
        )
    if fault.lead_angle:
        what, why = f"lead_angle = {fault.lead_angle:g} rad", "Waves of hypoid pairs are uniform"
        raise InputError(what, Argument("lead_angle"), why, "Remove it")


def turning_table(
    table: MeshTable, gears: Mapping[str, BevelGear], faults: Sequence[Fault], driver: str
) -> TurningMesh:
    """Repeat the mesh of a hypoid pair over whole turns, with the deviations of its flanks."""
    for fault in faults:
        check_hypoid_fault(fault)
    cycles = math.lcm(*(gears[fault.gear].teeth for fault in faults))
    errors = [_error(fault, table, gears[fault.gear], driver) for fault in faults]

    def error(clock: Array | float) -> Array:
        turned = np.asarray(clock, dtype=float) * cycles
        nearest = np.round(turned)
        turned = np.where(np.abs(turned - nearest) < _ROUNDING, nearest, turned)
        return np.asarray(sum((of(turned) for of in errors), np.zeros(turned.shape)))

    grid, law = table.grid, table.force_law
    count = cycles * sum(grid.intervals)
    clock = np.arange(count + 1) / count
    static = table.static_transmission_error
    if table.unloaded_transmission_error is not None:
        static = static + table.unloaded_transmission_error
    over_turns = [
        PhaseFunction(grid, values)(clock * cycles % 1.0)
        for values in (static, table.mesh_stiffness_tangent, table.load_share)
    ]
    events = (np.arange(cycles)[:, None] + np.array(grid.event_phases)).ravel() / cycles
    return TurningMesh(
        phase=clock * cycles,
        transmission_error=over_turns[0] + error(clock),
        mesh_stiffness_tangent=over_turns[1],
        load_share=over_turns[2],
        face_position=np.zeros(1),
        face_load=np.ones((cycles, 1)),
        force_law=MeshForceLaw(
            PhaseGrid(tuple(events.tolist()), grid.intervals * cycles),
            np.tile(law.knot_deflection, (cycles, 1)),
            np.tile(law.knot_stiffness, (cycles, 1)),
        ),
        cycles=cycles,
        error=error if faults else None,
    )


def _error(
    fault: Fault, table: MeshTable, gear: BevelGear, driver: str
) -> Callable[[Array], Array]:
    """Error of a fault in the direction of the mesh force [m] over mesh cycles."""
    if isinstance(fault, Waviness):
        wave = fault
        return lambda turned: wave._gap_after(turned / gear.teeth)
    assert isinstance(fault, PitchDeviations)
    places = np.cumsum(fault.single(gear)) * (gear.lever / gear.reference_radius)
    # a flank of the driving gear that is ahead has a gap, one of the driven gear touches early
    gaps = (places - places[0]) * (1.0 if fault.gear == driver else -1.0)
    share = PhaseFunction(table.grid, table.load_share)

    def of_teeth(turned: Array) -> Array:
        cycle = np.floor(turned).astype(int)
        number = np.arange(table.load_share.shape[1])  # mesh cycles since each pair entered
        tooth = (cycle[..., None] - number) % gear.teeth
        return np.asarray((share(turned - cycle) * gaps[tooth]).sum(axis=-1))

    return of_teeth
