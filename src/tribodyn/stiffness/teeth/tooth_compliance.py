"""Structural compliance of one gear at one tooth: tooth, foundation and body."""

from __future__ import annotations

from typing import NamedTuple

from tribodyn.errors import InputError, ModelOption
from tribodyn.gear import Material, SpurGear
from tribodyn.stiffness.teeth.load_point import LoadPoint
from tribodyn.stiffness.teeth.sainsot import LARGEST_RATIO, sainsot_compliance, wind_up_compliance
from tribodyn.stiffness.teeth.tooth_bending import tooth_bending_compliance, tooth_section
from tribodyn.types import Array

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


def check_choice(name: str, value: str, known: tuple[str, ...], why: str) -> None:
    """Refuse a word that an option of the models does not know."""
    if value not in known:
        raise InputError(
            f'{name} = "{value}"',
            where=ModelOption("stiffness", name=name),
            why=why,
            remedy="Write " + " or ".join(f'"{word}"' for word in known),
        )


def check_reference(reference: str) -> None:
    """Refuse a name that is no body reference."""
    why = "The body of each gear is held at its bore or under its rim"
    check_choice("reference", reference, REFERENCES, why)


def tooth_compliance(
    gear: SpurGear,
    load: LoadPoint,
    face_width: float,
    material: Material,
    reference: str = "bore",
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

    Returns
    -------
    ToothCompliance

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
