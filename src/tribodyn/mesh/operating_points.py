"""Mesh tables of several operating points of one pair, and films over its flank at each."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import fields, replace
from functools import partial
from typing import Any, NamedTuple, TypeVar

import numpy as np

from tribodyn.contact import hertz_line
from tribodyn.contact.face_contacts import SLICES, face_positions
from tribodyn.ehl import FILM_MODELS
from tribodyn.ehl.steady.batch import Films
from tribodyn.errors import ModelWarning, TribodynError, collected, require_positive
from tribodyn.friction import LAWS, FrictionParts, pitch_point
from tribodyn.mesh.build import columns_of, table_of, teeth_under_load
from tribodyn.mesh.cycle import MeshCycle, pairs_in_contact
from tribodyn.mesh.face_lines import along_flank
from tribodyn.mesh.film.film_columns import as_columns
from tribodyn.mesh.film.film_lookup import look_up_slices
from tribodyn.mesh.film.path_film import FormulaFilm, Friction, film_of
from tribodyn.mesh.gears import Gears
from tribodyn.mesh.loads import Loads, reported_films, tribological_contact, under_load
from tribodyn.mesh.sharing import Teeth, ToothContact, shared_load_columns
from tribodyn.mesh.table import MeshTable
from tribodyn.nomenclature import GEARS
from tribodyn.progress import Progress
from tribodyn.types import Array, Tree

#: A mesh table, and the warnings of its models.
TableWithWarnings = tuple[MeshTable, list[ModelWarning]]


T = TypeVar("T")


class _Point(NamedTuple):
    """An operating point with its teeth and the warnings of their models."""

    speed: float
    torque: float
    cycle: MeshCycle
    teeth: Teeth
    warnings: list[ModelWarning]


def mesh_tables(
    pair: Gears,
    settings: ToothContact,
    operations: Sequence[tuple[float, float]],
    *,
    force_law: bool = False,
) -> list[TableWithWarnings]:
    """Compute the mesh tables at several speeds and torques in one batch.

    Return an empty list where films are solved numerically or are springs, or where a point cannot
    be computed: the caller then computes each table separately.
    """
    if FILM_MODELS[settings.film_model].method or settings.film_in_series or len(operations) < 2:
        return []
    try:
        points = [_point(pair, settings, *operation) for operation in operations]
        columns = _columns(pair, settings, points)
    except TribodynError:
        return []
    tables: list[TableWithWarnings] = []
    for row, (speed, torque, cycle, teeth, warnings) in enumerate(points):
        with collected() as also:
            shared = shared_load_columns(teeth, teeth.shared_load(), None, force_law=force_law)
        row_columns = {name: c[row] if np.ndim(c) == 3 else c for name, c in columns.items()}
        table = table_of(pair, settings, cycle, (speed, torque), shared | row_columns)
        tables.append((table, [*warnings, *also]))
    return tables


def _point(pair: Gears, settings: ToothContact, speed: float, torque: float) -> _Point:
    require_positive(f"{GEARS[0]}_torque", torque, "N*m")
    with collected() as warnings:
        cycle, teeth = teeth_under_load(pair, settings, torque, None, None)
    return _Point(speed, torque, cycle, teeth, warnings)


def _columns(pair: Gears, settings: ToothContact, points: Sequence[_Point]) -> Tree:
    """Columns of all points, one row each, or without rows where they are the same."""
    cycle = points[0].cycle
    motion = cycle.motion(np.array([[point.speed] for point in points]))
    pairs = pairs_in_contact(cycle, motion, settings.lubricant, settings.material)
    load = np.stack([point.teeth.dry_load for point in points])
    least = np.array([[point.teeth.least_load] for point in points])
    film_at = FormulaFilm(settings, pairs, least)
    shared = points[0].teeth.shared_load()
    loads = Loads(shared, load, np.maximum(load, least), film_at, None)

    def films_of(row: int) -> Films:
        film_of_row: FormulaFilm = replace(_row(film_at, row), pairs=_row(pairs, row))
        return film_of_row(loads.tribological[row])

    films: Films = _compute_rows(points, lambda: film_at(loads.tribological), films_of)
    roughness = settings.composite_roughness
    contact = tribological_contact(
        motion, pairs, loads.tribological, roughness, None, films, bodies=settings.bodies
    )

    def friction_of(row: int) -> Friction:
        pitch = pitch_point(pair, points[row].speed, points[row].torque)
        contact_of_row = replace(_row(contact, row), pitch=pitch)
        return film_at.friction(contact_of_row, motion, settings)

    together = LAWS[settings.friction_law].together
    all_at_once = partial(film_at.friction, contact, motion, settings) if together else None
    friction = _compute_rows(points, all_at_once, friction_of)
    reported = reported_films(films, loads, least)
    return columns_of(cycle, motion, loads, contact, reported, friction)


def _compute_rows(
    points: Sequence[_Point],
    compute_together: Callable[[], T] | None,
    compute_row: Callable[[int], T],
) -> T:
    """Compute all rows in one call, or one by one where their warnings may differ."""
    if compute_together is not None:
        with collected() as warnings:
            results = compute_together()
        if not warnings:
            return results
    row_results = []
    for row, point in enumerate(points):
        with collected() as warnings:
            row_results.append(compute_row(row))
        point.warnings.extend(warnings)
    stacked: T = _stacked(row_results)
    return stacked


def _row(bundle: Any, row: int) -> Any:
    """Return a copy of a dataclass with one row of each column that has rows."""
    values = {each.name: getattr(bundle, each.name) for each in fields(bundle)}
    row_values = {name: value[row] for name, value in values.items() if np.ndim(value) == 2}
    return replace(bundle, **row_values)


def _stacked(row_results: Sequence[Any]) -> Any:
    """Stack the results of the rows."""
    first: Any = row_results[0]
    if isinstance(first, np.ndarray):
        return np.stack(row_results)
    if not isinstance(first, Films | FrictionParts):
        return first
    names = [part.name for part in fields(first)]
    return replace(first, **{n: _stacked([getattr(row, n) for row in row_results]) for n in names})


def films_over_flank(
    pair: Gears, settings: ToothContact, torques: Array, speeds: Array, progress: Progress
) -> Tree:
    """Films of all slices, one after the other, each at its places from entry to exit."""
    dry = replace(settings, film_model="none", film_options={})
    loads, films = list[Array](), list[list[dict[str, Array]]]()
    for torque in torques.tolist():
        cycle, teeth = teeth_under_load(pair, settings, torque, None, None)
        number = np.zeros(cycle.in_contact.shape, dtype=np.int64)
        number[cycle.in_contact] = np.arange(np.count_nonzero(cycle.in_contact))
        order = along_flank(number, cycle.in_contact, SLICES)
        films.append([])
        for speed in speeds.tolist():
            motion = cycle.motion(speed)
            pairs = pairs_in_contact(cycle, motion, settings.lubricant, settings.material)
            film = look_up_slices(settings, cycle, teeth, pairs) or film_of(
                settings, cycle, teeth, pairs, speed, progress
            )
            shared = under_load(teeth, dry, film, cycle.named)
            solved = reported_films(shared.film_at(shared.tribological), shared, teeth.least_load)
            columns = as_columns(solved, settings.composite_roughness)
            films[-1].append({name: column[order] for name, column in columns.items()})
        loads.append(shared.tribological[order])
    motion, load = cycle.motion(speeds[:, None]), np.array(loads)
    radius = getattr(motion, f"{pair.driver}_curvature_radius")[0]
    modulus, reduced = pairs.effective_modulus, motion.equivalent_radius[0][order]
    positions = np.tile(face_positions(cycle.contact, SLICES), cycle.path.shape[1] // SLICES)
    face = np.broadcast_to(positions, cycle.path.shape)
    return {
        "path": along_flank(cycle.path, cycle.in_contact, SLICES),
        "face_position": along_flank(face, cycle.in_contact, SLICES),
        "roll_angle": radius[order] / pair.driving.base_radius,
        "load_per_width": load,
        "hertz_pressure": hertz_line(load, reduced, modulus).maximum_pressure,
        "entrainment_speed": motion.entrainment_speed[:, order],
        **{n: np.array([[point[n] for point in row] for row in films]) for n in films[0][0]},
    }
