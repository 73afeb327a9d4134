"""Mean friction of a gear mesh between measured points of torque and speed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import InputError, require_between, require_positive, warn
from tribodyn.friction.mesh_means import PitchPoint, mean_law
from tribodyn.model import numbers
from tribodyn.types import Array, Index, Mask
from tribodyn.units import RPM

#: Printed points of a back-to-back rig whose gear of 24 teeth drives: torque [N*m] and speed
#: [rad/s] of the driving gear, and friction coefficient.
FZG_POINTS = (
    (50.0, 150.0, 300.0, 150.0, 150.0),
    tuple(speed * math.pi / 30.0 for speed in (1400.0, 1400.0, 1400.0, 400.0, 1800.0)),
    (0.0271, 0.0692, 0.119, 0.1505, 0.0554),
)


def measured(
    torque: ArrayLike,
    speed: ArrayLike,
    measured_torques: Sequence[float] = FZG_POINTS[0],
    measured_speeds: Sequence[float] = FZG_POINTS[1],
    measured_coefficients: Sequence[float] = FZG_POINTS[2],
) -> Array:
    """Friction coefficient between measured points, linear in the logarithms of all three.

    Triangles join the points; outside of them the nearest value on their border is held. Points of
    one torque or of one speed are joined by lines.

    Parameters
    ----------
    torque : float or array [N*m]
        Torque on the driving gear.
    speed : float or array [rad/s]
        Speed of the driving gear.
    measured_torques : sequence of float [N*m]
        Torque of each point.
    measured_speeds : sequence of float [rad/s]
        Speed of each point.
    measured_coefficients : sequence of float
        Friction coefficient of each point.

    Returns
    -------
    float or array
        Friction coefficient, of the common shape of ``torque`` and ``speed``.

    Raises
    ------
    InputError
        If the points are not of one number, two of them are at one place, or a value is not
        positive or a coefficient above 1.

    Warns
    -----
    ModelWarning
        Code ``friction-range`` outside of the measured points.

    Valid for the gear, oil and temperature of the measurement. Source: the measured points; the
    default is a printed table of an FZG rig with a mineral gear oil.

    Examples
    --------
    >>> round(float(measured(150.0, 1400.0 * np.pi / 30.0)), 4)
    0.0692
    """
    require_positive("torque", torque, "N*m")
    require_positive("speed", speed, "rad/s", remedy="1400 rpm is 146.6 rad/s")
    columns = (measured_torques, measured_speeds, measured_coefficients)
    points = _points(*(tuple(float(value) for value in column) for column in columns))
    shape = np.broadcast_shapes(np.shape(torque), np.shape(speed))
    where = np.stack([np.ravel(np.broadcast_to(value, shape)) for value in (torque, speed)], axis=1)
    logarithm, outside = _interpolated(points, np.log(where))
    if outside.any():
        low, high = np.exp(points[:, :2].min(axis=0)), np.exp(points[:, :2].max(axis=0))
        first = where[outside][0]
        warn(
            "friction-range",
            f"measured: {first[0]:.4g} N*m at {first[1] / RPM:.4g} rpm is outside the measured "
            f"points ({low[0]:.4g} to {high[0]:.4g} N*m and {low[1] / RPM:.4g} to "
            f"{high[1] / RPM:.4g} rpm): the nearest value inside is used. Measure there, or "
            "choose another friction law.",
        )
    return np.exp(logarithm).reshape(shape)[()]


@lru_cache(maxsize=16)
def _points(*columns: tuple[float, ...]) -> Array:
    """Logarithms of the points, torque first; refused where they are no table."""
    names = ("measured_torques", "measured_speeds", "measured_coefficients")
    if len({len(column) for column in columns}) > 1 or not columns[0]:
        counted = ", ".join(f"{len(c)} {n}" for c, n in zip(columns, names, strict=True))
        why, remedy = "Each point has one of each", "Give lists of one length"
        raise InputError(counted, where='friction law "measured"', why=why, remedy=remedy)
    for name, column, unit in zip(names, columns, ("N*m", "rad/s", ""), strict=True):
        require_positive(name, np.array(column), unit)
    require_between(names[2], np.array(columns[2]), 0.0, 1.0)
    points = np.log(np.array(columns)).T
    places: set[tuple[float, float]] = set()
    for place in zip(columns[0], columns[1], strict=True):
        if place in places:
            what = f"two points at {place[0]:.4g} N*m and {place[1] / RPM:.4g} rpm"
            why, remedy = "One place has one friction coefficient", "Give their mean"
            raise InputError(what, where='friction law "measured"', why=why, remedy=remedy)
        places.add(place)
    return np.asarray(points)


def _interpolated(points: Array, where: Array) -> tuple[Array, Mask]:
    """Values at the places, and whether they lie outside."""
    spread = np.linalg.svd(points[:, :2] - points[:, :2].mean(axis=0), compute_uv=False)
    if len(points) < 3 or spread[1] <= 1e-9 * spread[0]:
        order = np.lexsort((points[:, 1], points[:, 0]))
        edges = np.stack([order[:-1], order[1:]], axis=1) if len(points) > 1 else order[[[0, 0]]]
        nearest, distance = _nearest(points, edges, where)
        return nearest, distance > 1e-9
    from scipy.interpolate import LinearNDInterpolator
    from scipy.spatial import Delaunay

    mesh = Delaunay(points[:, :2])
    values = LinearNDInterpolator(mesh, points[:, 2])(where)
    outside = np.isnan(values)
    if outside.any():
        nearest, distance = _nearest(points, mesh.convex_hull, where[outside])
        values[outside] = nearest
        outside[outside] = distance > 1e-9
    return values, outside


def _nearest(points: Array, edges: Index, where: Array) -> tuple[Array, Array]:
    """Values at the nearest place on the edges between points, and the distance to it."""
    start, end = points[edges[:, 0]], points[edges[:, 1]]
    along = end - start
    length = np.maximum(np.sum(along[:, :2] ** 2, axis=1), np.finfo(float).tiny)
    part = np.einsum("pec,ec->pe", where[:, None] - start[:, :2], along[:, :2]) / length
    place = start + np.clip(part, 0.0, 1.0)[:, :, None] * along
    distance = np.linalg.norm(place[:, :, :2] - where[:, None], axis=2)
    best = np.argmin(distance, axis=1)
    rows = np.arange(len(where))
    return np.asarray(place[rows, best, 2]), np.asarray(distance[rows, best])


def _column(
    low: float, high: float, why: str, column: int, of: str, quantity: str, example: str
) -> Any:
    attributes = {"default": FZG_POINTS[column], "of": of, "example": example}
    return numbers(low, high, why, meaning=f"{quantity} at each measured point", **attributes)


_GUARD = "guards against a wrong unit"


@mean_law(
    "measured",
    source="the points measured; by default those of an FZG rig (1400 rpm, 150 N*m and others)",
    meaning="mean friction coefficient of a mesh between measured points of torque and speed",
    needs_oil=False,
    rough=False,
    law_options={
        "measured_torques": _column(
            1e-6, 1e8, _GUARD, 0, "torque", "torque on the driving gear", '["50 N*m", "150 N*m"]'
        ),
        "measured_speeds": _column(
            1e-3, 2e4, _GUARD, 1, "speed", "speed of the driving gear", '["1400 rpm", "1400 rpm"]'
        ),
        "measured_coefficients": _column(
            1e-6,
            1.0,
            "lubricated steel lies below 0.2",
            2,
            "friction_coefficient",
            "friction coefficient",
            "[0.0271, 0.0692]",
        ),
    },
)
def _law(contact: object, point: PitchPoint, **table: Sequence[float]) -> Array:
    return measured(point.driving_torque, point.driving_speed, **table)
