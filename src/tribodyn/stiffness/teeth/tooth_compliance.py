"""Structural compliance of one gear at one tooth: tooth, foundation and body."""

from __future__ import annotations

from typing import NamedTuple, TypeVar

import numpy as np

from tribodyn.errors import InputError, ModelOption, require_positive, warn
from tribodyn.gear import Material, SpurGear
from tribodyn.stiffness.teeth.tooth_bending import (
    LoadPoint,
    tooth_bending_compliance,
    tooth_section,
)
from tribodyn.types import Array

Number = TypeVar("Number", float, Array)

#: Rows L*, M*, P*, Q*; columns A..F of ``A/theta^2 + B h^2 + C h/theta + D/theta + E h + F``.
_POLYNOMIALS = np.array(
    [
        [-5.574e-5, -1.9986e-3, -2.3015e-4, 4.7702e-3, 0.0271, 6.8045],
        [60.111e-5, 28.100e-3, -83.431e-4, -9.9256e-3, 0.1624, 0.9086],
        [-50.952e-5, 185.50e-3, 0.0538e-4, 53.300e-3, 0.2895, 0.9236],
        [-6.2042e-5, 9.0889e-3, -4.0964e-4, 7.8297e-3, -0.1472, 0.6904],
    ]
)
#: Fitted ratios of root radius to bore radius.
LEAST_RATIO, LARGEST_RATIO = 1.4, 7.0
#: Half angles [rad] that are accepted; fitted up to 0.12, beyond which little changes.
_LEAST_ANGLE, _LARGEST_ANGLE = 0.01, 0.25


def sainsot_coefficients(
    root_half_angle: float, root_radius: float, bore_radius: float
) -> tuple[float, float, float, float]:
    """Coefficients ``L*, M*, P*, Q*`` of the foundation formula.

    Parameters
    ----------
    root_half_angle : float [rad]
        Half of the angle that the foot of the tooth takes on the root circle.
    root_radius : float [m]
        Root radius.
    bore_radius : float [m]
        Radius of the bore, where the body is held.

    Returns
    -------
    tuple of four floats

    Raises
    ------
    InputError
        If an argument is not positive.

    Notes
    -----
    Fitted for a ratio of root to bore radius of 1.4 to 7 and half angles of 0.01 to 0.12 rad.
    Gears of few teeth lie above 0.12 rad; up to 0.25 rad the coefficients change by less than
    13 %. Beyond, and outside the ratios, a warning ``foundation-range``.
    Source: Sainsot, Velex and Duverger (2004), J. Mech. Des. 126, 748-752, table 1.

    Examples
    --------
    >>> L, M, P, Q = sainsot_coefficients(0.1, 0.045, 0.015)
    >>> print(f"{L:.4f} {M:.4f} {P:.4f} {Q:.4f}")
    6.9030 1.3593 3.9438 0.3904
    """
    require_positive("root_half_angle", root_half_angle, "rad")
    require_positive("root_radius", root_radius, "m")
    require_positive("bore_radius", bore_radius, "m")
    theta, h = root_half_angle, root_radius / bore_radius
    terms = np.array([1.0 / theta**2, h**2, h / theta, 1.0 / theta, h, 1.0])
    in_range = _LEAST_ANGLE <= theta <= _LARGEST_ANGLE
    if not (in_range and LEAST_RATIO <= h <= LARGEST_RATIO * (1.0 + 1e-9)):
        warn(
            "foundation-range",
            f"root half angle {theta:.4g} rad, root to bore radius {h:.4g}: the foundation "
            f"formula holds for {_LEAST_ANGLE:g} to {_LARGEST_ANGLE:g} rad and {LEAST_RATIO:g} to "
            f"{LARGEST_RATIO:g}; check the bore, or choose another stiffness model",
        )
    L, M, P, Q = (float(value) for value in _POLYNOMIALS @ terms)
    return L, M, P, Q


def sainsot_compliance(
    load_angle: Number,
    load_height: Number,
    root_half_angle: float,
    root_radius: float,
    bore_radius: float,
    face_width: float,
    material: Material,
) -> Number:
    """Compliance of the foundation along the line of action.

    ``cos^2(a) / (b E) [L* (u/S)^2 + M* u/S + P* (1 + Q* tan^2 a)]`` with the foot width
    ``S = 2 r_f theta_f``.

    Parameters
    ----------
    load_angle : float or array [rad]
        Angle between the load and the normal of the tooth axis.
    load_height : float or array [m]
        Height ``u`` above the root circle at which the load meets the tooth axis.
    root_half_angle, root_radius, bore_radius : float [rad], [m], [m]
        As for :func:`sainsot_coefficients`.
    face_width, material : float [m], Material
        Of the gear.

    Returns
    -------
    float or array [m/N]

    Raises
    ------
    InputError
        If a width, angle or radius is not positive.

    Notes
    -----
    Range as :func:`sainsot_coefficients`. The body is held at its bore, so its wind-up is part of
    the result: the term of ``P*`` with ``h^2`` is the torsion of the ring between bore and root
    circle. Adding :func:`tribodyn.stiffness.wind_up_compliance` would count it twice. Source:
    Sainsot, Velex and Duverger (2004), J. Mech. Des. 126, 748-752, equation 9.

    Examples
    --------
    >>> from tribodyn.gear import Material
    >>> compliance = sainsot_compliance(0.3, 5e-3, 0.1, 0.045, 0.015, 0.02, Material())
    >>> print(f"{compliance * 1e9:.4f} um/kN")
    1.5455 um/kN
    """
    require_positive("face_width", face_width, "m")
    L, M, P, Q = sainsot_coefficients(root_half_angle, root_radius, bore_radius)
    ratio = load_height / (2.0 * root_radius * root_half_angle)
    bracket = L * ratio**2 + M * ratio + P * (1.0 + Q * np.tan(load_angle) ** 2)
    compliance: Number = np.cos(load_angle) ** 2 / (face_width * material.youngs_modulus) * bracket
    return compliance


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
    root_radius, bore_radius, face_width : float [m]
        Outer and inner radius of the ring, and its width.
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
            f"bore radius {bore_radius * 1e3:g} mm",
            where='stiffness reference = "bore"',
            why="The bore is the fixed end of the gear body; a shaft of no diameter gives "
            "way without limit",
            remedy='Give bore_diameter, or choose reference = "rim", which leaves the wind-up '
            "of the body out",
        )
    if bore_radius >= root_radius:
        what = f"bore diameter {2e3 * bore_radius:.4g} mm, root diameter {2e3 * root_radius:.4g} mm"
        why = "The body is the ring between the two"
        raise InputError(what, "bore_diameter", why, "Give a bore smaller than the root circle")
    ring = 1.0 / bore_radius**2 - 1.0 / root_radius**2
    return base_radius**2 / (4.0 * np.pi * material.shear_modulus * face_width) * ring


#: Where the gear body is held: at the bore, or rigidly under the teeth.
REFERENCES = ("bore", "rim")


class ToothCompliance(NamedTuple):
    """Compliance of one gear along the line of action, by where it arises.

    Parameters
    ----------
    bending, shear, axial : array [m/N]
        Tooth from its foot to the load.
    foundation : array [m/N]
        Fillet and gear body under the tooth, without the wind-up.
    wind_up : float [m/N]
        Torsion of the body between bore and root circle; zero with the rim as reference.
    """

    bending: Array
    shear: Array
    axial: Array
    foundation: Array
    wind_up: float

    @property
    def total(self) -> Array:
        """Sum of all [m/N]."""
        return self.bending + self.shear + self.axial + self.foundation + self.wind_up


def check_choice(name: str, value: str, choices: tuple[str, ...], why: str) -> None:
    """Refuse a word that an option of the models does not know."""
    if value not in choices:
        remedy = "Write " + " or ".join(f'"{choice}"' for choice in choices)
        raise InputError(f'{name} = "{value}"', ModelOption("stiffness", name=name), why, remedy)


def check_reference(reference: str) -> None:
    """Refuse a name that is no body reference."""
    why = "The body of each gear is held at its bore or under its rim"
    check_choice("reference", reference, REFERENCES, why)


def tooth_compliance(
    gear: SpurGear, load: LoadPoint, face_width: float, material: Material, reference: str = "bore"
) -> ToothCompliance:
    """Structural compliance of one gear loaded at one tooth, without the local compression.

    Parameters
    ----------
    gear : SpurGear
        The loaded gear.
    load : LoadPoint
        Where the load meets the tooth.
    face_width : float [m]
        Width that carries: the common face width of the pair.
    material : Material
        Material of the gear.
    reference : str
        ``"bore"``: with the wind-up of the body between bore and root circle; ``"rim"``: without.

    Raises
    ------
    InputError
        If the reference is unknown, or is the bore of a gear without bore.

    Notes
    -----
    Plane stress. The foot of the tooth is where the rack-generated fillet meets the root circle.
    The foundation formula holds the body at its bore and so contains the wind-up; it is taken
    out for the rim, and for a bore below a seventh of the root radius the formula is used at a
    seventh and the wind-up of the rest added. Source:
    :func:`tribodyn.stiffness.tooth_bending_compliance`,
    :func:`tribodyn.stiffness.sainsot_compliance`, :func:`tribodyn.stiffness.wind_up_compliance`.

    Examples
    --------
    >>> from tribodyn.gear import SpurGear
    >>> from tribodyn.stiffness import load_point
    >>> gear = SpurGear(teeth=24, normal_module=4.5e-3, normal_pressure_angle=0.349066,
    ...     profile_shift_coefficient=0.0, tip_diameter=0.117, face_width=0.02)
    >>> parts = tooth_compliance(gear, load_point(gear, 0.02), 0.02, Material(), "rim")
    >>> bool(parts.foundation > parts.axial), parts.wind_up
    (True, 0.0)
    """
    check_reference(reference)
    section = tooth_section(gear)
    root_radius = section.root_radius
    bore_radius = 0.5 * gear.bore_diameter
    tooth = tooth_bending_compliance(
        section, load.height, load.half_thickness, load.load_angle, face_width, material
    )

    def wind_up(held_at: float) -> float:
        return wind_up_compliance(gear.base_radius, root_radius, held_at, face_width, material)

    fitted_bore = max(bore_radius, root_radius / LARGEST_RATIO)
    held_at_bore = sainsot_compliance(
        load.load_angle,
        load.axis_height - root_radius,
        section.root_half_angle,
        root_radius,
        fitted_bore,
        face_width,
        material,
    )
    return ToothCompliance(
        *tooth,
        foundation=held_at_bore - wind_up(fitted_bore),
        wind_up=wind_up(bore_radius) if reference == "bore" else 0.0,
    )
