"""Mesh tables in files: read from netCDF, and written as text for other programs."""

from __future__ import annotations

import io
import math
from collections.abc import Mapping
from dataclasses import MISSING, Field, fields
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.errors import InputError, OutputExistsError
from tribodyn.files import atomic_write
from tribodyn.interrupt import deferred
from tribodyn.mesh.columns import FILM_COLUMNS, MIXED_COLUMNS, MeshColumns
from tribodyn.mesh.gears import NoGears, coordinates_of, read_pair
from tribodyn.mesh.grid import PhaseGrid
from tribodyn.nomenclature import QUANTITIES
from tribodyn.record import labels_of
from tribodyn.types import Array, ByName, Tree
from tribodyn.validated_files import read_bytes, read_dataset

if TYPE_CHECKING:
    import xarray

#: Values of the attribute ``format`` of a file; earlier versions cannot read files without gears.
FORMAT, FORMAT_WITHOUT_GEARS = "tribodyn mesh table 3", "tribodyn mesh table 4"
#: Tables of independent pairs, as they were written before; the first without a film in series.
_EARLIER = ("tribodyn mesh table 1", "tribodyn mesh table 2")
#: Columns of films, which may hold NaN.
FILMS = (*FILM_COLUMNS, *MIXED_COLUMNS)
#: Columns of tables whose films are in series with the teeth only.
OF_TEETH_ALONE = ("tooth_load_share", "tooth_corner_share", "tooth_transmission_error")
_OF_THE_FORCE = (
    "stiffness", "tooth_stiffness", "corner_share", "static_transmission_error", "ramp_deflection",
    "mesh_stiffness_tangent", "ramp_stiffness", "load_share", "normal_force", "sliding_direction",
    "friction_coefficient", "friction_direction", "unloaded_transmission_error",
)  # fmt: skip
_MOST_KNOTS = 10**6


@deferred()
def is_mesh_table(path: Path) -> bool:
    """Whether this library wrote a netCDF file."""
    import h5py

    try:
        with h5py.File(io.BytesIO(read_bytes(path, "netcdf"))) as file:
            return str(file.attrs.get("format", "")).startswith("tribodyn mesh table")
    except Exception:  # HDF5 reports damaged files by many exceptions.
        return False


def stored_values(path: str | PathLike[str]) -> Tree:
    """Fields of the mesh table in a netCDF file."""
    try:
        data = read_dataset(path)
    except InputError as error:
        raise _unreadable(path, f"{error.problems[0].why}. {error.problems[0].remedy}") from None
    if data.attrs.get("format") not in (FORMAT, FORMAT_WITHOUT_GEARS, *_EARLIER):
        raise _unreadable(path, f"its format is {data.attrs.get('format', 'not named')}")
    try:
        values = _values(data)
        if data.attrs["format"] in _EARLIER:
            values = _earlier(values)
        _check(values)
    # Damaged files raise many exceptions.
    except Exception as error:
        reason = error.args[0] if isinstance(error, KeyError) and error.args else error
        raise _unreadable(path, f"It is damaged: {reason or type(error).__name__}") from None
    return values


def _values(data: xarray.Dataset) -> Tree:
    """Read the fields of a table from a data set."""
    if absent := [name for name in ("event_phase", "intervals") if name not in data.variables]:
        raise ValueError(f"{absent[0]} is missing")
    grid = PhaseGrid(
        tuple(float(value) for value in data["event_phase"].values),
        tuple(int(value) for value in data["intervals"].values),
    )
    stored_pair = data.attrs.get("gear_pair")
    if stored_pair is None and data.attrs["format"] != FORMAT_WITHOUT_GEARS:
        raise ValueError("gear_pair is missing")
    pair = read_pair(stored_pair) if stored_pair is not None else NoGears()
    values: Tree = {"grid": grid, "gear_pair": pair}
    for field in fields(MeshColumns):
        if field.name in data.variables:
            values[field.name] = data[field.name].values
        elif field.name not in values and (stored_pair is None or _is_required(field)):
            values[field.name] = _plain(data.attrs.get(field.name))
        if field.name == "film_offset":
            # Tables of earlier versions count from the flanks.
            values[field.name] = float(data.attrs.get(field.name, 0.0))
    return values


def _check(values: ByName) -> None:
    """Raise for missing fields, wrong shapes, and values that have to be finite but are not."""
    _check_grid(values["grid"])
    count = len(coordinates_of(*(np.shape(values.get("direction", 0.0))[-1:] or (0,))))
    sizes = {"knot": values["grid"].phase.size, "end": 2, "coordinate": count}
    foreign = isinstance(values["gear_pair"], NoGears)
    for field in fields(MeshColumns):
        name, value, kind = field.name, values.get(field.name), str(field.type)
        labels = _LABELS.get(name)
        if value is None and ("None" in kind or not _is_required(field)):
            continue
        if labels is None or not labels.dims:
            _check_fact(name, value, kind, sizes)
        elif not isinstance(value, np.ndarray) or not value.size:
            raise ValueError(f"{name} is missing")
        else:
            lacks = name in FILMS or (foreign and name not in _OF_THE_FORCE)
            _check_column(name, value, labels.dims, sizes, lacks)


def _check_grid(grid: PhaseGrid) -> None:
    edges, counts = np.array((*grid.event_phases, 1.0)), np.array(grid.intervals)
    if edges.size != counts.size + 1 or edges[0] != 0.0 or not np.all(np.diff(edges) > 0.0):
        raise ValueError("event_phase does not lead from 0 to 1")
    if np.any(counts < 4) or np.any(counts % 2) or counts.max() > _MOST_KNOTS:
        raise ValueError(f"intervals are {counts.min()} to {counts.max()}")


def _check_fact(name: str, value: Any, kind: str, sizes: Mapping[str, int]) -> None:
    if kind in ("float", "int"):
        sound = isinstance(value, int | float) and math.isfinite(value)
    elif name == "direction":
        shapes = ((sizes["coordinate"],), (sizes["knot"], sizes["coordinate"]))
        sound = np.shape(value) in shapes and bool(np.isfinite(value).all())
    else:
        sound = kind != "str" or isinstance(value, str)
    if not sound:
        raise ValueError(f"{name} is {value!r}")


def _check_column(
    name: str, value: Array, dims: tuple[str, ...], sizes: dict[str, int], lacks: bool
) -> None:
    shape = tuple(sizes.setdefault(*pair) for pair in zip(dims, value.shape, strict=False))
    if value.shape != shape or len(dims) != value.ndim:
        raise ValueError(f"{name} has the shape {value.shape}")
    if value.dtype.kind != ("b" if name == "in_contact" else "f"):
        raise ValueError(f"{name} has values of the kind {value.dtype}")
    if value.dtype.kind == "f" and not lacks and not np.isfinite(value).all():
        raise ValueError(f"{name} is not finite")


def _is_required(field: Field[Any]) -> bool:
    return field.default is MISSING and field.default_factory is MISSING


def _earlier(values: Tree) -> Tree:
    """Add the fields that earlier formats lack: their pairs were independent springs."""
    total_stiffness = values["stiffness"].sum(axis=1)
    force = values["pinion_torque"] / values["gear_pair"].pinion.base_radius
    new = {
        "tooth_stiffness": values["stiffness"],
        "film_stiffness_kind": "none",
        "corner_share": np.zeros((total_stiffness.size, 2)),
        "static_transmission_error": force / total_stiffness,
        "mesh_stiffness_tangent": total_stiffness,
        "maximum_single_pair_stiffness": float(values["stiffness"].max()),
        "ramp_deflection": np.zeros((total_stiffness.size, 1)),
        "ramp_stiffness": total_stiffness[:, None],
    }
    return {**values, **{k: v for k, v in new.items() if values.get(k) is None}}


def _plain(value: object) -> Any:
    """Convert a netCDF attribute, read as NumPy scalar, to a Python value."""
    return value.item() if isinstance(value, np.generic) else value


def _unreadable(path: str | PathLike[str], reason: str) -> InputError:
    what = f"{path} is no mesh table"
    return InputError(what, "argument path", reason, "Give a file that MeshTable.save wrote")


#: Columns of a text file: one for the mesh, one per ramp, per contact, per coordinate.
OF_THE_MESH = (
    "phase",
    "static_transmission_error",
    "unloaded_transmission_error",
    "tooth_transmission_error",
    "mesh_stiffness_tangent",
)
OF_RAMPS, DIRECTIONS = ("ramp_deflection", "ramp_stiffness"), ("direction", "friction_direction")
_LABELS = labels_of(MeshColumns)
OF_CONTACTS = tuple(
    name
    for name, labels in _LABELS.items()
    if labels.dims in (("knot", "pair"), ("knot", "end")) and name != "normal_force"
)
UNITS = {"phase": ""} | {
    name: QUANTITIES[_LABELS[name].of or name if name in _LABELS else name].unit
    for name in (*OF_THE_MESH[1:], *OF_RAMPS, *OF_CONTACTS, *DIRECTIONS)
}
#: Values in the head of a file, which apply to all rows.
_OF_THE_FILE = (
    "base_radius_pinion",
    "base_radius_wheel",
    "pinion_torque",
    "pinion_speed",
    "maximum_single_pair_stiffness",
    "film_offset",
)
FACTS = {name: QUANTITIES[name].unit for name in _OF_THE_FILE}


def facts_of(table: MeshColumns) -> dict[str, float]:
    """Values that apply to all rows of a table; the film offset only if films are in series."""
    facts = {name: float(getattr(table, name)) for name in FACTS}
    return {name: value for name, value in facts.items() if name != "film_offset" or value > 0.0}


def write_csv(table: MeshColumns, path: str | PathLike[str]) -> None:
    """Write a mesh table as CSV, which :mod:`tribodyn.mesh.table_file` reads back unchanged."""
    place = Path(path)
    if place.exists():
        why = "An existing file is never overwritten"
        what = f"{path} exists already"
        raise OutputExistsError(what, "argument path", why, "Give another path, or overwrite=True")
    facts = facts_of(table)
    columns: dict[str, Array] = {"phase": table.phase}
    for name, unit in UNITS.items():
        values = table.phase if name == "phase" else getattr(table, name)
        if values is None or (name == "direction" and values.ndim == 1):
            continue
        flat = np.asarray(values, dtype=float).reshape(table.phase.size, -1)
        if name in DIRECTIONS:
            heads = [f"{name}_{c}" for c in coordinates_of(values.shape[-1])]
            if name != "direction":
                heads = [f"{h}_{i + 1}" for i in range(values.shape[1]) for h in heads]
        else:
            several = name not in OF_THE_MESH
            heads = [f"{name}_{i + 1}" if several else name for i in range(flat.shape[1])]
        columns |= {
            f"{head} [{unit or '-'}]" if name != "phase" else head: flat[:, number]
            for number, head in enumerate(heads)
        }
    lines = [f"# {name} = {value!r} {FACTS[name]}" for name, value in facts.items()]
    lines.append(",".join(columns))
    lines += [",".join(repr(float(v)) for v in row) for row in np.stack([*columns.values()], 1)]
    with atomic_write(place) as partial:
        partial.write_text("\n".join(lines) + "\n", encoding="utf-8")
