"""Motion of a case with faults over whole turns of its gears."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from tribodyn.errors import collected, warn
from tribodyn.faults import BearingDefect
from tribodyn.progress import SILENT, Progress
from tribodyn.record import Record, fact, quantity, record
from tribodyn.study.faults.clock import turning_clock
from tribodyn.study.faults.recording import require_sensor
from tribodyn.types import Array, ComplexArray

if TYPE_CHECKING:
    from tribodyn.dynamics import Response, System
    from tribodyn.faults import BearingImpacts, DrivenSystem, TurningMesh
    from tribodyn.mesh import MeshTable
    from tribodyn.study.case.case import Case
    from tribodyn.study.pipeline.assembly import Damping
    from tribodyn.study.pipeline.result import Result
    from tribodyn.study.pipeline.run import PreparedRun

#: Signals of a mesh.
MESH_SENSORS = ("mesh_force", "transmission_error")
#: Steps of the search for each mesh cycle, tried in turn, and even samples of the motion.
_STEPS, SAMPLES = (128, 256, 512), 512
#: Mesh order up to which the acceleration is that of the positions; from half of it on in part.
_SMOOTH = 64
#: Change of the motion with half the steps, over its size, that is small enough, and the certified
#: error that suffices beside it.
_ACCURATE, _CERTIFIED = 2e-3, 1e-6


@record
class TurningMotion(Record):
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

    @cached_property
    def splines(self) -> dict[Any, Any]:
        """Signals as smooth functions, by sensor and sampling rate; filled where they are used."""
        return {}

    tacho: ClassVar = "pinion"  #: gear with the tacho

    @property
    def period(self) -> float:
        """Time after which all repeats [s]."""
        return self.cycles / self.mesh_frequency

    def rotation_frequency(self, gear: str) -> float:
        """Turns per second of the ``"pinion"`` or the ``"wheel"`` [Hz]."""
        teeth = self.pinion_teeth if gear == "pinion" else self.wheel_teeth
        return self.mesh_frequency / teeth

    @property
    def sensors(self) -> tuple[str, ...]:
        """Signals of :meth:`signal`."""
        return (*self.names, *MESH_SENSORS)

    def signal(self, sensor: str) -> tuple[Array, str]:
        """Return acceleration of a coordinate, mesh force or transmission error, with its unit."""
        if sensor in self.names:
            unit = "rad/s^2" if "_theta" in sensor else "m/s^2"
            return self.acceleration[:, self.names.index(sensor)], unit
        require_sensor(sensor, self.sensors)
        return getattr(self, sensor), "N" if sensor == "mesh_force" else "m"

    def impacts(
        self, sensor: str, defect: tuple[str, BearingImpacts], time: Array, seed: int
    ) -> Array | float:
        """Acceleration of the impacts of a bearing of a gear at the sensors of this gear."""
        gear, impacts = defect
        if sensor.partition("_")[0] != gear or self.signal(sensor)[1] != "m/s^2":
            return 0.0
        assert isinstance(impacts, BearingDefect)
        return impacts.signal(self.rotation_frequency(gear), time, seed)

    def harmonics(self, sensor: str) -> tuple[Array, ComplexArray]:
        """Frequencies (k,) [Hz] and complex peak amplitudes (k,) of a signal, from its mean on."""
        return signal_lines(self.signal(sensor)[0], self.period)

    def __repr__(self) -> str:
        """One line."""
        force = self.mesh_force
        return (
            f"TurningMotion({self.cycles} mesh cycles at {self.mesh_frequency:.6g} Hz, mesh force "
            f"{force.min():.5g} to {force.max():.5g} N)"
        )


def even_samples(phase: Array, count: int) -> Callable[[Array], Array]:
    """Linear interpolation of periodic values (p, ...) at phases to ``count`` even samples."""
    order = np.argsort(phase, kind="stable")
    order = np.concatenate((order[-1:], order, order[:1]))
    place = phase[order] + np.array([-1.0, *np.zeros(phase.size), 1.0])
    at = np.arange(count) / count
    after = np.searchsorted(place, at, side="right")
    width = place[after] - place[after - 1]
    part = np.divide(at - place[after - 1], width, out=np.zeros(count), where=width > 0.0)
    left, right = order[after - 1], order[after]

    def sampled(values: Array) -> Array:
        weight = part.reshape(-1, *[1] * (values.ndim - 1))
        begin = values[left]
        return np.asarray(begin + weight * (values[right] - begin))

    return sampled


def signal_lines(values: Array, period: float) -> tuple[Array, ComplexArray]:
    """Frequencies and complex peak amplitudes of even samples of a period, from its mean on."""
    lines = np.fft.rfft(values) / values.size
    lines[1:] *= 2.0
    return np.arange(lines.size) / period, lines


def turning_mesh_of(case: Case, table: MeshTable | None = None) -> TurningMesh:
    """Force law of a case with its faults over whole turns; of hypoid pairs from their table."""
    from tribodyn.faults import turning_mesh
    from tribodyn.faults.turning_table import turning_table
    from tribodyn.study.faults.section import bevel_gears, gear_faults
    from tribodyn.study.pipeline.tooth_contact import loaded_settings

    faults = tuple(gear_faults(case).values())
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
    from tribodyn.dynamics import follow_load, law_contact
    from tribodyn.dynamics.equations.clock import on_clock
    from tribodyn.dynamics.equations.system import FRICTION_ENTRIES
    from tribodyn.study.pipeline.assembly import structure_of
    from tribodyn.study.pipeline.tooth_contact import load_friction_of

    functions = mesh.functions(table.functions())
    system = structure_of(case, functions, damping, "stiffness")
    first, *others = system.contacts
    contacts = (law_contact(first, mesh.force_law), *others)
    friction = load_friction_of(case, table)
    if friction is None:
        return replace(system, contacts=contacts)
    rubbing = follow_load(replace(system, frictions=()), friction).frictions
    over_turns = [on_clock(each, FRICTION_ENTRIES, mesh.cycles, 0.0) for each in rubbing]
    contacts = tuple(replace(contact, friction=None) for contact in contacts)
    return replace(system, contacts=contacts, frictions=(*system.frictions, *over_turns))


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
    """Compute the steady motion of a result over whole turns of its gears."""
    from tribodyn.dynamics import harmonic_balance
    from tribodyn.study.case.to_models import locate_errors

    case = result.case
    with locate_errors(case):
        clock = turning_clock(case)
        progress.start(f"Teeth over whole turns: {clock}")
        mesh = turning_mesh_of(case, result.mesh)
        driven = driven_system(case, result.mesh, result.damping, mesh)
        frequency = result.mesh.mesh_frequency / driven.cycles
        response: Response | None = None
        for steps in _STEPS:
            with collected() as model_warnings:
                response = harmonic_balance(
                    driven.system,
                    frequency,
                    steps=steps * driven.cycles // driven.system.cycles,
                    start=response,
                    tolerance=_CERTIFIED,
                    progress=progress,
                )
            if not response.step_error > _ACCURATE:
                break
        for warning in model_warnings:
            warn(warning.code, warning.message)
    assert response is not None
    return _sampled(case, mesh, driven, response, result.mesh.mesh_frequency)


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


def _sampled(
    case: Case, mesh: TurningMesh, driven: DrivenSystem, response: Response, mesh_frequency: float
) -> TurningMotion:
    """The motion on evenly spaced samples."""
    cycles = driven.cycles
    fine, count, period = response.fine, SAMPLES * cycles, cycles / mesh_frequency
    at, even = np.arange(count) / count, even_samples(fine.phase, count)

    def over(values: Array, turned: int | None = None) -> Array:
        """Values on the samples of the period, with a derivative of the fluctuating rotation."""
        samples = even(values)
        if turned is not None and driven.lead.lines.any():
            lead = driven.lead.derivative(turned)(at) / period**turned
            samples = samples + lead[:, None] * driven.rotation
        return np.asarray(samples)

    position = over(fine.position, 0)
    return TurningMotion(
        time=at * period,
        position=position,
        velocity=over(fine.velocity, 1),
        acceleration=_accelerations(position, over(fine.acceleration, 2), cycles, period),
        mesh_force=over(fine.contact_force.sum(axis=1)),
        transmission_error=over(fine.deflection[:, 0]) - 0.5 * case.backlash,
        names=response.names,
        mesh=mesh,
        mesh_frequency=mesh_frequency,
        cycles=cycles,
        **{f"{name}_teeth": abs(gear.teeth) for name, gear in case.gears.by_name.items()},
        response=response,
        lead=driven.lead(at),
    )
