"""Influence of a gear at its teeth in milliseconds: beam teeth on an elastic ring."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tribodyn.errors import InputError, ModelOption, Problem, require_between
from tribodyn.gear import Material, SpurGear, half_tooth
from tribodyn.stiffness.teeth.influence import GearInfluence
from tribodyn.stiffness.teeth.load_point import LoadPoint, flank_nodes, load_point
from tribodyn.stiffness.teeth.ring_fourier import (
    RingCompliance,
    foot_compliance,
    foot_stresses,
    ring_compliance,
)
from tribodyn.stiffness.teeth.sainsot import LARGEST_RATIO, wind_up_compliance
from tribodyn.stiffness.teeth.tooth_bending import beam_to_axis
from tribodyn.stiffness.teeth.tooth_compliance import check_reference, tooth_compliance
from tribodyn.types import Array

#: What the loaded tooth stands on: the elastic ring itself, or the formula fitted to rings.
FOUNDATIONS = ("ring", "sainsot")
#: Points of the tooth outline, as for the compliance of a single tooth.
_OUTLINE_POINTS = 400
#: Waves around the rim times the half angle of a foot; beyond, compliances change by 1e-4 of
#: themselves.
_RESOLUTION = 80.0
#: Bore over root radius at which a gear without bore is held.
_SOLID = 1.0 / LARGEST_RATIO


class _Body(NamedTuple):
    """Ring under the teeth, and how the loads at the nodes stand on it."""

    ring: RingCompliance
    half_angle: float
    pitch_angle: float
    stresses: Array

    def influence(self, neighbour: int) -> Array:
        """Compliance [m^2/N] of the ring alone, ``[loaded, seen]``."""
        # The tooth with the larger radius of curvature is the clockwise one.
        work = foot_compliance(self.ring, self.half_angle, -neighbour * self.pitch_angle)
        return np.asarray((self.stresses.T @ work @ self.stresses).T)


def analytic_influence(
    gear: SpurGear,
    material: Material,
    *,
    reference: str = "bore",
    neighbours: int = 3,
    nodes: int = 30,
    foundation: str = "ring",
) -> GearInfluence:
    """Influence of one gear from closed formulas.

    The loaded tooth is a beam with its true outline. It stands on the ring between bore and root
    circle, which the load deforms through the foot of the tooth; the other teeth ride on the ring.

    Parameters
    ----------
    gear : SpurGear
        The loaded gear.
    material : Material
        Material of the gear.
    reference : str
        ``"bore"``: held at the bore; ``"rim"``: without the wind-up of the body.
    neighbours : int
        Number of teeth on each side that are seen, at least zero; at most half of the others.
    nodes : int
        Number of places along the flank, at least 4.
    foundation : str
        Under the loaded tooth: ``"ring"``, or ``"sainsot"`` for the formula fitted to such rings.

    Returns
    -------
    GearInfluence

    Raises
    ------
    InputError
        If a name is unknown, the reference is the bore of a gear without bore, the bore leaves
        no ring, or a number is out of range.

    Notes
    -----
    Plane stress. The beam ends where the load crosses the tooth axis, because the local
    compression reaches from the flank to there. Against plane finite elements a single pair is
    1 % off on the mean over the path, and up to 5 % too stiff where it meets a thin tip; cross
    compliances are up to 3 % of the self compliance off. A gear without bore and with the rim as
    reference is held at a seventh of its root radius. Source: Weber and Banaschek (1953) for the
    beam, Muskhelishvili for the ring, Sainsot, Velex and Duverger (2004) for the stress under the
    foot; see `beam_to_axis`, `ring_compliance` and `foot_stresses`.

    Examples
    --------
    >>> gear = SpurGear(teeth=24, normal_module=4.5e-3, normal_pressure_angle=0.349066,
    ...     profile_shift_coefficient=0.0, tip_diameter=0.117, face_width=0.02,
    ...     bore_diameter=0.03)
    >>> analytic_influence(gear, Material())
    GearInfluence(30 nodes from 5.312 to 29.11 mm, 2.873e-05 to 7.808e-05 mm^2/N, 3 neighbours)
    """
    check_reference(reference)
    _check_foundation(foundation)
    require_between("neighbours", neighbours, 0, 100)
    require_between("nodes", nodes, 4, 1000)
    outline = half_tooth(gear, _OUTLINE_POINTS)
    radii = flank_nodes(gear, nodes)
    load = load_point(gear, radii)
    body, wind_up = _body(gear, material, reference, outline, load)
    cross = np.zeros((min(neighbours, (gear.teeth - 1) // 2), nodes, nodes))
    for index in range(cross.shape[0]):
        cross[index] = body.influence(index + 1) - wind_up
    own = beam_to_axis(outline, load, material).total
    if foundation == "ring":
        own = own + np.diag(body.influence(0)) - wind_up
    else:
        parts = tooth_compliance(gear, load, 1.0, material, reference)
        own = own + parts.foundation + parts.wind_up
    return GearInfluence(radii, own, cross)


def _body(
    gear: SpurGear,
    material: Material,
    reference: str,
    outline: tuple[Array, Array],
    load: LoadPoint,
) -> tuple[_Body, float]:
    """Ring under the teeth, and its wind-up [m^2/N] where that is to be left out."""
    foot_height, foot_half_width = float(outline[0][0]), float(outline[1][0])
    root_radius = math.hypot(foot_height, foot_half_width)
    half_angle = math.atan2(foot_half_width, foot_height)
    bore_radius = 0.5 * gear.bore_diameter
    if reference == "rim" and bore_radius == 0.0:
        bore_radius = _SOLID * root_radius
    wind_up = wind_up_compliance(gear.base_radius, root_radius, bore_radius, 1.0, material)
    body = _Body(
        ring_compliance(bore_radius, root_radius, material, math.ceil(_RESOLUTION / half_angle)),
        half_angle,
        2.0 * math.pi / gear.teeth,
        foot_stresses(load.load_angle, gear.base_radius, root_radius, half_angle),
    )
    return body, wind_up if reference == "rim" else 0.0


def _check_foundation(foundation: str) -> None:
    if foundation not in FOUNDATIONS:
        raise InputError(
            Problem(
                what=f'foundation = "{foundation}"',
                where=ModelOption("stiffness", name="foundation"),
                why="A tooth stands on the ring, or on the formula that was fitted to rings",
                remedy='Write "ring" or "sainsot"',
            )
        )
