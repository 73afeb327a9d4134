"""Mesh tables in files: read from netCDF, and written as text for other programs."""

from __future__ import annotations

from dataclasses import MISSING, Field, fields
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from tribodyn.errors import InputError, OutputExistsError
from tribodyn.files import whole
from tribodyn.mesh.columns import MeshColumns
from tribodyn.mesh.gears import COORDINATES, NoGears, read_pair
from tribodyn.mesh.grid import PhaseGrid
from tribodyn.nomenclature import QUANTITIES
from tribodyn.record import labels_of
from tribodyn.types import Array

#: What the attribute ``format`` of a file says; earlier versions cannot read one without gears.
FORMAT, FORMAT_WITHOUT_GEARS = "tribodyn mesh table 3", "tribodyn mesh table 4"
#: Tables of independent pairs, as they were written before; the first without a film in series.
_EARLIER = ("tribodyn mesh table 1", "tribodyn mesh table 2")


def is_mesh_table(path: Path) -> bool:
    """Whether this library wrote a netCDF file."""
    import xarray

    try:
        with xarray.open_dataset(path, engine="h5netcdf") as opened:
            return str(opened.attrs.get("format", "")).startswith("tribodyn mesh table")
    except (OSError, ValueError):
        return False


def stored_values(path: str | PathLike[str]) -> dict[str, Any]:
    """Fields of the mesh table in a netCDF file."""
    import xarray

    try:
        with xarray.open_dataset(path, engine="h5netcdf") as opened:
            data = opened.load()
    except (OSError, ValueError) as error:
        raise _unreadable(path, str(error)) from error
    if data.attrs.get("format") not in (FORMAT, FORMAT_WITHOUT_GEARS, *_EARLIER):
        raise _unreadable(path, f"its format is {data.attrs.get('format', 'not named')}")
    grid = PhaseGrid(
        tuple(float(value) for value in data["event_phase"].values),
        tuple(int(value) for value in data["intervals"].values),
    )
    told = data.attrs.get("gear_pair")
    pair = read_pair(told) if told is not None else NoGears()
    values: dict[str, Any] = {"grid": grid, "gear_pair": pair}
    for field in fields(MeshColumns):
        if field.name in data:
            values[field.name] = data[field.name].values
        elif field.name not in values and (told is None or _is_required(field)):
            values[field.name] = _plain(data.attrs.get(field.name))
    if data.attrs["format"] in _EARLIER:
        values = _earlier(values)
    return values


def _is_required(field: Field[Any]) -> bool:
    return field.default is MISSING and field.default_factory is MISSING


def _earlier(values: dict[str, Any]) -> dict[str, Any]:
    """Add what earlier tables did not have: their pairs were independent springs."""
    whole = values["stiffness"].sum(axis=1)
    force = values["pinion_torque"] / values["gear_pair"].pinion.base_radius
    new = {
        "tooth_stiffness": values["stiffness"],
        "film_stiffness_kind": "none",
        "corner_share": np.zeros((whole.size, 2)),
        "static_transmission_error": force / whole,
        "mesh_stiffness_tangent": whole,
        "maximum_single_pair_stiffness": float(values["stiffness"].max()),
        "ramp_deflection": np.zeros((whole.size, 1)),
        "ramp_stiffness": whole[:, None],
    }
    return {**values, **{k: v for k, v in new.items() if values.get(k) is None}}


def _plain(value: Any) -> Any:
    """NetCDF attributes come back as NumPy scalars."""
    return value.item() if isinstance(value, np.generic) else value


def _unreadable(path: str | PathLike[str], reason: str) -> InputError:
    return InputError(
        f"{path} is no mesh table",
        where="argument path",
        why=reason,
        remedy="Give a file that MeshTable.save wrote",
    )


#: Columns of a text file that stand once, for each ramp, for each contact, for each coordinate.
OF_THE_MESH = (
    "phase",
    "static_transmission_error",
    "unloaded_transmission_error",
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
#: What holds for the whole file.
_OF_THE_FILE = (
    "base_radius_pinion",
    "base_radius_wheel",
    "pinion_torque",
    "pinion_speed",
    "maximum_single_pair_stiffness",
)
FACTS = {name: QUANTITIES[name].unit for name in _OF_THE_FILE}


def write_csv(table: MeshColumns, path: str | PathLike[str]) -> None:
    """Write a mesh table as CSV, of which :mod:`tribodyn.mesh.table_file` makes an equal one."""
    place = Path(path)
    if place.exists():
        why = "An existing file is never overwritten"
        raise OutputExistsError(f"{path} exists already", "argument path", why)
    facts = {name: float(getattr(table, name)) for name in FACTS}
    columns: dict[str, Array] = {"phase": table.phase}
    for name, unit in UNITS.items():
        values = table.phase if name == "phase" else getattr(table, name)
        if values is None or (name == "direction" and values.ndim == 1):
            continue
        flat = np.asarray(values, dtype=float).reshape(table.phase.size, -1)
        if name in DIRECTIONS:
            heads = [f"{name}_{c}" for c in COORDINATES]
            if name != "direction":
                heads = [f"{h}_{i + 1}" for i in range(flat.shape[1] // 6) for h in heads]
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
    with whole(place) as partial:
        partial.write_text("\n".join(lines) + "\n", encoding="utf-8")
