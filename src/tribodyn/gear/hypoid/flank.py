"""Flanks of one side as grids of points, with undercut and interference, for export."""

from __future__ import annotations

import os
from dataclasses import field
from functools import cached_property
from pathlib import Path

import numpy as np

from tribodyn.errors import Argument, InputError, require_one_of, shortened, warn
from tribodyn.files import atomic_write
from tribodyn.gear.hypoid.blank import HypoidBlank
from tribodyn.gear.hypoid.conjugate import ConjugateFlanks
from tribodyn.gear.hypoid.ease_off import EaseOff, eased_gap, working_depth
from tribodyn.gear.hypoid.envelope import turned
from tribodyn.nomenclature import GEARS, require_whole
from tribodyn.record import Record, fact, figure_method, quantity, record
from tribodyn.types import Array, Mask, Tree

SIDES = ("drive", "coast")
_GRID = ("length", "profile")


@record
class HypoidFlanks(Record):
    """Flanks of pinion and wheel on one side of the teeth; made by :func:`hypoid_flanks`.

    The wheel turns about the z axis of its points, the pinion about the y axis of its own; the
    origins are where the common perpendicular meets each axis. Both flanks stand as they touch in
    the calculation point. Normals point out of the pinion into the wheel.

    Parameters
    ----------
    along : array (length,) [m]
        Places along the pitch cone of the wheel from the calculation point towards the heel.
    across : array (length, profile) [m]
        Places across the pitch cone of the wheel towards its tip.
    wheel_position, wheel_normal : array (length, profile, 3) [m]
        Points of the wheel's flank, and unit normals (pure numbers).
    pinion_position, pinion_normal : array (length, profile, 3) [m]
        Points of the pinion's flank that meet them, with the ease-off, and unit normals.
    gap : array (length, profile) [m]
        Ease-off.
    active : array of bool (length, profile)
        Whether the point lies on the flanks of both gears.
    wheel_rotation : array (length, profile) [rad]
        Rotation of the wheel at which the point touches, from the calculation point on.
    relative_curvature : array (length, profile) [1/m]
        Curvature of the gap across the contact line; not positive where the flanks interfere.
    regularity : array (length, profile) [-]
        Area of the conjugate pinion flank over that of the wheel; not positive where the pinion is
        undercut.
    side : str
        ``"drive"`` or ``"coast"``.
    blank : HypoidBlank
        The blanks.
    ease_off : EaseOff
        What the pinion has less than its conjugate.

    Notes
    -----
    Source: Litvin and Fuentes, Gear Geometry and Applied Theory, 2004, envelope of a surface and
    undercutting.
    """

    along: Array = quantity("length", unit="m", axis=True)
    across: Array = quantity(*_GRID, unit="m")
    wheel_position: Array = quantity(*_GRID, "component", unit="m")
    wheel_normal: Array = quantity(*_GRID, "component", unit="1")
    pinion_position: Array = quantity(*_GRID, "component", unit="m")
    pinion_normal: Array = quantity(*_GRID, "component", unit="1")
    gap: Array = quantity(*_GRID, unit="m")
    active: Mask = quantity(*_GRID, unit="1")
    wheel_rotation: Array = quantity(*_GRID, unit="rad")
    relative_curvature: Array = quantity(*_GRID, unit="1/m")
    regularity: Array = quantity(*_GRID, unit="1")
    side: str = fact()
    blank: HypoidBlank = field()
    ease_off: EaseOff = field()

    @property
    def undercut_share(self) -> float:
        """Share of the active flank on which the pinion is undercut."""
        return float(np.mean(self.regularity[self.active] <= 0.0))

    @property
    def interference_share(self) -> float:
        """Share of the active flank on which the flanks cut into each other."""
        return float(np.mean(self.relative_curvature[self.active] <= 0.0))

    plot_ease_off = figure_method("ease_off", "Draw the ease-off over the flank.")

    @cached_property
    def conjugate(self) -> ConjugateFlanks:
        """The surfaces themselves."""
        return ConjugateFlanks(self.blank, self.side, self.ease_off)

    def points(self, gear: str) -> tuple[Array, Array]:
        """Points and outward normals of the flank of one tooth.

        Parameters
        ----------
        gear : str
            ``"pinion"`` or ``"wheel"``.

        Returns
        -------
        tuple of array (length, profile, 3) [m], [-]
            Points, and unit normals out of the tooth.

        Raises
        ------
        InputError
            If the gear is neither.
        """
        gear = require_one_of("gear", gear, GEARS)
        outward = 1.0 if gear == "pinion" else -1.0
        return getattr(self, f"{gear}_position"), outward * getattr(self, f"{gear}_normal")

    def to_csv(self, path: str | os.PathLike[str], gear: str) -> Path:
        """Write points and outward normals of the flank of one tooth.

        Parameters
        ----------
        path : str or path
            File to write, in mm; an existing one is replaced at once.
        gear : str
            ``"pinion"`` or ``"wheel"``.
        """
        position, normal = self.points(gear)
        rows = np.hstack([1e3 * position.reshape(-1, 3), normal.reshape(-1, 3)])
        lines = [
            "x [mm],y [mm],z [mm],nx,ny,nz",
            *(",".join(map(repr, row)) for row in rows.tolist()),
        ]
        return _written(path, "\n".join(lines) + "\n")

    def to_stl(self, path: str | os.PathLike[str], gear: str) -> Path:
        """Write the flanks of all teeth of one gear as triangles.

        Parameters
        ----------
        path, gear
            As :meth:`to_csv` takes them.
        """
        position, normal = self.points(gear)
        a, b, c, d = (
            position[rows, columns]
            for rows, columns in (
                (slice(None, -1), slice(None, -1)),
                (slice(1, None), slice(None, -1)),
                (slice(1, None), slice(1, None)),
                (slice(None, -1), slice(1, None)),
            )
        )
        corners = np.stack([np.stack([a, b, c], axis=-2), np.stack([a, c, d], axis=-2)])
        facing = np.cross(
            corners[..., 1, :] - corners[..., 0, :], corners[..., 2, :] - corners[..., 0, :]
        )
        if np.sum(facing * normal[:-1, :-1]) < 0.0:
            corners, facing = corners[..., ::-1, :], -facing
        corners, facing = corners.reshape(-1, 3, 3), facing.reshape(-1, 3)
        facing /= np.linalg.norm(facing, axis=-1, keepdims=True)
        axis = np.array([0.0, 1.0, 0.0] if gear == "pinion" else [0.0, 0.0, 1.0])
        lines = [f"solid {gear}"]
        for angle in np.arange(teeth := getattr(self.blank, f"teeth_{gear}")) * 2.0 * np.pi / teeth:
            for place, out in zip(
                1e3 * turned(corners, axis, angle), turned(facing, axis, angle), strict=True
            ):
                lines.append(f"facet normal {_numbers(out)}\nouter loop")
                lines += [f"vertex {_numbers(corner)}" for corner in place]
                lines.append("endloop\nendfacet")
        return _written(path, "\n".join([*lines, f"endsolid {gear}", ""]))


def _numbers(vector: Array) -> str:
    return " ".join(f"{value:.9g}" for value in vector)


def _written(path: str | os.PathLike[str], text: str) -> Path:
    if not isinstance(path, str | os.PathLike):
        what = f"path = {shortened(repr(path))}"
        why = "Wanted: the name of a file"
        raise InputError(what, Argument("path"), why, "Give it as a text or a Path")
    with atomic_write(Path(path)) as partial:
        partial.write_text(text, "utf-8")
    return Path(path)


def hypoid_flanks(
    blank: HypoidBlank, side: str = "drive", ease_off: EaseOff | None = None, *, points: int = 41
) -> HypoidFlanks:
    """Flanks of a Formate wheel and of the pinion that it envelops.

    Parameters
    ----------
    blank : HypoidBlank
        The blanks.
    side : str
        ``"drive"``, on which the pinion is concave, or ``"coast"``.
    ease_off : EaseOff, optional
        What the pinion has less than its conjugate; nothing by default.
    points : int
        Points along the face and over the working depth, from 5 on.

    Raises
    ------
    InputError
        If an argument is wrong, or the cutter does not reach the whole face of the wheel.

    Warns
    -----
    ModelWarning
        ``hypoid-undercut`` and ``hypoid-interference`` with the share of the flank.

    Notes
    -----
    The mean cutter radius is taken on the flank itself.

    Examples
    --------
    >>> import math
    >>> from tribodyn.gear import hypoid_blank
    >>> blank = hypoid_blank(10, 43, 31.7e-3, 0.336, 47.7e-3, math.radians(46.0), 0.1143)
    >>> flanks = hypoid_flanks(blank, ease_off=EaseOff(lengthwise_crowning=30e-6))
    >>> flanks.undercut_share, round(float(flanks.gap.max()) * 1e6)
    (0.0, 31)
    """
    side = require_one_of("side", side, SIDES)
    count = require_whole("points", points, 5)
    if count > 1000:
        what = f"points = {count}"
        raise InputError(what, Argument("points"), "At most 1000 are made", "Give 1000 at most")
    flanks = ConjugateFlanks(blank, side, ease_off or EaseOff())
    mean = blank.mean_cone_distance_wheel
    along = np.linspace(
        blank.inner_cone_distance_wheel - mean, blank.outer_cone_distance_wheel - mean, count
    )
    (low, _), (high, _) = working_depth(blank, along)
    across = low[:, None] + np.linspace(0.0, 1.0, count) * (high - low)[:, None]
    places = np.stack(np.broadcast_arrays(along[:, None], across), axis=-1)
    surfaces = _grid(flanks, places)
    result = HypoidFlanks(
        along=along, across=across, side=side, blank=blank, ease_off=flanks.ease_off, **surfaces
    )
    _warn(result)
    return result


def _grid(flanks: ConjugateFlanks, places: Array) -> Tree:
    touch = flanks.touch(places)
    curvature = touch.curvature
    parameters = flanks.wheel.parameters(places)
    wheel, opening = flanks.wheel.at(parameters), np.array(flanks.blank.shaft_angle - 0.5 * np.pi)
    position, normal = (
        turned(each, np.array([1.0, 0.0, 0.0]), opening) for each in flanks.pinion_at(parameters)
    )
    if not np.all(np.isfinite(parameters)):
        radius = flanks.blank.cutter_radius * 1e3
        what, where = f"cutter_radius = {radius:.6g} mm", Argument("blank.cutter_radius")
        why = "Part of the wheel's flank is out of the cutter's reach"
        raise InputError(what, where, why, "Choose a larger cutter or a smaller face width")
    lost = float(np.mean(~np.isfinite(touch.contact.rotation)))
    if lost > 0.0:
        what, where = f"{lost:.1%} of the wheel's flank never touches a pinion", Argument("blank")
        why = "Its normals pass the pinion's axis at every rotation"
        remedy = "Give a smaller face width, offset or depth, or a smaller spiral angle"
        raise InputError(what, where, why, remedy)
    return {
        "wheel_position": wheel.position,
        "wheel_normal": wheel.normal,
        "pinion_position": position,
        "pinion_normal": normal,
        "gap": eased_gap(flanks.ease_off, flanks.blank, places)[0],
        "active": np.all(flanks.margins(touch) >= 0.0, axis=-1),
        "wheel_rotation": touch.contact.rotation,
        "relative_curvature": curvature.tensor[..., 1, 1],
        "regularity": curvature.regularity,
    }


def _warn(flanks: HypoidFlanks) -> None:
    location = (
        f"of the active {flanks.side} flank; give the pinion more teeth, a larger spiral angle or "
        "a smaller working depth"
    )
    undercut, cutting = flanks.undercut_share, flanks.interference_share
    if undercut > 0.0:
        message = f"the pinion is undercut on {undercut:.1%} {location}"
        warn("hypoid-undercut", message, stacklevel=3)
    if cutting > 0.0:
        message = f"the flanks cut into each other on {cutting:.1%} {location}"
        warn("hypoid-interference", message, stacklevel=3)
