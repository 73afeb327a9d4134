"""Result of a machine: its loads, summary, data and report."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tribodyn.aliases import warn_of_old_name
from tribodyn.drawing import draw
from tribodyn.errors import Argument, InputError, collected, no_such
from tribodyn.gear import Misalignment, MisalignmentStudy, misalignment_study
from tribodyn.interrupt import single_blas_thread
from tribodyn.machine.static.supports import clearance_supports, without_clearance_supports
from tribodyn.record import Parts
from tribodyn.study.faults.sensors import sensors_of
from tribodyn.study.machine.first_look import shape_figures
from tribodyn.study.machine.housing_files import HOUSING, copy_housing
from tribodyn.study.machine.modes import MeshOrder, mesh_orders
from tribodyn.study.machine.motion import MachineMotion, machine_motion
from tribodyn.study.machine.summary import summary_of
from tribodyn.study.pipeline.result_of_case import Result
from tribodyn.study.pipeline.stored_motion import of_passes
from tribodyn.study.pipeline.tooth_contact import repeat
from tribodyn.study.planetary.stage_result import StageResult

if TYPE_CHECKING:
    from tribodyn.dynamics import Response, System
    from tribodyn.errors import ModelWarning
    from tribodyn.machine import (
        Machine,
        MachineModes,
        PowerFlow,
        RingSensorSignal,
        StaticBalance,
    )
    from tribodyn.machine.structure import MachineStructure
    from tribodyn.mesh import MeshTable
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.faults.machine_signals import MachineTurningMotion
    from tribodyn.study.faults.sensors import Sensors
    from tribodyn.study.heat_balance import HeatBalance
    from tribodyn.study.machine.case import MachineCase
    from tribodyn.study.machine.modes import MachineCampbell
    from tribodyn.study.machine.read_parts import LoadCase
    from tribodyn.study.rated_parts import PartRatings
    from tribodyn.study.rating import RatedMesh


#: Steps per cycle of the fastest mesh, at least of the only one of a lone stage, and those after
#: which they are not doubled any more.
STEPS, _OF_STAGE, _MOST = 128, 240, 1024


def steady_motion(structure: MachineStructure, system: System) -> Response:
    """Motion on one clock, with steps that suffice, or over phases."""
    from tribodyn.dynamics.harmonic.harmonic_balance import STEP_LIMIT

    if system.phases:
        return _motion(structure, system, structure.machine.phases.frequency)
    steps = steps_of(structure)
    while True:
        with collected() as model_warnings:
            response = _motion(structure, system, structure.machine.clock.frequency, steps=steps)
        if not response.step_error > STEP_LIMIT or steps >= _MOST:
            break
        steps *= 2
    repeat(model_warnings)
    return response


def _motion(structure: MachineStructure, system: System, frequency: Any, **search: Any) -> Response:
    """Motion with bearings that may be loose."""
    from tribodyn.dynamics import clearance_motion, harmonic_balance

    if supports := clearance_supports(structure):
        system = without_clearance_supports(structure, system)
        return clearance_motion(system, [*supports.values()], frequency, **search)
    return harmonic_balance(system, frequency, **search)


def power_with_friction(
    machine: Machine, tables: Mapping[str, MeshTable]
) -> tuple[PowerFlow, dict[str, float]]:
    """Power flow less the friction of computed teeth, and what each mesh loses of it [W]."""
    nominal = machine.kinematics.meshes
    lost = {
        name: table.mean_friction_power / nominal[name].power if nominal[name].power else 0.0
        for name, table in tables.items()
    }
    flow = machine.power_flow({name: 1.0 - share for name, share in lost.items()})
    return flow, {name: share * flow.meshes[name].power for name, share in lost.items()}


def steps_of(structure: MachineStructure) -> int:
    """Steps per cycle of the fastest mesh."""
    if structure.frame is None:
        return STEPS
    # All planets have their samples at the same places of the cycle, so that forces balance.
    (stage,) = structure.machine.planets.values()
    return -(-_OF_STAGE // (2 * stage.count)) * 2 * stage.count


@dataclass(frozen=True, eq=False)
class LoadResult:
    """A machine under one load.

    Parameters
    ----------
    load : LoadCase
        Speed and torque.
    structure : MachineStructure
        With the force laws of its teeth and the stiffness of its bearings at this load.
    static : StaticBalance
        Deflections, bearing loads and misalignments at rest.
    tables : mapping of str to MeshTable
        Tooth contact of the meshes that are computed.
    misalignment : mapping of str to float or Misalignment
        Misalignment of the flanks with which each table was computed [m], of hypoid gears the
        mounting errors by deflection.
    system : System
        The structure, reduced where it is large, and its contacts.
    motion : MachineMotion
        Forces, errors and accelerations by the names of the parts.
    steady : Response, optional
        Motion of all coordinates over one period of the clock, where it was computed.
    heat : HeatBalance, optional
        Heat balance of gears and oil, if ``lubricant.heat_transfer`` is given.
    losses : mapping of str to float
        Power that bearings, seals, oil bath and air take, by ``[losses]`` [W].
    """

    load: LoadCase
    structure: MachineStructure
    static: StaticBalance
    tables: Mapping[str, MeshTable]
    misalignment: Mapping[str, float | Misalignment]
    system: System
    motion: MachineMotion
    steady: Response | None = None
    heat: HeatBalance | None = None
    losses: Mapping[str, float] = field(default_factory=dict)

    @cached_property
    def response(self) -> Response:
        """Motion of all coordinates over one period; of a stored result computed again."""
        return self.steady or steady_motion(self.structure, self.system)

    @property
    def machine(self) -> Machine:
        """The machine at this load."""
        return self.structure.machine

    @property
    def steps(self) -> int:
        """Steps per cycle of the fastest mesh."""
        return steps_of(self.structure)

    @property
    def signals(self) -> Any:
        """Signals by part with units."""
        return self.motion.to_xarray()

    @property
    def clock_frequency(self) -> float:
        """Periods of the motion in a second [Hz]."""
        return self.machine.clock.frequency

    @cached_property
    def power_flow(self) -> PowerFlow:
        """Speeds, torques and power of shafts and meshes, less the friction of computed teeth."""
        return power_with_friction(self.machine, self.tables)[0]

    @cached_property
    def friction_power(self) -> dict[str, float]:
        """Power that the computed teeth of each mesh lose of what reaches it [W]."""
        return power_with_friction(self.machine, self.tables)[1]

    @cached_property
    def modes(self) -> MachineModes:
        """Natural modes at this load."""
        from tribodyn.machine import machine_modes

        with single_blas_thread():
            return machine_modes(self.structure)

    def stage(self, name: str | None = None) -> StageResult:
        """Load sharing, motion, modes and ring sensor of a planetary stage.

        Parameters
        ----------
        name : str, optional
            Name of the stage; the first by default.

        Returns
        -------
        StageResult

        Raises
        ------
        InputError
            If the machine has no such stage.
        """
        stages = self.machine.planets
        chosen = next(iter(stages), "") if name is None else name
        if chosen not in stages:
            raise InputError(no_such("stage", chosen, stages, Argument("name")))
        return StageResult(self, chosen)

    def ring_sensor(
        self, sensor_angle: float = 0.0, window: Any = None, steps: int = 256
    ) -> RingSensorSignal:
        """Signal of a sensor on the ring of the first stage, see :meth:`StageResult.ring_sensor`.

        Parameters
        ----------
        sensor_angle : float
            Angle of the sensor from y towards z [rad].
        window : float or function, optional
            As for :func:`tribodyn.machine.ring_sensor_signal`.
        steps : int
            Samples of a mesh cycle.

        Returns
        -------
        RingSensorSignal

        Raises
        ------
        InputError
            If the machine has no stage, or an argument is out of range.
        """
        return self.stage().ring_sensor(sensor_angle, window, steps)

    def __getattr__(self, name: str) -> Any:
        """Find what a lone stage had in an earlier version."""
        if name not in ("shares", "phases") or not self.machine.planets:
            raise AttributeError(f"LoadResult has no attribute {name!r}")
        warn_of_old_name(f"LoadResult.{name}", f"LoadResult.stage().{name}")
        return getattr(self.stage(), name)

    @property
    def mesh_orders(self) -> tuple[MeshOrder, ...]:
        """Mesh harmonics with the shares of the meshes in the modes."""
        return mesh_orders(self.modes)

    def _stored(self) -> Parts:
        """What a file holds: the motion, and the misalignments of the computed teeth."""
        values = {
            name: asdict(value) if isinstance(value, Misalignment) else value
            for name, value in self.misalignment.items()
        }
        variables, coordinates, facts = self.motion._parts()
        if self.heat is not None:
            its_variables, its_facts = of_passes("heat", self.heat)
            variables, facts = {**variables, **its_variables}, {**facts, **its_facts}
        facts = {**facts, "misalignment": json.dumps(values)}
        if self.load.sharing:
            facts["sharing"] = json.dumps(dict(self.load.sharing))
        return Parts(variables, coordinates, facts)

    def signals_along(self, response: Response) -> MachineMotion:
        """Forces, errors and accelerations of the parts along another motion.

        Parameters
        ----------
        response : Response
            Motion of the same coordinates.

        Returns
        -------
        MachineMotion
        """
        return machine_motion(self.structure, response)

    @cached_property
    def figures(self) -> dict[str, float]:
        """All figures in SI by dotted key."""
        return summary_of(self)

    def __repr__(self) -> str:
        """One line."""
        meshes = ", ".join(self.motion.mesh)
        return f"LoadResult({self.load.name}: meshes {meshes} at {self.motion.frequency:.6g} Hz)"


@dataclass(frozen=True, eq=False, repr=False)
class MachineResult(Result, of=LoadResult):
    """What :func:`tribodyn.run` returns for a machine.

    Parameters
    ----------
    case : MachineCase
        What was computed.
    operation : LoadResult
        At the speed and torque of ``[operation]``.
    load_cases : tuple of LoadResult
        Under each of ``[[load_cases]]``.
    warnings : tuple of ModelWarning
        Warnings of the models.
    """

    case: MachineCase
    operation: LoadResult
    load_cases: tuple[LoadResult, ...]
    warnings: tuple[ModelWarning, ...]

    __eq__, __hash__ = object.__eq__, object.__hash__

    @property
    def _sensors(self) -> Sensors:
        return sensors_of(self.case)

    def _shape_figures(self) -> Mapping[str, float]:
        return shape_figures(self.case)

    def _rated(self) -> tuple[Iterable[RatedMesh], PartRatings]:
        from tribodyn.study.machine.rated_meshes import rated_loads, rated_meshes, rated_parts

        loads = rated_loads(self)
        return rated_meshes(self.case, loads), rated_parts(self.case, loads)

    @property
    def loads(self) -> Mapping[str, LoadResult]:
        """Results by load: ``"operation"``, and each load case by its name."""
        named = {each.load.name: each for each in self.load_cases}
        if (same := named.pop("operation", None)) is not None:
            named["load_cases.operation"] = same
        return {"operation": self.operation, **named}

    def __getattr__(self, name: str) -> Any:
        """Find what the operating point has: its motion, system, modes, power flow, stages, ..."""
        load = vars(self).get("operation")
        if name[0] != "_" and name in {*vars(load), *vars(type(load))}:
            return getattr(load, name)
        return super().__getattr__(name)

    def __dir__(self) -> list[str]:
        """Attributes, those of the operating point, and figures."""
        return sorted({*super().__dir__(), *dir(self.operation)})

    @property
    def mesh(self) -> MeshTable | None:
        """Tooth contact of the first mesh whose teeth are computed; None if there is none."""
        return next(iter(self.tables.values()), None)

    @property
    def _pair(self) -> PairCase:
        name, load = next(iter(self.tables), ""), self.operation
        if not name:
            raise InputError("the machine has no mesh whose teeth are computed", "", "", "")
        return self.case.pair(name, load.load, load.misalignment[name])

    @cached_property
    def campbell(self) -> MachineCampbell:
        """Natural frequencies and excitations over the speed of the input."""
        from tribodyn.study.machine.modes import campbell_of

        return campbell_of(self.structure, modes=self.modes)

    @cached_property
    def turning_motion(self) -> MachineTurningMotion:
        """Motion over whole turns of the shafts whose gears have faults or unequal teeth."""
        from tribodyn.study.faults.machine_motion import machine_turning_motion

        return machine_turning_motion(self.case, self.operation)

    def mounting_study(self, mesh: str) -> MisalignmentStudy:
        """Contact patterns of a hypoid mesh without load: as mounted, and as deflected.

        Parameters
        ----------
        mesh : str
            Name of the mesh.

        Returns
        -------
        MisalignmentStudy
            Of the operating point and the load cases on the same flank.

        Raises
        ------
        InputError
            If there is no such mesh, or its tooth contact is not that of hypoid gears.
        """
        from tribodyn.study.machine.pair_cases import inputs_under
        from tribodyn.study.mesh_inputs import HypoidTeeth

        studies: dict[str, MisalignmentStudy] = vars(self).setdefault("_mounting_studies", {})
        if mesh in studies:
            return studies[mesh]
        by_mesh = self.operation.misalignment
        if not isinstance(by_mesh.get(mesh), Misalignment):
            names = [n for n, m in by_mesh.items() if isinstance(m, Misalignment)]
            why = f"Hypoid meshes with computed teeth: {', '.join(names) or 'none'}"
            raise InputError(f'mesh "{mesh}" has no mounting errors', Argument("mesh"), why, "")
        nominal = inputs_under(self.case, mesh, self.operation.load).teeth
        assert isinstance(nominal, HypoidTeeth)
        displaced: list[Any] = [
            inputs_under(self.case, mesh, each.load, each.misalignment[mesh]).teeth
            for each in (self.operation, *self.load_cases)
        ]
        cases = [teeth.mounting for teeth in displaced if teeth.gears.side == nominal.gears.side]
        errors = list(dict.fromkeys((nominal.mounting, *cases)))
        studies[mesh] = misalignment_study(nominal.flanks, errors)
        return studies[mesh]

    def mesh_spectra(self, mesh: str | None = None) -> Any:
        """Peak amplitudes of all signals at the operating point over the order of one mesh.

        Parameters
        ----------
        mesh : str, optional
            Name of the mesh whose frequency is order 1; the first by default.

        Returns
        -------
        xarray.Dataset
            As :meth:`MachineMotion.mesh_spectra`, with the ``teeth`` of both gears.

        Raises
        ------
        InputError
            If there is no such mesh.
        """
        name = self.motion.mesh[0] if mesh is None else mesh
        spectra = self.motion.mesh_spectra(name, self.case.motion.harmonics)
        gears = [self.machine.gears[gear] for gear in self.machine.meshes[name].gears]
        return spectra.assign_attrs(teeth=[abs(gear.teeth) for gear in gears])

    def plot(self, figure: str = "machine") -> Any:
        """Draw a figure: ``machine``, ``machine_orders``, ``machine_forces``, ...

        Parameters
        ----------
        figure : str
            Name in :data:`tribodyn.plot.FIGURES`.

        Returns
        -------
        plotly.graph_objects.Figure
        """
        return draw(self, figure)

    def to_csv(self) -> str:
        """Write the mesh forces over the clock as comma-separated values in SI.

        Returns
        -------
        str
            A column for each mesh [N].
        """
        return str(self.to_xarray().mesh_force.to_pandas().to_csv())

    def _parts(self) -> Parts:
        return self.operation.motion._parts()

    def _case_in(self, place: Path) -> MachineCase:
        return copy_housing(self.case, place, HOUSING)

    @property
    def _headline(self) -> str:
        """Chief figures in one line."""
        figures = self.operation.figures
        peaks = ", ".join(
            f"{name} {figures[f'meshes.{name}.peak_mesh_force']:.5g} N" for name in self.motion.mesh
        )
        count = len(self.load_cases)
        loads = f", {count} load case{'s' * (count != 1)}" if count else ""
        return f"peak mesh forces {peaks}{loads}"


#: Names of an earlier version: a planetary stage is a machine.
PlanetaryResult, PlanetaryLoadResult = MachineResult, LoadResult
