"""What the compliances of a gear pair by finite elements cost: cold, kept, and done plainly.

The rivals have the same mesh. One forms its element matrices one by one, as textbooks show it; the
other assembles the ring of all teeth and factorizes it at once, where we factorize one tooth and
let the harmonics around the ring do the rest. Their numbers must equal ours.
"""

from __future__ import annotations

import math
import os
import tempfile
import warnings
from collections.abc import Sequence
from unittest.mock import patch

# Everyone's linear algebra keeps to one core; NumPy reads this when it is loaded.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("MKL_NUM_THREADS", "1")

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.linalg import splu

from race import Goal, arguments, machine, print_goals, print_table, race
from tribodyn.errors import ModelWarning
from tribodyn.gear import Material, SpurGear, SpurPair, spur_pair
from tribodyn.stiffness.fe2d import MeshSize, fe2d_influence
from tribodyn.stiffness.fe2d.flank_load import flank_loads
from tribodyn.stiffness.fe2d.ring import Ring, plane_stress, sector_stiffness, shape_gradients
from tribodyn.stiffness.fe2d.tooth_mesh import SectorMesh, tooth_mesh

__all__ = ["main", "plain_assembly", "whole_ring"]

_STEEL = Material()
#: Goals: processor time [s] of a pair without and with kept results.
_COLD, _KEPT = 2.5, 0.1
#: Goal: how many times longer the plain assembly of one sector takes.
_PLAIN_RATIO = 10.0


def pair_of(pinion_teeth: int, wheel_teeth: int) -> SpurPair:
    """Pair with bores of 30 mm.

    Parameters
    ----------
    pinion_teeth, wheel_teeth : int

    Returns
    -------
    SpurPair
        FZG type A for 16 and 24 teeth.
    """
    fzg = (pinion_teeth, wheel_teeth) == (16, 24)
    shifts = (0.8635, -0.5103) if fzg else (0.0, 0.0)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        return spur_pair(
            pinion_teeth=pinion_teeth,
            wheel_teeth=wheel_teeth,
            normal_module=4.5e-3,
            normal_pressure_angle=math.radians(20.0),
            center_distance=91.5e-3 if fzg else 2.25e-3 * (pinion_teeth + wheel_teeth),
            pinion_face_width=20e-3,
            pinion_profile_shift_coefficient=shifts[0],
            wheel_profile_shift_coefficient=shifts[1],
            pinion_bore_diameter=30e-3,
            wheel_bore_diameter=30e-3,
        )


def plain_assembly(mesh: SectorMesh) -> coo_array:
    """Stiffness of a sector, element by element and point by point.

    Parameters
    ----------
    mesh : SectorMesh

    Returns
    -------
    scipy.sparse.coo_array
        Displacements in x and y.
    """
    slopes, weights = shape_gradients()
    elasticity = plane_stress(1.0, 0.3)
    rows, columns, entries = [], [], []
    for element in mesh.elements:
        stiffness = np.zeros((18, 18))
        for local, weight in zip(slopes, weights, strict=True):
            jacobian = local @ mesh.nodes[element]
            gradient = np.linalg.solve(jacobian, local)
            strain = np.zeros((3, 18))
            strain[0, 0::2] = gradient[0]
            strain[1, 1::2] = gradient[1]
            strain[2, 0::2] = gradient[1]
            strain[2, 1::2] = gradient[0]
            stiffness += weight * np.linalg.det(jacobian) * strain.T @ elasticity @ strain
        freedoms = np.stack([2 * element, 2 * element + 1], axis=1).ravel()
        for i, row in enumerate(freedoms):
            for j, column in enumerate(freedoms):
                rows.append(row)
                columns.append(column)
                entries.append(stiffness[i, j])
    size = 2 * len(mesh.nodes)
    return coo_array((entries, (rows, columns)), shape=(size, size))


def whole_ring(mesh: SectorMesh, forces: np.ndarray) -> np.ndarray:
    """Displacements along the forces with the ring of all teeth factorized at once.

    Parameters
    ----------
    mesh : SectorMesh
    forces : array (2 nodes, cases)

    Returns
    -------
    array (3, cases, cases)
        Seen on the loaded tooth and on the next two clockwise.
    """
    matrix = sector_stiffness(mesh, plane_stress(1.0, 0.3)).tocoo()
    count, size = mesh.count, matrix.shape[0]
    number = np.arange(count * size).reshape(count, size)
    right, left, held = (
        (2 * nodes[:, None] + np.arange(2)).ravel()
        for nodes in (mesh.right_cut, mesh.left_cut, mesh.held)
    )
    number[:, left] = np.roll(number[:, right], -1, axis=0)
    rows, columns = number[:, matrix.row].ravel(), number[:, matrix.col].ravel()
    whole = coo_array((np.tile(matrix.data, count), (rows, columns)), shape=(number.size,) * 2)
    free = np.setdiff1d(np.unique(number), number[:, held])
    load = np.zeros((number.size, forces.shape[1]))
    load[number[0]] = forces
    moved = np.zeros_like(load)
    factors = splu(
        whole.tocsr()[free][:, free].tocsc(),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    moved[free] = factors.solve(load[free])
    return np.stack([moved[number[-n]].T @ forces for n in range(3)])


def _both(pair: SpurPair, *, cache: bool, size: MeshSize | None = None) -> float:
    for gear in (pair.pinion, pair.wheel):
        fe2d_influence(gear, _STEEL, cache=cache, size=size)
    return 1.0


def _pairs(teeth: Sequence[tuple[int, int]], rounds: int, size: MeshSize) -> dict[str, float]:
    """Cold and kept pairs; returns the largest medians [s]."""
    rows, worst = [], {"cold": 0.0, "kept": 0.0}
    with (
        tempfile.TemporaryDirectory() as folder,
        patch.dict(os.environ, {"TRIBODYN_CACHE_DIR": folder}),
    ):
        for numbers in teeth:
            pair = pair_of(*numbers)
            times = race(
                {
                    "cold": lambda pair=pair: _both(pair, cache=False, size=size),
                    "kept": lambda pair=pair: _both(pair, cache=True, size=size),
                },
                rounds,
            )
            for name, spent in times.items():
                worst[name] = max(worst[name], spent.median)
            cells = (f"{1e3 * times[name].median:.3g}" for name in worst)
            rows.append((f"{numbers[0]}/{numbers[1]} teeth", *cells))
    print("Both gears of a pair, CPU ms")
    print_table(("", "cold", "kept"), rows)
    return worst


def _loads(gear: SpurGear, mesh: SectorMesh, cases: int) -> np.ndarray:
    tip = gear.roll_angle(gear.tip_radius) * gear.base_radius
    return flank_loads(gear, mesh, np.linspace(0.6, 0.98, cases) * tip).forces


def _against_plain(size: MeshSize, rounds: int) -> dict[str, float]:
    """Ratios of processor times on the pinion, whose numbers are compared first."""
    gear = pair_of(16, 24).pinion
    mesh = tooth_mesh(gear, 0.5 * gear.bore_diameter, size)
    forces = _loads(gear, mesh, 25)
    elasticity = plane_stress(1.0, 0.3)

    def by_harmonics() -> np.ndarray:
        ring = Ring(mesh, elasticity)
        return ring.seen(ring.solve(forces), forces, [0, -1, -2])

    ours, theirs = by_harmonics(), whole_ring(mesh, forces)
    gap = float(np.abs(ours - theirs).max() / np.abs(theirs).max())
    times = race(
        {
            "assembly": lambda: float(sector_stiffness(mesh, elasticity).nnz > 0),
            "assembly, one by one": lambda: float(plain_assembly(mesh).nnz > 0),
            "ring by harmonics": lambda: float(by_harmonics().size > 0),
            "ring in full": lambda: float(whole_ring(mesh, forces).size > 0),
        },
        rounds,
    )
    print(f"Pinion, {2 * len(mesh.nodes)} unknowns a tooth, 16 teeth, 25 loads, CPU ms")
    print_table(("", "median"), [(n, f"{1e3 * t.median:.3g}") for n, t in times.items()])
    print(f"greatest difference of the two rings {gap:.1e}\n")
    return {
        "assembly": times["assembly"].faster_than(times["assembly, one by one"]),
        "ring": times["ring by harmonics"].faster_than(times["ring in full"]),
        "gap": gap,
    }


def main(words: Sequence[str] | None = None) -> None:
    """Run the races and print them.

    Parameters
    ----------
    words : sequence of str, optional
        Words of the command line.
    """
    quick = arguments(__doc__, words).quick
    print(f"Finite elements of a gear pair: {machine()}\n")
    if quick:
        coarse = MeshSize(flank=0.15, largest=0.3, growth=2.0, body_growth=0.6, body_ratio=0.4)
        _pairs([(16, 24)], 1, coarse)
        _against_plain(coarse, 1)
        return
    worst = _pairs([(16, 24), (20, 80), (40, 60)], 5, MeshSize())
    ratio = _against_plain(MeshSize(), 3)
    print_goals(
        [
            Goal("pair, cold", _COLD, worst["cold"], "s CPU", at_least=False),
            Goal("pair, kept", _KEPT, worst["kept"], "s CPU", at_least=False),
            Goal("assembly", _PLAIN_RATIO, ratio["assembly"], "times", at_least=True),
            Goal("ring by harmonics", 1.0, ratio["ring"], "times", at_least=True),
            Goal("difference of the rings", 1e-8, ratio["gap"], "", at_least=False),
        ]
    )


if __name__ == "__main__":
    main()
