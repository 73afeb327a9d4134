"""Planetary stages of a machine case: their planets, pins, supports and pairs of gears."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.errors import Problem, no_such
from tribodyn.machine import Bearing, Gear, Mesh, PlanetaryStage, Shaft, sun_to_ring_lag
from tribodyn.machine.planetary.mesh_laws import gear_lag
from tribodyn.machine.planetary.stage_parts import LARGEST_ERROR, mesh_kinds
from tribodyn.machine.planetary.turning_frame import centrifugal_loads
from tribodyn.study.case.values import KeyedProblems, Plain
from tribodyn.study.machine.pair_cases import mesh_hand, pair_case, pinion_and_wheel, with_forms
from tribodyn.study.machine.read_parts import is_faulty, read_gear
from tribodyn.types import ByName, Tree

if TYPE_CHECKING:
    from tribodyn.gear import CylindricalPair
    from tribodyn.machine import Machine, MeshLoad, PowerFlow
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.case.user_input import Source

#: Members of a stage; sun and ring are gears, the carrier is a shaft.
MEMBERS = ("sun", "ring", "carrier")


@dataclass(frozen=True, eq=False)
class CaseStage:
    """A planetary stage of a machine case."""

    name: str
    table: Any  #: values of ``[planets.NAME]``
    data: ByName  #: tables of the case
    planets: Sequence[Gear]  #: that at the sun, and of double planets that at the ring
    gears: Mapping[str, Gear]  #: of the case, without planets
    source: Source | None

    @property
    def key(self) -> str:
        """Table of the case file."""
        return f"planets.{self.name}"

    @property
    def planet(self) -> Gear:
        """Planet at the sun."""
        return self.planets[0]

    @property
    def planet_names(self) -> tuple[str, ...]:
        """Names of the gears of the planets in the case."""
        names = self.table.planet, self.table.ring_planet
        return tuple(name for name in names if name is not None)

    def names_of(self, mesh: str) -> tuple[str, str]:
        """Pinion and wheel of the ``sun``, ``ring`` or ``planet`` mesh as the case names them."""
        names, table = self.planet_names, self.table
        ends = {"sun": (table.sun, names[0]), "ring": (names[-1], table.ring), "planet": names}
        gears = {**self.gears, **dict(zip(names, self.planets, strict=True))}
        return pinion_and_wheel(ends[mesh], gears)

    def case_name(self, gear: str) -> str:
        """Name of a gear in the case; that of all planets is one."""
        if gear.startswith(f"{self.name}_ring_planet"):
            return self.planet_names[-1]
        return self.table.planet if gear.startswith(f"{self.name}_planet") else gear

    def shaft_of(self, role: str) -> str:
        """Shaft of a member."""
        name: str = getattr(self.table, role)
        return name if role == "carrier" else self.gears[name].shaft

    def pair_data(self, mesh: str) -> Tree:
        """Tables of the case with the centre distance and the module of a kind of mesh."""
        body = dict(self.data["planets"][self.name])
        if mesh == "ring" and self.table.ring_normal_module is not None:
            body["normal_module"] = Plain(self.table.ring_normal_module)
        distance = self._stated_distance(mesh)
        if mesh == "ring" and self.table.planet_type != "meshed":
            distance = self.center_distance
        body.pop("center_distance", None)
        if distance is not None:
            body["center_distance"] = Plain(abs(float(distance)))
        return {**self.data, "planets": {self.name: body}}

    def _stated_distance(self, mesh: str) -> float | None:
        names = {"sun": "center_distance", "planet": "pair_center_distance"}
        value: float | None = getattr(self.table, names.get(mesh, "ring_center_distance"))
        return value

    @cached_property
    def center_distance(self) -> float:
        """Distance from the axis of the sun to those of the planets [m]."""
        return abs(float(self.gear_pair("sun").center_distance))

    def gear_pair(self, mesh: str) -> CylindricalPair:
        """Geometry of a kind of mesh."""
        return self._pair(mesh).gear_pair  # type: ignore[return-value]

    def _pair(self, mesh: str) -> PairCase:
        """Pair of a kind of mesh, at any speed and torque."""
        if mesh not in self._pairs:
            names = self.names_of(mesh)
            parts = self.pair_data(mesh), self.key, names, self.source
            self._pairs[mesh] = pair_case(*parts, driver=names[0], operation=(1.0, 1.0))
        return self._pairs[mesh]

    @cached_property
    def _pairs(self) -> dict[str, PairCase]:
        return {}

    def with_forms(self) -> CaseStage:
        """Stage whose gears have their tooth forms and densities."""
        gears = {**self.gears, **dict(zip(self.planet_names, self.planets, strict=True))}
        for mesh in mesh_kinds(self.table.planet_type):
            gears |= with_forms(gears, self.names_of(mesh), self._pair(mesh))
        planets = [gears[name] for name in self.planet_names]
        return replace(self, planets=planets, gears={name: gears[name] for name in self.gears})

    def stage(self, load: MeshLoad | None = None) -> PlanetaryStage:
        """Stage of the machine, its phases for the load of a sun mesh."""
        table = self.table
        width = sum(gear.face_width for gear in self.planets[: 1 + self.is_stepped])
        axial = table.pin_stiffness if table.helix_angle or self.is_stepped else 0.0
        pin = Bearing(
            "planet",
            0.0,
            table.pin_stiffness,
            axial_stiffness=axial,
            tilting_stiffness=axial * width**2 / 12.0,
            carrier_position=table.carrier_position,
            clearance=table.pin_clearance,
        )
        double: Tree = {"planet_type": table.planet_type}
        if len(self.planets) > 1:
            double["ring_planet"] = self.planets[1]
            double["ring_mesh"] = {"normal_module": table.ring_normal_module or table.normal_module}
        if table.planet_type == "meshed":
            for mesh, name in (("ring", "ring"), ("planet", "pair")):
                distance = abs(self.gear_pair(mesh).center_distance)
                double[f"{name}_center_distance"] = distance
        equal_hands = self.planet_names[:1] if len(self.planets) > 1 else (table.planet, table.ring)
        hands = {name: self.data["gears"].get(name, {}).get("hand") for name in equal_hands}
        at_sun = next((name for name, hand in hands.items() if hand), equal_hands[0])
        hand = mesh_hand(table, (table.sun, at_sun), self.data)
        stage = PlanetaryStage(
            *(table.sun, table.ring, table.carrier, self.planet, table.count),
            *(table.normal_module, table.helix_angle),
            hand,
            *(self.center_distance, table.normal_pressure_angle),
            angles=table.angles,
            pin=pin,
            pin_errors=table.pin_errors or 0.0,
            thickness_errors=table.thickness_errors or 0.0,
            **double,
        )
        drives = load is None or load.driver == table.sun
        return replace(stage, **self._lags(stage, drives, load is not None and load.sense < 0))

    @property
    def is_stepped(self) -> bool:
        """Whether the planets have two gears behind each other."""
        return bool(self.table.planet_type == "stepped")

    def _lags(self, stage: PlanetaryStage, drives: bool, backwards: bool) -> Tree:
        """Lags behind the sun mesh; a torque on the sun backwards has the mirrored stage."""
        if self.is_stepped:  # the gears of a planet may have any position on its shaft
            return {}
        sign = -1.0 if backwards else 1.0
        if self.table.planet_type == "single":
            lag = sun_to_ring_lag(*map(self.gear_pair, ("sun", "ring")), sun_drives=drives)
            return {"sun_to_ring": sign * lag % 1.0}
        first, second = stage.planet_axes(self.gears, np.zeros(1))[:, 0]
        line = sign * float(np.angle(second - first))
        beyond = line - sign * float(np.angle(second))
        sun, pair, ring = (self.gear_pair(mesh) for mesh in ("sun", "planet", "ring"))
        at_sun = self.names_of("sun")[1] == self.table.planet
        is_wheel = self.names_of("planet")[1] == self.table.planet
        lag = gear_lag(sun, pair, wheel=(at_sun, is_wheel), turn=line, drives=drives)
        last = gear_lag(pair, ring, wheel=(not is_wheel, False), turn=beyond, drives=drives)
        return {"sun_to_planet": sign * lag % 1.0, "sun_to_ring": sign * (lag + last) % 1.0}

    def mesh_roles(self) -> dict[str, str]:
        """Kind of each mesh of the machine: ``sun``, ``ring`` or ``planet``."""
        numbers, kinds = range(1, self.table.count + 1), mesh_kinds(self.table.planet_type)
        return {f"{self.name}_{name}{i}": m for i in numbers for m, name in kinds.items()}

    def machine_names(self, mesh: str, role: str) -> tuple[str, str]:
        """First and second gear of a mesh of the machine."""
        kind = mesh_kinds(self.table.planet_type)[role]
        number = mesh.removeprefix(f"{self.name}_{kind}")
        planets = [f"{self.name}_{place}planet{number}" for place in ("", "ring_")]
        if role == "planet":
            return planets[0], planets[1]
        last = planets[len(self.planets) - 1]
        return (self.table.sun, planets[0]) if role == "sun" else (last, self.table.ring)

    def carrier_shaft(self, shafts: Mapping[str, Shaft]) -> Shaft:
        """Shaft of the carrier with its mass, a steel disc by default."""
        shaft, table, width = shafts[self.table.carrier], self.table, self.planet.face_width
        density = shaft.material.density
        mass, inertia = carrier_body(table, density, self.center_distance, width)
        return replace(
            shaft,
            mass=mass,
            moment_of_inertia=shaft.moment_of_inertia + inertia,
            transverse_moment_of_inertia=0.5 * inertia + mass * width**2 / 12.0,
            mass_position=table.carrier_position,
        )

    def supports(
        self, parts: Mapping[str, Shaft], present: Mapping[str, Bearing], links: set[str]
    ) -> dict[str, Bearing]:
        """Supports of rigid members without bearings, and of the member that is held."""
        bearings, radii, users = {}, self._radii(), list(present.values())
        shafts = {role: self.shaft_of(role) for role in MEMBERS}
        fixed = any(bearing.holds and bearing.shaft in shafts.values() for bearing in users)
        for role, shaft in shafts.items():
            loose = parts[shaft].is_rigid and all(b.shaft != shaft for b in users)
            stands = shaft not in links and not fixed
            hold = self.table.torsional_support * radii[role] ** 2 if stands else 0.0
            if not (loose or hold):
                continue
            radial = getattr(self.table, f"{role}_support") if loose else None
            spatial = self.table.helix_angle or self.is_stepped
            axial = (radial or 0.0) if loose and spatial else 0.0
            bearings[f"{self.name}_{role}"] = Bearing(
                *(shaft, 0.0, radial),
                axial_stiffness=axial,
                tilting_stiffness=axial * radii[role] ** 2,
                torsional_stiffness=hold,
            )
        return bearings

    def _radii(self) -> dict[str, float]:
        """Base radii of sun and ring, radius of the pins [m]."""
        table = self.table
        tangent = math.tan(table.normal_pressure_angle) / math.cos(table.helix_angle)
        base = 0.5 * table.normal_module / math.cos(table.helix_angle)
        base *= math.cos(math.atan(tangent))
        radii = {role: base * abs(self.gears[getattr(table, role)].teeth) for role in MEMBERS[:2]}
        return {**radii, "carrier": self.center_distance}


def carrier_body(table: Any, density: float, radius: float, width: float) -> tuple[float, float]:
    """Mass and polar moment of inertia of a carrier, by default a disc through the pins."""
    mass, inertia = table.carrier_mass, table.carrier_moment_of_inertia
    mass = density * math.pi * radius**2 * width if mass is None else mass
    return mass, 0.5 * mass * radius**2 if inertia is None else inertia


def read_stages(
    tables: ByName, gears: ByName, problems: KeyedProblems
) -> dict[str, tuple[Any, ...]]:
    """Tables and planets of the stages, from the tables of stages and of gears."""
    stages: dict[str, tuple[Any, ...]] = {}
    for name, table in tables.items():
        if is_faulty(f"planets.{name}", problems):
            continue
        wrong = _stage_problems(f"planets.{name}", table, gears)
        problems += wrong
        if wrong:
            continue
        names = [table.planet] + ([] if table.planet_type == "single" else [table.ring_planet])
        parts: list[Any] = [read_gear(n, gears[n], problems) for n in names]
        if None in parts:
            continue
        if table.planet_type == "stepped" and gears[names[1]].position is None:
            behind = 0.5 * sum(gear.face_width for gear in parts)
            parts[1] = replace(parts[1], position=behind)
        stages[name] = table, *parts
    return stages


def _stage_problems(key: str, table: Any, gears: ByName) -> KeyedProblems:
    """Names of no gear, lists of another length, and a ring with external teeth."""
    problems = _double_problems(key, table)
    roles = ("sun", "ring", "planet", "ring_planet")
    if not table.carrier:
        problem = Problem('carrier = ""', "", "It names a shaft", "Give its name")
        problems.append((f"{key}.carrier", problem))
    for role in roles[: 3 if problems or table.planet_type == "single" else 4]:
        if (gear := getattr(table, role)) not in gears:
            problem = no_such("gear", gear, gears, "", "Add the gear, or correct the name")
            problems.append((f"{key}.{role}", problem))
    ring = gears.get(table.ring)
    if ring is not None and ring.teeth is not None and ring.teeth > 0 and not ring.internal:
        why, remedy = "Internal teeth have a negative number", f"Write teeth = {-ring.teeth}"
        problem = Problem(f"teeth = {ring.teeth} of the ring", "", why, remedy)
        problems.append((f"gears.{table.ring}.teeth", problem))
    most = LARGEST_ERROR * table.normal_module if table.normal_module else math.inf
    for role in ("angles", "pin_errors", "thickness_errors"):
        values = getattr(table, role)
        if values is not None and len(values) != table.count:
            what = f"{role} has {len(values)} values for {table.count} planets"
            problem = Problem(what, "", "", "Give one value for each planet")
            problems.append((f"{key}.{role}", problem))
        elif role != "angles" and max(map(abs, values or ()), default=0.0) > most:
            what = f"{role} = {table.spec(role).show(tuple(values))}"
            why = f"Allowed: {LARGEST_ERROR:g} times the module, {1e3 * most:.4g} mm, at most"
            problems.append((f"{key}.{role}", Problem(what, "", why, "Correct value and unit")))
    return problems


def stage_by_itself(data: ByName) -> str | None:
    """Name of the stage of tables that describe nothing else; None of other machines."""
    others = ("shafts", "meshes", "bearings", "couplings", "housing")
    stages = data.get("planets", {})
    alone = len(stages) == 1 and not any(data.get(group) for group in others)
    return next(iter(stages)) if alone else None


def floating_members(key: str, table: Any) -> KeyedProblems:
    """Problems of members of a lone stage that nothing holds across the axis."""
    floating = [role for role in MEMBERS if getattr(table, f"{role}_support") == 0.0]
    if len(floating) <= (table.count > 2):
        return []
    what = " and ".join(f"{role}_support = 0 N/m" for role in floating)
    what += f" with {table.count} planet{'s' * (table.count != 1)}"
    why = "The meshes of three or more planets centre one floating member, fewer none"
    remedy = f"Give {floating[-1]}_support a stiffness, for example 1e6 N/m"
    return [(f"{key}.{floating[-1]}_support", Problem(what, "", why, remedy))]


def _double_problems(key: str, table: Any) -> KeyedProblems:
    """Double planets without a second gear, and single ones that have it."""
    if (table.planet_type == "single") == (table.ring_planet is None):
        return []
    what = f'planet_type = "{table.planet_type}"'
    if table.ring_planet is None:
        why, remedy = "Double planets have a second gear", 'Add ring_planet = "NAME", a gear'
        return [(f"{key}.ring_planet", Problem(f"{what} without ring_planet", "", why, remedy))]
    why, remedy = "Single planets have one gear", 'Write planet_type = "stepped" or "meshed"'
    return [(f"{key}.planet_type", Problem(f"{what} with ring_planet", "", why, remedy))]


def motion_of_stage(
    machine: Machine, name: str, stage: PlanetaryStage, flow: PowerFlow
) -> dict[str, float]:
    """Ratio of a stage between input and output, power that rolls, speed of planets on pins."""
    run = machine.operation
    members = {stage.carrier, *(machine.gears[each].shaft for each in (stage.sun, stage.ring))}
    start, end = (flow.shafts[shaft].speed for shaft in (run.input, run.output))
    suns = [flow.meshes[mesh] for mesh in stage.mesh_names(name)["sun"]]
    carrier, planet = (flow.shafts[shaft].speed for shaft in (stage.carrier, f"{name}_planet1"))
    return {
        **({"ratio": start / end} if {run.input, run.output} <= members else {}),
        "rolling_power": sum(abs(mesh.torque[0] * mesh.speeds[0]) for mesh in suns),
        "planet_speed": planet - carrier,
    }


def stage_figures(result: Any) -> dict[str, dict[str, float]]:
    """Figures of each stage of a machine under one load, in SI."""
    figures = {}
    machine, motion = result.machine, result.motion
    outward = centrifugal_loads(machine)
    for name, stage in machine.planets.items():
        suns = stage.mesh_names(name)["sun"]
        static_force = np.array([result.static.meshes[mesh].force for mesh in suns])
        columns = [motion.mesh.index(mesh) for mesh in suns]
        moving = motion.mean(motion.mesh_force[:, columns])
        pins = [motion.bearing.index(f"{name}_pin{i + 1}") for i in range(stage.count)]
        pin = motion.mean(motion.bearing_force[:, pins])
        sun = result.structure.gear(stage.sun)[1:3]
        moved = result.response.fine.position @ sun.T
        figures[name] = {
            **motion_of_stage(machine, name, stage, result.power_flow),
            "planets_unloaded": float((static_force == 0.0).sum()),
            "sun_orbit": float(np.hypot(*motion.rms(moved))),
            "load_factor": float(static_force.max() / static_force.mean()),
            "dynamic_load_factor": float(moving.max() / moving.mean()),
            "mean_pin_force": float(np.hypot(pin[:, 1], pin[:, 2]).max()),
            "peak_pin_force": float(motion.radial_force[:, pins].max()),
            "centrifugal_force": outward[f"{name}_planet1"],
        }
    return figures


def stage_mesh(mesh: Mesh, fields: ByName) -> Mesh:
    """Mesh of a planet with the force law of its teeth, less the excess thickness of the planet."""
    excess = mesh.error
    if fields.get("contacts") and excess:
        from tribodyn.machine.planetary.plane_model import without_excess

        assert isinstance(excess, float)
        contacts = tuple(
            replace(contact, error=without_excess(contact.error, -excess))
            for contact in fields["contacts"]
        )
        fields = {**fields, "contacts": contacts}
    return replace(mesh, **fields)
