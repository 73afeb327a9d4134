"""Shafts, gears and bearings of a REXS model at their positions, as tables of a machine."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from tribodyn.errors import InputError
from tribodyn.exchange.gearbox import GearboxModel, StageGear, add_remark
from tribodyn.exchange.rexs_file import Component
from tribodyn.types import Array, Tree

#: Stiffness of a bearing without data, and of one that the file calls rigid [N/m, N*m/rad], which
#: is one above the others.
_STIFF, _TILTING, _RIGID, _RIGID_TILTING = 1e9, 1e8, 1e12, 1e10
_GAP = 1e-6
#: Types of bearings by what the name of the REXS type contains, names of their elements, and the
#: name of the type; cylindrical roller bearings are mere roller bearings in REXS 1.0 to 1.4.
BEARING_TYPES = {
    "tapered": ("tapered-roller", "roller", "radial_tapered_roller_bearing"),
    "cylindrical": ("cylindrical-roller", "roller", "radial_roller_bearing"),
    "radial_roller": ("cylindrical-roller", "roller", "radial_roller_bearing"),
    "angular": ("angular-contact", "ball", "angular_contact_ball_bearing"),
    "grooved": ("deep-groove", "ball", "radial_grooved_ball_bearing"),
}


@dataclass(frozen=True)
class Axis:
    """A shaft of the file: its axis in space, and its sections from small to large x, in SI."""

    component: Component
    name: str  #: of the shaft in the machine
    start: Array | None
    along: Array  #: direction of its u axis in the file
    sense: int  #: -1 if this direction points against x of the machine
    sections: list[list[float]]  #: length, outer, inner diameter, and both of the end
    offset: float  #: where its first section begins on the u axis
    length: float

    @property
    def table(self) -> Tree:
        """Table of the shaft in a machine, without its material."""
        rows = [s[:3] if s[1:3] == s[3:] else s for s in self.sections]
        rows = [s[:2] if s[2:] == [0.0] else s for s in rows]
        return {"sections": rows} if rows else {}

    def position(self, coordinate: float) -> float:
        """Position on the shaft [m] of a coordinate on its u axis."""
        distance = coordinate - self.offset
        return round(distance if self.sense > 0 else self.length - distance, 12)

    def coordinate(self, part: Component, *names: str) -> float | None:
        """Coordinate of a part on the u axis [m]: of its middle in space, or as written."""
        middle = point(part)
        if middle is not None and self.start is not None and part.kind.endswith("gear"):
            return float((middle - self.start) @ self.along)  # REXS 1.0 writes the begin of a face
        values = (part.number(name, "m") for name in names)
        return next((value for value in values if value is not None), None)

    def along_x(self, gear: Component) -> float | None:
        """Place of the middle of a gear along x of the machine [m]; None without positions."""
        coordinate = self.coordinate(gear, "u_coordinate_on_shaft")
        if coordinate is None or self.start is None:
            return None
        return self.sense * float(self.start @ self.along + coordinate)


def part_name(model: GearboxModel, number: int) -> str:
    """Name of a part in a machine: its kind and number, in a file of ours that of the case."""
    part = model.file.components[number]
    kinds = (k for k in ("carrier", "gear", "stage", "shaft") if part.kind.endswith(k))
    name = f"{next(kinds, 'bearing')}_{number}"
    return part.name or name if model.file.stored_case else name


def point(component: Component, name: str = "support_vector") -> Array | None:
    """Position or direction in space [m]; None where the file has none."""
    vector = component.vector(name, "m")
    return None if vector is None else np.array(vector)


def axes_of(model: GearboxModel, shafts: list[int]) -> tuple[dict[int, Axis], Array | None]:
    """Shafts by number, and the directions y and z of the machine in the file, as rows."""
    components = [model.file.components[number] for number in shafts]
    units = [_unit(component, "u_axis_vector") for component in components]
    first = next((unit for unit in units if unit is not None), np.array([1.0, 0.0, 0.0]))
    axes = {}
    for component, unit in zip(components, units, strict=True):
        along = first if unit is None else unit
        if abs(cosine := float(along @ first)) < 0.9999:
            angle = math.degrees(math.acos(min(abs(cosine), 1.0)))
            what = f"its axis is inclined by {angle:.4g} deg to {components[0]}"
            why = "All shafts of a machine are parallel"
            raise InputError(what, f"{model.path}: {component}", why, "Leave out its stage")
        sense = 1 if cosine > 0.0 else -1
        sections, offset = _sections(model, component)
        if sense < 0:
            sections = [[s[0], s[3], s[4], s[1], s[2]] for s in reversed(sections)]
        length = sum(section[0] for section in sections)
        axes[component.id] = Axis(
            component, part_name(model, component.id), point(component), along, sense, sections,
            offset, length,
        )  # fmt: skip
    upward = _unit(components[0], "w_axis_vector") if components else None
    directions = None if upward is None else np.array([np.cross(upward, first), upward])
    return axes, directions


def _unit(component: Component, name: str) -> Array | None:
    vector = point(component, name)
    length = 0.0 if vector is None else float(np.linalg.norm(vector))
    return None if vector is None or not length else vector / length


def _sections(model: GearboxModel, shaft: Component) -> tuple[list[list[float]], float]:
    """Sections along the u axis, and where the first one begins; none where they leave gaps."""
    parts = [
        model.file.components[number]
        for relation in model.file.related("assembly", assembly=shaft.id)
        if (number := relation.of("part")) is not None
        and model.file.components[number].kind == "shaft_section"
    ]
    rows = []
    for part in parts:
        length = part.number("length", "m")
        outer = part.number("outer_diameter_begin", "m")
        if not length or not outer:
            add_remark(model, f"{part}: without length or diameter, {shaft} is rigid")
            return [], 0.0
        inner = part.number("inner_diameter_begin", "m") or 0.0
        ends = (part.number(f"{side}_diameter_end", "m") for side in ("outer", "inner"))
        outer_end, inner_end = ends
        rows.append((
            part.number("u_coordinate_on_shaft", "m"),
            [length, outer, inner, outer_end or outer, inner if inner_end is None else inner_end],
        ))  # fmt: skip
    if all(start is not None for start, _ in rows):
        rows.sort(key=lambda row: row[0] or 0.0)
    begin = end = (rows[0][0] or 0.0) if rows else 0.0
    for start, section in rows:
        if start is not None and abs(start - end) > _GAP:
            kind = "leave a gap" if start > end else "overlap"
            add_remark(model, f"{shaft}: its sections {kind} at {1e3 * end:.6g} mm; it is rigid")
            return [], 0.0
        end += section[0]
    return [section for _, section in rows], begin


def gear_table(model: GearboxModel, gear: StageGear, axis: Axis | None) -> Tree:
    """Table of a gear, of one without a shaft of the machine without its place."""
    table: Tree = {"teeth": gear.teeth}
    if axis is not None:
        table = {"shaft": axis.name, **table}
        coordinate = axis.coordinate(model.file.components[gear.id], "u_coordinate_on_shaft")
        if coordinate is not None:
            table["position"] = axis.position(coordinate)
    names = ("profile_shift_coefficient", "face_width", "tip_diameter", "roughness_ra")
    table |= {name: value for name in names if (value := getattr(gear, name)) is not None}
    return {**table, "modification": gear.modification} if gear.modification else table


def bearing_tables(model: GearboxModel, axes: dict[int, Axis]) -> Iterator[tuple[str, Tree, str]]:
    """Name, table and reason of what is assumed of each bearing."""
    connections = [(b, _sides(model, b, axes)) for b in _bearings(model)]
    grounded = [next(iter(sides.values())) for _, sides in connections if len(sides) == 1]
    for bearing, sides in connections:
        if not sides:
            add_remark(model, f"{bearing} is left out: it is on no shaft of the stages")
            continue
        side = min(sides, key=lambda side: (grounded.count(sides[side]), side))
        axis = axes[sides[side]]
        names = (f"u_coordinate_on_shaft_{side}_side", "u_coordinate_on_shaft")
        coordinate = axis.coordinate(bearing, *names)
        if coordinate is None:
            add_remark(model, f"{bearing} is left out: the file has no position of it")
            continue
        table: Tree = {"shaft": axis.name, "position": axis.position(coordinate)}
        rolling, reason = _rolling(bearing, axis)
        if not rolling:
            rolling, reason = _support(bearing)
        if len(sides) > 1:
            shafts = " and ".join(axes[number].name for number in sides.values())
            note = f"it joins {shafts} in the file; it holds {axis.name} against the housing"
            reason = f"{note}; {reason}" if reason else note
        yield part_name(model, bearing.id), table | rolling, reason


def _bearings(model: GearboxModel) -> list[Component]:
    return [c for c in model.file.components.values() if c.kind.endswith("bearing")
            or c.kind.startswith("rolling_bearing_with")]  # fmt: skip


def _sides(model: GearboxModel, bearing: Component, axes: dict[int, Axis]) -> dict[str, int]:
    """Shafts at the inner and the outer side of a bearing."""
    for relation in model.file.related("side", assembly=bearing.id):
        sides = {side: relation.of(f"{side}_part") for side in ("inner", "outer")}
        return {side: number for side, number in sides.items() if number in axes}
    shaft = model.shaft_of(bearing.id)
    return {"inner": shaft} if shaft in axes else {}


def _rolling(bearing: Component, axis: Axis) -> tuple[Tree, str]:
    """Type and dimensions of a rolling bearing, and a note; empty where the file has none."""
    kind = bearing.text("bearing_type")
    matches = [
        t for stem, t in BEARING_TYPES.items() if stem in kind and not kind.startswith("axial")
    ]
    bore, outer = (bearing.number(f"{side}_diameter", "m") for side in ("inner", "outer"))
    rows = bearing.number("number_of_bearing_rows", "") or 1.0
    if not matches or not bore or not outer or rows > 1.0:
        return {}, ""
    name, element, _ = matches[0]
    absorption, note = bearing.text("axial_force_absorption"), ""
    table: Tree = {"type": name, "bore_diameter": bore, "outer_diameter": outer}
    values = {
        "width": bearing.number("width", "m"),
        f"{element}_diameter": bearing.number("diameter_of_rolling_element", "m"),
    }
    if element == "roller":
        values["roller_length"] = bearing.number("length_of_rolling_element", "m")
        if not values["width"] and not values["roller_length"]:
            return {}, ""
    if count := bearing.number("number_of_rolling_elements", ""):
        values[f"{element}s"] = int(count)
    if name in ("angular-contact", "tapered-roller"):
        # e = 1.5 tan(angle) of ISO 281
        angle = math.atan((bearing.number("catalogue_value_e", "") or 0.0) / 1.5)
        values["contact_angle"] = bearing.number("contact_angle", "rad") or (
            angle if name == "tapered-roller" else None
        )
        if not values["contact_angle"] or absorption == "no_direction":
            return {}, ""  # without axial force it carries no radial one
        table["direction"] = -axis.sense if absorption == "negative" else axis.sense
    elif absorption == "no_direction" and element == "ball":
        table["floating"] = True
    elif absorption in ("positive", "negative") and element == "ball":
        note = f"it takes axial forces of both directions, in the file of the {absorption} one"
    return table | {key: value for key, value in values.items() if value}, note


def _support(bearing: Component) -> tuple[Tree, str]:
    """Stiffness of a linear support, and what of it is assumed."""
    radial, axial = (bearing.number(f"{way}_stiffness", "N/m") for way in ("radial", "axial"))
    tilting = bearing.number("bending_stiffness", "N*m/rad") or 0.0
    holds = bearing.values.get("radial_force_absorption")
    is_radial = holds is None or holds.content is not False
    is_axial = bearing.text("axial_force_absorption") not in ("", "no_direction")
    missing = not radial or (is_axial and not axial)
    rigid = max(radial or 0.0, axial or 0.0) > _RIGID or tilting > _RIGID_TILTING
    radial, axial = (_STIFF if (v or _RIGID) >= _RIGID else v for v in (radial, axial))
    table = {
        "radial_stiffness": radial if is_radial else 0.0,
        "axial_stiffness": axial if is_axial else 0.0,
        "tilting_stiffness": _TILTING if tilting > _RIGID_TILTING else tilting,
    }
    designation = bearing.text("catalogue_designation") or bearing.text("name")
    notes = []
    if bearing.kind.startswith("rolling_bearing"):
        label = f" {designation}" if designation else ""
        notes.append(
            f"the file has no dimensions of the bearing{label}; set type, bore_diameter and "
            "outer_diameter for its stiffness at the working load"
        )
    if missing:
        notes.append(f"{_STIFF:g} N/m where the file has no stiffness")
    if rigid:
        notes.append(f"rigid in the file: {_STIFF:g} N/m, {_TILTING:g} N*m/rad against tilting")
    filled = {k: value for k, value in table.items() if value or k == "radial_stiffness"}
    return filled, "; ".join(notes)
