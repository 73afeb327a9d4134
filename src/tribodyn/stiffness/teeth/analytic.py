"""Influence of a gear at its teeth in milliseconds: beam teeth on an elastic ring."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tribodyn.errors import InputError, require_between, require_positive
from tribodyn.gear import Material, SpurGear
from tribodyn.stiffness.teeth.influence import GearInfluence
from tribodyn.stiffness.teeth.tooth_bending import (
    LoadPoint,
    ToothSection,
    beam_to_axis,
    flank_nodes,
    load_point,
    tooth_section,
)
from tribodyn.stiffness.teeth.tooth_compliance import (
    LARGEST_RATIO,
    check_choice,
    check_reference,
    tooth_compliance,
    wind_up_compliance,
)
from tribodyn.types import Array

#: Ratio of inner to outer radius up to which the solution keeps eight digits.
_LARGEST_INNER = 0.995
#: Waves times the logarithm of the radii from which the inner circle is not felt (1e-15).
_DECAYED = 24.0


class RingCompliance(NamedTuple):
    """Displacement of the rim of a ring per stress on the rim, wave by wave."""

    outer_radius: float  #: radius of the rim [m]
    expansion: float  #: radial displacement under an even radial stress [m/Pa]
    torsion: float  #: tangential displacement under an even tangential stress [m/Pa]
    waves: Array  #: for ``k = 1  [m/Pa]


def ring_compliance(
    inner_radius: float, outer_radius: float, material: Material, waves: int
) -> RingCompliance:
    """Compliance of the rim of a ring whose inner circle is held."""
    require_positive("inner_radius", inner_radius, "m")
    require_positive("outer_radius", outer_radius, "m")
    if inner_radius > _LARGEST_INNER * outer_radius:
        raise InputError(
            f"inner radius {inner_radius * 1e3:.6g} mm, outer radius {outer_radius * 1e3:.6g} mm",
            where="ring under the teeth",
            why="The body is the ring between the two; it must be at least "
            f"{1.0 - _LARGEST_INNER:.1%} of the radius thick",
            remedy="Give a smaller bore",
        )
    ratio = inner_radius / outer_radius
    shear = material.shear_modulus
    long = min(waves, math.ceil(_DECAYED / math.log(outer_radius / inner_radius)))
    rim = np.concatenate([_long(long, ratio, material), _short(long, waves, material)])
    rim *= outer_radius / (2.0 * shear)
    # Even pressure: u = A (r - r_i^2 / r).
    thick = 1.0 - ratio**2
    nu = material.poissons_ratio
    stretched = (1.0 + nu) / (1.0 - nu) + ratio**2
    return RingCompliance(
        outer_radius=outer_radius,
        expansion=outer_radius * thick / (2.0 * shear * stretched),
        torsion=outer_radius * thick / (2.0 * shear * ratio**2),
        # Betti and Maxwell to the last digit.
        waves=0.5 * (rim + rim.swapaxes(1, 2)),
    )


def _long(waves: int, ratio: float, material: Material) -> Array:
    """Compliance of the rim (times 2 G over its radius) for all waves up to a number."""
    inside = _solutions(waves, ratio, ratio, material)
    outside = _solutions(waves, 1.0, ratio, material)
    conditions = np.concatenate([inside[:, :2], outside[:, 2:]], axis=1)
    stress = np.zeros((waves, 4, 2))
    stress[:, 2, 0] = stress[:, 3, 1] = 1.0
    return np.asarray(outside[:, :2] @ np.linalg.solve(conditions, stress))


def _short(beyond: int, waves: int, material: Material) -> Array:
    """The same for more waves, which do not reach the inner circle: those of a full disk."""
    n = np.arange(beyond + 1.0, waves + 1.0)
    nu = material.poissons_ratio
    kappa = (3.0 - nu) / (1.0 + nu)
    grow, turn = kappa * (n - 1.0), n + 1.0
    table = np.empty((n.size, 2, 2))
    table[:, 0, 0] = table[:, 1, 1] = 0.5 * (grow + turn) / (n**2 - 1.0)
    table[:, 0, 1] = table[:, 1, 0] = 0.5 * (grow - turn) / (n**2 - 1.0)
    return table


def _solutions(waves: int, radius: float, ratio: float, material: Material) -> Array:
    """Radial and tangential displacement (times 2 G) and stress of the four solutions per wave."""
    n = np.arange(1.0, waves + 1.0)
    nu = material.poissons_ratio
    kappa = (3.0 - nu) / (1.0 + nu)
    out, low = radius**n, (ratio / radius) ** n
    table = np.empty((waves, 4, 4))
    table[:, :, 0] = _column(out, radius, (kappa - n - 1.0, kappa + n + 1.0), (2.0 - n, n), n + 1.0)
    table[:, :, 1] = _column(out / radius**2, radius, (-1.0, 1.0), (-1.0, 1.0), n - 1.0)
    table[:, :, 2] = _column(low, radius, (kappa + n - 1.0, n - kappa - 1.0), (n + 2.0, n), 1.0 - n)
    table[:, :, 3] = _column(low * (ratio / radius) ** 2, radius, (-1.0, -1.0), (1.0, 1.0), n + 1.0)
    # One wave: the force terms of ln z replace the constant, single-valued by their factor.
    log = 2.0 * kappa * np.log(radius)
    table[0, :, 2] = log - 1.0, -log - 1.0, (3.0 + kappa) / radius, (1.0 - kappa) / radius
    return table


def _column(
    size: Array,
    radius: float,
    moves: tuple[Array | float, Array | float],
    stresses: tuple[Array | float, Array | float],
    factor: Array,
) -> Array:
    rows = [size * radius * move for move in moves]
    rows += [size * factor * stress for stress in stresses]
    return np.stack(rows, axis=1)


def foot_stresses(
    load_angle: Array | float, base_radius: float, root_radius: float, half_angle: float
) -> Array:
    """Stresses (3, K) [1/m] per load per width at the foot of the tooth under its load.

    The load turns the gear counter-clockwise. Over the foot an even tangential stress carries the
    torque, an even radial stress the force along the tooth, and a radial stress that grows
    linearly with the angle from the tooth axis the rest of the force across; of the latter the
    value at the counter-clockwise end is given. Force and torque are those of the load exactly.
    Source: distributions of Sainsot, Velex and Duverger (2004), J. Mech. Des. 126, 748-752.

    The tangential stress carries the torque, here 0.03 N m/m per 1 N/m.

    >>> stress = foot_stresses(0.3, 0.03, 0.032, 0.1)
    >>> print(f"{float(stress[0, 0]) * 2 * 0.1 * 0.032**2:.6f}")
    0.030000
    """
    for name, value, unit in (
        ("base_radius", base_radius, "m"),
        ("root_radius", root_radius, "m"),
        ("half_angle", half_angle, "rad"),
    ):
        require_positive(name, value, unit)
    angle = np.atleast_1d(np.asarray(load_angle, dtype=float))
    chord = 2.0 * root_radius * np.sin(half_angle)
    tangential = np.full(angle.shape, base_radius / (2.0 * half_angle * root_radius**2))
    lever = (np.sin(half_angle) - half_angle * np.cos(half_angle)) / half_angle
    linear = (np.cos(angle) - tangential * chord) / (2.0 * root_radius * lever)
    return np.stack([tangential, -np.sin(angle) / chord, linear])


def foot_compliance(ring: RingCompliance, half_angle: float, turn: float) -> Array:
    """Displacement of one foot under the stress on another, in the pattern of the stresses."""
    require_positive("half_angle", half_angle, "rad")
    n = np.arange(1.0, ring.waves.shape[0] + 1.0)
    phase = n * half_angle
    even = 2.0 * np.sin(phase) / (np.pi * n)
    linear = 2.0 * (np.sin(phase) - phase * np.cos(phase)) / (np.pi * n * phase)
    # Stresses about their own tooth axis: tangential even, radial even, radial odd. In waves of
    # p cos + q sin the even radial part is (p, 0); a quarter wave on, the tangential one is
    # (0, -q) and the odd one (p, 0).
    size = np.stack([-even, even, linear])
    kind = np.array([1, 0, 0])
    quarter = np.array([1, 0, 1])
    coupling = ring.waves[:, kind[:, None], kind[None, :]]
    products = size[:, None, :] * size[None, :, :] * np.moveaxis(coupling, 0, 2)
    in_phase = products @ np.cos(n * turn)
    a_quarter_off = products @ np.sin(n * turn)
    step = quarter[None, :] - quarter[:, None]
    work = np.pi * ring.outer_radius * np.where(step == 0, in_phase, step * a_quarter_off)
    share = 2.0 * ring.outer_radius * half_angle**2 / np.pi
    work[0, 0] += share * ring.torsion
    work[1, 1] += share * ring.expansion
    return np.asarray(work)


#: Foundation of the loaded tooth: the elastic ring itself, or the formula fitted to rings.
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

    The loaded tooth is a beam with its true outline. Its foundation is the ring between bore and
    root circle, which the load deforms through the foot of the tooth; the other teeth follow it.
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
    why = "The foundation of a tooth is the ring, or the formula fitted to rings"
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
    gear: SpurGear, material: Material, reference: str, section: ToothSection, load: LoadPoint
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
