"""Laws of one mean coefficient for a whole mesh, from its load and speeds at the pitch point."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.contact import path_of_contact
from tribodyn.errors import require_one_of, require_positive
from tribodyn.friction.base import LAWS, Range, TribologicalContact, warn_outside
from tribodyn.gear import SpurPair
from tribodyn.model import choice, number
from tribodyn.types import Array, ByName


@dataclass(frozen=True)
class PitchPoint:
    """A mesh at its pitch point, the whole normal force on one line of contact.

    Parameters
    ----------
    load_per_width : float [N/m]
        Tangential load at the base circle per face width.
    sum_velocity : float [m/s]
        SUM of the surface speeds.
    equivalent_radius : float [m]
        Reduced radius of curvature.
    pitch_line_velocity : float [m/s]
        Speed of the pitch circles.
    pinion_pitch_diameter : float [m]
        Operating pitch diameter of the pinion.
    load_intensity : float [Pa]
        K-factor: pitch-line load over face width and pitch diameter of the pinion, times (u + 1)/u.
    driving_torque : float [N*m]
        Torque on the driving gear.
    driving_speed : float [rad/s]
        Speed of the driving gear.

    Examples
    --------
    >>> PitchPoint(133022.0, 2.6333, 8.3822e-3, 3.4495, 73.2e-3, 2.8e6, 90.0, 94.2).sum_velocity
    2.6333
    """

    load_per_width: float
    sum_velocity: float
    equivalent_radius: float
    pitch_line_velocity: float
    pinion_pitch_diameter: float
    load_intensity: float
    driving_torque: float
    driving_speed: float


def pitch_point(pair: SpurPair, pinion_speed: float, pinion_torque: float) -> PitchPoint:
    """Loads and speeds of a cylindrical pair at its pitch point.

    Parameters
    ----------
    pair : SpurPair
        The pair.
    pinion_speed : float [rad/s]
        Speed of the pinion.
    pinion_torque : float [N*m]
        Torque on the pinion.

    Raises
    ------
    InputError
        If speed or torque is not positive.

    Source: ISO/TR 14179-1 (load intensity) and ISO/TR 14179-2 (the others).

    Examples
    --------
    >>> import math
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...                  normal_pressure_angle=math.radians(20.0), pinion_face_width=50e-3)
    >>> point = pitch_point(pair, 100.0, 200.0)
    >>> round(point.sum_velocity / point.pitch_line_velocity, 6)  # twice the sine of 20 degrees
    0.68404
    """
    require_positive("pinion_speed", pinion_speed, "rad/s")
    require_positive("pinion_torque", pinion_torque, "N*m")
    contact = path_of_contact(pair)
    motion = contact.kinematics(contact.C, pinion_speed)
    width = pair.common_face_width
    radius = abs(pair.center_distance / (1.0 + pair.ratio))
    turned = 1.0 if pair.driver == "pinion" else abs(pair.ratio)
    return PitchPoint(
        load_per_width=pinion_torque / pair.pinion.base_radius / width,
        sum_velocity=2.0 * float(motion.entrainment_speed),
        equivalent_radius=float(motion.equivalent_radius),
        pitch_line_velocity=pinion_speed * radius,
        pinion_pitch_diameter=2.0 * radius,
        load_intensity=pinion_torque * (1.0 + 1.0 / pair.ratio) / (2.0 * width * radius**2),
        driving_torque=pinion_torque * turned,
        driving_speed=pinion_speed / turned,
    )


_FASTEST = 35.0  # [m/s] sum of the surface speeds, 50 m/s at the pitch circle
#: Arguments of the formula: unit, and the factor that makes N/mm, m/s, mm, mPa s and um of it.
_STATE = {
    "load_per_width": ("N/m", 1e-3),
    "sum_velocity": ("m/s", 1.0),
    "equivalent_radius": ("m", 1e3),
    "dynamic_viscosity": ("Pa*s", 1e3),
    "roughness_ra": ("m", 1e6),
}

#: Mean Ra of both flanks over their composite rms roughness, heights being Gaussian and both
#: flanks equal: sqrt(2/pi) of the rms of one, which is composite/sqrt(2).
RA_OF_COMPOSITE = math.sqrt(1.0 / math.pi)

#: Options of every law that is fitted to Ra and knows oils by a factor.
OPTIONS = {
    "roughness_ra": number(
        None,
        1e-9,
        1e-4,
        "guards against a wrong unit",
        unit="m",
        display_unit="um",
        symbol="Ra",
        example='"0.3 um"',
        meaning="mean Ra of both flanks",
        basis="0.564 times the composite rms roughness: Gaussian heights, the same on both flanks",
    ),
    "lubricant_factor": number(
        1.0,
        0.3,
        2.0,
        "published factors lie between 0.5 and 1.5",
        symbol="X_L",
        meaning="factor of the base oil: mineral 1, PAO and esters 0.8, polyglycols 0.6 to 0.7",
        example="0.8",
    ),
}


def mean_friction(
    law: str,
    state: tuple[ArrayLike, ...],
    lubricant_factor: ArrayLike,
    factor: Callable[[Array, Array, Array, Array], Array | float],
    fastest: float = _FASTEST,
) -> Array:
    """Formula of this family, times a factor of load, speed, radius and viscosity.

    ``state`` is that of ``_STATE`` in SI; the formula and the factor have engineers' units.
    """
    values = []
    for (name, (unit, scale)), value in zip(_STATE.items(), state, strict=True):
        require_positive(name, value, unit, remedy="1 N/mm is 1000 N/m" if unit == "N/m" else "")
        values.append(scale * np.asarray(value, dtype=float))
    require_positive("lubricant_factor", lubricant_factor)
    load, speed, radius, viscosity, roughness = values
    formula = (load / (speed * radius)) ** 0.2 * viscosity**-0.05 * roughness**0.25
    family = factor(load, speed, radius, viscosity) * formula
    coefficient = np.asarray(family * np.asarray(lubricant_factor, dtype=float))[()]
    warn_outside(
        law,
        (
            Range("sum_velocity", speed, 0.0, fastest, "m/s"),
            Range("Ra", roughness, 0.0, 4.0, "um"),
            Range("friction coefficient", coefficient, 0.0, 0.2),
        ),
        "Check the units, or compare with another friction law.",
    )
    return coefficient


def mean_law(
    name: str, *, law_options: ByName | None = None, rough: bool = True, **about: Any
) -> Callable[[Callable[..., Array]], None]:
    """Register a function of contacts and their pitch point as a law with one value everywhere.

    With ``rough`` it receives the arguments of the formula above as ``state``, and its own options.
    """

    def keep(function: Callable[..., Array]) -> None:
        def law(contact: TribologicalContact, **options: Any) -> Array:
            point: PitchPoint = contact.require("pitch")
            if rough:
                options["state"] = _state(contact, point, options.pop("roughness_ra"))
                options["state"]["lubricant_factor"] = options.pop("lubricant_factor")
            return np.full(np.shape(contact.load_per_width), function(contact, point, **options))

        shared = OPTIONS if rough else {}
        LAWS.define(name, options={**(law_options or {}), **shared}, **about)(law)

    return keep


def _state(contact: TribologicalContact, point: PitchPoint, ra: float | None) -> dict[str, float]:
    return {
        "load_per_width": point.load_per_width,
        "sum_velocity": point.sum_velocity,
        "equivalent_radius": point.equivalent_radius,
        "dynamic_viscosity": contact.dynamic_viscosity,
        "roughness_ra": RA_OF_COMPOSITE * contact.composite_roughness if ra is None else ra,
    }


def schlenk(
    load_per_width: ArrayLike,
    sum_velocity: ArrayLike,
    equivalent_radius: ArrayLike,
    dynamic_viscosity: ArrayLike,
    roughness_ra: ArrayLike,
    lubricant_factor: ArrayLike = 1.0,
) -> Array:
    """Mean friction coefficient of a mesh by the formula of Schlenk.

    ``mu = 0.048 (F_bt/b / (v_sum rho))^0.2 eta^-0.05 Ra^0.25 X_L`` at the pitch point; N/mm, m/s,
    mm, mPa s and um.

    Parameters
    ----------
    load_per_width : float or array [N/m]
        Tangential load at the base circle per face width.
    sum_velocity : float or array [m/s]
        SUM of the surface speeds at the pitch point.
    equivalent_radius : float or array [m]
        Reduced radius of curvature at the pitch point.
    dynamic_viscosity : float or array [Pa*s]
        Viscosity at ambient pressure and oil temperature.
    roughness_ra : float or array [m]
        Mean of the arithmetical roughnesses Ra of both flanks.
    lubricant_factor : float or array
        X_L: mineral oil 1, PAO and esters 0.8, polyglycols about 0.7.

    Returns
    -------
    float or array
        Friction coefficient, of the common shape of the arguments.

    Raises
    ------
    InputError
        If a value is not finite or not positive.

    Warns
    -----
    ModelWarning
        Code ``friction-range`` where the speeds add up to more than 35 m/s, which is some 50 m/s
        at the pitch circle, Ra exceeds 4 um or the coefficient 0.2.

    Fitted to FZG tests of steel gears; open programs for gearbox losses have the same constants.
    Source: Schlenk, Diss. TU Munich (1994); ISO/TR 14179-2.

    Examples
    --------
    >>> round(float(schlenk(133022.0, 2.633310, 8.382091e-3, 0.082, 0.53e-6)), 5)
    0.04706
    """
    state = (load_per_width, sum_velocity, equivalent_radius, dynamic_viscosity, roughness_ra)
    return mean_friction("schlenk", state, lubricant_factor, lambda *_: 0.048)


mean_law(
    "schlenk",
    source="Schlenk, Diss. TU Munich (1994)",
    meaning="mean friction coefficient of a mesh, fitted to FZG tests of loss",
    papers=("schlenk",),
)(lambda contact, point, state: schlenk(**state))


#: Published forms and what they are.
FORMS = {
    "winter-michaelis": "0.045 (F_bt/b / (v_sum rho))^0.2 eta^-0.05 X_R X_L with "
    "X_R = 3.8 (Ra/d_1)^0.25",
    "iso-tc60": "the older 0.12 (F_bt/b Ra / (eta v_sum rho))^0.25, without a factor of the oil",
}


def niemann(
    load_per_width: ArrayLike,
    sum_velocity: ArrayLike,
    equivalent_radius: ArrayLike,
    dynamic_viscosity: ArrayLike,
    roughness_ra: ArrayLike,
    pinion_diameter: ArrayLike,
    lubricant_factor: ArrayLike = 1.0,
    *,
    form: str = "winter-michaelis",
) -> Array:
    """Mean friction coefficient of a mesh by Niemann and Winter.

    ``mu = 0.045 (F_bt/b / (v_sum rho))^0.2 eta^-0.05 X_R X_L`` with ``X_R = 3.8 (Ra/d_1)^0.25``, or
    the older ``mu = 0.12 (F_bt/b Ra / (eta v_sum rho))^0.25`` of ISO/TC 60; N/mm, m/s, mm, mPa s
    and um.

    Parameters
    ----------
    load_per_width, sum_velocity, equivalent_radius, dynamic_viscosity, roughness_ra
        State at the pitch point, each in the same unit as for :func:`schlenk`.
    pinion_diameter : float or array [m]
        Pitch diameter of the pinion.
    lubricant_factor : float or array
        X_L: mineral oil 1, PAO and esters 0.8, polyglycols about 0.7.
    form : {"winter-michaelis", "iso-tc60"}
        Published form.

    Returns
    -------
    float or array
        Friction coefficient, of the common shape of the arguments.

    Raises
    ------
    InputError
        If a value is not finite or not positive, or the form is unknown.

    Warns
    -----
    ModelWarning
        Code ``friction-range`` where the speeds add up to more than 35 m/s, Ra exceeds 4 um or the
        coefficient 0.2.

    No second source of the constants was found. Source: Niemann and Winter, Maschinenelemente II;
    Winter and Michaelis (1985); the older form as listed by Xu et al. (2007).

    Examples
    --------
    >>> print(round(float(niemann(133022.0, 2.6333, 8.382e-3, 0.082, 0.53e-6, 73.2e-3)), 4))
    0.0573
    """
    require_one_of("form", form, FORMS)
    require_positive("pinion_diameter", pinion_diameter, "m")
    state = (load_per_width, sum_velocity, equivalent_radius, dynamic_viscosity, roughness_ra)
    size = 3.8 * (1e3 * np.asarray(pinion_diameter, dtype=float)) ** -0.25

    def old(load: Array, speed: Array, radius: Array, viscosity: Array) -> Array:
        """Powers 0.25 of all instead of the family's 0.2 and -0.05, and no factor of the oil."""
        powers = (load / (speed * radius)) ** 0.05 * viscosity**-0.2
        return np.asarray(0.12 * powers / np.asarray(lubricant_factor, dtype=float))

    factor = old if form == "iso-tc60" else lambda *_: 0.045 * size
    return mean_friction("niemann", state, lubricant_factor, factor)


@mean_law(
    "niemann",
    source="Niemann and Winter, Maschinenelemente II (2003)",
    meaning="mean friction coefficient of a mesh, as the textbook on machine elements has it",
    law_options={"form": choice("winter-michaelis", FORMS, meaning="published form")},
    papers=("niemann-winter",),
)
def _niemann(contact: object, point: PitchPoint, state: dict[str, float], form: str) -> Array:
    return niemann(**state, pinion_diameter=point.pinion_pitch_diameter, form=form)


def iso_6336_22(
    load_per_width: ArrayLike,
    sum_velocity: ArrayLike,
    equivalent_radius: ArrayLike,
    dynamic_viscosity: ArrayLike,
    roughness_ra: ArrayLike,
    lubricant_factor: ArrayLike = 1.0,
) -> Array:
    """Mean friction coefficient of a mesh by ISO/TS 6336-22.

    ``mu = 0.045 (K F_bt/b / (v_sum rho))^0.2 eta^-0.05 X_R X_L`` at the pitch point with
    ``X_R = 2.2 (Ra/rho)^0.25``; N/mm, m/s, mm, mPa s and um.

    Parameters
    ----------
    load_per_width, sum_velocity, equivalent_radius, dynamic_viscosity, roughness_ra
        State at the pitch point, each in the same unit as for :func:`schlenk`; the load times
        the load factors K of ISO 6336-1.
    lubricant_factor : float or array
        X_L: mineral oil 1, PAO 0.8, polyglycols 0.6 (water-soluble) or 0.7, phosphate ester 1.3,
        traction fluid 1.5.

    Returns
    -------
    float or array
        Friction coefficient, of the common shape of the arguments.

    Raises
    ------
    InputError
        If a value is not finite or not positive.

    Warns
    -----
    ModelWarning
        Code ``friction-range`` where the speeds add up to more than 35 m/s, Ra exceeds 4 um or the
        coefficient 0.2.

    No second source of the constants was found. Source: ISO/TS 6336-22:2018 (before: ISO/TR
    15144-1), mean coefficient of friction.

    Examples
    --------
    >>> print(round(float(iso_6336_22(133022.0, 2.6333, 8.382e-3, 0.082, 0.53e-6)), 4))
    0.057
    """
    state = (load_per_width, sum_velocity, equivalent_radius, dynamic_viscosity, roughness_ra)
    return mean_friction(
        "iso-6336-22", state, lubricant_factor, lambda _, v, rho, eta: 0.045 * 2.2 * rho**-0.25
    )


_LOAD_FACTOR = number(
    1.0,
    0.5,
    10.0,
    "load factors of ISO 6336-1 lie between 1 and 4",
    meaning="product of the load factors of ISO 6336-1 on the load",
    symbol="K",
    example="1.3",
)


@mean_law(
    "iso-6336-22",
    source="ISO/TS 6336-22:2018",
    meaning="mean friction coefficient of a mesh, as the micropitting standard has it",
    law_options={"load_factor": _LOAD_FACTOR},
    papers=("iso-6336-22",),
)
def _iso_6336_22(
    contact: object, point: PitchPoint, state: dict[str, float], load_factor: float
) -> Array:
    return iso_6336_22(**{**state, "load_per_width": load_factor * point.load_per_width})
