"""A tooth as a beam from its foot to the place where the load crosses its axis."""

from __future__ import annotations

import numpy as np

from tribodyn.gear import Material
from tribodyn.stiffness.load_point import LoadPoint
from tribodyn.stiffness.tooth_bending import ToothBendingCompliance, tooth_bending_compliance
from tribodyn.types import Array

#: Shear correction of a rectangular section.
_SHEAR_FACTOR = 1.2


def beam_to_axis(
    outline: tuple[Array, Array], load: LoadPoint, material: Material
) -> ToothBendingCompliance:
    """Compliance of a tooth below the local compression, per unit face width.

    The local compression reaches from the flank along the load to the tooth axis. What bends,
    shears and compresses the tooth as a beam begins there.

    Parameters
    ----------
    outline : two arrays (m,) [m]
        Height along the tooth axis, increasing from the foot, and half thickness.
    load : LoadPoint
        Where the load meets the tooth.
    material : Material
        Material of the gear.

    Returns
    -------
    ToothBendingCompliance
        Contributions [m^2/N], of the shape of the load point.

    Notes
    -----
    Plane stress. A load low on the flank of a gear of many teeth crosses the axis below the foot;
    it then spares a piece of the body as wide as the foot, whose shear and axial compression are
    negative contributions. Source: Weber and Banaschek (1953), integrals up to the tooth axis.

    Examples
    --------
    >>> from tribodyn.gear import SpurGear, half_tooth
    >>> from tribodyn.stiffness import load_point
    >>> gear = SpurGear(teeth=24, normal_module=4.5e-3, normal_pressure_angle=0.349066,
    ...     profile_shift_coefficient=0.0, tip_diameter=0.117, face_width=0.02)
    >>> parts = beam_to_axis(half_tooth(gear), load_point(gear, 0.02), Material())
    >>> bool(parts.shear > parts.axial > 0.0)
    True
    """
    foot_height, foot_half_width = float(outline[0][0]), float(outline[1][0])
    within = np.maximum(load.axis_height, foot_height)
    parts = tooth_bending_compliance(outline, within, 0.0, load.load_angle, 1.0, material)
    # Zero, or the negative length of the beam over the width of the foot.
    spared = np.minimum(load.axis_height - foot_height, 0.0) / (2.0 * foot_half_width)
    return ToothBendingCompliance(
        bending=parts.bending,
        shear=parts.shear
        + _SHEAR_FACTOR * np.cos(load.load_angle) ** 2 / material.shear_modulus * spared,
        axial=parts.axial + np.sin(load.load_angle) ** 2 / material.youngs_modulus * spared,
    )
