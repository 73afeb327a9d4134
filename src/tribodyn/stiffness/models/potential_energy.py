"""Pair stiffness by the energy method, with true fillets, foundation and local compression.

Every pair deflects on its own: the model adds the stiffness of neighbouring pairs although they
stand on the same gear body. It is named after the method of the literature, and shares its bias
in the zones of several pairs; a single pair is close to a finite element solution.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from tribodyn.errors import Argument, ComputationError, InputError, ModelOption, require_positive
from tribodyn.gear import Material, SpurGear, SpurPair
from tribodyn.stiffness.model import MODELS, MeshState, reference_option
from tribodyn.stiffness.teeth.influence import GearInfluence, local_terms
from tribodyn.stiffness.teeth.tooth_bending import flank_nodes, load_point
from tribodyn.stiffness.teeth.tooth_compliance import tooth_compliance
from tribodyn.types import Array, Mask

#: The load share settles to this relative change; each pass gains more than one digit.
_TOLERANCE = 1e-13
_PASSES = 60


class _PairContacts(NamedTuple):
    """What the deflection of tooth pairs at given places depends on, their load excepted."""

    structure: Array
    terms: Array  #: of :func:`local_terms`
    scale: float
    face_width: float

    def stiffness(self, force: Array) -> Array:
        """Secant stiffness [N/m] of each pair under its own force [N]."""
        load = force / self.face_width
        brackets = self.terms - 0.5 * np.log(load)
        if np.any(brackets <= 0.0):
            what = f"under {np.max(load):.4g} N/m the contact is as wide as the teeth are thick"
            why = "The formula holds for a half width much smaller than the depth"
            raise ComputationError(what, "Weber-Banaschek compression", why, "Lower the load")
        local = self.scale * load * brackets.sum(axis=0)
        return np.asarray(force / (force * self.structure + local))


def _contacts(pair: SpurPair, material: Material, path: Array, reference: str) -> _PairContacts:
    gears, radii = (pair.pinion, pair.wheel), (path, pair.line_of_action_length - path)
    width = pair.common_face_width
    structure = sum(
        tooth_compliance(gear, load_point(gear, radius), width, material, reference).total
        for gear, radius in zip(gears, radii, strict=True)
    )
    terms, scale = local_terms(gears, radii, material)
    return _PairContacts(np.asarray(structure), terms, scale, width)


def single_pair_stiffness(
    pair: SpurPair,
    material: Material,
    path: Array | float,
    normal_force: Array | float,
    reference: str = "bore",
) -> Array:
    """Secant stiffness of one tooth pair that carries a given force alone.

    Parameters
    ----------
    pair, material : SpurPair, Material
        Both gears in their working position, and their material.
    path : float or array [m]
        Distance of the contact from the pinion's base tangent point.
    normal_force : float or array [N]
        Force along the line of action, broadcast against ``path``.
    reference : str
        ``"bore"`` or ``"rim"``: where the gear bodies are held.

    Returns
    -------
    array [N/m]
        Normal force over deflection.

    Raises
    ------
    InputError
        If the force is not positive, the place is not on the line of action, the reference is
        unknown, or is the bore of a gear without bore.

    Notes
    -----
    Against mesh-converged plane finite elements a single pair is 1.6 to 5.3 % too soft on the
    mean over the path. Source: sum of :func:`tribodyn.stiffness.tooth_compliance` of both gears
    and :func:`tribodyn.stiffness.weber_banaschek_compression` of both bodies.

    Examples
    --------
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...     normal_pressure_angle=0.3490658504, pinion_face_width=0.02,
    ...     pinion_bore_diameter=0.03, wheel_bore_diameter=0.03)
    >>> stiffness = single_pair_stiffness(pair, Material(), 0.0137, 2000.0)
    >>> print(f"{float(stiffness) * 1e-6:.0f} N/um")
    204 N/um
    """
    require_positive("normal_force", normal_force, "N")
    place, force = np.broadcast_arrays(
        np.asarray(path, dtype=float), np.asarray(normal_force, dtype=float)
    )
    return _contacts(pair, material, place, reference).stiffness(force)


def potential_energy_influence(
    gear: SpurGear, material: Material, *, reference: str = "bore"
) -> GearInfluence:
    """Structure of one gear whose teeth know nothing of each other.

    Parameters
    ----------
    gear, material : SpurGear, Material
        The gear and its material.
    reference : str
        ``"bore"`` or ``"rim"``: where the gear body is held.

    Returns
    -------
    GearInfluence
        Without neighbours.

    Raises
    ------
    InputError
        If the reference is unknown, or is the bore of a gear without bore.

    Notes
    -----
    Source: :func:`tribodyn.stiffness.tooth_compliance`.

    Examples
    --------
    >>> gear = SpurGear(teeth=24, normal_module=4.5e-3, normal_pressure_angle=0.349066,
    ...     profile_shift_coefficient=0.0, tip_diameter=0.117, face_width=0.02)
    >>> potential_energy_influence(gear, Material(), reference="rim").neighbours
    0
    """
    radii = flank_nodes(gear)
    load = load_point(gear, radii)
    compliance = tooth_compliance(gear, load, 1.0, material, reference).total
    return GearInfluence(radii, compliance, np.zeros((0, radii.size, radii.size)))


def potential_energy_stiffness(
    pair: SpurPair,
    material: Material,
    path: Array,
    in_contact: Mask,
    normal_force: float,
    *,
    reference: str = "bore",
) -> Array:
    """Secant stiffness of every pair at the load share that makes their deflections equal.

    Parameters
    ----------
    pair, material
        As for :func:`single_pair_stiffness`.
    path : array (n, pairs) [m]
        Distance of each contact from the pinion's base tangent point.
    in_contact : bool array (n, pairs)
        Whether the pair is in contact.
    normal_force : float [N]
        Force that all pairs carry together.
    reference : str
        As there.

    Returns
    -------
    array (n, pairs) [N/m]
        Zero where not in contact.

    Raises
    ------
    InputError
        As :func:`single_pair_stiffness`.
    ComputationError
        If the load share does not settle.

    Notes
    -----
    Pairs are independent, which overstates the stiffness of the mesh where two pairs share the
    gear bodies: by about 21 % for FZG type A. Source: as :func:`single_pair_stiffness`.

    Examples
    --------
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...     normal_pressure_angle=0.3490658504, pinion_face_width=0.02,
    ...     pinion_bore_diameter=0.03, wheel_bore_diameter=0.03)
    >>> path = np.array([[0.0085, 0.0085 + pair.base_pitch]])
    >>> both = potential_energy_stiffness(pair, Material(), path, path > 0.0, 2660.0)
    >>> [[f"{value * 1e-6:.0f} N/um" for value in row] for row in both]
    [['187 N/um', '177 N/um']]
    """
    require_positive("normal_force", normal_force, "N")
    if path.ndim != 2 or in_contact.shape != path.shape:
        what = f"path has the shape {path.shape}, in_contact {in_contact.shape}"
        remedy = "Give both for the same phases and pairs"
        raise InputError(what, Argument("path"), "Both have the shape (phases, pairs)", remedy)
    contacts = _contacts(pair, material, path[in_contact], reference)
    stiffness = np.zeros(path.shape)
    share = in_contact / in_contact.sum(axis=1, keepdims=True)
    for _ in range(_PASSES):
        stiffness[in_contact] = contacts.stiffness(normal_force * share[in_contact])
        settled = stiffness / stiffness.sum(axis=1, keepdims=True)
        change = np.max(np.abs(settled - share))
        share = settled
        if change < _TOLERANCE:
            return stiffness
    what = f"the load share still changes by {change:.2g} after {_PASSES} passes"
    why = f"It must settle to {_TOLERANCE:g}"
    remedy = "Check the load; the local compression formula may be outside its range"
    raise ComputationError(what, ModelOption("stiffness", "potential-energy"), why, remedy)


@MODELS.define(
    "potential-energy",
    external_only=True,
    options={"reference": reference_option("bore")},
    influence=potential_energy_influence,
    meaning="stiffness from the strain energy of each tooth, its foundation and the Hertzian "
    "contact",
    papers=("sainsot", "weber-banaschek"),
)
def _model(*mesh: Any, **options: Any) -> Array:
    pair, material, path, in_contact, _, force = MeshState(*mesh)
    return potential_energy_stiffness(pair, material, path, in_contact, force, **options)
