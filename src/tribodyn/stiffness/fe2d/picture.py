"""Displacements of the outline of a loaded gear, to be drawn exaggerated."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from tribodyn.errors import Argument, InputError
from tribodyn.gear import Material, SpurGear
from tribodyn.stiffness.fe2d.flank_load import flank_loads
from tribodyn.stiffness.fe2d.provider import held_radius, wind_up_to_take_off
from tribodyn.stiffness.fe2d.ring import Ring, plane_stress
from tribodyn.stiffness.fe2d.tooth_mesh import MeshSize, tooth_mesh
from tribodyn.types import Array

#: Half width of the loads [modules]: wide, so that the dent does not hide the bending.
_HALF_WIDTH = 0.2
#: A picture needs no fine mesh.
_SIZE = MeshSize(flank=0.08, largest=0.14, growth=1.4, body_growth=0.4)
#: Teeth beyond the loaded ones on each side.
_MARGIN = 1


def deformed_gear(
    gear: SpurGear,
    material: Material,
    loads: Sequence[tuple[int, float, float]],
    *,
    reference: str = "bore",
) -> tuple[Array, Array]:
    """Outline of the loaded teeth and one more on each side, with their displacements.

    Parameters
    ----------
    gear : SpurGear
        The gear; tooth 0 is centred on +y and the flanks with x > 0 are loaded.
    material : Material
        Its material.
    loads : sequence of tuple (int, float [m], float [N/m])
        Tooth, radius of curvature and load per width. Teeth are counted as the neighbours of
        :class:`tribodyn.stiffness.GearInfluence`: clockwise here, to the side of larger radii;
        those of a ring anticlockwise.
    reference : str
        ``"bore"``: the bore is held; ``"rim"``: the wind-up of the body is taken off.

    Returns
    -------
    tuple of array (2, n) [m]
        Points of the outline, anticlockwise, the same number for each tooth with the middle of
        the space shared by neighbours; and their displacements. If all teeth are shown, the last
        point equals the first.

    Raises
    ------
    InputError
        If there is no load, a place is not on the flank, or as :func:`fe2d_influence`.

    Notes
    -----
    The load is spread over 0.4 modules, so that the dent of the contact does not hide the bending
    of the teeth. Source: see :func:`fe2d_influence`.

    Examples
    --------
    >>> gear = SpurGear(teeth=24, normal_module=4.5e-3, normal_pressure_angle=0.349066,
    ...     profile_shift_coefficient=0.0, tip_diameter=0.117, face_width=0.02, bore_diameter=0.03)
    >>> outline, moved = deformed_gear(gear, Material(), [(0, 0.02, 100e3)])
    >>> highest = outline[1].argmax()
    >>> bool(moved[0, highest] < -5e-6), bool(np.hypot(*outline[:, 0]) < gear.base_radius)
    (True, True)
    """
    wind_up = wind_up_to_take_off(gear, material, reference)
    teeth, radii, forces = _split(gear, loads)
    mesh = tooth_mesh(gear, held_radius(gear), _SIZE)
    ring = Ring(mesh, plane_stress(1.0, material.poissons_ratio))
    solution = ring.solve(flank_loads(gear, mesh, radii, _HALF_WIDTH, inside=True).forces)
    drawn_teeth = _drawn_teeth(teeth, abs(gear.teeth))[:: gear.sign]
    points, moves = [], []
    for tooth in drawn_teeth:
        moved = np.zeros((len(mesh.outline), 2))
        for case, loaded in enumerate(teeth):
            sector = gear.sign * (loaded - tooth)
            displacement = ring.displacement(solution, sector)[:, case].reshape(-1, 2)
            moved += forces[case] / material.youngs_modulus * displacement[mesh.outline]
        turn = 2.0 * math.pi * tooth / gear.teeth
        # a clockwise turn of rows
        matrix = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
        keep = slice(None) if tooth == drawn_teeth[-1] else slice(None, -1)
        points.append((mesh.nodes[mesh.outline] @ matrix)[keep])
        moves.append((moved @ matrix)[keep])
    outline = gear.normal_module * np.concatenate(points).T
    displacement = np.concatenate(moves).T
    angle = wind_up * forces.sum() / gear.base_radius
    return outline, displacement - angle * outline[::-1] * np.array([[-1.0], [1.0]])


def _split(
    gear: SpurGear, loads: Sequence[tuple[int, float, float]]
) -> tuple[list[int], Array, Array]:
    if not loads:
        what = "no load"
        remedy = "Give (tooth, radius of curvature, load per width) for each contact"
        raise InputError(what, Argument("loads"), "There is nothing to deform the gear", remedy)
    teeth = [int(tooth) for tooth, _, _ in loads]
    radii = np.array([radius for _, radius, _ in loads], dtype=float)
    tip = gear.roll_angle(gear.tip_radius) * gear.base_radius
    beyond = gear.sign * (radii - tip) > 1e-9 * tip
    if np.any(beyond | (radii <= 0.0)):
        what = f"radii of curvature {radii.min() * 1e3:.6g} to {radii.max() * 1e3:.6g} mm"
        why = f"The flank ends at the tip with {tip * 1e3:.6g} mm"
        raise InputError(what, Argument("loads"), why, "Load the tooth on its involute")
    return teeth, radii, np.array([load for _, _, load in loads], dtype=float)


def _drawn_teeth(teeth: Sequence[int], count: int) -> list[int]:
    """Teeth anticlockwise, which is against their number."""
    first, last = max(teeth) + _MARGIN, min(teeth) - _MARGIN
    return list(range(first, max(last, first - count + 1) - 1, -1))
