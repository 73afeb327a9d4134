"""The case of a planetary stage: its gears and members, checked and in SI."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from copy import deepcopy
from functools import cached_property
from typing import Any, Literal, cast

import numpy as np

from tribodyn.errors import Argument, InputError, Problem
from tribodyn.machine import (
    Gear,
    MeshPhases,
    PlanetaryKinematics,
    mesh_phases,
    planetary_kinematics,
    planetary_positions,
)
from tribodyn.machine.planetary.mesh_laws import sun_to_ring_lag
from tribodyn.study.case.case import Case
from tribodyn.study.case.provenance import Assumption, reason_faults
from tribodyn.study.case.user_input import Source, unsound, without_spread
from tribodyn.study.case.values import KeyedProblems, Plain
from tribodyn.study.faults.machine_section import stage_fault_problems
from tribodyn.study.faults.section import PartFaultTable
from tribodyn.study.faults.sensors import StageSensors, stage_sensors
from tribodyn.study.machine.load_cases import LoadCase, read_loads
from tribodyn.study.machine.pair_cases import MESH_KEYS, SHARED, mesh_tables, pair_case
from tribodyn.study.machine.read_parts import (
    check_tables,
    in_si,
    read_gear,
    table_of,
    tables_of,
)
from tribodyn.study.machine.tables import STIFF, MotionTable, PlanetsTable
from tribodyn.study.machine.unused_keys import unused_keys, unused_keys_of_stage
from tribodyn.study.machine.user_tables import (
    PartsCase,
    backlash_assumptions,
    stated_assumptions,
)

_TOP = ("title", "origin", "gears", "planets", "operation", "load_cases", "dynamics", "faults")
_MEMBERS = ("sun", "ring", "carrier")
#: Keys of the case for arguments of the functions of a stage.
_KEYS = {
    "planets": "planets.{0}.count",
    "angles": "planets.{0}.angles",
    "input_torque": "operation.torque",
    "input_speed": "operation.speed",
    "input": "operation.input",
    "sun_teeth": "gears.{sun}.teeth",
    "ring_teeth": "gears.{ring}.teeth",
    "planet_teeth": "gears.{planet}.teeth",
    "pin_errors": "planets.{0}.pin_errors",
    "thickness_errors": "planets.{0}.thickness_errors",
}
#: What the motion of a stage leaves out.
_MODEL = (
    ("motion", "in the plane", "axial motion and tilting of the members are left out"),
    ("members", "rigid", "the flexibility of ring and carrier is left out"),
)


class PlanetaryCase(PartsCase):
    """A planetary stage under its load cases: frozen, checked, in SI.

    Created by :func:`tribodyn.load_case` from a file with ``[planets.NAME]``, or from nested
    keywords: a float is SI, text carries its unit.

    Parameters
    ----------
    source : Source, optional
        Where the values come from; then a bare number for a dimension is refused.
    **data : object
        The tables of the case file.

    Raises
    ------
    InputError
        Listing every problem with the part that has it, the limit and the remedy.

    Examples
    --------
    >>> case = PlanetaryCase(
    ...     gears={"s": {"teeth": 17, "face_width": "50 mm"},
    ...            "p": {"teeth": 22, "face_width": "50 mm"},
    ...            "r": {"teeth": -61, "face_width": "50 mm"}},
    ...     planets={"low": {"sun": "s", "ring": "r", "planet": "p", "carrier": "c", "count": 3,
    ...                      "normal_module": "4 mm"}},
    ...     lubricant={"name": "ISO VG 220", "temperature": "70 degC"},
    ...     operation={"input": "s", "output": "c", "speed": "1500 rpm", "torque": "100 N*m"})
    >>> case
    PlanetaryCase("Planetary stage": 3 planets, sun 17, planet 22, ring 61 teeth)
    """

    def __init__(self, source: Source | None = None, /, **data: Any) -> None:
        origin = source or Source()
        if unreadable := list(unsound(data)):
            raise InputError(origin.place(unreadable))
        self.source = source
        tables = deepcopy(data) if source is not None else in_si(data)
        self.data, self.uncertain, problems = without_spread(_for_each_planet(tables), lists=True)
        check_tables(self.data, (*_TOP, *SHARED, "assumed"), problems)
        problems += [*unused_keys(self.data), *unused_keys_of_stage(self.data)]
        self.title: str = self.data.get("title", "Planetary stage")
        self.origin: str | None = self.data.get("origin")
        problems += reason_faults(self.data.get("assumed", {}))
        self.name, self.table = self._read_planets(problems)
        bodies = tables_of(self.data, "gears", problems)
        parts = {n: read_gear(n, {"shaft": n, **b}, problems) for n, b in bodies.items()}
        self.gears: dict[str, Gear] = {n: gear for n, gear in parts.items() if gear is not None}
        dynamics = self.data.get("dynamics", {})
        motion = {k: v for k, v in dynamics.items() if k not in MESH_KEYS}
        self.motion = table_of(MotionTable, motion, "dynamics", problems)
        faults = {
            name: table_of(PartFaultTable, body, f"faults.{name}", problems)
            for name, body in tables_of(self.data, "faults", problems).items()
        }
        self.faults = {name: table for name, table in faults.items() if table is not None}
        loads = read_loads(self.data, problems)
        if loads is not None and self.table is not None:
            self.ends, self.operating_point, self.load_cases = loads
            self._check_members(bodies, problems)
            problems += stage_fault_problems(self)
        if problems:
            raise InputError(origin.place(problems))
        try:
            self._check_stage()
        except InputError as error:
            raise InputError([self._located(each) for each in error.problems]) from None
        self._check_spreads(origin)

    @property
    def _sensors(self) -> StageSensors:
        return stage_sensors(self)

    def _read_planets(self, problems: KeyedProblems) -> tuple[str, Any]:
        """Name and values of the only stage."""
        stages = tables_of(self.data, "planets", problems)
        if len(stages) != 1:
            what = f"there are {len(stages)} tables [planets.NAME]"
            why = "A planetary stage is computed by itself"
            remedy = "Write one of them; stages in a row are cases of their own"
            problems.append(("planets", Problem(what, "", why, remedy)))
            return "", None
        ((name, body),) = stages.items()
        inner = mesh_tables(body)
        keys = {k: v for k, v in body.items() if k not in (*inner, *MESH_KEYS)}
        return name, table_of(PlanetsTable, keys, f"planets.{name}", problems)

    def _check_members(self, bodies: Mapping[str, Any], problems: KeyedProblems) -> None:
        """Refuse gears and members that do not exist, and lists of another length."""
        key, table = f"planets.{self.name}", self.table
        if table.planet_type != "single" or table.ring_planet is not None:
            what = f'planet_type = "{table.planet_type}", ring_planet = "{table.ring_planet}"'
            why = "A stage with double planets is a machine"
            remedy = "Write both in the case file, or load the changed tables"
            problems.append((f"{key}.planet_type", Problem(what, "", why, remedy)))
        for role in ("sun", "ring", "planet"):
            name = getattr(table, role)
            if name not in bodies:
                why, remedy = f"Known: {', '.join(bodies)}", "Add the gear, or correct the name"
                problem = Problem(f'there is no gear "{name}"', "", why, remedy)
                problems.append((f"{key}.{role}", problem))
        if table.carrier in bodies:
            what, why = f'carrier = "{table.carrier}" is a gear', "The carrier has no teeth"
            problems.append((f"{key}.carrier", Problem(what, "", why, "Rename the carrier")))
        for end, name in zip(("input", "output"), self.ends, strict=True):
            if name not in self.members.values():
                what = f'{end} = "{name}" is no member of the stage'
                why = f"Members: {', '.join(self.members.values())}"
                problems.append((f"operation.{end}", Problem(what, "", why, "Name one of these")))
        if self.ends[0] == self.ends[1]:
            what, why = f'output = "{self.ends[1]}" is the input', "Power leaves by another member"
            problems.append(("operation.output", Problem(what, "", why, "Name another member")))
        problems += self._floating_members()
        for name in ("angles", "pin_errors", "thickness_errors"):
            values = getattr(table, name)
            if values is not None and len(values) != table.count:
                what = f"{name} has {len(values)} values for {table.count} planets"
                problem = Problem(what, "", "", "Give one value for each planet")
                problems.append((f"{key}.{name}", problem))

    def _floating_members(self) -> KeyedProblems:
        """Problems of members that nothing holds across the axis."""
        key, table = f"planets.{self.name}", self.table
        floating = [role for role in _MEMBERS if getattr(table, f"{role}_support") == 0.0]
        if len(floating) > (table.count > 2):
            what = " and ".join(f"{role}_support = 0 N/m" for role in floating)
            what += f" with {table.count} planet{'s' * (table.count != 1)}"
            why = "The meshes of three or more planets centre one floating member, fewer none"
            remedy = f"Give {floating[-1]}_support a stiffness, for example 1e6 N/m"
            return [(f"{key}.{floating[-1]}_support", Problem(what, "", why, remedy))]
        return []

    def _check_stage(self) -> None:
        """Refuse planets that do not fit, and teeth that cannot run."""
        ring = self.gears[self.table.ring]
        if not ring.is_ring:
            what = f"teeth = {ring.teeth} of the ring"
            remedy = f"Write teeth = {-ring.teeth}"
            where = f"gears.{self.table.ring}.teeth"
            raise InputError(what, where, "Internal teeth have a negative number", remedy)
        planet = self.pairs["ring"].gear_pair.pinion
        planetary_positions(
            **self._teeth,
            planet_teeth=self.gears[self.table.planet].teeth,
            center_distance=self.center_distance,
            tip_diameter=2.0 * planet.tip_radius,
        )
        self.kinematics(self.operating_point)

    def _located(self, problem: Problem) -> Problem:
        """Problem of a function of the stage at the key of the case."""
        if isinstance(problem.where, Argument):
            roles = {role: getattr(self.table, role) for role in ("sun", "ring", "planet")}
            key = _KEYS.get(problem.where.name, "planets.{0}").format(self.name, **roles)
        elif str(problem.where).partition(".")[0] in ("gears", "planets", "operation"):
            key = str(problem.where)
        else:
            return problem
        return (self.source or Source()).place([(key, problem)])[0]

    @property
    def members(self) -> dict[str, str]:
        """Names of sun, ring and carrier in the case."""
        return {role: getattr(self.table, role) for role in _MEMBERS}

    @property
    def roles(self) -> tuple[str, str, str]:
        """Which of sun, ring and carrier drives, is driven, and is held."""
        roles = {name: role for role, name in self.members.items()}
        ends = [roles[name] for name in self.ends]
        (fixed,) = (role for role in _MEMBERS if role not in ends)
        return ends[0], ends[1], fixed

    @property
    def _teeth(self) -> dict[str, Any]:
        return {
            "sun_teeth": self.gears[self.table.sun].teeth,
            "ring_teeth": self.gears[self.table.ring].teeth,
            "planets": self.table.count,
            "angles": self.table.angles,
        }

    def kinematics(self, load: LoadCase, **efficiencies: Any) -> PlanetaryKinematics:
        """Speeds, torques and power under a load.

        Parameters
        ----------
        load : LoadCase
            Speed and torque of the input.
        **efficiencies : float
            ``sun_efficiency`` and ``ring_efficiency``; 1 by default.

        Returns
        -------
        PlanetaryKinematics

        Raises
        ------
        InputError
            If the torque brakes the input, or the stage locks itself.
        """
        driver, _, fixed = self.roles
        if load.speed == 0.0 or load.torque == 0.0:
            name = "speed" if load.speed == 0.0 else "torque"
            why = "Teeth that stand, or that carry nothing, have no film and no motion"
            raise InputError(f"{name} is 0", f"operation.{name}", why, "Give another value")
        return planetary_kinematics(
            sun_teeth=self.gears[self.table.sun].teeth,
            ring_teeth=self.gears[self.table.ring].teeth,
            planet_teeth=self.gears[self.table.planet].teeth,
            held=cast("Literal['sun', 'ring', 'carrier']", fixed),
            input=cast("Literal['sun', 'ring', 'carrier']", driver),
            input_speed=load.speed,
            input_torque=load.torque * float(np.sign(load.speed)),
            **efficiencies,
        )

    def sun_drives(self, load: LoadCase) -> bool:
        """Whether the sun drives the planets relative to the carrier.

        Parameters
        ----------
        load : LoadCase
            Speed and torque of the input.

        Returns
        -------
        bool
        """
        stage = self.kinematics(load)
        return stage.torques["sun"] * stage.relative_speeds["sun"] > 0.0

    @property
    def center_distance(self) -> float:
        """Distance from the axis of the sun to those of the planets [m]."""
        return self.pairs["sun"].gear_pair.center_distance

    @cached_property
    def pairs(self) -> dict[str, Case]:
        """Sun mesh and ring mesh at the operating point."""
        return self._pairs_under(self.operating_point)

    def pairs_under(self, load: LoadCase) -> dict[str, Case]:
        """Sun mesh and ring mesh of one planet under a load, each as the case of a pair.

        Parameters
        ----------
        load : LoadCase
            Speed and torque of the input.

        Returns
        -------
        dict of str to Case
            ``sun`` and ``ring``, with the speeds relative to the carrier.
        """
        return self.pairs if load == self.operating_point else self._pairs_under(load)

    def _pairs_under(self, load: LoadCase) -> dict[str, Case]:
        sun = self._pair("sun", load, None)
        distance = self.table.center_distance or sun.gear_pair.center_distance
        return {"sun": sun, "ring": self._pair("ring", load, distance)}

    def mesh_pairs(self) -> Iterator[tuple[str, Case, tuple[str, str]]]:
        """Iterate over the sun mesh and the ring mesh.

        Yields
        ------
        tuple of str, Case and (str, str)
            Key of the table of the stage, pair of gears as a case, and names of both gears.
        """
        for mesh, pair in self.pairs.items():
            yield f"planets.{self.name}", pair, self.gears_of(mesh)

    def gears_of(self, mesh: str) -> tuple[str, str]:
        """Pinion and wheel of the sun mesh or the ring mesh.

        Parameters
        ----------
        mesh : str
            ``sun`` or ``ring``.

        Returns
        -------
        (str, str)
        """
        sun, planet, ring = self.table.sun, self.table.planet, self.table.ring
        if mesh == "ring":
            return planet, ring
        sun_is_pinion = self.gears[sun].teeth <= self.gears[planet].teeth
        return (sun, planet) if sun_is_pinion else (planet, sun)

    def hand_of(self, gear: str) -> Literal["right", "left"]:
        """Hand of a gear: ``hand`` is that of the sun.

        Parameters
        ----------
        gear : str
            Name of the gear.

        Returns
        -------
        str
        """
        right = (self.table.hand == "right") == (gear == self.table.sun)
        return "right" if right else "left"

    def _pair(self, mesh: str, load: LoadCase, distance: float | None) -> Case:
        stage, names = self.kinematics(load), self.gears_of(mesh)
        body = dict(self.data["planets"][self.name])
        if distance is not None:
            body["center_distance"] = Plain(distance)
        member = getattr(self.table, mesh)
        planet_drives = self.sun_drives(load) == (mesh == "ring")
        pinion = names[0]
        share = abs(stage.torques["sun"]) / self.table.count / self.gears[self.table.sun].teeth
        role = "sun" if pinion == self.table.sun else "planet"
        return pair_case(
            {**self.data, "planets": {self.name: body}},
            f"planets.{self.name}",
            names,
            self.source,
            driver=self.table.planet if planet_drives else member,
            operation=(abs(stage.relative_speeds[role]), share * self.gears[pinion].teeth),
            hand=self.hand_of(pinion) if self.table.helix_angle else "",
        )

    def phases(self, load: LoadCase) -> MeshPhases:
        """Phases of all meshes under a load, with the lag of the ring meshes.

        Parameters
        ----------
        load : LoadCase
            Speed and torque of the input.

        Returns
        -------
        MeshPhases
            Angles are counted in the direction of the torque on the sun.
        """
        sun, ring = (self.pairs[mesh].gear_pair for mesh in ("sun", "ring"))
        lag = sun_to_ring_lag(sun, ring, sun_drives=self.sun_drives(load))
        angles = planetary_positions(**self._teeth).angles
        if self.turn(load) < 0:
            angles = -angles
        return mesh_phases(**{**self._teeth, "angles": angles}, sun_to_ring=lag)

    def turn(self, load: LoadCase) -> int:
        """Sign of the torque on the sun.

        Parameters
        ----------
        load : LoadCase
            Speed and torque of the input.

        Returns
        -------
        int
        """
        return 1 if self.kinematics(load).torques["sun"] > 0.0 else -1

    @property
    def assumptions(self) -> tuple[Assumption, ...]:
        """What is assumed: reasons in ``[assumed]``, defaults, and limits of the model."""
        return (*stated_assumptions(self), *self._defaults())

    def _defaults(self) -> Iterator[Assumption]:
        key, body = f"planets.{self.name}", self.data["planets"][self.name]
        for name in ("pin_stiffness", "sun_support", "ring_support", "carrier_support"):
            if name not in body:
                yield Assumption(f"{key}.{name}", f"{STIFF:g} N/m", "default", "stiff")
        if "torsional_support" not in body:
            reason = f"the held member, {self.members[self.roles[2]]}, is stiff"
            yield Assumption(f"{key}.torsional_support", f"{STIFF:g} N/m", "default", reason)
        if "pin_clearance" not in body:
            yield Assumption(f"{key}.pin_clearance", "0 um", "default", "planets without clearance")
        for name in ("carrier_mass", "carrier_moment_of_inertia"):
            if name not in body:
                reason = "a steel disc of the radius of the pins and the face width of the planets"
                yield Assumption(f"{key}.{name}", "", "default", reason)
        for name in (self.table.sun, self.table.planet, self.table.ring):
            if "mass" not in self.data["gears"][name]:
                yield Assumption(f"gears.{name}.mass", "", "default", "a solid body")
        yield from backlash_assumptions(self)
        for name, value, reason in _MODEL:
            yield Assumption(f"{key}: {name}", value, "default", reason)

    def __repr__(self) -> str:
        """One line."""
        teeth = ", ".join(
            f"{role} {abs(self.gears[getattr(self.table, role)].teeth)}"
            for role in ("sun", "planet", "ring")
        )
        count = self.table.count
        return f'PlanetaryCase("{self.title}": {count} planet{"s" * (count != 1)}, {teeth} teeth)'


def _for_each_planet(tables: dict[str, Any]) -> dict[str, Any]:
    """Tables in which one text for the errors of all planets is a list with one for each."""
    stages = tables.get("planets")
    for body in stages.values() if isinstance(stages, dict) else ():
        for name in ("pin_errors", "thickness_errors"):
            count = body.get("count") if isinstance(body, dict) else None
            count = count.value if isinstance(count, Plain) else count
            if isinstance(count, int) and isinstance(body.get(name), str):
                body[name] = [body[name]] * min(max(count, 1), 99)
    return tables
