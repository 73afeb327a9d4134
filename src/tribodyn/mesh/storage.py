"""A mesh table as a labelled data set, and to and from a netCDF file."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import MISSING, Field, asdict, fields
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.errors import InputError, OutputExistsError, quiet
from tribodyn.files import whole
from tribodyn.gear import BasicRack, FlankModification, ProfileMap, SpurGear, SpurPair
from tribodyn.mesh.cycle import COORDINATES, NoGears
from tribodyn.mesh.grid import PhaseGrid
from tribodyn.mesh.table import MeshTable
from tribodyn.nomenclature import QUANTITIES
from tribodyn.stored import read_dataset, write_dataset
from tribodyn.types import Array

if TYPE_CHECKING:
    import xarray


_FORMAT = "tribodyn mesh table 3"
#: A table without gears, which earlier versions cannot read.
_FORMAT_WITHOUT_GEARS = "tribodyn mesh table 4"
#: Tables of independent pairs, as they were written before; the first without a film in series.
_EARLIER = ("tribodyn mesh table 1", "tribodyn mesh table 2")
#: Columns whose quantity has another name in the nomenclature.
_QUANTITY = {
    "stiffness": "pair_stiffness",
    "pinion_curvature_radius": "curvature_radius",
    "wheel_curvature_radius": "curvature_radius",
    "phase": "mesh_phase",
}
#: Second dimension of columns that are not over the pairs.
_OVER = {"ramp_deflection": "ramp", "ramp_stiffness": "ramp", "corner_share": "end"}
#: Dimensions of columns that are not over knots and pairs.
_RANKS = {"static_transmission_error": (1,), "mesh_stiffness_tangent": (1,), "direction": (1, 2),
          "friction_direction": (3,), "unloaded_transmission_error": (1,)}  # fmt: skip
#: Films that are not known everywhere; and all that a table of another program has to know.
_MAY_LACK = ("central_film", "minimum_film", "film_ratio", "film_pressure", "film_stiffness")
_OF_THE_FORCE = (*_OVER, *_RANKS, "stiffness", "tooth_stiffness", "load_share", "normal_force",
                 "friction_coefficient", "sliding_direction")  # fmt: skip
_MOST_KNOTS = 10**6
_DERIVED = ("mesh_stiffness", "friction_sum", "friction_moment_pinion", "friction_moment_wheel")


def to_xarray(table: MeshTable) -> xarray.Dataset:
    """Convert a mesh table to a labelled data set."""
    import xarray

    variables: dict[str, Any] = {}
    attributes: dict[str, Any] = {"format": _FORMAT, "mesh_order": table.mesh_order}
    if table.gears is None:
        attributes["format"] = _FORMAT_WITHOUT_GEARS
    else:
        attributes["gear_pair"] = _write_pair(table.gears.pair)
    for field in fields(table):
        value = getattr(table, field.name)
        if field.name == "direction" and table.gears is not None:
            continue  # It follows from the gears.
        if isinstance(value, np.ndarray):
            variables[field.name] = (_dimensions(field.name, value), value, _describe(field.name))
        elif isinstance(value, float | str):
            attributes[field.name] = value
    for name in _DERIVED:
        variables[name] = (("knot",), getattr(table, name), _describe(name))
    coordinates = {
        "phase": (("knot",), table.phase, _describe("phase")),
        "event_phase": (("event",), np.array(table.event_phases), _describe("phase")),
        "intervals": (("event",), np.array(table.grid.intervals)),
    }
    return xarray.Dataset(variables, coordinates, attributes)


def _dimensions(name: str, values: Array) -> tuple[str, ...]:
    if name == "direction":
        return ("knot", "coordinate")[-values.ndim :]
    return ("knot", _OVER.get(name, "pair"), "coordinate")[: values.ndim]


def _describe(column: str) -> dict[str, str]:
    quantity = QUANTITIES[_QUANTITY.get(column, column)]
    return {"units": quantity.unit or "1", "long_name": quantity.meaning}


def save(table: MeshTable, path: str | PathLike[str]) -> None:
    """Write a mesh table to a netCDF file."""
    if Path(path).exists():
        raise OutputExistsError(
            f"{path} exists already",
            where="argument path",
            why="An existing file is never overwritten",
            remedy="Choose another name or remove the file",
        )
    with whole(Path(path)) as partial:
        write_dataset(to_xarray(table), partial)


def is_mesh_table(path: Path) -> bool:
    """Whether this library wrote a netCDF file."""
    try:
        return str(read_dataset(path).attrs.get("format", "")).startswith("tribodyn mesh table")
    except InputError:
        return False


def load(path: str | PathLike[str]) -> MeshTable:
    """Read a mesh table from a netCDF file."""
    try:
        data = read_dataset(path)
    except InputError as error:
        raise _unreadable(path, f"{error.problems[0].why}. {error.problems[0].remedy}") from None
    if data.attrs.get("format") not in (_FORMAT, _FORMAT_WITHOUT_GEARS, *_EARLIER):
        raise _unreadable(path, f"its format is {data.attrs.get('format', 'not named')}")
    try:
        values = _values(data)
        if data.attrs["format"] in _EARLIER:
            values = _earlier(values)
        _check(values)
        return MeshTable(**values)
    # What a damaged file holds makes its readers stumble in many ways.
    except Exception as error:
        told = error.args[0] if isinstance(error, KeyError) and error.args else error
        raise _unreadable(path, f"It is damaged: {told or type(error).__name__}") from None


def _values(data: xarray.Dataset) -> dict[str, Any]:
    """Fields of a table as a data set has them."""
    for name in ("event_phase", "intervals"):
        if name not in data.variables:
            raise ValueError(f"{name} is missing")
    grid = PhaseGrid(
        tuple(float(value) for value in data["event_phase"].values),
        tuple(int(value) for value in data["intervals"].values),
    )
    told = data.attrs.get("gear_pair")
    if told is None and data.attrs["format"] != _FORMAT_WITHOUT_GEARS:
        raise ValueError("gear_pair is missing")
    values: dict[str, Any] = {
        "grid": grid,
        "gear_pair": NoGears() if told is None else _read_pair(told),
    }
    for field in fields(MeshTable):
        if field.name in data.variables:
            column = data[field.name]
            if column.dims != _dimensions(field.name, column.values):
                raise ValueError(f"{field.name} is over {', '.join(map(str, column.dims))}")
            values[field.name] = column.values
        elif field.name not in values and (told is None or _is_required(field)):
            values[field.name] = _plain(data.attrs.get(field.name))
    return values


def _check(values: Mapping[str, Any]) -> None:
    """Refuse a column that is missing, has another shape, or is not finite where it has to be."""
    grid = values["grid"]
    _check_grid(grid)
    shape = values["stiffness"].shape
    shapes = {"knot": grid.phase.size, "pair": shape[-1], "end": 2, "coordinate": len(COORDINATES)}
    foreign = isinstance(values["gear_pair"], NoGears)
    for field in fields(MeshTable):
        name, value = field.name, values.get(field.name)
        kind = str(field.type)
        if kind.startswith(("Array", "Mask")):
            if value is None:
                if "None" not in kind and _is_required(field):
                    raise ValueError(f"{name} is missing")
                continue
            _check_column(name, value, shapes, foreign)
        elif kind in ("float", "int", "str") and (name in values or _is_required(field)):
            sound = isinstance(value, str) if kind == "str" else isinstance(value, int | float)
            if not sound or (kind != "str" and not math.isfinite(float(value or 0))):
                raise ValueError(f"{name} is {value!r}")


def _check_grid(grid: PhaseGrid) -> None:
    edges, counts = np.array((*grid.event_phases, 1.0)), np.array(grid.intervals)
    if edges.size != counts.size + 1 or edges[0] != 0.0 or not np.all(np.diff(edges) > 0.0):
        raise ValueError("event_phase does not lead from 0 to 1")
    if np.any(counts < 4) or np.any(counts % 2) or counts.max() > _MOST_KNOTS:
        raise ValueError(f"intervals are {counts.min()} to {counts.max()}")


def _check_column(name: str, value: Any, sizes: dict[str, int], foreign: bool) -> None:
    over = _dimensions(name, value)
    shape = tuple(sizes.setdefault(*pair) for pair in zip(over, value.shape, strict=True))
    wanted = _RANKS.get(name, (2,))
    if value.shape != shape or value.ndim not in wanted or not value.size:
        raise ValueError(f"{name} has the shape {value.shape}")
    if value.dtype.kind != ("b" if name == "in_contact" else "f"):
        raise ValueError(f"{name} has values of the kind {value.dtype}")
    lacks = name in _MAY_LACK or (foreign and name not in _OF_THE_FORCE)
    if value.dtype.kind == "f" and not lacks and not np.isfinite(value).all():
        raise ValueError(f"{name} is not finite")


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


def _write_pair(pair: SpurPair) -> str:
    return json.dumps(asdict(pair))


def _read_pair(text: str) -> SpurPair:
    values = json.loads(text)
    with quiet():
        # Whoever made the table has seen what there was to say about these gears.
        for name in ("pinion", "wheel"):
            rack = BasicRack(**values[name].pop("rack"))
            modification = _read_modification(values[name].pop("modification", {}))
            values[name] = SpurGear(rack=rack, modification=modification, **values[name])
        return SpurPair(**values)


def _read_modification(values: dict[str, Any]) -> FlankModification:
    """Modification of a gear; tables from before there were any have none."""
    chart = values.pop("profile_map", None)
    return FlankModification(profile_map=ProfileMap(**chart) if chart else None, **values)
