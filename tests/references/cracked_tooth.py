"""Compliance of root cracks by triangles: ``python tests/references/cracked_tooth.py``.

The triangles of ``gear_compliance.py`` on the whole gear, bore held, with the nodes of the crack
doubled and the mesh graded to its tip, down to 0.003 modules. The crack begins where the tangent of
the curve of the tip round has an angle to the centre line of the tooth. The compliance of the crack
is the displacement along a point force on the flank, less that of the sound gear with the same
mesh. Nothing of tribodyn is used. Lengths in mm, forces in N, angles in degrees.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.sparse.linalg import splu
from scipy.spatial import cKDTree

from references.gear_compliance import Gear, Outline, _stiffness, outline_of

#: Radii of curvature of the loads [mm]; the tip of the pinion has 19.99.
RADII = (8.0, 13.0, 18.0)
#: Gear, depth [mm], angle of crack and of tangent to the centre line -> compliance [1e-6 mm^2/N].
CRACKS: dict[tuple[str, float, float, float], tuple[float, float, float]] = {
    ("type C pinion", 1.0, 90.0, 30.0): (1.4518, 1.733, 2.7268),
    ("type C pinion", 2.5, 90.0, 30.0): (4.9694, 6.5592, 11.497),
    ("type C pinion", 4.0, 90.0, 35.0): (11.5005, 15.0758, 27.3608),
    ("type C pinion", 2.5, 60.0, 30.0): (7.9219, 9.1118, 13.3356),
    ("type C pinion", 2.5, 45.0, 35.0): (7.8844, 8.6167, 11.6352),
    ("type A wheel", 2.0, 70.0, 35.0): (14.1016, 16.1745, 21.2078),
}
#: Shallow cracks square to a tooth of 4 mm module at the tangent of 30 deg, by depth [mm].
SHALLOW_GEAR = (22, 0.4, 0.0)
SHALLOW: dict[float, tuple[float, float, float]] = {
    0.2: (0.1290, 0.1440, 0.2119),
    0.5: (0.6005, 0.6973, 1.0627),
    1.0: (1.6246, 2.0279, 3.2613),
}


@dataclass(frozen=True)
class Crack:
    """A straight line from the fillet into the tooth."""

    start: np.ndarray
    direction: np.ndarray
    depth: float

    @classmethod
    def at(cls, outline: Outline, depth: float, angle: float, tangent: float) -> Crack:
        """Begin where the tangent has this angle; the lower part of the profile is the fillet."""
        radius, half = outline.profile.T
        x, y = radius * np.sin(half), radius * np.cos(half)
        slope = np.degrees(np.arctan2(-np.diff(x), np.diff(y)))  # from the root circle up
        first = int(np.argmax(slope < tangent))
        start = np.array([x[first], y[first]])
        turn = math.radians(angle)
        return cls(start, -np.array([math.sin(turn), math.cos(turn)]), depth)

    @property
    def tip(self) -> np.ndarray:
        """End in the tooth."""
        return self.start + self.depth * self.direction


class CrackedGear(Gear):
    """Triangles whose edges lie on a crack."""

    def __init__(self, outline: Outline, crack: Crack, least: float = 0.003) -> None:
        self.crack, self.least = crack, least
        loads = np.array([outline.flank_point(radius)[0] for radius in RADII])
        super().__init__(outline, crack.tip[None], loads)

    def spacing(self, points: np.ndarray) -> np.ndarray:
        m, o = self.outline.module, self.outline
        along = np.linspace(0.0, 1.0, 200)[:, None] * self.crack.depth * self.crack.direction
        crack = cKDTree(self.crack.start + along).query(points)[0]
        loads = cKDTree(self.loads).query(points)[0]
        tip = np.hypot(*(points - self.crack.tip).T)
        depth = np.maximum(0.0, o.profile[0, 0] - np.hypot(*points.T))
        near = np.hypot(points[:, 0], points[:, 1] - o.tip_radius) < 4.0 * m
        wide = np.minimum(np.where(near, 0.15, 0.3) * m + 0.4 * depth, 0.2 * o.bore_radius)
        wide = np.minimum(wide, 0.04 * m + 0.3 * np.minimum(loads, crack))
        return np.asarray(np.minimum(wide, self.least * m + 0.2 * tip))

    def _boundary(self) -> np.ndarray:
        line = self.crack.start + self._steps()[:-1, None] * self.crack.direction
        points = super()._boundary()
        far = cKDTree(line).query(points)[0]
        near_loads = cKDTree(self.loads).query(points)[0]
        wanted = self.spacing(points)
        points = points[(far > 0.5 * wanted) & (near_loads > 0.5 * wanted)]
        return np.concatenate((points, line, self.loads))

    def _steps(self) -> np.ndarray:
        """Distances of nodes from the surface on."""
        fine = np.linspace(0.0, self.crack.depth, 2001)
        sizes = self.spacing(self.crack.start + fine[:, None] * self.crack.direction)
        count = np.concatenate(([0.0], np.cumsum(np.diff(fine) / sizes[1:])))
        return np.interp(np.linspace(0.0, count[-1], math.ceil(count[-1]) + 1), count, fine)

    def compliances(self) -> tuple[float, float, float]:
        """What the crack adds at the loads [1e-6 mm^2/N]."""
        away = self.points - self.crack.start
        direction = self.crack.direction
        along, above = away @ direction, away @ np.array([direction[1], -direction[0]])
        tip = along > self.crack.depth * (1.0 - 1e-9)
        seam = np.flatnonzero((np.abs(above) < 1e-9) & (along > -1e-9) & ~tip)
        twin = np.arange(len(self.points))
        twin[seam] = len(self.points) + np.arange(seam.size)
        corners = self.points[self.triangles[:, :3]].mean(axis=1) - self.crack.start
        upper = corners @ np.array([direction[1], -direction[0]]) > 0.0
        opened = np.where(upper[:, None], twin[self.triangles], self.triangles)
        points = np.concatenate((self.points, self.points[seam]))
        matrix = _stiffness(points, opened)
        free = np.concatenate((self.free, 2 * len(self.points) + np.arange(2 * seam.size)))
        solver = splu(matrix[free][:, free].tocsc())
        added = []
        for radius in RADII:
            place, normal, _ = self.outline.flank_point(radius)
            node = int(np.argmin(np.hypot(*(self.points - place).T)))
            force = np.zeros(2 * len(points))
            force[2 * node : 2 * node + 2] = normal
            cracked = force[free] @ solver.solve(force[free])
            sound = force[self.free] @ self.solver.solve(force[self.free])
            added.append(float(1e6 * (cracked - sound)))
        return added[0], added[1], added[2]


def compliances(
    name: str | tuple[int, float, float],
    depth: float,
    angle: float,
    tangent: float,
    least: float = 0.003,
) -> tuple[float, float, float]:
    """Compliances of a crack of the table."""
    outline = outline_of(name)
    least = min(least, 0.08 * depth / outline.module)
    return CrackedGear(outline, Crack.at(outline, depth, angle, tangent), least).compliances()


if __name__ == "__main__":
    for crack, expected in CRACKS.items():
        print(*crack, "stated", expected, " found", np.round(compliances(*crack), 4))
    for depth, expected in SHALLOW.items():
        computed = np.round(compliances(SHALLOW_GEAR, depth, 90.0, 30.0), 4)
        print(SHALLOW_GEAR, depth, "stated", expected, " found", computed)
