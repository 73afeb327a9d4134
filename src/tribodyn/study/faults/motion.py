"""Motion of a pair with faults: on one clock where all repeats soon, or over phases."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np

from tribodyn.faults import BearingDefect
from tribodyn.nomenclature import GEARS
from tribodyn.progress import SILENT, Progress
from tribodyn.record import Labels, Record
from tribodyn.study.faults.clock import MESH_POINTS, PairTurns
from tribodyn.study.faults.sensors import PairSensors, SensorPlace
from tribodyn.study.faults.turning import (
    SAMPLES,
    Accuracy,
    PeriodicMotion,
    SensedLines,
    joined,
    lead_on_clock,
    lines_over_phase,
    steady_over_turns,
)
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.dynamics import Contact, LoadFriction, Response, System
    from tribodyn.faults import BearingImpacts, DrivenSystem, Fault, TurningMesh
    from tribodyn.faults.driven import Lead
    from tribodyn.machine.graph.clock import Phases
    from tribodyn.machine.mesh import Turn
    from tribodyn.mesh import MeshFriction, MeshTable
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.pipeline.assembly import Damping
    from tribodyn.study.pipeline.result import PairResult
    from tribodyn.study.pipeline.run import PreparedRun

_ACCURACY = Accuracy((128, 256, 512), 1e-6)
#: Most mesh cycles of the piece of a motion over phases that is exported.
_PIECE = 512


@dataclass(frozen=True, eq=False, repr=False)
class TurningMotion(PeriodicMotion, Record):
    """Motion with faults: its lines, and even samples of its period or of a piece of it."""

    DERIVED: ClassVar = {
        "names": Labels(("coordinate",), axis=True, name="coordinate"),
        "time": Labels(("time",), "s", axis=True),
        "position": Labels(("time", "coordinate"), "m or rad"),
        "velocity": Labels(("time", "coordinate"), "m/s or rad/s"),
        "acceleration": Labels(("time", "coordinate"), "m/s^2 or rad/s^2"),
        "mesh_force": Labels(("time",), "N"),
        "transmission_error": Labels(("time",), "m"),
        "ahead_cycles": Labels(("time",), "1", name="lead"),
        "mesh_frequency": Labels(()),
        "cycles": Labels(()),
        "pinion_teeth": Labels(()),
        "wheel_teeth": Labels(()),
    }
    case: PairCase
    table: MeshTable
    repeats_after: int  #: mesh cycles
    teeth: TurningMesh  #: of the teeth that differ, without the errors that turn with the gears
    waves: tuple[Turn, ...]  #: errors that turn with the gears
    errors: _Errors
    speed: Array  #: of the coordinates as the drive turns [rad/s]

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the coordinates."""
        return self.response.names

    @property
    def pinion_teeth(self) -> int:
        """Teeth of the pinion."""
        return abs(self.case.gears.by_name[GEARS[0]].teeth)

    @property
    def wheel_teeth(self) -> int:
        """Teeth of the wheel."""
        return abs(self.case.gears.by_name[GEARS[1]].teeth)

    @cached_property
    def mesh(self) -> TurningMesh:
        """Mesh with all faults over the turns of the gears that have them."""
        return turning_mesh_of(self.case, self.table)

    @cached_property
    def at_rest(self) -> Array:
        """Static transmission error under the mean load on even samples of the motion [m]."""
        error = self.teeth.transmission_error[:-1]
        count = self.cycles * (error.size // self.teeth.cycles)
        cycle = np.arange(count) * (self.cycles / count)
        waves = (turn.error(np.asarray(cycle * float(turn.waves) % 1.0)) for turn in self.waves)
        return np.asarray(sum(waves, np.resize(error, count)))

    @cached_property
    def time(self) -> Array:
        """Times of the samples [s]."""
        count = SAMPLES * self.cycles
        return np.asarray(np.arange(count) * (self.period / count))

    @cached_property
    def position(self) -> Array:
        """Positions on the samples (s, n) [m or rad]."""
        return self._columns(0)

    @cached_property
    def velocity(self) -> Array:
        """Velocities on the samples (s, n) [m/s or rad/s]."""
        return self._columns(1)

    @cached_property
    def acceleration(self) -> Array:
        """Accelerations on the samples (s, n) [m/s^2 or rad/s^2]."""
        return self._columns(2)

    @cached_property
    def mesh_force(self) -> Array:
        """Mesh force on the samples [N]."""
        return self.signal("mesh_force")[0]

    @cached_property
    def transmission_error(self) -> Array:
        """Transmission error on the samples [m]."""
        return self.signal("transmission_error")[0]

    @cached_property
    def ahead_cycles(self) -> Array:
        """Mesh cycles by which the rotation is ahead of its mean on the samples."""
        return self.lead_at(self.time)

    def _columns(self, derivative: int) -> Array:
        columns = [self._coordinate(number, derivative) for number in range(len(self.names))]
        return np.stack([self.sampled(column) for column in columns], axis=1)

    def _coordinate(self, number: int, derivative: int) -> SensedLines:
        """Lines of a coordinate or of its derivative, with the rotation that is ahead."""
        frequency, amplitude, numbers = self._lines("position")
        lines = SensedLines(frequency, amplitude[:, number], numbers)
        if self.ahead is not None and self.speed[number]:
            lines = joined(lines, self._lead_lines(float(self.speed[number])))
        rate = (2j * np.pi * lines.frequency) ** derivative
        return SensedLines(lines.frequency, lines.amplitude * rate, lines.numbers)

    def _linear(self, place: SensorPlace) -> SensedLines:
        if place.quantity == "acceleration":
            return self._coordinate(self.names.index(place.part), 2)
        if place.quantity == "mesh_force":
            frequency, amplitude, numbers = self._lines("contact_force")
            return SensedLines(frequency, amplitude.sum(axis=1), numbers)
        offset, direction, terms = self.errors
        quantity = "deflection" if direction is None else "position"
        frequency, amplitude, numbers = self._lines(quantity)
        values = amplitude[:, 0].copy() if direction is None else amplitude @ direction
        values[0] -= offset
        errors = (lines_over_phase(*term, self.frequencies) for term in terms)
        return joined(SensedLines(frequency, values, numbers), *errors)

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


class _Errors(NamedTuple):
    """How the transmission error follows from positions and compressions."""

    offset: float  #: where perfect rigid driving flanks touch [m]
    direction: Array | None  #: of the mesh, if it is constant (n,)
    #: Otherwise errors of the mesh with their periods over each phase, and mesh cycles in these.
    terms: tuple[tuple[Callable[[Array], Array], Any, int], ...] = ()


def turning_mesh_of(
    case: PairCase, table: MeshTable | None = None, faults: Sequence[Fault] | None = None
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


def turning_system_of(
    case: PairCase, table: MeshTable, damping: Damping, mesh: TurningMesh
) -> System:
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
    from tribodyn.dynamics.equations.phases import on_clock
    from tribodyn.dynamics.equations.system import FRICTION_ENTRIES
    from tribodyn.dynamics.structure.force_law import with_load_friction

    first, *others = contacts
    over_turns = (law_contact(first, mesh.force_law), *others)
    if friction is None:
        return over_turns, ()
    rubbing = with_load_friction(names, contacts, friction)[1]
    rubbing = tuple(on_clock(each, FRICTION_ENTRIES, mesh.cycles, 0.0) for each in rubbing)
    return tuple(replace(contact, friction=None) for contact in over_turns), rubbing


def _over(turns: PairTurns, system: System, mesh: TurningMesh, phases: Phases) -> System:
    """A system of teeth that differ over phases of all that turns, or one of all."""
    first, *others = (
        replace(contact, cycles=phases.cycles["mesh"], period=mesh.cycles)
        for contact in system.contacts
    )
    turned = replace(
        first,
        turning_error=[turn.error for turn in turns.waves],
        turning_cycles=[phases.turns[rate] for rate in turns.rates],
    )
    return replace(system, contacts=[turned, *others])


def driven_system(
    case: PairCase, table: MeshTable, damping: Damping, turns: PairTurns, mesh: TurningMesh
) -> DrivenSystem:
    """The system on the clock of all that repeats, with the excitation of its shafts."""
    from tribodyn.faults import drive
    from tribodyn.study.pipeline.assembly import rotation_of, shaft_coordinates

    plain = turning_system_of(case, table, damping, mesh)
    system = _over(turns, plain, mesh, turns.phases(together=True))
    return drive(
        system,
        system.cycles,
        turns.excited,
        mesh_frequency=table.mesh_frequency,
        teeth=turns.teeth,
        coordinates=shaft_coordinates(case, system),
        rotation=rotation_of(case, system.names),
    )


class _Found(NamedTuple):
    """A steady motion, and what it is a motion of."""

    response: Response
    ahead: Lead | None
    speed: Array
    errors: _Errors
    cycles: int = 0  #: of a motion that repeats with the mesh, or after more cycles of it


def turning_motion(result: PairResult | PreparedRun, progress: Progress = SILENT) -> TurningMotion:
    """Compute the steady motion with faults; with equal teeth it is that of the result."""
    from tribodyn.study.case.to_models import locate_errors

    case, table = result.case, result.mesh
    with locate_errors(case):
        turns = PairTurns.of(case)
        clock = turns.clock()
        progress.start(f"Teeth over whole turns: {clock}")
        mesh = turning_mesh_of(case, table, turns.faults)
        find = _on_clock if clock.phases is None else _over_phases
        steady = _of_run(result, turns, progress) or find(result, turns, mesh, progress)
    cycles, teeth = steady.cycles or clock.cycles, turns.teeth
    if clock.phases is not None and cycles > _PIECE:
        slow = max(teeth.values())
        cycles = max(_PIECE // slow, 1) * slow
    over = () if clock.phases is None else turns.cycles_of_mesh
    return TurningMotion(
        cycles=cycles,
        mesh_frequency=table.mesh_frequency,
        places=PairSensors(steady.response.names),
        turns={gear: cycles / number for gear, number in teeth.items()},
        tacho=GEARS[0],
        response=steady.response,
        ahead=steady.ahead,
        meshes={"mesh": over if over else (cycles,)},
        units=turns.units(together=not over),
        case=case,
        table=table,
        repeats_after=clock.cycles,
        teeth=mesh,
        waves=turns.waves,
        errors=steady.errors,
        speed=steady.speed,
    )


def _of_run(
    result: PairResult | PreparedRun, turns: PairTurns, progress: Progress
) -> _Found | None:
    """Motion of a run, if its teeth are equal and its drive is steady."""
    from tribodyn.study.pipeline.response_series import film_offset, is_steady

    if turns.vary:
        return None
    sound = result if isinstance(result, Record) else result.result(progress)
    if not is_steady(sound.response):
        return None
    response = sound.response
    offset = sound.half_backlash + film_offset(sound)
    still = np.zeros(len(response.names))
    errors = _Errors(offset, None, ((sound.static_error, response.periods, 1),))
    return _Found(response, None, still, errors, response.periods)


def _on_clock(
    result: PairResult | PreparedRun, turns: PairTurns, mesh: TurningMesh, progress: Progress
) -> _Found:
    """Motion on the clock of all that repeats."""
    frequency = result.mesh.mesh_frequency
    driven = driven_system(result.case, result.mesh, result.damping, turns, mesh)
    response = steady_over_turns(driven, frequency / driven.cycles, _ACCURACY, progress)
    contact = driven.system.clocked_contacts[0]
    errors = _errors_of(result.case, contact, [(contact.error, (1,), driven.cycles)])
    ahead = lead_on_clock(driven, frequency)
    return _Found(response, ahead, driven.rotation * frequency, errors)


def _over_phases(
    result: PairResult | PreparedRun, turns: PairTurns, mesh: TurningMesh, progress: Progress
) -> _Found:
    """Motion over phases of the mesh and of what turns and drives it."""
    from tribodyn.dynamics import harmonic_balance
    from tribodyn.faults.driven import drive_over_phases
    from tribodyn.study.pipeline.assembly import rotation_of, shaft_coordinates

    case, table, phases = result.case, result.mesh, turns.phases()
    system = _over(turns, turning_system_of(case, table, result.damping, mesh), mesh, phases)
    rotation = rotation_of(case, system.names)
    speed = np.zeros(system.size) if rotation is None else rotation * table.mesh_frequency
    rows, at = np.eye(system.size), shaft_coordinates(case, system)
    lead = None
    if turns.excited:
        driven = [
            (each, phases.driven[rate], turns.speed(each.gear), rows[at[each.gear]])
            for each, rate in zip(turns.excited, turns.driven_rates, strict=True)
        ]
        system, lead = drive_over_phases(system, driven, speed)
    steps = turns.points(MESH_POINTS)
    response = harmonic_balance(system, phases.frequency, steps=steps, progress=progress)
    contact = system.contacts[0]
    terms = [(contact.error, phases.cycles["mesh"], mesh.cycles)]
    terms += [(term.error, term.cycles, 1) for term in contact.turning]
    return _Found(response, lead, speed, _errors_of(case, contact, terms))


def _errors_of(case: PairCase, contact: Contact, terms: list[tuple[Any, Any, int]]) -> _Errors:
    """Transmission error of a contact with these errors."""
    if not callable(contact.direction):
        return _Errors(0.5 * case.backlash, np.asarray(contact.direction))
    varying = tuple(term for term in terms if callable(term[0]))
    return _Errors(0.5 * case.backlash, None, varying)
