"""Planetary stages of a REXS model: sun, equal planets, ring and carrier, as tables of a case."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from tribodyn.errors import InputError, Problem
from tribodyn.exchange.gearbox import GearboxModel, Stage, StageGear
from tribodyn.exchange.machine_parts import Axis, gear_table, part_name
from tribodyn.exchange.rexs_file import Component
from tribodyn.exchange.to_case import teeth_table
from tribodyn.types import Array, Tree

#: Deviation from equal spacing above which the angles are listed [rad].
_UNEQUAL = 1e-6


@dataclass(frozen=True)
class PlanetStage:
    """A planetary stage of the file."""

    model: GearboxModel
    component: Component
    sun: StageGear
    planets: list[StageGear]
    ring: StageGear
    pair: Stage  #: sun and first planet

    @property
    def name(self) -> str:
        """Name of the stage in a machine."""
        return part_name(self.model, self.component.id)

    @property
    def carriers(self) -> list[int]:
        """Shafts of the carrier; without any the carrier itself, or the stage."""
        links = self.model.file.related("planet_carrier_shaft", planetary_stage=self.component.id)
        shafts = [n for link in links if (n := link.of("shaft")) is not None]
        return shafts or [self._carrier]

    @property
    def _carrier(self) -> int:
        """Number of the carrier, or of the stage in a file that has none."""
        file, number = self.model.file, self.component.id
        carriers = [c.id for c in file.of_kind("planet_carrier")]
        parts = {link.of("part") for link in file.related("assembly", assembly=number)}
        return next((n for n in carriers if n in parts), [*carriers, number][0])

    def central(self, gear: StageGear) -> int:
        """Shaft of sun or ring; the gear itself where it has none."""
        number = self.model.shaft_of(gear.id)
        return gear.id if number is None else number

    def senses(self) -> Iterator[tuple[int, int, int]]:
        """Shafts that the stage joins, and 1 or -1 for their senses while the third is fixed."""
        yield self.central(self.sun), self.central(self.ring), -1
        for carrier in self.carriers:
            yield self.central(self.sun), carrier, 1

    def shaft_names(self, *, lone: bool) -> dict[int, str]:
        """Names of the shafts of the members; a lone stage has those of gears and carrier."""
        carrier = part_name(self.model, self._carrier if lone else self.carriers[0])
        if lone and self._carrier == self.component.id:
            carrier = "carrier"
        names = dict.fromkeys(self.carriers, carrier)
        for gear in (self.sun, self.ring):
            shaft = self.central(gear)
            names[shaft] = part_name(self.model, gear.id if lone else shaft)
        return names

    def gear_tables(self, axes: dict[int, Axis]) -> Tree:
        """Tables of sun, ring and planet, with their places on the shafts of a machine."""
        gears = (self.sun, self.planets[0], self.ring)
        return {
            part_name(self.model, gear.id): gear_table(
                self.model, gear, None if gear is gears[1] else axes.get(self.central(gear))
            )
            for gear in gears
        }

    def table(self, *, lone: bool) -> Tree:
        """Table of the stage."""
        gears = {"sun": self.sun, "planet": self.planets[0], "ring": self.ring}
        table: Tree = {r: part_name(self.model, gear.id) for r, gear in gears.items()}
        table["carrier"] = self.shaft_names(lone=lone)[self.carriers[0]]
        table["count"] = count = len(self.planets)
        angles, equal = self._angles(), 2.0 * np.pi * np.arange(count) / count
        if angles is not None and np.abs(angles - equal).max() > _UNEQUAL:
            table["angles"] = angles.tolist()
        return table | teeth_table(self.model, self.pair)

    def _angles(self) -> Array | None:
        """Angles of the planets, rising from the first; None where the file has no positions."""
        file, gears = self.model.file, (self.sun, *self.planets)
        parts = [file.components[self.central(gear)] for gear in gears]
        places = [part.vector("support_vector", "m") for part in parts]
        axis = parts[0].vector("u_axis_vector", "m")
        if axis is None or None in places:
            return None
        along = np.array(axis) / np.linalg.norm(axis)
        offsets = np.array(places[1:], dtype=float) - np.array(places[0], dtype=float)
        offsets -= np.outer(offsets @ along, along)
        if not np.linalg.norm(offsets, axis=1).min() > 0.0:
            return None
        first = offsets[0] / np.linalg.norm(offsets[0])
        angles = np.arctan2(offsets @ np.cross(along, first), offsets @ first) % (2.0 * np.pi)
        return np.sort(np.where(angles > 2.0 * np.pi - _UNEQUAL, 0.0, angles))


def planet_stages(model: GearboxModel) -> tuple[list[PlanetStage], list[Stage]]:
    """Planetary stages of a model, and its stages on fixed axes; other designs are refused."""
    planetary = []
    for component in model.file.of_kind("planetary_stage"):
        links = model.file.related("assembly", assembly=component.id)
        numbers = {link.of("part") for link in links}
        planetary.append(
            _members(model, component, [stage for stage in model.stages if stage.id in numbers])
        )
    return planetary, [stage for stage in model.stages if not stage.planetary]


def _members(model: GearboxModel, component: Component, stages: list[Stage]) -> PlanetStage:
    """Sun, planets and ring of a planetary stage from its pairs."""
    remedy = f"List the data of its gears: tribodyn import {model.path}"
    inner = [stage for stage in stages if stage.ratio > 0.0]
    outer = [stage for stage in stages if stage.ratio < 0.0]
    if not inner or len(inner) != len(outer):
        why = "A stage has a sun and a ring that mesh with every planet"
        raise InputError(Problem(f"{component} has another design", model.path, why, remedy))
    rings = [s.gear_1 if s.gear_1.teeth < 0 else s.gear_2 for s in outer]
    planets = [s.gear_2 if s.gear_1.teeth < 0 else s.gear_1 for s in outer]
    numbers = {planet.id for planet in planets}
    suns = [s.gear_2 if s.gear_1.id in numbers else s.gear_1 for s in inner]
    planet_types = {(p.teeth, p.profile_shift_coefficient, p.helix_angle) for p in planets}
    if max(len({sun.id for sun in suns}), len({ring.id for ring in rings}), len(planet_types)) > 1:
        why = "All planets are equal and mesh with one sun and one ring"
        raise InputError(f"{component} has another design", model.path, why, remedy)
    pair = replace(inner[0], gear_1=suns[0], gear_2=planets[0])
    return PlanetStage(model, component, suns[0], planets, rings[0], pair)
