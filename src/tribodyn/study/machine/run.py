"""Compute a machine: teeth of each mesh, static balance, motion, and figures by part."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribodyn.dynamics import law_contact
from tribodyn.dynamics.structure.force_law import with_load_friction
from tribodyn.errors import (
    ComputationError,
    InputError,
    ModelWarning,
    collected,
)
from tribodyn.gear import Misalignment
from tribodyn.interrupt import in_threads, processors, single_blas_thread
from tribodyn.machine import (
    MachineStructure,
    face_laws,
)
from tribodyn.machine import system as system_of
from tribodyn.progress import SILENT, Progress
from tribodyn.study.coupling import load_of_torque, mesh_under_load
from tribodyn.study.heat_balance import HeatBalance, Temperatures
from tribodyn.study.machine.case import MachineCase
from tribodyn.study.machine.first_look import over_phases, shape_figures, warn_of_gears
from tribodyn.study.machine.motion import MachineMotion, machine_motion, motion_from
from tribodyn.study.machine.pair_cases import inputs_under, read_teeth, teeth_under
from tribodyn.study.machine.read_parts import LoadCase
from tribodyn.study.machine.result import (
    LoadResult,
    MachineResult,
    power_with_friction,
    steady_motion,
)
from tribodyn.study.mesh_inputs import MeshInputs, named_mesh
from tribodyn.study.part_losses import part_losses
from tribodyn.study.pipeline.assembly import mesh_contacts, mesh_damping
from tribodyn.study.pipeline.cautions import (
    MeshWarning,
    contact_cautions,
    friction_cautions,
    friction_suspected,
    load_cautions,
    mesh_cautions,
    tension_cautions,
    warn_of_meshes,
)
from tribodyn.study.pipeline.motion import by_engine
from tribodyn.study.pipeline.store import Stored, StoredLoad, figures_of_load
from tribodyn.study.pipeline.stored_motion import read_passes
from tribodyn.study.pipeline.tooth_contact import (
    load_friction_of,
    mesh_table,
    teeth_contact_ratio,
)
from tribodyn.study.settle import settle

if TYPE_CHECKING:
    from tribodyn.dynamics import LoadFriction
    from tribodyn.machine import Machine, MeshBalance, StaticBalance
    from tribodyn.mesh import MeshTable
    from tribodyn.types import Array

#: Passes of teeth and balance at most, and change of the misalignment over the compression of the
#: teeth that ends them.
_PASSES, _SAME = 4, 0.1
#: Weight of the change of the share of a mesh in a loop.
_OF_SHARE = 20.0
#: The same where a temperature follows from the teeth.
_HEATED_PASSES, _SETTLED = 40, 1e-9
#: Difference of misalignments of equal teeth that is rounding [m].
_EQUAL = 1e-8


class Balanced(NamedTuple):
    """A machine at rest under one load, with its computed teeth."""

    load: LoadCase  #: with the temperatures of the heat balance
    static: StaticBalance
    tables: dict[str, MeshTable]
    misalignment: Mapping[str, float | Misalignment]  #: with which the teeth were computed [m]
    warnings: list[MeshWarning]
    heat: HeatBalance | None = None

    @property
    def machine(self) -> Machine:
        """The machine with the force laws of its teeth."""
        return self.static.machine

    def structure(self, case: MachineCase) -> MachineStructure:
        """Structure of the machine for its motion."""
        return structure_of(case, self.static.linearized())


def run_machine(case: MachineCase, progress: Progress = SILENT) -> MachineResult:
    """Compute a machine under all its loads without raising the warnings, which the result has."""
    from tribodyn.study.faults.clock import check_motion

    # The matrices of a machine are small: threads of the linear algebra only wait for each other.
    with collected() as caught, single_blas_thread():
        check_motion(case)
        warn_of_gears(case)
        of_meshes: list[MeshWarning] = []
        results: list[LoadResult] = []
        for load in (case.operating_point, *case.load_cases):
            equal = [
                r for r in results if (r.load.speed, r.load.torque) == (load.speed, load.torque)
            ]
            computed = equal[0] if equal else run_load(case, load, progress, of_meshes)
            same = replace(computed.load, name=load.name, share=load.share)
            results.append(replace(computed, load=same))
        warn_of_meshes(of_meshes)
    return MachineResult(case, results[0], tuple(results[1:]), tuple(caught))


def run_load(
    case: MachineCase, load: LoadCase, progress: Progress, of_meshes: list[MeshWarning]
) -> LoadResult:
    """Compute a machine under one load."""
    state = balanced_machine(case, load, progress)
    of_meshes += state.warnings
    progress.start(f"Motion: {load.name}")
    structure = state.structure(case)
    system = system_of(structure, phases=over_phases(case.solver, structure.machine))
    with friction_suspected(state.tables.values()):
        response = by_engine(case.solver.engine, steady_motion(structure, system))
    progress.finish()
    motion = machine_motion(structure, response)
    of_meshes += _of_motion(case, load, structure.machine, motion)
    losses = part_losses(case, state.load, state.static)
    return LoadResult(
        *(state.load, structure, state.static, state.tables, state.misalignment),
        *(system, motion, response, state.heat, losses),
    )


def rehearse_machine(case: MachineCase) -> Balanced:
    """Raise the input errors of teeth and balance without films and motion; warn of the load."""
    with collected(), single_blas_thread():
        states = [
            balanced_machine(case, load, rehearsal=True)
            for load in (case.operating_point, *case.load_cases)
        ]
    warn_of_gears(case)
    warn_of_meshes(each for state in states for each in state.warnings)
    return states[0]


def _of_motion(
    case: MachineCase, load: LoadCase, machine: Machine, motion: MachineMotion
) -> Iterator[MeshWarning]:
    """Warnings about the meshes in a motion, those of a pair."""
    for column, (name, mesh) in enumerate(machine.meshes.items()):
        force, opened = motion.mesh_force[:, column], motion.open[:, column]
        back = bool(np.any((opened > 0.0) & (force != 0.0)))
        damped, share = any(c.damping_in_gap for c in mesh.contacts), float(motion.mean(opened))
        cautions = [*contact_cautions(share, touches_back=back, damped=damped and mesh.has_play)]
        cautions += friction_cautions(next(iter(mesh.frictions), None), force)
        if not mesh.has_play:
            computed = name in case.meshes_with_teeth
            law = inputs_under(case, name, load).law if computed else "stiffness"
            cautions += tension_cautions(force, linear=law != "force-law")
        yield from (MeshWarning(name, load.name, each) for each in cautions)


def balanced_machine(
    case: MachineCase, load: LoadCase, progress: Progress = SILENT, *, rehearsal: bool = False
) -> Balanced:
    """Static balance of a machine with computed teeth that agree with load and temperature."""
    start, heat = MachineTeeth(case, load, progress, rehearsal), None if rehearsal else case.heat
    coupling = "none" if rehearsal else case.solver.coupling
    names = case.meshes_with_teeth if heat is not None else ()
    oils = [read_teeth(case, n, teeth_under(case, n, load))[0].lubricant for n in names]
    oils += [case.heat] if case.heat is not None and not names else []
    try:
        settled = settle(start, coupling, case.solver.coupling_tolerance, heat, oils)
    except ComputationError as error:
        raise ComputationError(case._located(error)) from None
    point, tables = settled.point, dict(settled.tables)
    warm = point.load
    if settled.temperatures is not None:
        warm = warmed(warm, settled.temperatures)
    if rehearsal:  # the few phases of its teeth have their load alone
        inputs = point.inputs
        ratios = {n: teeth_contact_ratio(inputs[n]) for n in tables}
        cautions = {n: load_cautions(table, ratios[n]) for n, table in tables.items()}
    else:
        cautions = {n: mesh_cautions(table) for n, table in tables.items()}
    of_meshes = [MeshWarning(n, load.name, each) for n in tables for each in cautions[n]]
    of_meshes = of_meshes if rehearsal else [*point.warnings, *of_meshes]
    parts = point.balance(tables), tables, point.misalignment, of_meshes
    return Balanced(warm, *parts, settled.heat)


def warmed(load: LoadCase, to: Temperatures) -> LoadCase:
    """A load at the temperatures of a heat balance."""
    return replace(load, temperature=to.oil, gear_temperature=to.gears)


@dataclass(frozen=True)
class MachineTeeth:
    """The teeth of all meshes of a machine under a load, whose forces bend the shafts."""

    case: MachineCase
    load: LoadCase
    progress: Progress
    rehearsal: bool = False
    misalignment: Mapping[str, float | Misalignment] = field(default_factory=dict)

    @cached_property
    def teeth(self) -> dict[str, tuple[MeshTable, dict[str, Any], list[ModelWarning]]]:
        """Mesh table, force law and warnings of each mesh under the nominal load."""
        return _teeth(self.case, self.load, self.misalignment, self.rehearsal, self.progress)

    @cached_property
    def tables(self) -> Mapping[str, MeshTable]:
        """Teeth under the nominal load."""
        return {name: table for name, (table, _, _) in self.teeth.items()}

    @cached_property
    def static(self) -> StaticBalance:
        """Static balance with the teeth under the nominal load."""
        laws = {name: law for name, (_, law, _) in self.teeth.items()}
        return _static(self.case, self.load, laws, self.misalignment)

    @property
    def warnings(self) -> list[MeshWarning]:
        """Warnings of the teeth."""
        listed = ((name, each) for name, (_, _, of_mesh) in self.teeth.items() for each in of_mesh)
        return [MeshWarning(name, self.load.name, each) for name, each in listed]

    @cached_property
    def inputs(self) -> dict[str, MeshInputs]:
        """What the teeth are computed from."""
        misaligned = self.misalignment.items()
        return {name: inputs_under(self.case, name, self.load, m) for name, m in misaligned}

    def aligned(self) -> MachineTeeth:
        """The same with the misalignment by the shafts that these teeth bend."""
        # Deflected shafts misalign the flanks, which changes the stiffness of the teeth and so, a
        # little, the deflection: teeth and balance are repeated until they agree.
        if not self.case.meshes_with_teeth:
            return self._misaligned(self.static)
        heated = self.case.heat is not None and not self.rehearsal
        passes, same = (_HEATED_PASSES, _SETTLED) if heated else (_PASSES, _SAME)
        point = self if self.misalignment else self._misaligned(_static(self.case, self.load))
        for _ in range(passes - 1):
            if _moved(point.misalignment, point.static)[0] <= same:
                break
            point = point._misaligned(point.static)
        self.progress.finish()
        return point

    def _misaligned(self, static: StaticBalance) -> MachineTeeth:
        names = self.case.meshes_with_teeth
        misalignment = {n: misalignment_of(static.meshes[n]) for n in names}
        load = replace(self.load, sharing=static.sharing)
        return replace(self, load=load, misalignment=misalignment)

    def at(self, to: Temperatures) -> MachineTeeth:
        """The same at other temperatures."""
        point = self._misaligned(self.static) if self.misalignment else self
        return replace(point, load=warmed(self.load, to))

    def balance(self, tables: Mapping[str, MeshTable]) -> StaticBalance:
        """Static balance with the force laws of mesh tables."""
        if all(tables[name] is table for name, table in self.tables.items()):
            return self.static
        return _balance(self.case, self.load, tables, self.misalignment)

    def required(self, tables: Mapping[str, MeshTable]) -> dict[str, Array]:
        """Forces that hold the torques which reach the meshes, less the friction before them."""
        machine = self.static.machine
        flow, nominal = power_with_friction(machine, tables)[0].meshes, machine.kinematics.meshes
        return {
            name: flow[name].power
            / nominal[name].power
            * load_of_torque(table, self.inputs[name].driver)
            for name, table in tables.items()
        }

    def following(self, tables: Mapping[str, MeshTable]) -> tuple[MachineTeeth, float]:
        """The same with the misalignments by these teeth, and their change."""
        static = self.balance(tables)
        change, _ = _moved(self.misalignment, static)
        return (self if change <= _SETTLED else self._misaligned(static)), change

    def under(self, loading: Mapping[str, Array]) -> dict[str, MeshTable]:
        """Teeth under given forces; planets with equal teeth and forces share them."""
        nominal = self.tables
        keys = {n: (id(nominal[n]), of.round(12).tobytes()) for n, of in loading.items()}
        first = {key: name for name, key in reversed(keys.items())}

        def compute(name: str) -> MeshTable:
            loads = nominal[name], loading[name]
            return mesh_under_load(self.inputs[name], *loads, about_load=True)

        listed = in_threads(compute, [*first.values()], processors())
        tables = dict(zip(first, listed, strict=True))
        return {name: tables[key] for name, key in keys.items()}

    def friction(self, tables: Mapping[str, MeshTable]) -> float:
        """Power that the friction of all teeth takes [W]."""
        return sum(power_with_friction(self.static.machine, tables)[1].values())

    def lost(self, tables: Mapping[str, MeshTable], to: Temperatures) -> float:
        """Power that teeth, bearings, seals and oil lose [W]."""
        others = part_losses(self.case, warmed(self.load, to), self.balance(tables))
        return self.friction(tables) + sum(others.values())


def _teeth(
    case: MachineCase,
    load: LoadCase,
    misalignment: Mapping[str, float | Misalignment],
    rehearsal: bool,
    progress: Progress,
) -> dict[str, tuple[MeshTable, dict[str, Any], list[ModelWarning]]]:
    """Computed teeth by mesh; planets with equal teeth and misalignment share them."""
    groups: dict[Any, list[str]] = {}
    for name, value in misalignment.items():
        shift = round(value / _EQUAL) if isinstance(value, float) else name
        groups.setdefault((case.tooth_group(name), shift), []).append(name)
    firsts = [names[0] for names in groups.values()]
    inputs = [inputs_under(case, name, load, misalignment[name]) for name in firsts]
    pairs = [*zip(firsts, inputs, strict=True)]
    listed = teeth_of_meshes(pairs, load, progress, rehearsal=rehearsal)
    computed = zip(groups.values(), listed, strict=True)
    teeth = {name: each for names, each in computed for name in names}
    return {name: teeth[name] for name in misalignment}


def teeth_of_meshes(
    inputs: Sequence[tuple[str, MeshInputs]],
    load: LoadCase,
    progress: Progress,
    *,
    rehearsal: bool = False,
) -> list[tuple[MeshTable, dict[str, Any], list[ModelWarning]]]:
    """Teeth of several meshes under a load, in threads."""
    progress.start(f"Tooth contact: {load.name}", len(inputs))

    def compute(
        of_mesh: tuple[str, MeshInputs],
    ) -> tuple[MeshTable, dict[str, Any], list[ModelWarning]]:
        teeth = teeth_of(*of_mesh, rehearsal=rehearsal)
        progress.advance()
        return teeth

    return in_threads(compute, inputs, processors())


def misalignment_of(mesh: MeshBalance) -> float | Misalignment:
    """Misalignment of a mesh by its deflected shafts [m]; mounting errors on crossed axes."""
    return mesh.misalignment if mesh.mounting is None else mesh.mounting


def _moved(
    before: Mapping[str, float | Misalignment], static: StaticBalance
) -> tuple[float, dict[str, float | Misalignment]]:
    """Greatest change of a misalignment over the compression of the teeth, and all of them."""
    after = {name: misalignment_of(static.meshes[name]) for name in before}
    changes = [_change(before[n], after[n]) / static.meshes[n].compression for n in before]
    sharing = static.machine._sharing
    changes += [_OF_SHARE * abs(1.0 - sharing.get(n, 0.0) / s) for n, s in static.sharing.items()]
    return max(changes, default=0.0), after


def _change(before: float | Misalignment, after: float | Misalignment) -> float:
    """Greatest change of a length from one misalignment to another [m]."""
    if isinstance(before, Misalignment):
        names = ("offset", "pinion_axial", "wheel_axial")
        return max(abs(float(getattr(after, n)) - float(getattr(before, n))) for n in names)
    assert isinstance(after, float)
    return abs(after - before)


def structure_at_rest(case: MachineCase, progress: Progress = SILENT) -> MachineStructure:
    """Structure of a machine about its static balance, with the mean stiffness of its meshes."""
    balanced = balanced_machine(case, case.operating_point, progress)
    warn_of_meshes(balanced.warnings)
    return structure_of(case, balanced.static.linearized())


def teeth_of(
    name: str, inputs: MeshInputs, *, rehearsal: bool = False
) -> tuple[MeshTable, dict[str, Any], list[ModelWarning]]:
    """Mesh table and force law of the teeth of a mesh, and their warnings."""
    with named_mesh(name), inputs.located(), collected() as caught:
        table = mesh_table(inputs, about_load=True, rehearsal=rehearsal)
        return table, _law(inputs, table, rehearsal=rehearsal), caught


def restored(case: MachineCase, stored: Stored) -> MachineResult:
    """Result from its folder; its matrices are assembled again, its motions are stored."""
    cases = (case.operating_point, *case.load_cases)
    loads = [_restored_load(case, *each) for each in zip(cases, stored.loads, strict=True)]
    for number, load in enumerate(loads):
        name = load.load.name if number else ""
        figures = figures_of_load(stored.summary, name)
        for key in () if number else shape_figures(case):  # of all loads
            figures.pop(key, None)
        vars(load)["figures"] = figures
    return MachineResult(case, loads[0], tuple(loads[1:]), stored.warnings)


def _restored_load(case: MachineCase, load: LoadCase, stored: StoredLoad) -> LoadResult:
    data, tables = stored.data, stored.tables
    misalignment = {
        name: Misalignment(**value) if isinstance(value, dict) else value
        for name, value in json.loads(data.attrs["misalignment"]).items()
    }
    load = replace(load, sharing=json.loads(data.attrs.get("sharing", "{}")))
    heat = read_passes("heat", next(iter(tables.values()), None), data)
    if heat is not None:
        warm = (heat.temperature, heat.gear_temperature)
        oil, gears = (None if each is None else float(each[-1]) for each in warm)
        load = replace(load, temperature=oil, gear_temperature=gears)
    static = _balance(case, load, tables, misalignment)
    structure = structure_of(case, static.linearized())
    motion = motion_from(data)
    system = system_of(structure, phases=motion.phase_turns is not None)
    at_rest = load, structure, static, tables, misalignment
    losses = part_losses(case, load, static)
    return LoadResult(*at_rest, system, motion, heat=heat, losses=losses)


def _balance(
    case: MachineCase,
    load: LoadCase,
    tables: Mapping[str, MeshTable],
    misalignment: Mapping[str, float | Misalignment],
) -> StaticBalance:
    """Static balance with the force laws of mesh tables."""
    inputs = {name: inputs_under(case, name, load, misalignment[name]) for name in tables}
    laws = {name: _law(inputs[name], table) for name, table in tables.items()}
    return _static(case, load, laws, misalignment)


def _static(
    case: MachineCase,
    load: LoadCase,
    laws: Mapping[str, Any] | None = None,
    misalignment: Mapping[str, float | Misalignment] | None = None,
) -> StaticBalance:
    """Static balance under a load, with errors placed in the file of the machine."""
    machine = case.machine(load, **(laws or {}))
    slopes = {n: m for n, m in (misalignment or {}).items() if not isinstance(m, Misalignment)}
    try:
        return case._at_rest.balance(machine, face_laws(machine, slopes))
    except (InputError, ComputationError) as error:
        raise type(error)(case._located(error)) from None


def structure_of(case: MachineCase, machine: Machine) -> MachineStructure:
    """Structure of a machine, reduced to the modes below the frequency limit of the case."""
    ratio, limit = case.motion.modal_damping_ratio, case.motion.frequency_limit
    stage = case.stages.get(case.lone_stage or "")
    frame = None if stage is None else stage.table.carrier
    parts = case._at_rest.parts(machine, ratio, frame)
    if limit is not None:
        return parts.reduced(machine, limit)
    return parts.at(machine) if frame is None else parts.turned(machine)


def _law(inputs: MeshInputs, table: MeshTable, *, rehearsal: bool = False) -> dict[str, Any]:
    """Force law of a mesh whose teeth are computed."""
    functions, single = table.functions(), inputs.law == "force-law"
    force = "stiffness" if single else inputs.law  # one spring for the ramps
    names, contacts = mesh_contacts(inputs, functions, mesh_damping(inputs, table), force)
    frictions: tuple[LoadFriction, ...] = ()
    if (friction := load_friction_of(inputs, table, rehearsal)) is not None:
        contacts, frictions = with_load_friction(names, contacts, friction)
    if single and functions.force_law:
        contacts = tuple(law_contact(each, functions.force_law) for each in contacts)
    return {
        # The static balance and the modes are those about the load.
        "stiffness": functions.tangent_stiffness or functions.stiffness,
        "contacts": contacts,
        "frictions": frictions,
        "events": functions.event_phases,
    }
