"""A crack on a part of the face by wedges: ``python tests/references/cracked_solid.py``.

The triangles of ``cracked_tooth.py``, coarser, times quadratic lines over a face of 14 mm: wedges
with 18 nodes, fixed two and a half modules under the root and at 2.4 pitches on each side. The
nodes of the crack are doubled on the first 5 mm of the face. The load is even over the face; the
compliance is its mean displacement less that of the same solid without the crack. In plane
stress this mesh is 2 to 4 % too stiff against that of ``cracked_tooth.py``. Lengths in mm, forces
in N.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.sparse import coo_matrix, csr_matrix, diags, eye, kron
from scipy.sparse.linalg import cg
from scipy.spatial import cKDTree

from references.cracked_tooth import RADII, Crack, CrackedGear
from references.gear_compliance import MODULUS, POISSON, _cross, outline_of

#: Ends of the elements over the face, and of the crack that begins at the first one [mm].
FACE, CRACK_END = (0.0, 2.0, 4.0, 5.0, 6.5, 9.0, 14.0), 5.0
#: FZG type C pinion, crack of 2.5 mm square to the tooth at the tangent of 30 deg: compliance under
#: loads at ``RADII`` [1e-6 mm^2/N].
COMPLIANCE = (0.978, 1.168, 1.924)


class CoarseGear(CrackedGear):
    """Triangles that are fine about loads and crack alone."""

    def spacing(self, points: np.ndarray) -> np.ndarray:
        m, root = self.outline.module, np.array([0.0, self.outline.profile[0, 0]])
        wide = 0.35 * m + 0.45 * np.maximum(0.0, np.hypot(*(points - root).T) - 1.2 * m)
        wide = np.minimum(wide, 0.35 * self.outline.bore_radius)
        near = cKDTree(self.loads).query(points)[0]
        wide = np.minimum(wide, 0.12 * m + 0.3 * near)
        tip = np.hypot(*(points - self.crack.tip).T)
        return np.asarray(np.minimum(wide, self.least * m + 0.3 * tip))


def _plane(points: np.ndarray, triangles: np.ndarray) -> dict[str, csr_matrix]:
    """Integrals of products of shape functions (0) and their slopes (x, y)."""
    a, b, c = (points[triangles[:, i]] for i in range(3))
    twice = _cross(b - a, c - a)
    side = np.stack([b - c, c - a, a - b], axis=1)
    slope = np.stack([side[:, :, 1], -side[:, :, 0]], axis=2) / twice[:, None, None]
    sums = {name: np.zeros((len(triangles), 6, 6)) for name in ("xx", "xy", "yy", "x0", "y0", "00")}
    for near, weight in (
        (0.445948490915965, 0.223381589678011),
        (0.091576213509771, 0.109951743655322),
    ):
        for l1, l2 in ((near, near), (near, 1 - 2 * near), (1 - 2 * near, near)):
            l3 = 1.0 - l1 - l2
            value = [l1 * (2 * l1 - 1), l2 * (2 * l2 - 1), l3 * (2 * l3 - 1),
                     4 * l1 * l2, 4 * l2 * l3, 4 * l3 * l1]  # fmt: skip
            rows = [(4 * l1 - 1, 0, 0), (0, 4 * l2 - 1, 0), (0, 0, 4 * l3 - 1),
                    (4 * l2, 4 * l1, 0), (0, 4 * l3, 4 * l2), (4 * l3, 0, 4 * l1)]  # fmt: skip
            gradient = np.einsum("ni,eid->end", np.array(rows, dtype=float), slope)
            of = {"x": gradient[:, :, 0], "y": gradient[:, :, 1]}
            of["0"] = np.broadcast_to(np.array(value), of["x"].shape)
            scale = (0.5 * twice * weight)[:, None, None]
            for name, total in sums.items():
                total += scale * of[name[0]][:, :, None] * of[name[1]][:, None, :]
    place = np.repeat(triangles, 6, axis=1).ravel(), np.tile(triangles, (1, 6)).ravel()
    size = (len(points), len(points))
    return {name: coo_matrix((part.ravel(), place), size).tocsr() for name, part in sums.items()}


def _line() -> tuple[np.ndarray, dict[str, np.ndarray], np.ndarray]:
    """Nodes over the face, integrals as those of the plane, and of the functions alone."""
    nodes = np.sort(np.concatenate([FACE, 0.5 * (np.array(FACE[1:]) + FACE[:-1])]))
    size = nodes.size
    sums = {name: np.zeros((size, size)) for name in ("00", "0z", "zz")}
    even = np.zeros(size)
    for first in range(0, size - 2, 2):
        half, at = 0.5 * (nodes[first + 2] - nodes[first]), slice(first, first + 3)
        for t, weight in zip(*np.polynomial.legendre.leggauss(3), strict=True):
            value = np.array([0.5 * t * (t - 1.0), 1.0 - t * t, 0.5 * t * (t + 1.0)])
            of = {"0": value, "z": np.array([t - 0.5, -2.0 * t, t + 0.5]) / half}
            even[at] += weight * half * value
            for name, total in sums.items():
                total[at, at] += weight * half * np.outer(of[name[0]], of[name[1]])
    return nodes, sums, even


def _solid(plane: dict[str, csr_matrix], line: dict[str, np.ndarray]) -> csr_matrix:
    """Stiffness of the solid, one direction after the other."""
    first = POISSON * MODULUS / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON))
    shear = 0.5 * MODULUS / (1.0 + POISSON)
    parts = {
        "xx": kron(plane["xx"], line["00"]), "yy": kron(plane["yy"], line["00"]),
        "zz": kron(plane["00"], line["zz"]), "xy": kron(plane["xy"], line["00"]),
        "xz": kron(plane["x0"], line["0z"]), "yz": kron(plane["y0"], line["0z"]),
    }  # fmt: skip
    total = 0.0
    for i, a in enumerate("xyz"):
        for j, b in enumerate("xyz"):
            both = parts[a + b] if a <= b else parts[b + a].T
            turned = parts[b + a] if b <= a else parts[a + b].T
            block = first * both + shear * turned
            if i == j:
                block = block + shear * (parts["xx"] + parts["yy"] + parts["zz"])
            place = coo_matrix(([1.0], ([i], [j])), (3, 3))
            total = total + kron(place, block, format="csr")
    return total


def compliances(least: float = 0.08) -> list[float]:
    """Compliances of the crack at the loads [1e-6 mm^2/N]."""
    outline = outline_of("type C pinion")
    crack = Crack.at(outline, 2.5, 90.0, 30.0)
    gear = CoarseGear(outline, crack, least)
    across = np.array([crack.direction[1], -crack.direction[0]])
    along, above = (
        (gear.points - crack.start) @ crack.direction,
        (gear.points - crack.start) @ across,
    )
    inside = (along > -1e-9) & (along < crack.depth * (1.0 - 1e-9))
    seam = np.flatnonzero(inside & (np.abs(above) < 1e-9))
    count, twin = len(gear.points), np.arange(len(gear.points))
    twin[seam] = count + np.arange(seam.size)
    upper = (gear.points[gear.triangles[:, :3]].mean(axis=1) - crack.start) @ across > 0.0
    triangles = np.where(upper[:, None], twin[gear.triangles], gear.triangles)
    points = np.concatenate((gear.points, gear.points[seam]))
    nodes, line, even = _line()
    stiffness = _solid(_plane(points, triangles), line)
    angle = np.abs(np.arctan2(*points.T))
    deep = np.hypot(*points.T) < outline.profile[0, 0] - 2.5 * outline.module
    held = np.repeat(deep | (angle > 2.4 * 2.0 * math.pi / outline.teeth), nodes.size)
    work = []
    for open_end in (CRACK_END, 0.0):
        base = np.arange(points.shape[0])[:, None] * nodes.size + np.arange(nodes.size)
        closed = nodes > open_end - 1e-9
        base[count:, closed] = base[seam][:, closed]
        number, place = np.unique(base.ravel(), return_inverse=True)
        free = np.flatnonzero(~held[number])
        rank = np.full(number.size, -1)
        rank[free] = np.arange(free.size)
        used = np.flatnonzero(rank[place] >= 0)
        size = (place.size, free.size)
        turn = coo_matrix((np.ones(used.size), (used, rank[place][used])), size)
        turn = kron(eye(3), turn, format="csr")
        matrix = turn.T @ stiffness @ turn
        root = diags(1.0 / np.sqrt(matrix.diagonal()))
        scaled = (root @ matrix @ root).tocsr()
        for radius in RADII:
            spot, normal, _ = outline.flank_point(radius)
            node = int(np.argmin(np.hypot(*(gear.points - spot).T)))
            force = np.zeros((3, points.shape[0], nodes.size))
            force[:2, node] = np.multiply.outer(normal, even)
            load = root @ (turn.T @ force.ravel())
            moved, status = cg(scaled, load, rtol=1e-7, maxiter=6000)
            assert status == 0
            work.append(1e6 * float(load @ moved) / FACE[-1])
    return [cracked - sound for cracked, sound in zip(work[:3], work[3:], strict=True)]


if __name__ == "__main__":
    print("stated", COMPLIANCE, " computed", np.round(compliances(), 4))
