"""Influence of a gear at its teeth in milliseconds: beam teeth on an elastic ring."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tribodyn.errors import require_between
from tribodyn.gear import Material, SpurGear
from tribodyn.stiffness.teeth.influence import GearInfluence
from tribodyn.stiffness.teeth.load_point import LoadPoint, flank_nodes, load_point
from tribodyn.stiffness.teeth.ring_fourier import (
    RingCompliance,
    foot_compliance,
    foot_stresses,
    ring_compliance,
)
from tribodyn.stiffness.teeth.sainsot import LARGEST_RATIO, wind_up_compliance
from tribodyn.stiffness.teeth.tooth_bending import ToothSection, beam_to_axis, tooth_section
from tribodyn.stiffness.teeth.tooth_compliance import (
    check_choice,
    check_reference,
    tooth_compliance,
)
from tribodyn.types import Array

#: What the loaded tooth stands on: the elastic ring itself, or the formula fitted to rings.
FOUNDATIONS = ("ring", "sainsot")
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
    """Influence of one gear from closed formulas, with up to ``neighbours`` teeth on each side.

    The loaded tooth is a beam with its true outline. It stands on the ring between bore and root
    circle, which the load deforms through the foot of the tooth; the other teeth ride on the ring.
    ``foundation="sainsot"`` takes the formula fitted to such rings under the loaded tooth instead.

    Plane stress. The beam ends where the load crosses the tooth axis, because the local
    compression reaches from the flank to there. Against plane finite elements a single pair is
    1 % off on the mean over the path, and up to 5 % too stiff where it meets a thin tip; cross
    compliances are up to 3 % of the self compliance off. A gear without bore and with the rim as
    reference is held at a seventh of its root radius. Source: Weber and Banaschek (1953) for the
    beam, Muskhelishvili for the ring, Sainsot, Velex and Duverger (2004) for the stress under the
    foot; see `beam_to_axis`, `ring_compliance` and `foot_stresses`.

    >>> gear = SpurGear(teeth=24, normal_module=4.5e-3, normal_pressure_angle=0.349066,
    ...     profile_shift_coefficient=0.0, tip_diameter=0.117, face_width=0.02,
    ...     bore_diameter=0.03)
    >>> analytic_influence(gear, Material())
    GearInfluence(30 nodes from 5.312 to 29.11 mm, 2.873e-05 to 7.808e-05 mm^2/N, 3 neighbours)
    """
    check_reference(reference)
    why = "A tooth stands on the ring, or on the formula that was fitted to rings"
    check_choice("foundation", foundation, FOUNDATIONS, why)
    require_between("neighbours", neighbours, 0, 100)
    require_between("nodes", nodes, 4, 1000)
    section = tooth_section(gear)
    radii = flank_nodes(gear, nodes)
    load = load_point(gear, radii)
    body, wind_up = _body(gear, material, reference, section, load)
    cross = np.zeros((min(neighbours, (gear.teeth - 1) // 2), nodes, nodes))
    for index in range(cross.shape[0]):
        cross[index] = body.influence(index + 1) - wind_up
    self_compliance = beam_to_axis(section, load, material).total
    if foundation == "ring":
        self_compliance = self_compliance + np.diag(body.influence(0)) - wind_up
    else:
        parts = tooth_compliance(gear, load, 1.0, material, reference)
        self_compliance = self_compliance + parts.foundation + parts.wind_up
    return GearInfluence(radii, self_compliance, cross)


def _body(
    gear: SpurGear,
    material: Material,
    reference: str,
    section: ToothSection,
    load: LoadPoint,
) -> tuple[_Body, float]:
    """Ring under the teeth, and its wind-up [m^2/N] where that is to be left out."""
    root_radius, half_angle = section.root_radius, section.root_half_angle
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
