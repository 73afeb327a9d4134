"""Planetary stages of a machine case: their planets, pins, supports and pairs of gears."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.errors import Problem
from tribodyn.machine import Bearing, Gear, Mesh, PlanetaryStage, Shaft, sun_to_ring_lag
from tribodyn.study.case.values import KeyedProblems, Plain
from tribodyn.study.machine.pair_cases import MESH_KEYS, mesh_tables, pair_case, pinion_and_wheel
from tribodyn.study.machine.read_parts import read_gear, table_of, tables_of
from tribodyn.study.machine.tables import PlanetsTable

if TYPE_CHECKING:
    from tribodyn.gear import CylindricalPair
    from tribodyn.study.case.case import Case
    from tribodyn.study.case.user_input import Source

#: Members of a stage; sun and ring are gears, the carrier is a shaft.
MEMBERS = ("sun", "ring", "carrier")


@dataclass(frozen=True, eq=False)
class CaseStage:
    """A planetary stage of a machine case."""

    name: str
    table: Any  #: values of ``[planets.NAME]``
    data: Mapping[str, Any]  #: tables of the case
    planet: Gear
    gears: Mapping[str, Gear]  #: of the case, without planets
    source: Source | None

    @property
    def key(self) -> str:
        """Table of the case file."""
        return f"planets.{self.name}"

    def names_of(self, mesh: str) -> tuple[str, str]:
        """Pinion and wheel of the ``sun`` or ``ring`` mesh as the case names them."""
        ends = self.table.planet, getattr(self.table, mesh)
        gears = {**self.gears, self.table.planet: self.planet}
        return pinion_and_wheel(ends[::-1] if mesh == "sun" else ends, gears)

    def case_name(self, gear: str) -> str:
        """Name of a gear in the case; that of all planets is one."""
        return self.table.planet if gear.startswith(f"{self.name}_planet") else gear

    def shaft_of(self, role: str) -> str:
        """Shaft of a member."""
        name: str = getattr(self.table, role)
        return name if role == "carrier" else self.gears[name].shaft

    @cached_property
    def pair_data(self) -> dict[str, Any]:
        """Tables of the case with the centre distance of the sun mesh for the ring mesh too."""
        body = dict(self.data["planets"][self.name])
        body["center_distance"] = Plain(self.center_distance)
        return {**self.data, "planets": {self.name: body}}

    @cached_property
    def center_distance(self) -> float:
        """Distance from the axis of the sun to those of the planets [m]."""
        if self.table.center_distance is not None:
            return abs(float(self.table.center_distance))
        return float(self._pair("sun", self.data).gear_pair.center_distance)

    def _pair(self, mesh: str, data: Mapping[str, Any]) -> Case:
        names = self.names_of(mesh)
        return pair_case(data, self.key, names, self.source, driver=names[0], operation=(1.0, 1.0))

    @cached_property
    def _gear_pairs(self) -> tuple[CylindricalPair, CylindricalPair]:
        sun, ring = (self._pair(mesh, self.pair_data).gear_pair for mesh in ("sun", "ring"))
        return sun, ring  # type: ignore[return-value]

    def stage(self, *, sun_drives: bool = True) -> PlanetaryStage:
        """Stage of the machine."""
        table = self.table
        width = self.planet.face_width
        axial = table.pin_stiffness if table.helix_angle else 0.0
        pin = Bearing(
            "planet",
            0.0,
            table.pin_stiffness,
            axial_stiffness=axial,
            tilting_stiffness=axial * width**2 / 12.0,
            carrier_position=table.carrier_position,
        )
        return PlanetaryStage(
            *(table.sun, table.ring, table.carrier, self.planet, table.count),
            *(table.normal_module, table.helix_angle, table.hand, self.center_distance),
            table.normal_pressure_angle,
            angles=table.angles,
            pin=pin,
            sun_to_ring=sun_to_ring_lag(*self._gear_pairs, sun_drives=sun_drives),
            pin_errors=table.pin_errors or 0.0,
            thickness_errors=table.thickness_errors or 0.0,
        )

    def mesh_roles(self) -> dict[str, str]:
        """Whether each mesh of the machine is one of the ``sun`` or of the ``ring``."""
        numbers = range(1, self.table.count + 1)
        return {f"{self.name}_{m}{i}": m for i in numbers for m in ("sun", "ring")}

    def machine_names(self, mesh: str, role: str) -> tuple[str, str]:
        """First and second gear of a mesh of the machine."""
        planet = f"{self.name}_planet{mesh.removeprefix(f'{self.name}_{role}')}"
        gear = getattr(self.table, role)
        return (gear, planet) if role == "sun" else (planet, gear)

    def carrier_shaft(self, shafts: Mapping[str, Shaft]) -> Shaft:
        """Shaft of the carrier with its mass, a steel disc by default."""
        shaft = shafts[self.table.carrier]
        table, radius, width = self.table, self.center_distance, self.planet.face_width
        mass = table.carrier_mass
        if mass is None:
            mass = shaft.material.density * math.pi * radius**2 * width
        inertia = table.carrier_moment_of_inertia
        inertia = 0.5 * mass * radius**2 if inertia is None else inertia
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
            axial = (radial or 0.0) if loose and self.table.helix_angle else 0.0
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


def read_stages(
    data: Mapping[str, Any], gears: dict[str, Any], problems: KeyedProblems, source: Source | None
) -> dict[str, tuple[Any, Gear]]:
    """Tables and planets of all stages; the planets are taken out of the tables of gears."""
    stages, planets = {}, set()
    tables = tables_of(data, "planets", problems)
    if "planets" in data and not tables:
        remedy = "Write [planets.NAME] with sun, ring, planet, carrier and count, or remove it"
        problems.append(("planets", Problem("there is no stage", "", "", remedy)))
    for name, body in tables.items():
        key, inner = f"planets.{name}", mesh_tables(body)
        keys = {k: v for k, v in body.items() if k not in (*inner, *MESH_KEYS)}
        table = table_of(PlanetsTable, keys, key, problems)
        if table is None:
            continue
        count = len(problems)
        for role in ("sun", "ring", "planet"):
            if (gear := getattr(table, role)) not in gears:
                why, remedy = f"Known: {', '.join(gears)}", "Add the gear, or correct the name"
                problem = Problem(f'there is no gear "{gear}"', "", why, remedy)
                problems.append((f"{key}.{role}", problem))
        ring = gears.get(table.ring, {})
        teeth = getattr(ring.get("teeth"), "value", ring.get("teeth"))
        if isinstance(teeth, int) and teeth > 0 and not ring.get("internal"):
            why, remedy = "Internal teeth have a negative number", f"Write teeth = {-teeth}"
            problem = Problem(f"teeth = {teeth} of the ring", "", why, remedy)
            problems.append((f"gears.{table.ring}.teeth", problem))
        for role in ("angles", "pin_errors", "thickness_errors"):
            values = getattr(table, role)
            if values is not None and len(values) != table.count:
                what = f"{role} has {len(values)} values for {table.count} planets"
                problem = Problem(what, "", "", "Give one value for each planet")
                problems.append((f"{key}.{role}", problem))
        if len(problems) > count:
            continue
        planets.add(table.planet)
        planet = read_gear(table.planet, {"shaft": "planet", **gears[table.planet]}, problems)
        if planet is not None:
            stages[name] = table, planet
    for planet in planets:
        del gears[planet]
    return stages


def stage_figures(result: Any) -> dict[str, dict[str, float]]:
    """Figures of each stage of a machine under one load, in SI."""
    figures = {}
    machine, motion = result.machine, result.motion
    flow = machine.kinematics
    for name, stage in machine.planets.items():
        suns = stage.mesh_names(name)["sun"]
        rest = np.array([result.static.meshes[mesh].force for mesh in suns])
        columns = [motion.mesh.index(mesh) for mesh in suns]
        moving = motion.mean(motion.mesh_force[:, columns])
        pins = [motion.bearing.index(f"{name}_pin{i + 1}") for i in range(stage.count)]
        pin = motion.mean(motion.bearing_force[:, pins])
        relative = flow.shafts[f"{name}_planet1"].speed - flow.shafts[stage.carrier].speed
        figures[name] = {
            "rolling_power": sum(flow.meshes[mesh].power for mesh in suns),
            "planet_speed": relative,
            "load_factor": float(rest.max() / rest.mean()),
            "dynamic_load_factor": float(moving.max() / moving.mean()),
            "mean_pin_force": float(np.hypot(pin[:, 1], pin[:, 2]).max()),
        }
    return figures


def stage_mesh(mesh: Mesh, fields: Mapping[str, Any]) -> Mesh:
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
