"""Read and check mesh tables of other programs: CSV or netCDF files with contacts."""

from __future__ import annotations

import csv
import os
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, NoReturn, cast

import numpy as np

from tribodyn import units
from tribodyn.arrays.splines import monotone_cubic
from tribodyn.errors import InputError
from tribodyn.mesh.force_law import at_rest
from tribodyn.mesh.gears import (
    COORDINATES,
    SPATIAL_COORDINATES,
    GearData,
    NoGears,
    coordinates_of,
    lever,
    plane_direction,
)
from tribodyn.mesh.grid import PhaseGrid, phase_grid
from tribodyn.mesh.storage import (
    DIRECTIONS,
    FACTS,
    FILMS,
    OF_CONTACTS,
    OF_RAMPS,
    OF_TEETH_ALONE,
    OF_THE_MESH,
    UNITS,
    facts_of,
    is_mesh_table,
)
from tribodyn.mesh.table import MeshTable
from tribodyn.types import Array, Tree
from tribodyn.validated_files import file_kind, plain_number, read_bytes, read_dataset

#: Columns that the force law does not need and that may hold NaN.
_MAY_BE_NAN = (*FILMS, "hertz_pressure", "path")
_SPEEDS = ("sliding_speed", "entrainment_speed")
_FRICTION = ("sliding_direction", "pinion_curvature_radius", "wheel_curvature_radius")
_HEADER = re.compile(r"([a-z_]+?)(?:_([1-9][0-9]{0,2}))?\s*(?:\[([^\]]*)\])?")
_FACT = re.compile(r"#\s*(\w+)\s*[=:]\s*(.+)")
#: Phases closer than this are the same; rows this evenly spaced are not resampled [mesh cycles].
_SAME, _EVEN = 1e-9, 1e-9
#: Least number of even grid points that replace uneven rows.
_GRID_POINTS = 512
#: Events of a mesh cycle, at most.
_MOST_EVENTS = 200
#: Relative difference up to which torques are the same.
_SAME_TORQUE = 1e-9


@dataclass(frozen=True, eq=False)
class TableFile:
    """Mesh table from a file of another program: columns in SI on a phase grid."""

    path: str
    grid: PhaseGrid
    columns: Mapping[str, Array]
    facts: Mapping[str, float]
    gears: GearData | None = None  #: where this library wrote the file

    @property
    def has_force_law(self) -> bool:
        """Whether the force is known at other loads: by ramps, not one stiffness."""
        place = self.columns.get("ramp_deflection")
        return place is not None and (place.shape[1] > 1 or bool(np.any(place)))

    @property
    def has_friction(self) -> bool:
        """Whether friction acts."""
        return bool(np.any(self.columns.get("friction_coefficient", 0.0)))

    def direction(self, driver: str) -> Array:
        """Change of the compression with the six coordinates of the pair [1 or m]."""
        if "direction" in self.columns:
            return self.columns["direction"]
        radii = (self.facts[f"base_radius_{gear}"] for gear in ("pinion", "wheel"))
        return plane_direction(driver, *radii)

    def lever(self, coordinate: str) -> float:
        """Lever of the normal force on a gear, over the cycle [m]."""
        return lever(self.direction("pinion"), coordinate, self.grid)

    def table(
        self,
        *,
        teeth: int,
        driver: str,
        pinion_speed: float,
        pinion_torque: float,
        friction_coefficient: float | None = None,
    ) -> MeshTable:
        """Table at a speed [rad/s] and a torque [N*m]; a coefficient replaces those of the file."""
        self._check_torque(pinion_torque)
        columns = dict(self.columns)
        stated = self.facts.get("pinion_speed", pinion_speed)
        for name in _SPEEDS:
            if name in columns:
                columns[name] = columns[name] * (pinion_speed / stated)
        if friction_coefficient is not None:
            self._need_friction_columns()
            columns["friction_coefficient"] = np.full_like(
                columns["stiffness"], friction_coefficient
            )
        direction = self.direction(driver)
        normal_force = pinion_torque / self.lever("pinion_theta")
        complete = self._complete(columns, normal_force)
        law = "none" if friction_coefficient == 0.0 else "table"
        return MeshTable(
            grid=self.grid,
            **complete,
            mesh_order=teeth,
            direction=direction,
            gear_pair=self.gears.pair if self.gears else cast(Any, NoGears()),
            pinion_speed=float(pinion_speed),
            pinion_torque=float(pinion_torque),
            composite_roughness=0.0,
            stiffness_model="table",
            friction_law=law,
            film_model="none",
            film_stiffness_kind="none",
            film_offset=self.facts.get("film_offset", 0.0),
        )

    def _complete(self, columns: Tree, normal_force: float) -> Tree:
        """Add the columns that follow from those of the file."""
        stiffness = columns["stiffness"]
        count, shape = stiffness.shape[0], stiffness.shape
        ramps = (columns["ramp_deflection"], columns["ramp_stiffness"])
        moved = self.has_force_law and not self._same_torque(normal_force)
        deflection, tangent = at_rest(*ramps, normal_force)
        if moved or "static_transmission_error" not in columns:
            columns["static_transmission_error"] = deflection
        if moved or "mesh_stiffness_tangent" not in columns:
            columns["mesh_stiffness_tangent"] = tangent
        share = columns.setdefault("load_share", stiffness / stiffness.sum(axis=1, keepdims=True))
        if moved:
            touch = at_rest(*ramps, 0.0)[0]
            columns["stiffness"] = share * (normal_force / (deflection - touch))[:, None]
            for name in OF_TEETH_ALONE:
                columns.pop(name, None)
        columns.setdefault("in_contact", (stiffness > 0.0) | (share > 0.0))
        columns["in_contact"] = np.asarray(columns["in_contact"]) > 0.5
        columns.setdefault("tooth_stiffness", columns["stiffness"])
        columns.setdefault("corner_share", np.zeros((count, 2)))
        columns["normal_force"] = share * normal_force
        names = {field.name for field in fields(MeshTable)}
        for name in ("friction_coefficient", *_FRICTION):
            columns.setdefault(name, np.zeros(shape))
        for name in names.intersection(OF_CONTACTS):
            lacks = name in (*FILMS, *OF_TEETH_ALONE)
            columns.setdefault(name, None if lacks else np.full(shape, np.nan))  # type: ignore[arg-type]
        columns.setdefault("friction_direction", None)  # type: ignore[arg-type]
        columns.setdefault("unloaded_transmission_error", None)  # type: ignore[arg-type]
        most = self.facts.get("maximum_single_pair_stiffness", float(columns["stiffness"].max()))
        names.remove("direction")
        table_columns = {name: value for name, value in columns.items() if name in names}
        return {"maximum_single_pair_stiffness": most, **table_columns}

    def _same_torque(self, normal_force: float) -> bool:
        stated = self.facts.get("pinion_torque")
        torque = normal_force * self.lever("pinion_theta")
        return stated is not None and abs(torque - stated) <= _SAME_TORQUE * stated

    def _check_torque(self, torque: float) -> None:
        stated = self.facts.get("pinion_torque")
        if stated is None or self.has_force_law or abs(torque - stated) <= _SAME_TORQUE * stated:
            return
        what = f"pinion_torque = {torque:.6g} N*m, and the mesh table belongs to {stated:.6g} N*m"
        why = "Its stiffness is valid at that load only: it has no force law"
        remedy = f"Keep {stated:.6g} N*m, or add ramp_deflection and ramp_stiffness to the table"
        raise InputError(what, "argument pinion_torque", why, remedy)

    def _need_friction_columns(self) -> None:
        missing = [name for name in _FRICTION if name not in self.columns]
        if missing and "friction_direction" not in self.columns:
            _refuse(
                self.path,
                f"the column {missing[0]} is missing",
                "Friction needs a direction",
                f"Add {', '.join(missing)}, or friction_direction",
            )


def read_table_file(path: str | os.PathLike[str]) -> TableFile:
    """Read and check a mesh table of another program or of this library."""
    place = Path(path)
    kind = file_kind(place)
    if kind != "file":
        what = "the mesh table " + ("is not a regular file" if kind else "does not exist")
        _refuse(path, what, "It is a CSV or netCDF file", "Correct the path")
    if place.suffix.lower() in (".nc", ".nc4", ".netcdf", ".h5"):
        return (
            _library_table(place) if is_mesh_table(place) else _checked(path, *_netcdf(place), [])
        )
    facts, columns, events = _csv(place)
    return _checked(path, facts, columns, events)


def _library_table(place: Path) -> TableFile:
    table = MeshTable.load(place)
    columns = {
        field.name: value
        for field in fields(table)
        if isinstance(value := getattr(table, field.name), np.ndarray)
        and field.name in (*UNITS, "normal_force")
    }
    if table.gears is not None:
        del columns["direction"]
    facts = facts_of(table)
    return TableFile(str(place), table.grid, columns, facts, table.gears)


def _refuse(path: object, what: str, why: str, remedy: str, where: str = "") -> NoReturn:
    raise InputError(what, f"{path}: {where}" if where else str(path), why, remedy)


def _checked(
    path: object, facts: dict[str, float], columns: dict[str, Array], events: list[float]
) -> TableFile:
    """Check columns in SI and put them on a phase grid."""
    if "phase" not in columns:
        _refuse(path, "the column phase is missing", "Rows are mesh phases", "Add it, from 0 to 1")
    if "stiffness" not in columns and "ramp_stiffness" not in columns:
        why = "A contact carries by a stiffness or by the ramps of a force law"
        remedy = "Add stiffness, or ramp_deflection and ramp_stiffness"
        _refuse(path, "the column stiffness is missing", why, remedy)
    for column, other in (OF_RAMPS, OF_RAMPS[::-1]):
        if column in columns and other not in columns:
            _refuse(path, f"the column {other} is missing", "Each ramp has both", f"Add {other}")
    radii = [f"base_radius_{gear}" for gear in ("pinion", "wheel")]
    if "direction" not in columns and not all(name in facts for name in radii):
        missing = next(name for name in radii if name not in facts)
        why = "The moments of the tooth forces need levers"
        _refuse(path, f"{missing} is missing", why, "Add both base radii, or direction columns")
    if any(name in columns for name in _SPEEDS) and "pinion_speed" not in facts:
        why = "Speeds of the contact belong to a speed of the pinion"
        _refuse(path, "pinion_speed is missing", why, "Add it to the head of the file")
    _check_values(path, columns)
    grid, columns = _on_phase_grid(path, columns, events)
    if "ramp_stiffness" not in columns:
        total_stiffness = columns["stiffness"].sum(axis=1)[:, None]
        columns |= {
            "ramp_deflection": np.zeros_like(total_stiffness),
            "ramp_stiffness": total_stiffness,
        }
    if "stiffness" not in columns:
        columns["stiffness"] = columns["ramp_stiffness"].sum(axis=1)[:, None]
    table_file = TableFile(str(path), grid, columns, facts)
    if table_file.has_friction:
        table_file._need_friction_columns()
    return table_file


def _check_values(path: object, columns: Mapping[str, Array]) -> None:
    for name, values in columns.items():
        bad = ~np.isfinite(values)
        if name not in _MAY_BE_NAN and bad.any():
            row = int(np.argwhere(bad)[0][0])
            why = "Every row of a mesh table has a number in every column of the force law"
            _refuse(path, f"{name} is {values[bad][0]} in row {row + 1}", why, "Complete it", name)
        if name in ("stiffness", "ramp_stiffness", "load_share") and np.any(values < 0.0):
            why = "The force of pressed teeth grows with the deflection"
            what = f"{name} falls to {values.min():.4g}"
            _refuse(path, what, why, "Correct the sign", name)
    ramp_stiffness = columns.get("ramp_stiffness", columns.get("stiffness"))
    if ramp_stiffness is not None and np.any(ramp_stiffness.sum(axis=1) == 0.0):
        row = int(np.argmin(ramp_stiffness.sum(axis=1)))
        _refuse(path, f"nothing carries in row {row + 1}", "Some contact is always there", "Add it")


def _on_phase_grid(
    path: object, columns: dict[str, Array], events: list[float]
) -> tuple[PhaseGrid, dict[str, Array]]:
    """Put the smooth pieces between events on a phase grid; resample unevenly spaced rows."""
    phase = columns.pop("phase").reshape(-1)
    steps = np.diff(phase)
    if np.any(steps < 0.0):
        row = int(np.argmax(steps < 0.0)) + 2
        what = f"the phase falls to {phase[row - 1]:.6g} in row {row}"
        _refuse(path, what, "Rows follow the mesh cycle from 0 to 1", "Sort the rows", "phase")
    if abs(phase[0]) > _SAME or abs(phase[-1] - 1.0) > _SAME:
        what = f"the phase runs from {phase[0]:.6g} to {phase[-1]:.6g}"
        why = "It is a fraction of the mesh cycle, and its end is written as phase 1"
        _refuse(path, what, why, "Let it run from 0 to 1", "phase")
    doubled = steps == 0.0
    if np.any(doubled[1:] & doubled[:-1]) or doubled[[0, -1]].any():
        why = "Only an event inside the cycle has two rows of one phase: before and after it"
        _refuse(path, "a phase is repeated", why, "Write two rows per event at most", "phase")
    cuts = {int(row) + 1 for row in np.flatnonzero(doubled)}
    pieces = [(a, b) for a, b in zip([0, *sorted(cuts)], [*sorted(cuts), phase.size], strict=True)]
    for event in events:
        pieces = list(_cut(path, pieces, phase, event))
    edges = tuple(float(phase[a]) for a, _ in pieces)
    intervals = tuple(b - a - 1 for a, b in pieces)
    even = all(
        count >= 4
        and count % 2 == 0
        and np.allclose(phase[a:b], np.linspace(phase[a], phase[b - 1], b - a), 0.0, _EVEN)
        for count, (a, b) in zip(intervals, pieces, strict=True)
    )
    edges = (0.0, *edges[1:])
    if even:
        rows = np.concatenate([np.arange(a, b) for a, b in pieces])
        return PhaseGrid(edges, intervals), {n: values[rows] for n, values in columns.items()}
    grid = phase_grid(edges, max(_GRID_POINTS, 2 * phase.size))
    joined = {
        name: np.concatenate(
            [
                _between(phase[a:b], values[a:b], grid.phase[part])
                for (a, b), part in zip(pieces, grid.segments, strict=True)
            ]
        )
        for name, values in columns.items()
    }
    return grid, joined


def _cut(
    path: object, pieces: list[tuple[int, int]], phase: Array, event: float
) -> Iterator[tuple[int, int]]:
    """Split the piece that contains an event; both parts include the row of the event."""
    if np.min(np.abs(phase - event)) > _SAME:
        why = "Columns jump at events, so each of them is a row, or two with both values"
        _refuse(path, f"no row has the phase of the event {event:.6g}", why, "Add it", "events")
    for a, b in pieces:
        inside = a + 1 + np.flatnonzero(np.abs(phase[a + 1 : b - 1] - event) <= _SAME)
        if inside.size:
            yield a, int(inside[0]) + 1
            yield int(inside[0]), b
        else:
            yield a, b


def _between(phase: Array, values: Array, at: Array) -> Array:
    """Interpolate the rows of a piece by a monotone cubic, which does not overshoot."""
    if not np.isfinite(values).all():  # NaN stays NaN
        columns = values.reshape(phase.size, -1).T
        interpolated = np.stack([np.interp(at, phase, column) for column in columns], axis=1)
        return interpolated.reshape(at.size, *values.shape[1:])
    return monotone_cubic(phase, values)(np.clip(at, phase[0], phase[-1]))


def _in_si(path: object, name: str, unit: str, values: Array) -> Array:
    """Convert a column to SI, or raise if its unit has another dimension."""
    if unit in ("", "-", "1"):
        unit = ""
    if unit == UNITS[name] or (name in DIRECTIONS and unit in ("", "m")):
        return values
    try:
        return np.asarray(values * units.convert(1.0, unit, UNITS[name]))
    except units.UnitProblemError:
        what = f"the unit of {name} [{unit or '1'}] does not fit"
        why = f"Its unit is {UNITS[name] or '1'}, or another one of the same dimension"
        _refuse(path, what, why, "Correct the unit", name)


def _fact(path: Any, name: str, value: Any) -> float:
    try:
        number = float(value) if not isinstance(value, str) else units.parse(value, FACTS[name])
    except Exception as error:
        _refuse(path, f"{name} = {value}", str(error), f"Write {name} in {FACTS[name]}", name)
    if not (np.isfinite(number) and number > 0.0):
        _refuse(path, f"{name} = {value}", "It is greater than zero", "Correct it", name)
    return number


def _csv(place: Path) -> tuple[dict[str, float], dict[str, Array], list[float]]:
    """Read facts, columns and events of a CSV file."""
    try:
        lines = read_bytes(place, "table").decode("utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "it is no text in UTF-8"
        _refuse(place, "the mesh table cannot be read", reason, "Give a text file in UTF-8")
    stated = [match.groups() for line in lines if (match := _FACT.match(line.strip()))]
    body = [line for line in lines if line.strip() and not line.lstrip().startswith("#")]
    if len(body) < 3:
        why = "It has a line of names and at least two rows"
        _refuse(place, "the mesh table is empty", why, "Write phase and stiffness, for example")
    sign = next((sign for sign in (";", "\t") if sign in body[0]), ",")
    try:
        names, *rows = csv.reader(body, delimiter=sign)
    except csv.Error as error:
        _refuse(place, "the mesh table cannot be read", str(error), "Correct the row")
    if not any(_column_name(header)[0] in UNITS for header in names):
        why = f"None of its columns is known. Known are {', '.join(UNITS)}"
        _refuse(place, "this is no mesh table", why, "Correct the first row")
    values = np.empty((len(rows), len(names)))
    for number, row in enumerate(rows):
        if len(row) != len(names):
            what = f"row {number + 1} has {len(row)} entries"
            _refuse(place, what, f"There are {len(names)} columns", "Complete the row")
        for column, entry in enumerate(row):
            value = plain_number(entry)
            if value is None:
                what, why = f'"{entry}" in row {number + 1} is no number', "Numbers have a point"
                _refuse(place, what, why, "Correct it", names[column])
            values[number, column] = value
    facts = {n: _fact(place, n, text.strip()) for n, text in stated if n in FACTS}
    events = [_event(place, e) for n, text in stated if n == "events" for e in text.split(",")]
    if len(events) > _MOST_EVENTS:
        why = f"A mesh cycle has at most {_MOST_EVENTS}"
        _refuse(place, f"there are {len(events)} events", why, "Keep those where columns jump")
    return facts, _columns_by_name(place, names, values), events


def _event(place: Path, text: str) -> float:
    value = plain_number(text.strip())
    if value is None or not 0.0 <= value <= 1.0:
        _refuse(place, f'events: "{text}"', "Events are phases", "Write 0.25, 0.6", "events")
    return value


def _columns_by_name(place: Path, names: list[str], values: Array) -> dict[str, Array]:
    """Columns by name, with contacts, ramps and coordinates stacked in arrays."""
    parts_by_name: dict[str, dict[tuple[int, str], Array]] = {}
    for column, header in enumerate(names):
        name, number, unit, coordinate = _column_name(header)
        if name not in UNITS:
            known_names = ", ".join(UNITS)
            _refuse(
                place, f'the column "{header}" is unknown', f"Known are {known_names}", "Rename it"
            )
        at = (int(number or 1) - 1, coordinate)
        if at in parts_by_name.setdefault(name, {}):
            what = f'the column "{header}" appears twice'
            _refuse(place, what, "Column names are unique", "Remove one")
        parts_by_name[name][at] = _in_si(place, name, (unit or "").strip(), values[:, column])
    coordinates = {
        coordinate for parts in parts_by_name.values() for _, coordinate in parts if coordinate
    }
    space = coordinates_of(len(SPATIAL_COORDINATES) if coordinates.difference(COORDINATES) else 0)
    return {name: _stacked(place, name, parts, space) for name, parts in parts_by_name.items()}


def _column_name(header: str) -> tuple[str, str | None, str | None, str]:
    """Name, contact, unit and coordinate of a column."""
    match = _HEADER.fullmatch(header.strip()) if len(header) < 200 else None
    name, number, unit = match.groups() if match else (header, None, None)
    for of in DIRECTIONS[::-1]:
        coordinate = name.removeprefix(f"{of}_")
        if name != coordinate and coordinate in (*COORDINATES, *SPATIAL_COORDINATES):
            return of, number, unit, coordinate
    return name, number, unit, ""


def _stacked(
    place: Path, name: str, parts: dict[tuple[int, str], Array], space: tuple[str, ...]
) -> Array:
    count = max(contact for contact, _ in parts) + 1
    rows = next(iter(parts.values())).size
    if name in OF_THE_MESH:
        return parts[0, ""]
    if name in DIRECTIONS:
        directions = np.zeros((rows, count, len(space)))
        for (contact, coordinate), values in parts.items():
            directions[:, contact, space.index(coordinate)] = values
        return directions[:, 0] if name == "direction" else directions
    if len(parts) != count:
        why = "Contacts and ramps are counted from 1"
        _refuse(place, f"the column {name}_{len(parts)} is missing", why, "Number them")
    return np.stack([parts[contact, ""] for contact in range(count)], axis=1)


def _netcdf(place: Path) -> tuple[dict[str, float], dict[str, Array]]:
    """Read facts and columns of a netCDF file."""
    data = read_dataset(place, str(place))
    columns = {}
    for name in (name for name in UNITS if name in data):
        values = np.asarray(data[name].values, dtype=float)
        if values.ndim == 1 and name not in OF_THE_MESH:
            values = values[:, None]
        columns[name] = _in_si(place, name, str(data[name].attrs.get("units", "")), values)
    sizes = {name: values.shape[0] for name, values in columns.items()}
    if len(set(sizes.values())) > 1:
        what = ", ".join(f"{name} has {size} rows" for name, size in sizes.items())
        _refuse(place, what, "The first dimension of every column is the phase", "Transpose it")
    facts = {n: _fact(place, n, data.attrs[n]) for n in FACTS if n in data.attrs}
    return facts, columns
