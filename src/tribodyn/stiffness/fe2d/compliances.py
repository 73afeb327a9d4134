"""Compliances of one gear over its flank for a Young's modulus of one."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribodyn.gear import Material, SpurGear
from tribodyn.stiffness.fe2d.element import plane_stress
from tribodyn.stiffness.fe2d.flamant import remainder_loads
from tribodyn.stiffness.fe2d.flank_load import flank_loads
from tribodyn.stiffness.fe2d.ring import Ring
from tribodyn.stiffness.fe2d.tooth_mesh import MeshSize, tooth_mesh
from tribodyn.stiffness.sainsot import LARGEST_RATIO
from tribodyn.stiffness.tooth_compliance import check_reference
from tribodyn.stiffness.wind_up import wind_up_compliance
from tribodyn.types import Array, Mask

#: Places along the flank.
NODES = 25
#: Least radius of curvature that is tabulated [modules].
_LEAST_CURVATURE = 0.02
#: Distances from the tip corner [modules] from which the self compliance goes on to the tip.
_TIP_SUPPORT = np.array([0.07, 0.11, 0.15])
#: Largest share of the involute that this may take.
_TIP_SHARE = 0.3


class UnitCompliances(NamedTuple):
    """Compliances for a Young's modulus of one."""

    curvature_radius: Array  #: nodes [m]
    self_compliance: Array
    cross_compliance: Array


def held_radius(gear: SpurGear) -> float:
    """Radius of the circle where the body is held."""
    if gear.bore_diameter > 0.0:
        return 0.5 * gear.bore_diameter
    return gear.root_radius / LARGEST_RATIO


def wind_up_to_take_off(gear: SpurGear, material: Material, reference: str) -> float:
    """Wind-up of the body per unit width that does not belong to the reference."""
    check_reference(reference)
    held = 0.5 * gear.bore_diameter if reference == "bore" else held_radius(gear)
    wind_up = wind_up_compliance(gear.base_radius, gear.root_radius, held, 1.0, material)
    return wind_up if reference == "rim" else 0.0


def unit_compliances(
    gear: SpurGear,
    poissons_ratio: float,
    neighbours: int,
    size: MeshSize | None = None,
    held_at: float | None = None,
) -> UnitCompliances:
    """Compliances of a gear whose body is held along a circle."""
    held = held_radius(gear) if held_at is None else held_at
    elasticity = plane_stress(1.0, poissons_ratio)
    mesh = tooth_mesh(gear, held, size)
    ring = Ring(mesh, elasticity)
    rho, support = _places(gear)
    loads = flank_loads(gear, mesh, np.concatenate([rho, support]))
    near = np.append(rho > support[0], np.zeros(support.size, dtype=bool))
    forces = loads.forces.copy()
    place, direction, depth = (part[~near] for part in loads[:3])
    forces[:, ~near] = remainder_loads(mesh, place, direction, depth, elasticity)
    solution = ring.solve(forces)
    # the side of larger radii is the clockwise one
    seen = ring.seen(solution, loads.forces, [-n for n in range(neighbours + 1)])
    own = _carried_to_tip(rho, support, np.diagonal(seen[0]), near[: rho.size])
    return UnitCompliances(rho, own, seen[1:, : rho.size, : rho.size].copy())


def _places(gear: SpurGear) -> tuple[Array, Array]:
    """Nodes from the form circle to the tip, denser at both ends, and supports near the tip [m]."""
    base, module = gear.base_radius, gear.normal_module
    tip = gear.roll_angle(gear.tip_radius) * base
    form = gear.roll_angle(max(gear.form_radius, base)) * base
    low = max(form, min(_LEAST_CURVATURE * module, 0.5 * tip))
    share = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, NODES))
    rho = low + (tip - low) * share
    rho[-1] = tip
    flank = 0.5 * (tip * tip - low * low) / base
    shrink = min(1.0, _TIP_SHARE * flank / (_TIP_SUPPORT[-1] * module))
    return rho, np.sqrt(tip * tip - 2.0 * base * module * shrink * _TIP_SUPPORT)


def _carried_to_tip(rho: Array, support: Array, own: Array, near: Mask) -> Array:
    """Self compliance at the nodes, beyond the supports as the parabola of the length."""
    tip = rho[-1]
    scale = tip * tip - support[-1] ** 2
    curve = np.polyfit((tip * tip - support**2) / scale, own[rho.size :], 2)
    parabola = np.polyval(curve, (tip * tip - rho * rho) / scale)
    return np.where(near, parabola, own[: rho.size])
