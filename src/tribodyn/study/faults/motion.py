"""Motion of a case with faults over whole turns of its gears."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tribodyn.faults import BearingDefect
from tribodyn.nomenclature import GEARS
from tribodyn.progress import SILENT, Progress
from tribodyn.record import Record, fact, quantity, record
from tribodyn.study.faults.clock import turning_clock
from tribodyn.study.faults.sensors import PairSensors, SensorPlace
from tribodyn.study.faults.turning import (
    SAMPLES,
    Accuracy,
    PeriodicMotion,
    even_samples,
    steady_over_turns,
)
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.dynamics import Contact, LoadFriction, Response, System
    from tribodyn.faults import BearingImpacts, DrivenSystem, Fault, TurningMesh
    from tribodyn.mesh import MeshFriction, MeshTable
    from tribodyn.study.case.case import Case
    from tribodyn.study.pipeline.assembly import Damping
    from tribodyn.study.pipeline.result import Result
    from tribodyn.study.pipeline.run import PreparedRun

#: Mesh order up to which the acceleration is that of the positions; from half of it on in part.
_SMOOTH = 64
_ACCURACY = Accuracy((128, 256, 512), 1e-6)


@record
class TurningMotion(PeriodicMotion, Record):
    """Motion over whole turns of a period, on evenly spaced samples from tooth 1 on."""

    time: Array = quantity("time", unit="s", axis=True)
    position: Array = quantity("time", "coordinate", unit="m or rad")
    velocity: Array = quantity("time", "coordinate", unit="m/s or rad/s")
    acceleration: Array = quantity("time", "coordinate", unit="m/s^2 or rad/s^2")
    mesh_force: Array = quantity("time", unit="N")
    transmission_error: Array = quantity("time", unit="m")
    names: tuple[str, ...] = quantity("coordinate", axis=True, name="coordinate")
    mesh: TurningMesh  #: over the same turns
    mesh_frequency: float = fact()  #: mesh cycles per second [Hz]
    cycles: int = fact()  #: mesh cycles of the period
    pinion_teeth: int = fact()
    wheel_teeth: int = fact()
    response: Response  #: on the steps of the search, without the fluctuation of the mean rotation
    #: Mesh cycles by which the rotation of the drive is ahead of its mean.
    lead: Array = quantity("time", unit="1")

    def series(self, place: SensorPlace) -> Array:
        """Acceleration of a coordinate, mesh force or transmission error."""
        if place.quantity == "acceleration":
            return np.asarray(self.acceleration[:, self.names.index(place.part)])
        return super().series(place)

    def impacts(
        self, sensor: str, defect: tuple[str, BearingImpacts], time: Array, seed: int
    ) -> Array | float:
        """Acceleration of the impacts of a bearing of a gear at the sensors of this gear."""
        gear, impacts = defect
        place = self.places.place(sensor)
        if place.part.partition("_")[0] != gear or place.unit != "m/s^2":
            return 0.0
        assert isinstance(impacts, BearingDefect)
        return impacts.signal(self.rotation_frequency(gear), time, seed)

    def __repr__(self) -> str:
        """One line."""
        force = self.mesh_force
        return (
            f"TurningMotion({self.cycles} mesh cycles at {self.mesh_frequency:.6g} Hz, mesh force "
            f"{force.min():.5g} to {force.max():.5g} N)"
        )


def turning_mesh_of(
    case: Case, table: MeshTable | None = None, faults: Sequence[Fault] | None = None
) -> TurningMesh:
    """Force law over whole turns with the faults of a case, or others; hypoid ones by table."""
    from tribodyn.faults import turning_mesh
    from tribodyn.faults.turning_table import turning_table
    from tribodyn.study.faults.section import bevel_gears, gear_faults
    from tribodyn.study.pipeline.tooth_contact import loaded_settings

    faults = tuple(gear_faults(case).values()) if faults is None else tuple(faults)
    if case.gears.kind == "hypoid":
        assert table is not None
        return turning_table(table, bevel_gears(case, table), faults, case.gears.driver)
    settings = loaded_settings(case)
    return turning_mesh(case.gear_pair, abs(case.pinion_torque), faults, **settings)


def turning_system(result: Result | PreparedRun, mesh: TurningMesh) -> System:
    """The structure of a result with the mesh over whole turns as its contact."""
    return turning_system_of(result.case, result.mesh, result.damping, mesh)


def turning_system_of(case: Case, table: MeshTable, damping: Damping, mesh: TurningMesh) -> System:
    """The structure of a case with the mesh over whole turns as its contact."""
    from tribodyn.study.mesh_inputs import mesh_inputs
    from tribodyn.study.pipeline.assembly import structure_of
    from tribodyn.study.pipeline.tooth_contact import load_friction_of

    system = structure_of(case, mesh.functions(table.functions()), damping, "stiffness")
    names, friction = tuple(system.names), load_friction_of(mesh_inputs(case), table)
    contacts, frictions = contacts_over_turns(names, system.contacts, mesh, friction)
    return replace(system, contacts=contacts, frictions=(*system.frictions, *frictions))


def contacts_over_turns(
    names: tuple[str, ...],
    contacts: Sequence[Contact],
    mesh: TurningMesh,
    friction: MeshFriction | None,
) -> tuple[tuple[Contact, ...], tuple[LoadFriction, ...]]:
    """Contacts and friction of teeth over whole turns, from those of a stiffness."""
    from tribodyn.dynamics import law_contact
    from tribodyn.dynamics.equations.clock import on_clock
    from tribodyn.dynamics.equations.system import FRICTION_ENTRIES
    from tribodyn.dynamics.structure.force_law import with_load_friction

    first, *others = contacts
    over_turns = (law_contact(first, mesh.force_law), *others)
    if friction is None:
        return over_turns, ()
    rubbing = with_load_friction(names, contacts, friction)[1]
    rubbing = tuple(on_clock(each, FRICTION_ENTRIES, mesh.cycles, 0.0) for each in rubbing)
    return tuple(replace(contact, friction=None) for contact in over_turns), rubbing


def driven_system(
    case: Case, table: MeshTable, damping: Damping, mesh: TurningMesh
) -> DrivenSystem:
    """The system with the mesh over whole turns and the excitation of its shafts."""
    from tribodyn.faults import drive
    from tribodyn.study.faults.section import excitations
    from tribodyn.study.pipeline.assembly import rotation_of, shaft_coordinates

    system = turning_system_of(case, table, damping, mesh)
    return drive(
        system,
        mesh.cycles,
        tuple(excitations(case).values()),
        mesh_frequency=table.mesh_frequency,
        teeth={name: abs(gear.teeth) for name, gear in case.gears.by_name.items()},
        coordinates=shaft_coordinates(case, system),
        rotation=rotation_of(case, system.names),
    )


def turning_motion(result: Result | PreparedRun, progress: Progress = SILENT) -> TurningMotion:
    """Compute the steady motion over whole turns; with equal teeth it is that of the result."""
    from tribodyn.study.case.to_models import locate_errors
    from tribodyn.study.pipeline.response_series import is_steady

    case = result.case
    with locate_errors(case):
        clock = turning_clock(case)
        progress.start(f"Teeth over whole turns: {clock}")
        mesh = turning_mesh_of(case, result.mesh)
        if not _varies(case):
            sound = result if isinstance(result, Record) else result.result(progress)
            if is_steady(sound.response):
                return _motion(case, mesh, sound.response, _of_run(sound), result.mesh)
        driven = driven_system(case, result.mesh, result.damping, mesh)
        frequency = result.mesh.mesh_frequency / driven.cycles
        response = steady_over_turns(driven, frequency, _ACCURACY, progress=progress)
    fine = response.fine
    error = fine.deflection[:, 0] - 0.5 * case.backlash
    return _motion(
        case, mesh, response, _Period(fine.phase, driven.cycles, error, driven), result.mesh
    )


def _varies(case: Case) -> bool:
    """Whether teeth differ or the drive is unsteady; a damaged bearing changes neither."""
    from tribodyn.study.faults.section import excitations, gear_faults

    pair = case.spur_pair
    differ = pair is not None and pair.teeth_differ
    return differ or bool(gear_faults(case)) or bool(excitations(case))


class _Period(NamedTuple):
    """Period of a motion, and what differs between that of a run and that of a driven system."""

    clock: Array  #: of the samples, in periods
    cycles: int  #: mesh cycles
    error: Array  #: transmission error of the samples [m]
    driven: DrivenSystem | None = None


def _of_run(sound: Result) -> _Period:
    from tribodyn.study.pipeline.response_series import transmission_error

    phase, cycles = sound.response.fine.phase, sound.response.periods
    error = transmission_error(sound, sound.response.fine)
    return _Period((phase - phase[0]) / cycles, cycles, error)


def _accelerations(position: Array, sampled: Array, cycles: int, period: float) -> Array:
    """Accelerations without what jumps of the friction alias into the low orders."""
    lines = np.fft.rfft(sampled, axis=0)
    number = np.arange(len(lines))
    rates = 2.0 * np.pi * number / period
    smooth = -np.fft.rfft(position, axis=0) * rates[:, None] ** 2
    # Positions are exact at low orders, samples of the acceleration hold the highest.
    share = np.clip(2.0 * number / (_SMOOTH * cycles) - 1.0, 0.0, 1.0)[:, None]
    blended = smooth + 0.5 * (1.0 - np.cos(np.pi * share)) * (lines - smooth)
    return np.asarray(np.fft.irfft(blended, len(sampled), axis=0))


def _motion(
    case: Case, mesh: TurningMesh, response: Response, of: _Period, table: MeshTable
) -> TurningMotion:
    """Motion on evenly spaced samples, with the rotation by which an unsteady drive is ahead."""
    from tribodyn.study.pipeline.response_series import mesh_force

    fine, cycles, driven, mesh_frequency = response.fine, of.cycles, of.driven, table.mesh_frequency
    count, period = SAMPLES * cycles, cycles / mesh_frequency
    at, even = np.arange(count) / count, even_samples(of.clock, count)
    ahead = driven is not None and driven.lead.lines.any()

    def over(values: Array, turned: int) -> Array:
        """Values on the samples of the period, with a derivative of the fluctuating rotation."""
        samples = even(values)
        if driven is not None and ahead:
            lead = driven.lead.derivative(turned)(at) / period**turned
            samples = samples + lead[:, None] * driven.rotation
        return np.asarray(samples)

    position = over(fine.position, 0)
    teeth = {name: abs(gear.teeth) for name, gear in case.gears.by_name.items()}
    return TurningMotion(
        time=at * period,
        position=position,
        velocity=over(fine.velocity, 1),
        acceleration=_accelerations(position, over(fine.acceleration, 2), cycles, period),
        mesh_force=even(mesh_force(fine)),
        transmission_error=even(of.error),
        lead=driven.lead(at) if driven is not None else np.zeros(count),
        names=response.names,
        mesh=mesh,
        mesh_frequency=mesh_frequency,
        cycles=cycles,
        places=PairSensors(response.names),
        turns={gear: cycles / number for gear, number in teeth.items()},
        tacho=GEARS[0],
        pinion_teeth=teeth[GEARS[0]],
        wheel_teeth=teeth[GEARS[1]],
        response=response,
    )
