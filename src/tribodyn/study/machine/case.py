"""The case of a machine: its parts and load cases, checked and in SI."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from copy import deepcopy
from functools import cached_property, partial
from inspect import Parameter, Signature
from typing import Any, ClassVar, Literal

import numpy as np

from tribodyn.aliases import with_old_names
from tribodyn.errors import InputError, Problem, TribodynError
from tribodyn.gear import Misalignment
from tribodyn.machine import (
    Bearing,
    Coupling,
    Gear,
    Housing,
    Machine,
    Mesh,
    Operation,
    Shaft,
)
from tribodyn.machine.plane_law import with_exchanged_gears
from tribodyn.machine.static.at_rest import AtRest
from tribodyn.study.case.case import Case
from tribodyn.study.case.pair import PairCase
from tribodyn.study.case.provenance import Assumption, reason_faults
from tribodyn.study.case.section import Section, choices, table_in
from tribodyn.study.case.sections import heat_problems
from tribodyn.study.case.user_input import Source, UserInput, values_in_si
from tribodyn.study.case.values import KeyedProblems, read_table, with_typed_keys
from tribodyn.study.faults.machine_section import impossible_faults, machine_fault_problems
from tribodyn.study.machine.assumptions import default_assumptions, stated_assumptions
from tribodyn.study.machine.housing_files import read_housing
from tribodyn.study.machine.pair_cases import (
    check_loads,
    constant_law,
    mesh_hand,
    pair_case,
    pinion_and_wheel,
    read_blanks,
    read_pair,
    read_teeth,
    take_loads,
    teeth_under,
    with_forms,
)
from tribodyn.study.machine.read_parts import (
    LoadCase,
    add_shafts,
    completed,
    each_part,
    for_each_planet,
    is_faulty,
    parts_of,
    read_bearing,
    read_coupling,
    read_gear,
    read_loads,
    read_rated_parts,
    read_shaft,
    solver_problems,
    unknown_gears,
)
from tribodyn.study.machine.tables import GROUPS, MeshDynamics
from tribodyn.study.machine.unused_keys import changed_machine, unknown_part_key, unused_keys
from tribodyn.study.machine_tables import MachineTables
from tribodyn.study.mesh_inputs import MeshInputs
from tribodyn.study.part_losses import loss_problems
from tribodyn.study.planetary.machine_stages import (
    MEMBERS,
    CaseStage,
    floating_members,
    read_stages,
    stage_by_itself,
    stage_mesh,
)

#: Tables in which problems of parts are placed.
_PLACED = (*GROUPS, "planets", "operation", "housing", "lubricant")
#: Keys of a mesh that its object takes as they are.
_OF_MESH = (*("normal_module", "helix_angle", "angle", "center_distance", "stiffness", "offset"),)


@with_old_names
class MachineCase(Case):
    """A machine under its load cases: frozen, checked, in SI.

    Created as any :class:`tribodyn.Case`, from tables with ``[meshes.NAME]`` and ``[gears.NAME]``.

    Parameters
    ----------
    source : Source, optional
        Where the values come from.
    **data : object
        The tables of the case file.

    Examples
    --------
    >>> case = Case(
    ...     gears={"z1": {"shaft": "in", "teeth": 27, "face_width": "50 mm"},
    ...            "z2": {"shaft": "out", "teeth": 51, "face_width": "50 mm"}},
    ...     meshes={"first": {"gears": ["z1", "z2"], "normal_module": "4.5 mm",
    ...                       "stiffness": "5e8 N/m"}},
    ...     operation={"input": "in", "output": "out", "speed": "1200 rpm", "torque": "400 N*m"})
    >>> case.machine()
    Machine(2 shafts, 2 gears, 1 mesh, 0 bearings)
    """

    lumped: ClassVar[Literal[False]] = False  #: its parts vibrate
    groups = ("shafts", "meshes", "bearings", "planets")
    root = MachineTables
    fields: ClassVar[dict[str, Any]] = {}  # its attributes are parts
    gears: dict[str, Gear]
    couplings: dict[str, Coupling]
    operating_point: LoadCase
    load_cases: tuple[LoadCase, ...]  #: of ``[[load_cases]]``

    def __init__(self, source: Source | None = None, /, **data: Any) -> None:
        stated, faults, misspelt, problems, typed_keys = self._take(source, data)
        problems += misspelt
        tables: Any = self._read_tables(completed(self.data), problems)
        self.title, self.origin = str(tables.title or self.kind), tables.origin
        groups = {name: parts_of(tables, name) for name in (*GROUPS, "planets", "load_cases")}
        self._blanks, widths = read_blanks(groups, problems)
        stages = read_stages(groups["planets"], groups["gears"], problems)
        if self.lone_stage in stages:
            problems += floating_members(f"planets.{self.lone_stage}", stages[self.lone_stage][0])
        gears = {n: t for n, t in groups["gears"].items() if n not in self.planet_names}
        self.gears = each_part(gears, partial(read_gear, widths=widths), problems)
        self.shafts: dict[str, Shaft] = each_part(groups["shafts"], read_shaft, problems)
        self.bearings: dict[str, Bearing] = each_part(groups["bearings"], read_bearing, problems)
        self._mesh_dynamics: dict[str, Any] = {}
        self._stage_of: dict[str, tuple[CaseStage, str]] = {}
        self._pairs: dict[str, PairCase] = {}
        self._teeth: dict[tuple[object, ...], tuple[PairCase, MeshInputs]] = {}
        self._machines: dict[tuple[float, float], Machine] = {}
        self._at_rest = AtRest()
        self._mesh_tables = each_part(groups["meshes"], self._read_mesh, problems)
        if not groups["meshes"] and "planets" not in self.data:
            remedy = 'Add [meshes.NAME] with gears = ["z1", "z2"] and normal_module'
            problems.append(("meshes", Problem("there is no mesh", "", "", remedy)))
        self.couplings = each_part(groups["couplings"], read_coupling, problems)
        self.housing: Housing | None = read_housing(tables.housing, problems)
        self.losses, self.oil = tables.losses, tables.lubricant
        self.heat = self.oil if getattr(self.oil, "heat_transfer", None) else None
        self.rated_parts = read_rated_parts(tables.rating, groups, self.shafts, problems)
        self.motion, self.solver = tables.dynamics, tables.solver
        self.faults: dict[str, Any] = groups["faults"]
        loads = read_loads(self.data, tables, groups["load_cases"], problems)
        if loads is not None:
            self.ends, self.operating_point, self.load_cases = loads
        if problems:
            raise InputError(self._source.place(with_typed_keys(problems, typed_keys)))
        self.implied_shafts = add_shafts(self.shafts, self.gears, stages, tables.material)
        named = machine_fault_problems(self)
        if problems := unknown_gears({n: self._gears_of(n) for n in self._mesh_tables}, self.gears):
            raise InputError(self._source.place([*problems, *named]))
        try:
            self._add_stages(stages)
            self._checked_machine(self.operating_point)
            self._add_forms()
            self._machines.clear()
            check_loads(self)
        except InputError as error:
            raise InputError([*self._located(error), *self._source.place(named)]) from None
        if problems := [*self._impossible(named), *faults]:
            raise InputError(self._source.place(problems))
        self._settle(stated)

    @staticmethod
    def _completed(data: dict[str, Any]) -> dict[str, Any]:
        return for_each_planet(deepcopy(data))

    def _impossible(self, named: KeyedProblems | None = None) -> KeyedProblems:
        """Problems of faults, losses and spreads that the parts do not allow."""
        faults = impossible_faults(self, named or [])
        return [*faults, *loss_problems(self), *self._spread_faults()]

    _changed_tables = staticmethod(changed_machine)
    _take_numbers = take_loads

    @cached_property
    def _effective(self) -> dict[str, Any]:  # type: ignore[override]
        return values_in_si(MachineTables, self.data)

    def _all_values(self) -> dict[str, Any]:
        files = {key: path.name for key, path in self._named_files().items()}
        return {**self._effective, **files}

    def _unknown_key(self, key: str) -> Problem:
        return unknown_part_key(self.data, key)

    def _read_tables(self, data: Mapping[str, Any], problems: KeyedProblems) -> Any:
        """Values of all tables; problems of what cannot be read, or has no effect."""
        problems += unused_keys(self.data)
        problems += reason_faults(self.data.get("assumed", {}))
        problems += heat_problems(UserInput({"lubricant": self.data.get("lubricant", {})}))
        body = {name: value for name, value in data.items() if name != "assumed"}
        faults: KeyedProblems = []
        chosen = choices(UserInput(body), MachineTables)
        tables: Any = read_table(MachineTables, body, "", chosen, faults)
        for group in (*GROUPS, "planets"):
            if "" in table_in(body, group):
                what, remedy = "a part has no name", f"Write [{group}.NAME]"
                problems.append((group, Problem(what, "", "Others refer to it by name", remedy)))
        if "planets" in body and not table_in(body, "planets"):
            remedy = "Write [planets.NAME] with sun, ring, planet, carrier and count, or remove it"
            problems.append(("planets", Problem("there is no stage", "", "", remedy)))
        reported = {key for key, _ in problems}
        problems += [(key, problem) for key, problem in faults if key not in reported]
        if tables.solver is not None:
            problems += solver_problems(data, tables.solver)
        return tables

    def __getstate__(self) -> dict[str, Any]:
        """Return the state without what is cached for further loads."""
        return {**vars(self), "_teeth": {}, "_machines": {}, "_at_rest": AtRest()}

    def _add_forms(self) -> None:
        """Set tooth forms and densities of the gears whose teeth are computed."""
        for mesh in self.meshes_with_teeth:
            if mesh not in self._blanks and mesh not in self._stage_of:
                names = self._pinion_and_wheel(mesh)
                self.gears |= with_forms(self.gears, names, self._pair_of(mesh))

    def _add_stages(self, stages: Mapping[str, tuple[Any, ...]]) -> None:
        """Planetary stages, with supports of members that have none."""
        self.stages = {}
        for name, (table, *planets) in stages.items():
            stage = CaseStage(name, table, self.data, planets, self.gears, self.source)
            self.stages[name] = stage = stage.with_forms()
            self.gears |= stage.gears
        linked = [self.gears[g].shaft for mesh in self._mesh_tables for g in self._gears_of(mesh)]
        linked += [shaft for coupling in self.couplings.values() for shaft in coupling.shafts]
        for stage in self.stages.values():
            self._stage_of |= {mesh: (stage, role) for mesh, role in stage.mesh_roles().items()}
            self.shafts[stage.table.carrier] = stage.carrier_shaft(self.shafts)
            others = [other for other in self.stages.values() if other is not stage]
            members = [other.shaft_of(role) for other in others for role in MEMBERS]
            links = {*linked, *members, *self.ends}
            self.bearings |= stage.supports(self.shafts, self.bearings, links)
            parts = stage.stage().parts(stage.name, stage.gears)
            self.gears |= parts["gears"]
            self._mesh_tables |= dict.fromkeys(parts["meshes"], stage.table)

    def _read_mesh(self, name: str, table: Any, problems: KeyedProblems) -> Any:
        """Table of a mesh, and the law of one with a constant stiffness."""
        key, names = f"meshes.{name}", table.gears
        listed = names if isinstance(names, list | tuple) else ()
        if len(listed) != 2 or not all(isinstance(n, str) and listed.count(n) == 1 for n in listed):
            remedy = 'Write gears = ["z1", "z2"]'
            what = "gears is missing" if names is None else f"gears = {names!r}"
            problem = Problem(what, "", "A mesh has two gears", remedy)
            problems[:] = [fault for fault in problems if fault[0] != f"{key}.gears"]
            problems.append((f"{key}.gears", problem))
        if isinstance(table.stiffness, Section):  # a model of the teeth, in place of a number
            vars(table)["stiffness"] = None
        if table.stiffness is not None and not is_faulty(key, problems):
            values = {**table_in(self.data, "dynamics"), **self.data["meshes"][name]}
            law = {k: v for k, v in values.items() if k in MeshDynamics.fields}
            self._mesh_dynamics[name] = read_table(MeshDynamics, law, key, {}, problems)
        return table

    def _located(self, error: TribodynError) -> list[Problem]:
        """Problems of a machine with the lines of its parts."""
        source = self.source
        return [
            source.place([(str(problem.where), problem)])[0]
            if str(problem.where).partition(".")[0] in _PLACED
            else problem
            for problem in error.problems
        ]

    def _gears_of(self, mesh: str) -> tuple[str, str]:
        if mesh in self._stage_of:
            stage, role = self._stage_of[mesh]
            return stage.machine_names(mesh, role)
        first, second = self.data["meshes"][mesh]["gears"]
        return first, second

    def _pinion_and_wheel(self, mesh: str) -> tuple[str, str]:
        return pinion_and_wheel(self._gears_of(mesh), self.gears)

    @property
    def assumptions(self) -> tuple[Assumption, ...]:
        """What is assumed: reasons in ``[assumed]``, and what the case does not give."""
        return (*stated_assumptions(self), *default_assumptions(self))

    @property
    def planet_names(self) -> tuple[str, ...]:
        """Names of the gears that are planets of stages."""
        stages = [b for b in table_in(self.data, "planets").values() if isinstance(b, dict)]
        return tuple(str(b[k]) for b in stages for k in ("planet", "ring_planet") if k in b)

    @cached_property
    def lone_stage(self) -> str | None:
        """Name of the stage of a case that is nothing else; None of other machines."""
        return stage_by_itself(self.data)

    @property
    def kind(self) -> str:
        """What the case describes, in words."""
        return "Planetary stage" if self.lone_stage else "Machine"

    @property
    def meshes(self) -> tuple[str, ...]:
        """Names of the meshes."""
        return tuple(self._mesh_tables)

    @cached_property
    def meshes_with_teeth(self) -> tuple[str, ...]:
        """Names of the meshes whose tooth contact is computed."""
        tables = self._mesh_tables.items()
        return tuple(n for n, table in tables if getattr(table, "stiffness", None) is None)

    def mesh_table(self, mesh: str) -> Any:
        """Values of the table of a mesh.

        Parameters
        ----------
        mesh : str
            Name of the mesh.

        Returns
        -------
        object
            With the keys of the table as attributes, in SI.
        """
        return self._mesh_tables[mesh]

    def machine(self, load: LoadCase | None = None, **meshes: Mapping[str, Any]) -> Machine:
        """Machine at its operating point or under a load case.

        Parameters
        ----------
        load : LoadCase, optional
            The operating point by default.
        **meshes : mapping
            Further fields of the meshes of these names.

        Returns
        -------
        Machine
        """
        machine = self._machine_under(load or self.operating_point)
        of_stages = {
            name: self._exchanged(stage_mesh(machine.meshes[name], fields))
            for name, fields in meshes.items()
            if name in self._stage_of
        }
        others = {n: self._mesh(n, f) for n, f in meshes.items() if n not in of_stages}
        return machine._with(meshes={**of_stages, **others}) if meshes else machine

    def _machine_under(self, load: LoadCase) -> Machine:
        """Machine under a load, without force laws of teeth that are computed."""
        key = load.speed, load.torque
        if key not in self._machines:
            same_sense = (m for k, m in self._machines.items() if min(np.multiply(k, key)) > 0.0)
            if (machine := next(same_sense, None)) is None:
                machine = self._checked_machine(load)
            self._machines[key] = machine._with(Operation(*self.ends, *key))
        shared = load.sharing
        return self._machines[key]._with(sharing=shared) if shared else self._machines[key]

    def _checked_machine(self, load: LoadCase) -> Machine:
        operation = Operation(*self.ends, load.speed, load.torque)
        objects = {n: self._mesh(n, {}) for n in self._mesh_tables if n not in self._stage_of}
        parts = self.shafts, self.gears, objects, self.bearings, self.housing, self.couplings
        planets = {name: stage.stage() for name, stage in self.stages.items()}
        machine = Machine(*parts, planets=planets, operation=operation)
        if not planets:
            return machine
        flow = machine.kinematics.meshes
        planets = {n: stage.stage(flow[f"{n}_sun1"]) for n, stage in self.stages.items()}
        return machine._with(planets=planets)

    def _mesh(self, name: str, fields: Mapping[str, Any]) -> Mesh:
        table = self._mesh_tables[name]
        if (blank := self._blanks.get(name)) is not None:
            apex = [1 if side == "+x" else -1 for side in (table.apex_pinion, table.apex_wheel)]
            values = {"angle": table.angle, "stiffness": table.stiffness}
            if (law := self._mesh_dynamics.get(name)) is not None:
                values |= constant_law(law)
            values |= fields
            return Mesh.hypoid(self._gears_of(name), blank, apex=(apex[0], apex[1]), **values)
        values = {k: getattr(table, k) for k in _OF_MESH}
        values["pressure_angle"] = table.normal_pressure_angle
        names = self._gears_of(name)
        internal = any(self.gears[gear].is_ring for gear in names)
        values["hand"] = mesh_hand(table, names, self.data, internal=internal)
        if (law := self._mesh_dynamics.get(name)) is not None:
            values |= constant_law(law)
        if table.center_distance is None and table.stiffness is None:
            values["center_distance"] = self._pair_of(name).gear_pair.center_distance
        return self._exchanged(Mesh(names, **{**values, **fields}))

    def _exchanged(self, mesh: Mesh) -> Mesh:
        """Mesh whose contacts were those of its pinion and its wheel."""
        pinion, wheel = pinion_and_wheel(mesh.gears, self.gears)
        if mesh.gears == (pinion, wheel):
            return mesh
        return with_exchanged_gears(mesh, internal=self.gears[wheel].is_ring)

    def _pair_of(self, mesh: str) -> PairCase:
        """Pair of cylindrical gears, at any speed and torque."""
        if mesh not in self._pairs:
            names = self._pinion_and_wheel(mesh)
            parts = self.data, f"meshes.{mesh}", names, self.source
            self._pairs[mesh] = pair_case(*parts, driver=names[0], operation=(1.0, 1.0))
        return self._pairs[mesh]

    def pair(self, mesh: str, load: LoadCase, misalignment: float | Misalignment = 0.0) -> PairCase:
        """Pair of a mesh under a load case, as a case of its own.

        Its pinion is the gear with fewer teeth.

        Parameters
        ----------
        mesh : str
            Name of the mesh.
        load : LoadCase
            Speed and torque of the machine.
        misalignment : float or Misalignment
            Increase of the compression over the common face width along x [m], of hypoid gears
            the mounting errors beyond those in their table.

        Returns
        -------
        Case

        Raises
        ------
        InputError
            If the gears of the mesh have no tooth contact that is computed.
        """
        under = teeth_under(self, mesh, load)
        if misalignment:
            return read_pair(self, mesh, under, under.along_path(misalignment))
        speed, torque = under.operation
        pair, _ = read_teeth(self, mesh, under)
        return pair.replace({"operation.speed": speed, "operation.torque": torque})

    def mesh_pairs(self) -> Iterator[tuple[str, PairCase, tuple[str, str]]]:
        """Iterate over the meshes with computed teeth.

        Yields
        ------
        tuple of str, PairCase and (str, str)
            Key of the table of the mesh, its pair of gears as a case, and names of both gears.
        """
        for mesh in self.meshes_with_teeth:
            pair, names = self.pair(mesh, self.operating_point), self._pinion_and_wheel(mesh)
            if mesh in self._stage_of:
                stage, role = self._stage_of[mesh]
                yield stage.key, pair, stage.names_of(role)
                continue
            yield f"meshes.{mesh}", pair, names

    def density(self, gear: str) -> float:
        """Density of one gear [kg/m^3], by its name.

        Parameters
        ----------
        gear : str

        Returns
        -------
        float
        """
        return float(self.gears[gear].density)

    def tooth_group(self, mesh: str) -> str:
        """Name that meshes with equal teeth share: those of all planets with one member.

        Parameters
        ----------
        mesh : str
            Name of the mesh.

        Returns
        -------
        str
        """
        stage, role = self._stage_of.get(mesh, (None, ""))
        return mesh if stage is None else f"{stage.key}.{role}"


MachineCase.__signature__ = Signature(
    [
        Parameter("source", Parameter.POSITIONAL_ONLY, default=None),
        Parameter("data", Parameter.VAR_KEYWORD),
    ]
)
#: Names of an earlier version: a planetary stage is a machine, the one case of named parts.
PlanetaryCase = PartsCase = MachineCase
AnyCase = PairCase | MachineCase
