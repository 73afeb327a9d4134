"""What a transient contact is given: series over time, checked, on one time axis."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.ehl.roughness import RoughnessProfile
from tribodyn.errors import InputError, Problem, require_positive
from tribodyn.types import Array

#: A number, an array over time, or a function of time.
Series = ArrayLike | Callable[[Array], ArrayLike]

_RAMP = "Begin and end a tooth engagement at 1 to 2 % of the load instead of zero"


@dataclass(frozen=True, eq=False)
class TransientInputs:
    """Inputs of a transient contact, all of the shape of the time."""

    time: Array  #: instants [s]
    load: Array  #: load per width, or its estimate where the approach is imposed [N/m]
    radius: Array  #: reduced radius of curvature [m]
    entrainment_speed: Array  #: HALF the sum of the surface speeds [m/s]
    approach: Array | None  #: imposed approach [m]
    travel: Array  #: distances that the two surfaces have travelled [m]
    profiles: tuple[RoughnessProfile | None, RoughnessProfile | None]


def read_inputs(
    time: ArrayLike,
    load_per_width: Series,
    equivalent_radius: Series,
    entrainment_speed: Series,
    *,
    impose: str,
    approach: Series | None,
    surface_speeds: tuple[Series, Series] | None,
    roughness: tuple[RoughnessProfile | None, RoughnessProfile | None],
) -> TransientInputs:
    """Bring all inputs to the time axis and check them."""
    t = _time(time)
    load = _series("load_per_width", load_per_width, t)
    radius = _series("equivalent_radius", equivalent_radius, t)
    speed = _series("entrainment_speed", entrainment_speed, t)
    require_positive("load_per_width", load, "N/m", remedy=_RAMP)
    require_positive("equivalent_radius", radius, "m")
    _require_speed(speed)
    _require_impose(impose, approach)
    given = None if approach is None else _series("approach", approach, t)
    travel = _travel(t, speed, surface_speeds, roughness)
    return TransientInputs(t, load, radius, speed, given, travel, roughness)


def _time(time: ArrayLike) -> Array:
    t = np.asarray(time, dtype=float).reshape(-1)
    if t.size < 2 or not np.all(np.isfinite(t)) or np.any(np.diff(t) <= 0.0):
        raise InputError(
            Problem(
                what=f"{t.size} instants"
                + ("" if t.size < 2 else f", least step {np.min(np.diff(t)):.4g} s"),
                where="argument time",
                why="time must hold at least two finite instants that rise",
                remedy="200 to 800 steps a mesh cycle, as numpy.linspace(0, duration, 401)",
            )
        )
    return t


def _series(name: str, given: Series, t: Array) -> Array:
    values = np.asarray(given(t) if callable(given) else given, dtype=float)
    if values.ndim > 0 and values.shape != t.shape:
        raise InputError(
            Problem(
                what=f"{name} has the shape {values.shape}",
                where=f"argument {name}",
                why=f"time has the shape {t.shape}",
                remedy="Give a number, one value per instant, or a function of time",
            )
        )
    bad = np.flatnonzero(~np.isfinite(np.atleast_1d(values)))
    if bad.size:
        raise InputError(
            Problem(
                what=f"{name} is {np.atleast_1d(values)[bad[0]]} at instant {bad[0]}",
                where=f"argument {name}",
                why="all values must be finite",
            )
        )
    return np.ascontiguousarray(np.broadcast_to(values, t.shape))


def _require_speed(speed: Array) -> None:
    if np.any(speed < 0.0):
        i = int(np.argmin(speed))
        raise InputError(
            Problem(
                what=f"entrainment_speed = {speed[i]:.6g} m/s at instant {i}",
                where="argument entrainment_speed",
                why="the oil enters at the negative end of the grid: the speed must be zero or "
                "positive",
                remedy="Mirror the contact, so that the surfaces roll in positive direction",
            )
        )


def _require_impose(impose: str, approach: Series | None) -> None:
    if impose not in ("load", "approach"):
        raise InputError(
            Problem(
                what=f'impose = "{impose}"',
                where="argument impose",
                why="Known: load, approach",
            )
        )
    if (impose == "approach") != (approach is not None):
        raise InputError(
            Problem(
                what=f'impose = "{impose}" with '
                + ("an approach" if approach is not None else "no approach"),
                where="arguments impose and approach",
                why="exactly one of load and approach is imposed, the other is the answer",
                remedy='Give approach together with impose = "approach", and only then',
            )
        )


def _travel(
    t: Array,
    speed: Array,
    surface_speeds: tuple[Series, Series] | None,
    roughness: tuple[RoughnessProfile | None, RoughnessProfile | None],
) -> Array:
    """Distances that the surfaces have travelled, by the trapezoidal rule."""
    if surface_speeds is None:
        if any(profile is not None for profile in roughness):
            raise InputError(
                Problem(
                    what="a roughness profile without surface speeds",
                    where="argument surface_speeds",
                    why="each surface carries its roughness at its own speed",
                    remedy="Give (u_1, u_2); both are entrainment_speed in pure rolling",
                )
            )
        return np.zeros((2, t.size))
    speeds = np.array([_series("surface_speeds", item, t) for item in surface_speeds])
    mean = 0.5 * (speeds[0] + speeds[1])
    apart = np.abs(mean - speed)
    if np.any(apart > 1e-6 * np.max(np.abs(speeds))):
        i = int(np.argmax(apart))
        raise InputError(
            Problem(
                what=f"surface speeds {speeds[0, i]:.6g} and {speeds[1, i]:.6g} m/s, "
                f"entrainment_speed {speed[i]:.6g} m/s at instant {i}",
                where="arguments surface_speeds and entrainment_speed",
                why="the entrainment speed is HALF the sum of the surface speeds",
            )
        )
    steps = 0.5 * (speeds[:, 1:] + speeds[:, :-1]) * np.diff(t)
    return np.concatenate((np.zeros((2, 1)), np.cumsum(steps, axis=1)), axis=1)
