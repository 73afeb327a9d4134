"""Wind-up of the gear body: the ring between bore and root circle under the tooth torque."""

from __future__ import annotations

import numpy as np

from tribodyn.errors import InputError, Problem, require_positive
from tribodyn.gear import Material


def wind_up_compliance(
    base_radius: float,
    root_radius: float,
    bore_radius: float,
    face_width: float,
    material: Material,
) -> float:
    """Compliance of the gear body in torsion, seen along the line of action.

    ``r_b^2 / (4 pi G b) (1 / r_i^2 - 1 / r_f^2)``: the bore is held, the torque enters evenly
    around the root circle.

    Parameters
    ----------
    base_radius : float [m]
        Base radius, the lever of the normal force.
    root_radius : float [m]
        Root radius, outer radius of the ring.
    bore_radius : float [m]
        Bore radius, inner radius of the ring.
    face_width : float [m]
        Width of the ring.
    material : Material
        Material of the gear.

    Returns
    -------
    float [m/N]

    Raises
    ------
    InputError
        If there is no bore, or it is not smaller than the root circle.

    Notes
    -----
    A ring of constant width. Source: thick ring in torsion, Timoshenko and Goodier, Theory of
    Elasticity, section on rotationally symmetric stress: ``tau = T / (2 pi r^2 b)``.

    Examples
    --------
    >>> from tribodyn.gear import Material
    >>> compliance = wind_up_compliance(0.0338, 0.0343, 0.015, 0.02, Material())
    >>> print(f"{compliance * 1e9:.5f} um/kN")
    0.20622 um/kN
    """
    for name, value in (
        ("base_radius", base_radius),
        ("root_radius", root_radius),
        ("face_width", face_width),
    ):
        require_positive(name, value, "m")
    if bore_radius <= 0.0:
        raise InputError(
            Problem(
                what=f"bore radius {bore_radius * 1e3:g} mm",
                where='stiffness reference = "bore"',
                why="The bore is the fixed end of the gear body; a shaft of no diameter gives "
                "way without limit",
                remedy='Give bore_diameter, or choose reference = "rim", which leaves the wind-up '
                "of the body out",
            )
        )
    if bore_radius >= root_radius:
        raise InputError(
            Problem(
                what=f"bore diameter {2e3 * bore_radius:.4g} mm, root diameter "
                f"{2e3 * root_radius:.4g} mm",
                where="bore_diameter",
                why="The body is the ring between the two",
                remedy="Give a bore smaller than the root circle",
            )
        )
    ring = 1.0 / bore_radius**2 - 1.0 / root_radius**2
    return base_radius**2 / (4.0 * np.pi * material.shear_modulus * face_width) * ring
