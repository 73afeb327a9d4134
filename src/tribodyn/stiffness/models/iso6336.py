"""Single and mesh stiffness after ISO 6336-1, method B, spread over the path as a parabola."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.contact import path_of_contact
from tribodyn.errors import require_positive, warn
from tribodyn.gear import Material, SpurPair
from tribodyn.stiffness.model import MODELS, MeshState
from tribodyn.types import Array

#: N/(mm um) in SI.
_PER_WIDTH = 1e9
#: Measured over theoretical single stiffness for solid discs.
_CORRECTION_FACTOR = 0.8
#: Young's modulus of the steel to which the polynomial was fitted [Pa].
_STEEL_MODULUS = 206e9
#: Below this specific load the flanks do not bear over their whole width [N/m].
_FULL_BEARING_LOAD = 100e3


def iso6336_single_stiffness(
    pair: SpurPair,
    material: Material,
    normal_force: float,
    *,
    application_factor: float = 1.0,
    gear_blank_factor: float = 1.0,
) -> float:
    """Maximum stiffness of one tooth pair per face width, ``c'``.

    ``c' = C_M C_R C_B cos(beta) / q' * E / E_steel``, times ``(F_t K_A / b / (100 N/mm))^0.25``
    below 100 N/mm.

    Parameters
    ----------
    pair, material : SpurPair, Material
        Both gears in their working position, and their material.
    normal_force : float [N]
        Force along the line of action.
    application_factor, gear_blank_factor : float
        ``K_A``, and ``C_R``, which is 1 for solid discs.

    Returns
    -------
    float [N/m^2]
        Force per deflection and face width; 1e9 N/m^2 is 1 N/(mm um).

    Raises
    ------
    InputError
        If a factor or the force is not positive.

    Notes
    -----
    Valid for spur and helical gears with ``x1 >= x2`` and ``-0.5 <= x1 + x2 <= 2``; outside a
    warning ``iso6336-range``. Reference is the rim: the gear bodies do not wind up. Source: ISO
    6336-1, method B for the tooth stiffness (deflection polynomial q', factors C_M, C_R, C_B).

    Examples
    --------
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=30, wheel_teeth=30, normal_module=4e-3,
    ...     normal_pressure_angle=0.3490658504, pinion_face_width=0.02)
    >>> print(f"{iso6336_single_stiffness(pair, Material(), 4000.0) / 1e9:.3f} N/(mm um)")
    12.785 N/(mm um)
    """
    require_positive("normal_force", normal_force, "N")
    require_positive("application_factor", application_factor)
    require_positive("gear_blank_factor", gear_blank_factor)
    theoretical = _PER_WIDTH / _deflection_coefficient(pair)
    stiffness = theoretical * _CORRECTION_FACTOR * gear_blank_factor * _basic_rack_factor(pair)
    stiffness *= np.cos(pair.helix_angle)
    tangential = normal_force * np.cos(pair.pinion.transverse_pressure_angle)
    specific_load = tangential * application_factor / pair.common_face_width
    light = min(1.0, float(specific_load / _FULL_BEARING_LOAD)) ** 0.25
    return float(stiffness * light * material.youngs_modulus / _STEEL_MODULUS)


def _deflection_coefficient(pair: SpurPair) -> float:
    """Minimum of the pair's flexibility per width ``q'`` [mm um/N]."""
    # Teeth of the virtual spur gears; a ring counts as a rack.
    virtual = 1.0 / (np.cos(pair.base_helix_angle) ** 2 * np.cos(pair.helix_angle))
    z1 = pair.pinion.teeth * virtual
    z2 = np.inf if pair.is_internal else pair.wheel.teeth * virtual
    x1, x2 = pair.pinion.profile_shift_coefficient, pair.wheel.profile_shift_coefficient
    if x1 < x2 or not -0.5 <= x1 + x2 <= 2.0:
        warn(
            "iso6336-range",
            f"profile shifts {x1:g} and {x2:g}: the ISO 6336-1 stiffness polynomial holds for "
            "x1 >= x2 and -0.5 <= x1 + x2 <= 2; choose another stiffness model",
        )
    return float(
        0.04723
        + 0.15551 / z1
        + 0.25791 / z2
        - 0.00635 * x1
        - 0.11654 * x1 / z1
        - 0.00193 * x2
        - 0.24188 * x2 / z2
        + 0.00529 * x1**2
        + 0.00182 * x2**2
    )


def _basic_rack_factor(pair: SpurPair) -> float:
    """Basic rack factor ``[1 + 0.5 (1.2 - h_fP*)] [1 - 0.02 (20 deg - alpha)]``, mean of both."""
    factors = [
        (1.0 + 0.5 * (1.2 - gear.rack.dedendum_coefficient))
        * (1.0 - 0.02 * (20.0 - np.degrees(gear.normal_pressure_angle)))
        for gear in (pair.pinion, pair.wheel)
    ]
    return float(np.mean(factors))


def iso6336_mesh_stiffness(single_stiffness: float, transverse_contact_ratio: float) -> float:
    """Mean of the mesh stiffness per face width, ``c_gamma_alpha = c' (0.75 eps + 0.25)``.

    Parameters
    ----------
    single_stiffness : float [N/m^2]
        ``c'``.
    transverse_contact_ratio : float
        ``epsilon_alpha``.

    Returns
    -------
    float [N/m^2]

    Raises
    ------
    InputError
        If an argument is not positive.

    Notes
    -----
    For spur gears with a contact ratio of at least 1.2; up to 10 % lower below. Source: ISO
    6336-1, mesh stiffness ``c_gamma_alpha``.

    Examples
    --------
    >>> print(f"{iso6336_mesh_stiffness(14e9, 1.6) / 1e9:.2f} N/(mm um)")
    20.30 N/(mm um)
    """
    require_positive("single_stiffness", single_stiffness, "N/m^2")
    require_positive("transverse_contact_ratio", transverse_contact_ratio)
    return single_stiffness * (0.75 * transverse_contact_ratio + 0.25)


def iso6336_pair_stiffness(
    pair: SpurPair, material: Material, path: Array, normal_force: float, **factors: float
) -> Array:
    """Stiffness of one tooth pair along the path of contact.

    The standard gives two numbers and no course: the maximum of a single pair and the mean of
    the mesh. The course taken here is the parabola that has both: ``b c'`` in the middle of the
    path and ``b c' (1 - 0.75 (1 - 1 / eps))`` at its two ends, so that the sum over the pairs in
    contact has the mean ``b c_gamma_alpha``.

    Parameters
    ----------
    pair, material
        As for :func:`iso6336_single_stiffness`.
    path : array [m]
        Distance of the contact from the pinion's base tangent point.
    normal_force : float [N]
        Force along the line of action.
    **factors : float
        ``application_factor`` and ``gear_blank_factor`` of :func:`iso6336_single_stiffness`.

    Returns
    -------
    array [N/m]
        Shape of ``path``.

    Raises
    ------
    InputError
        As :func:`iso6336_single_stiffness`.

    Notes
    -----
    Range and source as :func:`iso6336_single_stiffness`; the parabola is this library's.

    Examples
    --------
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=30, wheel_teeth=30, normal_module=4e-3,
    ...     normal_pressure_angle=0.3490658504, pinion_face_width=0.02)
    >>> middle = np.array([pair.line_of_action_length / 2])
    >>> print(f"{iso6336_pair_stiffness(pair, Material(), middle, 4000.0)[0] / 20e6:.3f}")
    12.785
    """
    single = iso6336_single_stiffness(pair, material, normal_force, **factors)
    contact = path_of_contact(pair)
    ratio = contact.contact_ratio
    mean = iso6336_mesh_stiffness(single, ratio) / (single * ratio)
    from_middle = (2.0 * path - contact.A - contact.E) / (contact.E - contact.A)
    return pair.common_face_width * single * (1.0 - 3.0 * (1.0 - mean) * from_middle**2)


@MODELS.define(
    "iso6336",
    meaning="stiffness from the fitted formulas of ISO 6336-1, over the path as a parabola",
    papers=("iso-6336-1",),
)
def _model(*mesh: Any, **options: Any) -> Array:
    state = MeshState(*mesh)
    stiffness = iso6336_pair_stiffness(state.pair, state.material, state.path, state.normal_force)
    return np.where(state.in_contact, stiffness, 0.0)
