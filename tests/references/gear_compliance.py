"""Compliances of whole gears by triangles: ``python tests/references/gear_compliance.py``.

Plane stress, six-node triangles on the outline of the whole gear, bore held, E 206 GPa, nu 0.3,
dedendum 1.25 and tip round 0.38 of the module. The tooth is the envelope of the rack: involute, and
the curve that the tip round of the rack leaves. The load is a Hertz pressure of half width 0.02
modules along the normal of the flank; its compression ``2/(pi E) (ln(2 h/a) - nu/2)`` with the
depth ``h`` of the tooth axis is taken off. Points are spaced by the distance from load and root and
joined by Delaunay. Nothing of tribodyn is used. Lengths in mm, forces in N.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu
from scipy.spatial import Delaunay, cKDTree

MODULUS, POISSON = 206e3, 0.3
ANGLE = math.radians(20.0)
#: Half width of the load over the module.
PATCH = 0.02

#: Gear -> radii of curvature [mm], self compliances [1e-5 mm^2/N], and compliances of the next
#: tooth [1e-6 mm^2/N] for loads at these radii seen at the same radii in reverse.
TRIANGLES = {
    "type A pinion": (
        (14.1331, 19.5569, 24.9808), (1.422, 1.9369, 3.2286), (8.2879, 7.6713, 7.0939),
    ),
    "type A wheel": (
        (5.3375, 12.3197, 19.3018), (4.3185, 5.0495, 7.1315), (15.6347, 16.0172, 15.9874),
    ),
    "type C pinion": (
        (5.9544, 12.56, 19.1656), (1.9786, 2.4806, 3.9513), (7.3944, 7.4156, 7.1132),
    ),
    "type C wheel": (
        (12.1457, 19.0109, 25.8761), (2.6645, 3.294, 4.837), (16.4473, 16.3282, 16.0036),
    ),
    (20, 0.6, 0.0): (
        (6.1633, 12.4294, 18.6954), (1.878, 2.4577, 4.0945), (4.9106, 5.0258, 4.8719),
    ),
    (25, 0.2, 0.5): (
        (15.0971, 20.8621, 26.6271), (3.8667, 4.4883, 5.9723), (31.2419, 30.8142, 30.2911),
    ),
    (32, 0.75, 0.0): (
        (14.5027, 20.965, 27.4273), (1.3745, 2.0673, 3.723), (3.299, 3.2076, 3.0845),
    ),
    (40, 0.95, 0.0): (
        (20.0292, 26.5728, 33.1164), (0.725, 1.3245, 2.7407), (0.5216, 0.4641, 0.43),
    ),
}  # fmt: skip


@dataclass(frozen=True)
class Outline:
    """A gear cut by a rack, tooth 0 on the axis of y."""

    teeth: int
    module: float
    shift: float
    tip_radius: float
    bore_radius: float

    @property
    def base_radius(self) -> float:
        """Of the involute."""
        return 0.5 * self.module * self.teeth * math.cos(ANGLE)

    def involute_half(self, radius: np.ndarray) -> np.ndarray:
        """Half angle of the tooth on its involute."""
        turned = np.arccos(np.minimum(1.0, self.base_radius / radius))
        start = (0.5 * math.pi + 2.0 * self.shift * math.tan(ANGLE)) / self.teeth
        return np.asarray(start + math.tan(ANGLE) - ANGLE - (np.tan(turned) - turned))

    @cached_property
    def profile(self) -> np.ndarray:
        """Radius and half angle of the tooth from the root circle to the tip."""
        m, r = self.module, 0.5 * self.module * self.teeth
        below = (1.25 - 0.38 - self.shift) * m
        side = 0.25 * math.pi * m - (1.25 - 0.38) * m * math.tan(ANGLE) - 0.38 * m / math.cos(ANGLE)
        across = np.linspace(0.0, below / math.tan(ANGLE), 400)
        length = np.hypot(across, below)
        x = across * (1.0 + 0.38 * m / length)
        y = r - below * (1.0 + 0.38 * m / length)
        # the rack has moved by across - side, and the gear has turned with it
        angle = np.arctan2(x, y) - (across - side) / r
        radius, half = np.hypot(x, y), math.pi / self.teeth - angle
        undercut = below > r * math.sin(ANGLE) ** 2
        first = max(self.base_radius, radius[0]) if undercut else radius[-1]
        used = np.linspace(first + 1e-9, self.tip_radius, 400)
        if undercut:  # the flank begins where it leaves the curve of the tip round
            fillet = np.interp(used, radius, half, right=np.inf)
            used = used[self.involute_half(used) <= fillet]
        fillet_end = used[0]
        low = radius < fillet_end
        return np.column_stack(
            (
                np.concatenate((radius[low], used)),
                np.concatenate((half[low], self.involute_half(used))),
            )
        )

    def flank_point(self, curvature: float, tooth: int = 0) -> tuple[np.ndarray, np.ndarray, float]:
        """Place on the right flank, inward normal, and depth of the tooth axis along it."""
        radius = math.hypot(self.base_radius, curvature)
        half = float(self.involute_half(np.array([radius]))[0])
        # the normal touches the base circle
        slope = math.acos(self.base_radius / radius) - half
        place = radius * np.array([math.sin(half), math.cos(half)])
        normal = -np.array([math.cos(slope), math.sin(slope)])
        depth = place[0] / -normal[0]
        turn = -2.0 * math.pi * tooth / self.teeth
        c, s = math.cos(turn), math.sin(turn)
        rotation = np.array([[c, -s], [s, c]])
        return rotation @ place, rotation @ normal, depth

    def half_at(self, radius: np.ndarray) -> np.ndarray:
        """Half angle at any radius, half a pitch in the body, nothing outside."""
        profile = self.profile
        half = np.interp(
            radius, profile[:, 0], profile[:, 1], left=math.pi / self.teeth, right=-1.0
        )
        return np.where(radius < profile[0, 0], math.pi / self.teeth, half)

    def inside(self, points: np.ndarray) -> np.ndarray:
        """Whether points lie in the gear."""
        radius, angle = np.hypot(*points.T), np.arctan2(points[:, 0], points[:, 1])
        pitch = 2.0 * math.pi / self.teeth
        off = np.abs((angle + 0.5 * pitch) % pitch - 0.5 * pitch)
        return (radius > self.bore_radius) & (off < self.half_at(radius))


class Gear:
    """Triangles of a gear and the factorized equations, fine about given places."""

    def __init__(self, outline: Outline, places: np.ndarray, loads: np.ndarray) -> None:
        self.outline, self.places, self.loads = outline, places, loads
        boundary = self._boundary()
        inner = self._inner(boundary)
        points = np.concatenate((places, boundary, inner))
        corners = self._triangles(points)
        self.points, self.triangles = _with_middles(points, corners)
        radius = np.hypot(*self.points.T)
        self.held = radius < outline.bore_radius * (1.0 + 1e-7) + 1e-9
        free = np.repeat(~self.held, 2)
        self.free = np.flatnonzero(free)
        matrix = _stiffness(self.points, self.triangles)[self.free][:, self.free]
        self.solver = splu(matrix.tocsc())

    def spacing(self, points: np.ndarray) -> np.ndarray:
        """Wanted distance of neighbours."""
        m, o = self.outline.module, self.outline
        load_distance = cKDTree(self.loads).query(points)[0]
        distance = cKDTree(self.places).query(points)[0]
        depth = np.maximum(0.0, o.profile[0, 0] - np.hypot(*points.T))
        wide = np.minimum(0.1 * m + 0.3 * depth, 0.05 * o.bore_radius)
        return np.minimum(
            wide, np.minimum(0.006 * m + 0.25 * load_distance, 0.04 * m + 0.25 * distance)
        )

    def _boundary(self) -> np.ndarray:
        o = self.outline
        profile = o.profile
        right = np.column_stack(
            (profile[:, 0] * np.sin(profile[:, 1]), profile[:, 0] * np.cos(profile[:, 1]))
        )
        width = profile[-1, 1]
        tip = np.linspace(width, -width, 60)[1:-1]
        top = o.tip_radius * np.column_stack((np.sin(tip), np.cos(tip)))
        left = right[::-1] * [-1.0, 1.0]
        root = np.linspace(-profile[0, 1], -2.0 * math.pi / o.teeth + profile[0, 1], 60)[1:-1]
        floor = profile[0, 0] * np.column_stack((np.sin(root), np.cos(root)))
        curve = np.concatenate((right, top, left, floor))
        boundary_points = []
        for tooth in range(o.teeth):
            turn = 2.0 * math.pi * tooth / o.teeth
            c, s = math.cos(turn), math.sin(turn)
            boundary_points.append(curve @ np.array([[c, -s], [s, c]]).T)
        round_bore = np.linspace(0.0, 2.0 * math.pi, 4000)
        bore = o.bore_radius * np.column_stack((np.sin(round_bore), np.cos(round_bore)))
        chains = [
            self._along(np.concatenate((*boundary_points, boundary_points[0][:1]))),
            self._along(bore),
        ]
        points = np.concatenate(chains)
        far = cKDTree(self.places).query(points)[0]
        return np.asarray(points[far > 0.3 * self.spacing(points)])

    def _along(self, chain: np.ndarray) -> np.ndarray:
        """Points on a closed chain at the wanted distances."""
        step = np.hypot(*np.diff(chain, axis=0).T)
        fine = np.concatenate(([0.0], np.cumsum(step)))
        sizes = self.spacing(chain)
        density = np.concatenate(([0.0], np.cumsum(step * 0.5 * (1 / sizes[1:] + 1 / sizes[:-1]))))
        count = math.ceil(density[-1])
        at = np.interp(np.linspace(0.0, density[-1], count, endpoint=False), density, fine)
        return np.column_stack([np.interp(at, fine, chain[:, axis]) for axis in (0, 1)])

    def _inner(self, boundary: np.ndarray) -> np.ndarray:
        """Staggered points of halved distances, each where its distance is wanted."""
        o, points_inside = self.outline, []
        size, least = 0.5 * o.tip_radius, 0.004 * o.module
        tree = cKDTree(np.concatenate((boundary, self.places)))
        sizes = [size * 0.7071**k for k in range(80) if size * 0.7071**k > least]
        centres = np.concatenate(([[0.0, 0.0]], self.places))
        for distance in sizes:
            reach = [o.tip_radius, *[60.0 * distance] * len(self.places)]
            for centre, length in zip(centres, reach, strict=True):
                if length == o.tip_radius and distance < 0.03 * o.module:
                    continue
                length = min(length, 2.0 * o.tip_radius)
                grid = _staggered(centre, length, distance)
                grid = grid[o.inside(grid)]
                want = self.spacing(grid)
                grid = grid[(want >= distance) & (want < distance / 0.7071)]
                if len(grid):
                    off = tree.query(grid)[0]
                    points_inside.append(grid[off > 0.6 * self.spacing(grid)])
        points = np.concatenate(points_inside)
        order = np.argsort(self.spacing(points), kind="stable")
        return _thinned(points[order], self.spacing(points[order]))

    def _triangles(self, points: np.ndarray) -> np.ndarray:
        corners = Delaunay(points).simplices
        middle = points[corners].mean(axis=1)
        a, b, c = (points[corners[:, i]] for i in range(3))
        area = 0.5 * _cross(b - a, c - a)
        longest = np.max([np.hypot(*(p - q).T) for p, q in ((a, b), (b, c), (c, a))], axis=0)
        valid = self.outline.inside(middle) & (np.abs(area) > 1e-4 * longest**2)
        flip = area < 0.0
        corners[flip] = corners[flip][:, [0, 2, 1]]
        return np.asarray(corners[valid])

    def displacement(self, place: np.ndarray, normal: np.ndarray) -> np.ndarray:
        """Displacements of all nodes by a Hertz pressure of unit force about a place."""
        a = PATCH * self.outline.module
        edges = _outer_edges(self.triangles)
        x, weight = np.polynomial.legendre.leggauss(6)
        tangent = np.array([-normal[1], normal[0]])
        force = np.zeros(2 * len(self.points))
        ends = self.points[edges]
        loaded = np.hypot(*(ends[:, 2] - place).T) < 3.0 * a
        for edge, (p, q, middle) in zip(edges[loaded], ends[loaded], strict=True):
            for t, w in zip(x, weight, strict=True):
                shape = np.array([0.5 * t * (t - 1.0), 0.5 * t * (t + 1.0), 1.0 - t * t])
                at = shape @ np.array([p, q, middle])
                offset = (at - place) @ tangent
                if abs(offset) < a:
                    pressure = 2.0 / (math.pi * a) * math.sqrt(1.0 - (offset / a) ** 2)
                    size = 0.5 * np.hypot(*(q - p)) * w * pressure
                    for node, share in zip(edge, shape, strict=True):
                        force[2 * node : 2 * node + 2] += size * share * normal
        total = force.reshape(-1, 2).sum(axis=0) @ normal
        moved = np.zeros_like(force)
        moved[self.free] = self.solver.solve(force[self.free] / total)
        return moved.reshape(-1, 2)


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])


def _staggered(centre: np.ndarray, reach: float, distance: float) -> np.ndarray:
    count = int(reach / distance) + 1
    i, j = np.meshgrid(np.arange(-count, count + 1), np.arange(-count, count + 1))
    x = (i + 0.5 * (j % 2)) * distance
    y = j * distance * math.sqrt(0.75)
    return np.column_stack((x.ravel(), y.ravel())) + centre


def _thinned(points: np.ndarray, spacing: np.ndarray) -> np.ndarray:
    """Leave out points too near to a finer one before them."""
    tree, retained = cKDTree(points), np.ones(len(points), dtype=bool)
    for index, others in enumerate(tree.query_ball_point(points, 0.65 * spacing)):
        if retained[index]:
            later = [other for other in others if other > index]
            retained[later] = False
    return points[retained]


def _with_middles(points: np.ndarray, corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    pairs = np.sort(corners[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    unique, back = np.unique(pairs, axis=0, return_inverse=True)
    middles = points[unique].mean(axis=1)
    used = np.unique(corners)
    renumber = np.full(len(points), -1)
    renumber[used] = np.arange(len(used))
    six = np.hstack((renumber[corners], len(used) + back.reshape(-1, 3)))
    return np.concatenate((points[used], middles)), six


def _outer_edges(triangles: np.ndarray) -> np.ndarray:
    """Both ends and middle of the edges that belong to one triangle."""
    edges = triangles[:, [0, 1, 3, 1, 2, 4, 2, 0, 5]].reshape(-1, 3)
    _, first, count = np.unique(edges[:, 2], return_index=True, return_counts=True)
    return np.asarray(edges[first[count == 1]])


def _stiffness(points: np.ndarray, triangles: np.ndarray) -> coo_matrix:
    """Plane stress stiffness of straight six-node triangles, thickness one."""
    plane = MODULUS / (1.0 - POISSON**2) * np.array(
        [[1.0, POISSON, 0.0], [POISSON, 1.0, 0.0], [0.0, 0.0, 0.5 * (1.0 - POISSON)]]
    )  # fmt: skip
    a, b, c = (points[triangles[:, i]] for i in range(3))
    twice = _cross(b - a, c - a)
    slope = np.stack([b - c, c - a, a - b], axis=1)
    slope = np.stack([slope[:, :, 1], -slope[:, :, 0]], axis=2) / twice[:, None, None]
    total = np.zeros((len(triangles), 12, 12))
    for area in ((2 / 3, 1 / 6, 1 / 6), (1 / 6, 2 / 3, 1 / 6), (1 / 6, 1 / 6, 2 / 3)):
        l1, l2, l3 = area
        rows = [(4 * l1 - 1, 0, 0), (0, 4 * l2 - 1, 0), (0, 0, 4 * l3 - 1),
                (4 * l2, 4 * l1, 0), (0, 4 * l3, 4 * l2), (4 * l3, 0, 4 * l1)]  # fmt: skip
        gradient = np.einsum("ni,eid->end", np.array(rows, dtype=float), slope)
        strain = np.zeros((len(triangles), 3, 12))
        strain[:, 0, 0::2] = strain[:, 2, 1::2] = gradient[:, :, 0]
        strain[:, 1, 1::2] = strain[:, 2, 0::2] = gradient[:, :, 1]
        total += np.einsum("e,eji,jk,ekl->eil", twice / 6.0, strain, plane, strain, optimize=True)
    index = (2 * triangles[:, :, None] + np.arange(2)).reshape(len(triangles), 12)
    rows, columns = np.repeat(index, 12, axis=1), np.tile(index, (1, 12))
    size = 2 * len(points)
    return coo_matrix((total.ravel(), (rows.ravel(), columns.ravel())), (size, size)).tocsr()


def outline_of(name: str | tuple[int, float, float]) -> Outline:
    """One of the gears of the table."""
    if isinstance(name, tuple):
        teeth, bore, shift = name
        bore_radius = 0.5 * bore * (teeth - 2.5 + 2.0 * shift) * 4.0
        return Outline(teeth, 4.0, shift, 0.5 * (teeth + 2.0 + 2.0 * shift) * 4.0, bore_radius)
    teeth, shift, tip = {
        "type A pinion": (16, 0.8635, 88.5927),
        "type A wheel": (24, -0.5103, 112.2285),
        "type C pinion": (16, 0.182, 82.46),
        "type C wheel": (24, 0.1715, 118.36),
    }[name]
    return Outline(teeth, 4.5, shift, 0.5 * tip, 15.0)


def column(outline: Outline, curvature: float, other: float) -> tuple[float, float, float]:
    """Compliance at a loaded place, that of another on the next tooth [mm^2/N], and the depth."""
    place, normal, depth = outline.flank_point(curvature)
    mate_point, direction, _ = outline.flank_point(other, 1)
    gear = Gear(outline, np.array([place, mate_point]), place[None])
    moved = gear.displacement(place, normal)
    at = [int(np.argmin(np.hypot(*(gear.points - p).T))) for p in (place, mate_point)]
    patch = math.log(2.0 * depth / (PATCH * outline.module)) - 0.5 * POISSON
    self_compliance = float(moved[at[0]] @ normal) - 2.0 / (math.pi * MODULUS) * patch
    return self_compliance, float(moved[at[1]] @ direction), depth


def compliances(name: str | tuple[int, float, float]) -> tuple[list[float], list[float]]:
    """Self compliances [1e-5 mm^2/N] and those of the next tooth [1e-6 mm^2/N] of a gear."""
    radii = TRIANGLES[name][0]
    outline = outline_of(name)
    columns = [column(outline, *pair) for pair in zip(radii, reversed(radii), strict=True)]
    return [1e5 * self_part for self_part, _, _ in columns], [
        1e6 * cross for _, cross, _ in columns
    ]


class Pair:
    """One pair of FZG type A, 20 mm wide, alone at a roll angle of the pinion, off its tips."""

    def __init__(self, roll: float) -> None:
        pinion, wheel = (outline_of(f"type A {gear}") for gear in ("pinion", "wheel"))
        line = math.sqrt(91.5**2 - (pinion.base_radius + wheel.base_radius) ** 2)
        path = roll * pinion.base_radius
        self.pinion_base, self.radius = pinion.base_radius, path * (line - path) / line
        bodies = [column(gear, at, at) for gear, at in ((pinion, path), (wheel, line - path))]
        self.structure = sum(self_part for self_part, _, _ in bodies)
        self.depths = np.array([depth for _, _, depth in bodies])

    def approach(self, load: float) -> float:
        """Deflection [mm] under a load per width [N/mm]; the compression is in plane strain."""
        strain = MODULUS / (1.0 - POISSON**2)
        half_width = math.sqrt(8.0 * load * self.radius / (math.pi * strain))
        logarithms = np.log(2.0 * self.depths / half_width) - 0.5 * POISSON / (1.0 - POISSON)
        return load * (self.structure + 2.0 / (math.pi * strain) * float(logarithms.sum()))

    def stiffness(self, load: float = 100.0) -> float:
        """Secant stiffness [1e8 N/m]."""
        return 20.0 * load / self.approach(load) * 1e-5

    def deflection(self, torque: float) -> float:
        """Deflection [um] under a torque on the pinion [N m]."""
        return 1e3 * self.approach(torque * 1e3 / self.pinion_base / 20.0)


#: FZG type A: roll angle at the pitch point, and secant stiffness of one pair there at 100 N/mm
#: [1e8 N/m].
PITCH_POINT, STIFFNESS = 0.4129625, 1.709
#: Roll angle [rad] where one pair carries -> deflection [um] under these torques on the pinion.
DEFLECTIONS = {0.5206: (13.666, 22.457, 44.051), 0.6384: (12.938, 21.244, 41.625)}
TORQUES = (90.0, 150.0, 300.0)


if __name__ == "__main__":
    print(f"pitch point: stated {STIFFNESS}, found {Pair(PITCH_POINT).stiffness():.4f}")
    for roll, expected in DEFLECTIONS.items():
        pair = Pair(roll)
        print(roll, "stated", *expected, " found", *(f"{pair.deflection(t):.3f}" for t in TORQUES))
    for name, (_, *tables) in TRIANGLES.items():
        columns = compliances(name)
        print(name)
        for expected, new in zip(tables, columns, strict=True):
            print("  stated", *expected, " found", *(f"{value:.4f}" for value in new))
