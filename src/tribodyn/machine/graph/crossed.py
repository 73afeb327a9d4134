"""Axes that cross or intersect: how the shafts of hypoid and bevel gears lie to each other."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from tribodyn.errors import Argument, InputError
from tribodyn.gear import HypoidBlank, Misalignment
from tribodyn.gear.hypoid.wheel_flanks import hand_sense, pair_axes, wheel_flank
from tribodyn.machine.fields import quoted
from tribodyn.types import Array

Reference = Literal["calculation-point", "crossing-point"]
#: Points of a gear that its position may be that of.
REFERENCES = ("calculation-point", "crossing-point")
#: Sliding over the speed of the pitch circle that is rounding.
_ROLLING = 1e-9
_Z = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, eq=False)
class CrossedAxes:
    """Axes of a hypoid or bevel pair, and the normals of its flanks.

    Parameters
    ----------
    blank : HypoidBlank
        Dimensions of the pair; without an offset it is a bevel pair.
    apex : (int, int)
        Side of pinion and wheel on which their apex lies: 1 towards x of the shaft, -1 against it.
    reference : str or (str, str)
        What the position of a gear, or of pinion and wheel, is that of: ``"calculation-point"``,
        the middle of the face, or ``"crossing-point"``, where the common perpendicular of the axes
        meets the axis.

    Raises
    ------
    InputError
        If a value is none of these.

    Notes
    -----
    Forces act in the calculation point, along the normal of the flank that carries.

    Examples
    --------
    >>> import math
    >>> from tribodyn.gear import hypoid_blank
    >>> blank = hypoid_blank(10, 43, 31.7e-3, 0.336, 47.7e-3, math.radians(46.0), 0.1143)
    >>> CrossedAxes(blank, apex=(1, -1)).reference
    ('calculation-point', 'calculation-point')
    """

    blank: HypoidBlank
    apex: tuple[int, int] = (1, 1)
    reference: Reference | tuple[Reference, Reference] = "calculation-point"

    def __post_init__(self) -> None:
        if not isinstance(self.blank, HypoidBlank):
            what, remedy = f"blank = {quoted(self.blank)}", "Give what hypoid_blank returns"
            raise InputError(what, Argument("CrossedAxes.blank"), "Wanted: a HypoidBlank", remedy)
        if tuple(self.apex) not in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
            what, why = f"apex = {quoted(self.apex)}", "Wanted: two signs, of pinion and wheel"
            raise InputError(what, Argument("CrossedAxes.apex"), why, "Give for example (1, -1)")
        names = self.reference
        object.__setattr__(self, "reference", 2 * (names,) if isinstance(names, str) else names)
        if len(self.reference) != 2 or any(name not in REFERENCES for name in self.reference):
            what, why = f"reference = {quoted(names)}", "A gear has two points to place"
            remedy = f"Choose {' or '.join(REFERENCES)}"
            raise InputError(what, Argument("CrossedAxes.reference"), why, remedy)


class CrossedGeometry:
    """Geometry of a pair whose common perpendicular has a direction about the pinion's shaft."""

    # Vectors of the pair are in the frame of tribodyn.gear.hypoid.envelope, whose origin is the
    # crossing point of the wheel.

    def __init__(self, crossed: CrossedAxes, angle: float) -> None:
        self.blank, self.apex, self._angle = crossed.blank, crossed.apex, angle
        self.pair = pair_axes(crossed.blank)
        self.crossing = self.pair.origin, np.zeros(3)
        distances = crossed.blank.calculation_point_pinion, crossed.blank.calculation_point_wheel
        self._outward = self.pair.axis, _Z
        #: Points that the positions of both gears are those of.
        self.nodes = tuple(
            point + (name == "calculation-point") * distance * way
            for name, point, distance, way in zip(
                crossed.reference, self.crossing, distances, self._outward, strict=True
            )
        )

    @property
    def sense(self) -> int:
        """Sign of the wheel's speed over that of the pinion, about x of their shafts."""
        return -self.apex[0] * self.apex[1]

    @cached_property
    def frames(self) -> tuple[Array, Array]:
        """Axes of both shafts as rows; y of the wheel's lies along the common perpendicular."""
        perpendicular = np.array([hand_sense(self.blank), 0.0, 0.0])
        frames = []
        for apex, outward, turn in zip(self.apex, self._outward, (self._angle, 0.0), strict=True):
            way = -apex * outward
            across, cosine, sine = np.cross(way, perpendicular), np.cos(turn), np.sin(turn)
            y, z = cosine * perpendicular - sine * across, sine * perpendicular + cosine * across
            frames.append(np.array([way, y, z]))
        return frames[0], frames[1]

    @property
    def turn(self) -> Array:
        """Axes of the wheel's shaft, as columns, in the frame of that of the pinion."""
        return np.asarray(self.frames[0] @ self.frames[1].T)

    @property
    def shift(self) -> Array:
        """From the node of the pinion to that of the wheel, in the frame of the pinion's shaft."""
        return np.asarray(self.frames[0] @ (self.nodes[1] - self.nodes[0]))

    def side(self, sense: int) -> str:
        """Flank that carries a torque of the pinion of this sign about x: drive or coast."""
        point, normal = self._flanks["drive"]
        drives = np.cross(point - self.pair.origin, normal) @ self.pair.axis
        return "drive" if -self.apex[0] * drives * sense > 0.0 else "coast"

    def levers(self, sense: int) -> tuple[float, float]:
        """Levers of the normal about both axes [m]."""
        point, normal = self._flanks[self.side(sense)]
        about = np.cross(point - self.pair.origin, normal) @ self.pair.axis
        return abs(float(about)), abs(float(np.cross(point, normal)[2]))

    @property
    def working_radii(self) -> tuple[float, float]:
        """Distances of the calculation point from both axes [m]."""
        blank = self.blank
        return 0.5 * blank.mean_pitch_diameter_pinion, 0.5 * blank.mean_pitch_diameter_wheel

    def pressure_angle(self, sense: int) -> float:
        """Generated normal pressure angle of the flank that carries [rad]."""
        return float(getattr(self.blank, f"normal_pressure_angle_{self.side(sense)}"))

    def along(self, sense: int) -> Array:
        """Derivative of the compression by the 12 coordinates of both gears."""
        return self._acting(sense, self._flanks[self.side(sense)][1])

    def sliding(self, sense: int, speed: int) -> Array:
        """Likewise of the way of the pinion's flank over that of the wheel, by a sign of speed."""
        way = self.pair.sliding(self._flanks[self.side(sense)][0])
        amount = float(np.linalg.norm(way))
        if amount < _ROLLING * self.working_radii[0]:  # intersecting axes
            return np.zeros(12)
        return self._acting(sense, -self.apex[0] * speed * way / amount)

    def _acting(self, sense: int, way: Array) -> Array:
        point, parts = self._flanks[self.side(sense)][0], []
        for sign, frame, node in zip((1.0, -1.0), self.frames, self.nodes, strict=True):
            parts += [sign * frame @ way, sign * frame @ np.cross(point - node, way)]
        return np.concatenate(parts)

    def pair_coordinates(self, senses: tuple[int, int]) -> Array:
        """Coordinates of a mesh table in space by those of both gear nodes, (12, 12)."""
        # They are x along the common perpendicular, y along the axis in the running sense, z, and
        # rotations, about the crossing points.
        rows, x = np.zeros((12, 12)), np.array([1.0, 0.0, 0.0])
        for gear, frame in enumerate(self.frames):
            axis = senses[gear] * frame[0]
            local = np.array([x, axis, np.cross(x, axis)]) @ frame.T
            arm = float((self.crossing[gear] - self.nodes[gear]) @ frame[0])
            moved, turned = (slice(6 * gear + i, 6 * gear + i + 3) for i in (0, 3))
            rows[moved, moved] = rows[turned, turned] = local
            # The crossing point moves with the rotations of the node about y and z.
            rows[moved, turned] = local @ [[0.0, 0.0, 0.0], [0.0, 0.0, arm], [0.0, -arm, 0.0]]
        return rows

    def misalignment(self, displacement: Array) -> Misalignment:
        """Mounting errors that displacements of both gear nodes (2, 6) amount to."""
        starts, ways = [], []
        for frame, node, outward, moved in zip(
            self.frames, self.nodes, self._outward, displacement, strict=True
        ):
            starts.append(node + moved[:3] @ frame)
            way = outward + np.cross(moved[3:] @ frame, outward)
            ways.append(way / np.linalg.norm(way))
        (a, b), between = ways, starts[1] - starts[0]
        # Feet of the common perpendicular on both axes, counted from the nodes.
        feet = np.linalg.solve([[1.0, -a @ b], [a @ b, -1.0]], [a @ between, b @ between])
        across = starts[0] + feet[0] * a - starts[1] - feet[1] * b
        nominal = [(node - at) @ out for node, at, out in
                   zip(self.nodes, self.crossing, self._outward, strict=True)]  # fmt: skip
        return Misalignment(
            offset=-hand_sense(self.blank) * float(across[0]) - self.blank.offset,
            pinion_axial=float(-feet[0] - nominal[0]),
            wheel_axial=float(-feet[1] - nominal[1]),
            shaft_angle=float(np.arccos(a @ b)) - self.blank.shaft_angle,
        )

    @cached_property
    def _flanks(self) -> dict[str, tuple[Array, Array]]:
        """Calculation point and normal out of the pinion of both sides."""
        sides = {side: wheel_flank(self.blank, side) for side in ("drive", "coast")}
        return {side: (flank.point, flank.normal) for side, flank in sides.items()}
