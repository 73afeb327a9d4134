"""The machine: shafts, gears, meshes, bearings and housing, joined by their names."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from copy import copy
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from types import MappingProxyType
from typing import ClassVar

import numpy as np

from tribodyn.dynamics.harmonic.phase_grid import Follower, first_sizes
from tribodyn.errors import InputError, Problem, no_such
from tribodyn.machine.bearing import Bearing
from tribodyn.machine.fields import check_name, check_number, quoted
from tribodyn.machine.gear import Gear
from tribodyn.machine.graph.bodies import GearBody, body_problems, gear_body
from tribodyn.machine.graph.clock import Clock, Phases, clock_of, phases_of
from tribodyn.machine.graph.directions import MeshDirection, mesh_direction
from tribodyn.machine.graph.kinematics import PowerFlow, kinematics, ratio_problems
from tribodyn.machine.graph.mobility import NOTHING, Drive, Mobility, ShaftGraph
from tribodyn.machine.graph.part_checks import (
    drive_problems,
    mesh_problems,
    place_problems,
    support_problems,
)
from tribodyn.machine.graph.placement import (
    Placement,
    carrier_axes,
    placement_problems,
    shaft_poses,
)
from tribodyn.machine.housing import Housing
from tribodyn.machine.mesh import Mesh
from tribodyn.machine.planetary.stage_parts import PlanetaryStage
from tribodyn.machine.shaft import Coupling, Shaft
from tribodyn.types import Array, ByName

#: What follows from the loads and the laws of the meshes and bearings.
_OF_LOADS = ("kinematics", "clock", "phases", "directions", "gear_loads")


@dataclass(frozen=True)
class Operation:
    """Speed and torque of the input, and where the power leaves.

    Parameters
    ----------
    input, output : str
        Names of two shafts.
    speed : float
        Speed of the input; a positive one turns y towards z [rad/s].
    torque : float
        Torque on the input in its direction of rotation; negative where the output drives [N*m].

    Raises
    ------
    InputError
        If a value is not finite.

    Examples
    --------
    >>> Operation("input", "output", speed=157.08, torque=300.0).torque
    300.0
    """

    input: str
    output: str
    speed: float
    torque: float

    def __post_init__(self) -> None:
        check_name(self, "input")
        check_name(self, "output")
        check_number(self, "speed", "rad/s", -1e6, 1e6)
        check_number(self, "torque", "N*m", -1e12, 1e12)


#: Keys of a stage by the arguments of the positions of its planets.
_OF_STAGE = {"planets": ".count", "angles": ".angles"}


@dataclass(frozen=True, eq=False)
class Machine:
    """Shafts on bearings that are joined by meshes.

    Parameters
    ----------
    shafts : mapping of str to Shaft
        Shafts by name.
    gears : mapping of str to Gear
        Gears by name.
    meshes : mapping of str to Mesh
        Meshes by name.
    bearings : mapping of str to Bearing
        Bearings by name.
    housing : Housing, optional
        Housing; rigid by default.
    couplings : mapping of str to Coupling
        Couplings by name.
    planets : mapping of str to PlanetaryStage
        Planetary stages by name; their planets, pins and meshes are added to the parts.
    operation : Operation
        Speed and torque.

    Raises
    ------
    InputError
        If the parts do not form a machine; the message names the part: ``bearings.A.position``.

    Examples
    --------
    >>> machine = Machine(
    ...     shafts={"input": Shaft(), "output": Shaft()},
    ...     gears={"z1": Gear("input", 0.0, 27, 0.05), "z2": Gear("output", 0.0, 51, 0.05)},
    ...     meshes={"first": Mesh(("z1", "z2"), normal_module=4.5e-3)},
    ...     operation=Operation("input", "output", speed=100.0, torque=400.0))
    >>> machine
    Machine(2 shafts, 2 gears, 1 mesh, 0 bearings)
    """

    shafts: Mapping[str, Shaft]
    gears: Mapping[str, Gear]
    meshes: Mapping[str, Mesh]
    bearings: Mapping[str, Bearing] = field(default_factory=dict)
    housing: Housing | None = None
    couplings: Mapping[str, Coupling] = field(default_factory=dict)
    planets: Mapping[str, PlanetaryStage] = field(default_factory=dict, kw_only=True)
    operation: Operation = field(kw_only=True)

    #: Torques of the first gears of meshes in loops over that of the input, where they are known.
    _sharing: ClassVar[Mapping[str, float]] = NOTHING

    def __post_init__(self) -> None:
        object.__setattr__(self, "planets", _parts("planets", self.planets, PlanetaryStage))
        if problems := [
            problem for stage in self.planets for problem in self._stage_problems(stage)
        ]:
            raise InputError(problems)
        for name, stage in self.planets.items():
            if stage._meshes(name) <= {*self.meshes}:
                continue  # a copy, with its parts
            for group, parts in stage.parts(name, self.gears).items():
                present = getattr(self, group)
                object.__setattr__(self, group, {**present, **parts, **present})
        kinds = {"shafts": Shaft, "gears": Gear, "meshes": Mesh, "bearings": Bearing,
                 "couplings": Coupling}  # fmt: skip
        for group, kind in kinds.items():
            object.__setattr__(self, group, _parts(group, getattr(self, group), kind))
        if not isinstance(self.operation, Operation):
            what, remedy = f"operation = {quoted(self.operation)}", "Give an Operation"
            raise InputError(what, "operation", "A machine runs at a speed under a torque", remedy)
        for check in (self._reference_problems, self._mesh_problems, self._place_problems):
            if listed := list(check()):
                raise InputError(listed)
        for name in self.planets:
            self._set_offsets(name)

    def __repr__(self) -> str:
        """One line."""
        counts = {
            "shaft": len(self.shafts),
            "gear": len(self.gears),
            "mesh": len(self.meshes),
            "bearing": len(self.bearings),
        }
        plural = {"mesh": "meshes"}
        parts = [f"{n} {k if n == 1 else plural.get(k, k + 's')}" for k, n in counts.items()]
        return f"Machine({', '.join(parts)})"

    def _with(
        self,
        operation: Operation | None = None,
        sharing: Mapping[str, float] | None = None,
        **groups: Mapping[str, object],
    ) -> Machine:
        """Copy with other meshes or bearings in the same places, which need no check again.

        Nor needs it another operation that presses the same flanks in the same sense, or torques
        of the first gears of meshes in loops over that of the input.
        """
        other = copy(self)
        # Bearings that hold the same shafts carry the same power.
        same = operation is None and sharing is None and groups.keys() <= {"bearings"}
        for name in () if same else _OF_LOADS:
            vars(other).pop(name, None)
        vars(other)["operation"] = operation or self.operation
        vars(other)["_sharing"] = self._sharing if sharing is None else sharing
        for group, parts in groups.items():
            vars(other)[group] = MappingProxyType({**getattr(self, group), **parts})
        for name in groups.get("planets", ()):
            other._set_offsets(name)
        return other

    @cached_property
    def graph(self) -> ShaftGraph:
        """Shafts, and the meshes and couplings between them."""
        edges = {
            name: (self.gears[mesh.gears[0]].shaft, self.gears[mesh.gears[1]].shaft)
            for name, mesh in self.meshes.items()
        }
        edges |= {name: coupling.shafts for name, coupling in self.couplings.items()}
        edges |= {name: (first, carrier) for name, (first, carrier, _) in self._carriers.items()}
        return ShaftGraph(edges, self.operation.input)

    @cached_property
    def _mobility(self) -> Mobility:
        return Mobility(self.graph, self.gears, self.meshes, self._drive)

    @cached_property
    def kinematics(self) -> PowerFlow:
        """Speeds, torques and power of shafts and meshes, without losses."""
        return self.power_flow({})

    def power_flow(self, efficiency: Mapping[str, float]) -> PowerFlow:
        """Speeds, torques and power of shafts and meshes, with the losses of meshes.

        Parameters
        ----------
        efficiency : mapping of str to float
            Power that the driven gear of a mesh receives over that which its driving gear gives,
            relative to their carrier [1]; meshes that are not named have no loss.

        Returns
        -------
        PowerFlow
            The torque of the input is that of the machine, the output has what the losses leave;
            the power of a mesh is that of its driving gear.
        """
        loads = kinematics(self._mobility, self.meshes, self._drive, efficiency)
        shafts = {name: loads.shafts[name] for name in self.shafts}
        for pin in self.bearings.values():
            if pin.carrier:
                planet, carrier = shafts[pin.shaft], shafts[pin.carrier]
                rolling = planet.torque * abs(planet.speed - carrier.speed)
                shafts[pin.shaft] = replace(planet, power=rolling)
        return replace(loads, shafts=shafts)

    @cached_property
    def clock(self) -> Clock:
        """Common period of all meshes and of all teeth that differ."""
        ratios = {name: shaft.ratio for name, shaft in self.kinematics.shafts.items()}
        cycles = {}
        for name, mesh in self.meshes.items():
            gear = self.gears[mesh.gears[0]]
            carrier = ratios[mesh.carrier] if mesh.carrier else 0
            cycles[name] = abs((ratios[gear.shaft] - carrier) * gear.teeth)
        clock = clock_of(cycles, ratios, abs(self.operation.speed) / (2.0 * math.pi))
        return clock.with_whole_periods({name: mesh.period for name, mesh in self.meshes.items()})

    @cached_property
    def phases(self) -> Phases:
        """Independent phases of the meshes, for a motion that needs no common period."""
        return self.phases_with()

    def phases_with(self, driven: Sequence[Fraction] = (), *, together: bool = False) -> Phases:
        """Phases of the meshes, of what turns with them, and of what drives shafts.

        Parameters
        ----------
        driven : sequence of Fraction
            Rates of what drives shafts: its cycles in a period of the clock.
        together : bool
            Whether meshes and what turns with them share one phase, after which all repeats.

        Returns
        -------
        Phases
        """
        clock, meshes = self.clock, self.meshes.items()
        turning = [
            clock.cycles[name] * turn.waves for name, mesh in meshes for turn in mesh.turning
        ]
        periods = {name: mesh.period for name, mesh in meshes}
        size = self._unknowns if max(periods.values(), default=1) > 1 else None
        return phases_of(clock, periods, turning, driven, together=together, size=size)

    def _followers(self, phases: Phases) -> list[Follower]:
        """Contacts of each mesh, and what they follow."""
        cycles = self.clock.cycles
        return [
            Follower(
                max(len(mesh.contacts), 1), phases.cycles[name], mesh.period,
                tuple(phases.turns[cycles[name] * turn.waves] for turn in mesh.turning),
            )
            for name, mesh in self.meshes.items()
        ]  # fmt: skip

    def _unknowns(self, phases: Phases) -> float:
        """Unknowns of the first grids over phases if these are not made coarser."""
        followers = self._followers(phases)
        sizes = first_sizes(followers, 0, coarser=False)
        return sum(each.contacts * size for each, size in zip(followers, sizes, strict=True))

    @cached_property
    def directions(self) -> Mapping[str, MeshDirection]:
        """Directions of each mesh in space."""
        turning = self.kinematics.meshes
        if not self.operation.speed:
            forward = replace(self._drive, speed=1.0)
            turning = kinematics(self._mobility, self.meshes, forward).meshes
        directions = {}
        for name, mesh in self.meshes.items():
            first, second = (self.gears[gear] for gear in mesh.gears)
            senses = [1 if speed > 0.0 else -1 for speed in turning[name].speeds]
            sense = self.kinematics.meshes[name].sense
            directions[name] = mesh_direction(mesh, (first, second), sense, (senses[0], senses[1]))
        return directions

    @cached_property
    def placement(self) -> Placement:
        """Axes of the shafts in space, and their places along x."""
        poses = shaft_poses(self.graph, self.gears, self.meshes, self._coupled_lengths)
        gears = {n: poses[g.shaft].on_axis(g.node_position) for n, g in self.gears.items()}
        bearings = {n: poses[b.shaft].on_axis(b.position) for n, b in self.bearings.items()}
        starts = {name: pose.start for name, pose in poses.items()}
        return Placement(starts, gears, bearings, {name: p.axes for name, p in poses.items()})

    @property
    def _drive(self) -> Drive:
        run = self.operation
        fixed = dict.fromkeys(b.shaft for b in self.bearings.values() if b.holds)
        springs = {name: c.torsional_stiffness for name, c in self.couplings.items()}
        ends = run.input, run.output
        return Drive(*ends, run.speed, run.torque, tuple(fixed), springs, self._sharing)

    @property
    def _carriers(self) -> dict[str, tuple[str, str, float]]:
        return carrier_axes(self.gears, self.meshes, self.bearings)

    @property
    def _coupled_lengths(self) -> dict[str, float]:
        """Length of the first shaft of each coupling, and from an axis to its carrier [m]."""
        lengths = {name: self.shafts[c.shafts[0]].length for name, c in self.couplings.items()}
        return lengths | {name: along for name, (_, _, along) in self._carriers.items()}

    @cached_property
    def gear_bodies(self) -> Mapping[str, GearBody]:
        """Mass and inertia of each gear without its shaft."""
        return {
            name: gear_body(
                gear, mesh, self.shafts[gear.shaft], mesh.gears.index(name) if mesh else 0
            )
            for name, gear in self.gears.items()
            for mesh in [self._mesh_of(name)]
        }

    @cached_property
    def gear_loads(self) -> Mapping[str, Array]:
        """Mean forces and moments of the meshes on each gear, in the order of a node [N, N*m]."""
        loads = {name: np.zeros(6) for name in self.gears}
        for name, mesh in self.meshes.items():
            load = -self.kinematics.meshes[name].force * self.directions[name].direction
            loads[mesh.gears[0]] += load[:6]
            loads[mesh.gears[1]] += load[6:]
        return loads

    def _stage_problems(self, name: str) -> Iterable[Problem]:
        """Members of a planetary stage that do not exist, and planets that do not fit."""
        stage, where = self.planets[name], f"planets.{name}"
        for role in ("sun", "ring"):
            yield from _missing(f"{where}.{role}", getattr(stage, role), "gear", self.gears)
        yield from _missing(f"{where}.carrier", stage.carrier, "shaft", self.shafts)
        if {stage.sun, stage.ring} <= set(self.gears):
            ring = self.gears[stage.ring]
            if not ring.is_ring:
                why, remedy = "Internal teeth have a negative number", f"Give {-ring.teeth}"
                yield Problem(f"teeth = {ring.teeth}", f"gears.{stage.ring}.teeth", why, remedy)
                return
            try:
                stage.positions(self.gears)
            except InputError as error:
                for problem in error.problems:
                    key = _OF_STAGE.get(getattr(problem.where, "name", ""), "")
                    yield replace(problem, where=f"{where}{key}")

    def _set_offsets(self, name: str) -> None:
        """Set the phases of the meshes of a planetary stage, by the sense of its sun."""
        stage, meshes = self.planets[name], dict(self.meshes)
        phases, names = stage.phases(self.gears), stage.mesh_names(name)
        lags = self.directions[names["sun"][0]].senses[0] > 0
        for mesh, each_mesh in names.items():
            lag = getattr(phases, mesh)
            for each, offset in zip(each_mesh, (-lag if lags else lag) % 1.0, strict=True):
                meshes[each] = replace(meshes[each], offset=float(offset) % 1.0)
        object.__setattr__(self, "meshes", MappingProxyType(meshes))

    def _mesh_of(self, gear: str) -> Mesh | None:
        return next((mesh for mesh in self.meshes.values() if gear in mesh.gears), None)

    def _mesh_problems(self) -> Iterable[Problem]:
        """Meshes that cannot run, and shafts that nothing drives."""
        problems = list(mesh_problems(self.gears, self.meshes))
        yield from problems
        if not problems:
            yield from drive_problems(self.graph, self.shafts, self.operation.output)

    def _place_problems(self) -> Iterable[Problem]:
        """Loops that do not close, and parts that are in a wrong place or not held."""
        problems = ratio_problems(self._mobility, self.meshes, self.operation.speed)
        lengths = self._coupled_lengths
        problems += placement_problems(self.graph, self.gears, self.meshes, lengths)
        problems += place_problems(self.shafts, self.gears, self.bearings)
        for name, gear in self.gears.items():
            meshes = [mesh for mesh in self.meshes.values() if name in mesh.gears]
            problems += body_problems(name, gear, meshes, self.shafts[gear.shaft])
        yield from problems
        if not problems:
            pushed: dict[str, float] = {}
            for name in dict.fromkeys(gear for mesh in self.meshes.values() for gear in mesh.gears):
                shaft = self.gears[name].shaft
                pushed[shaft] = pushed.get(shaft, 0.0) + float(self.gear_loads[name][0])
            yield from support_problems(self.shafts, self.bearings, pushed)

    def _reference_problems(self) -> Iterable[Problem]:
        """Names of parts that do not exist."""
        if not self.shafts:
            yield Problem("there is no shaft", "shafts", "A machine has shafts", "Add a shaft")
        for group, parts in (("gears", self.gears), ("bearings", self.bearings)):
            for name, part in parts.items():
                yield from _missing(f"{group}.{name}.shaft", part.shaft, "shaft", self.shafts)
        for name, mesh in self.meshes.items():
            for gear in mesh.gears:
                yield from _missing(f"meshes.{name}.gears", gear, "gear", self.gears)
        for group, members in (("meshes", self.meshes), ("bearings", self.bearings)):
            for name, member in members.items():
                if member.carrier is not None:
                    where = f"{group}.{name}.carrier"
                    yield from _missing(where, member.carrier, "shaft", self.shafts)
        for name, coupling in self.couplings.items():
            for shaft in coupling.shafts:
                yield from _missing(f"couplings.{name}.shafts", shaft, "shaft", self.shafts)
            if name in self.meshes:
                what, remedy = f'a mesh is called "{name}" too', "Rename the coupling"
                yield Problem(what, f"couplings.{name}", "A link of shafts has one name", remedy)
        for end in ("input", "output"):
            yield from _missing(
                f"operation.{end}", getattr(self.operation, end), "shaft", self.shafts
            )
        nodes = self.housing.nodes if self.housing and self.housing.nodes else {}
        for name, bearing in self.bearings.items():
            if bearing.node is not None:
                where = f"bearings.{name}.node"
                yield from _missing(where, bearing.node, "node of the housing", nodes)


def _parts(group: str, parts: object, kind: type) -> ByName:
    if not isinstance(parts, Mapping):
        what, why = f"{group} is {type(parts).__name__}", f"Wanted: a mapping of names to {kind}"
        raise InputError(what, group, why, f'Give {{"name": {kind.__name__}(...)}}')
    for name, part in parts.items():
        if not isinstance(name, str) or not isinstance(part, kind):
            what, why = f"{name!r}: {type(part).__name__}", f"Wanted: a name and a {kind.__name__}"
            raise InputError(what, f"{group}.{name}", why, f"Make it a {kind.__name__}")
    return MappingProxyType(dict(parts))


def _missing(where: str, name: str, kind: str, parts: Iterable[str]) -> Iterable[Problem]:
    if name not in (names := list(parts)):
        yield no_such(kind, name, names, where, f"Add the {kind}, or correct the name")
