"""Friction of the mixed-film tooth contact: the formula of Benedict and Kelley."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import InputError, require_between, require_positive, warn
from tribodyn.friction.base import DRY_STEEL, LAWS, of_columns
from tribodyn.model import Registry, choice, number
from tribodyn.nomenclature import positive
from tribodyn.types import Array

#: Floor of the sliding speed [m/s]. The formula grows without bound as sliding stops, though only
#: by some 0.02 per decade. A tooth slides slower than 1 mm/s on a thousandth of its path, so the
#: floor changes no mean, and keeps the coefficient finite where the friction reverses.
MINIMUM_SLIDING_SPEED = 1e-3

#: Factor of the logarithm: as published, and as printed in studies after He and Singh.
VARIANTS: Registry[float] = Registry("variant of the Benedict-Kelly formula")
VARIANTS.register("benedict-kelly")(0.0127)
VARIANTS.register("he-singh")(0.0137)

#: Rolling speed over entrainment speed: the mean of the surface speeds, or their sum, which the
#: original paper uses. The sum lowers the coefficient of smooth flanks by 0.0076.
ROLLING_SPEEDS: Registry[float] = Registry("rolling speed of the Benedict-Kelly formula")
ROLLING_SPEEDS.register("mean")(1.0)
ROLLING_SPEEDS.register("sum")(2.0)

_LIMIT = 1.13  # [um] roughness at which the formula diverges
_TRUSTED = 0.8  # [um] roughness above which the divergence rules
_CREEP = 0.1  # [m/s] entrainment speed below which there is hardly a film
_GREATEST = 0.2  # friction coefficient that lubricated steel hardly exceeds
_UNITS = 29700.0  # [mPa*s (m/s)^3 mm/N] makes the argument of the logarithm a pure number


def benedict_kelly(
    load_per_width: ArrayLike,
    sliding_speed: ArrayLike,
    entrainment_speed: ArrayLike,
    dynamic_viscosity: ArrayLike,
    roughness: ArrayLike,
    *,
    variant: str = "benedict-kelly",
    rolling_speed: str = "mean",
    minimum_sliding_speed: float = MINIMUM_SLIDING_SPEED,
) -> Array:
    """Friction coefficient by Benedict and Kelley.

    ``mu = 0.0127 * 1.13/(1.13 - S) * log10(29700 W' / (eta v_s v_e^2))`` with W' in N/mm, eta in
    cP, speeds in m/s and S in um. Largest at the pitch point, where the sliding speed is held at
    ``minimum_sliding_speed``.

    Parameters
    ----------
    load_per_width : float or array [N/m]
        Normal load of the tooth pair per face width.
    sliding_speed : float or array [m/s]
        Difference of the surface speeds; its sign does not matter.
    entrainment_speed : float or array [m/s]
        HALF the sum of the surface speeds.
    dynamic_viscosity : float or array [Pa*s]
        Viscosity at ambient pressure and oil temperature.
    roughness : float or array [m]
        Composite roughness, below 1.13 um.
    variant : {"benedict-kelly", "he-singh"}
        Factor 0.0127 as published, or 0.0137.
    rolling_speed : {"mean", "sum"}
        Speed v_e in the formula: half the sum of the surface speeds, or the sum.
    minimum_sliding_speed : float [m/s]
        Floor of the sliding speed. The formula is singular where sliding stops.

    Returns
    -------
    float or array
        Friction coefficient of the common shape of the arguments, from zero to that of dry
        steel, 0.78.

    Raises
    ------
    InputError
        If a value is not finite or not positive, or the roughness is 1.13 um or more.

    Warns
    -----
    ModelWarning
        Code ``friction-roughness`` above 0.8 um; code ``friction-range`` where the logarithm is
        negative and the coefficient is set to zero, below an entrainment speed of 0.1 m/s, where
        the coefficient exceeds 0.2, and where it exceeds 0.78 and is limited to that.

    Fitted to ground steel discs with a factor ``1.13/(1.13 - S)`` of at most 3, S to 0.75 um.
    Source: Benedict and Kelley, ASLE Trans. 4 (1961), with the constants of later gear studies.

    Examples
    --------
    >>> round(float(benedict_kelly(133022.0, 0.913038, 1.407953, 0.082, 0.53e-6)), 6)
    0.105843
    """
    require_between("sliding_speed", sliding_speed, -np.inf, np.inf, "m/s")
    require_positive("minimum_sliding_speed", minimum_sliding_speed, "m/s")
    load, speed, viscosity = positive(
        load_per_width=load_per_width,
        entrainment_speed=entrainment_speed,
        dynamic_viscosity=dynamic_viscosity,
    )
    rough = _roughness_factor(roughness)
    load, viscosity = load * 1e-3, viscosity * 1e3
    sliding = np.maximum(np.abs(np.asarray(sliding_speed, dtype=float)), minimum_sliding_speed)
    rolling = ROLLING_SPEEDS[rolling_speed] * speed
    argument = _UNITS * load / (viscosity * sliding * rolling**2)
    coefficient = _clipped(VARIANTS[variant] * rough * np.log10(argument))
    _warn_of_range(coefficient, rough, entrainment_speed)
    return np.asarray(np.minimum(coefficient, DRY_STEEL))[()]


def _roughness_factor(roughness: ArrayLike) -> Array:
    """Return 1.13/(1.13 - S), refused where it diverges and warned of where it soars."""
    require_between("roughness", roughness, 0.0, np.inf, "m")
    micrometres = np.asarray(roughness, dtype=float) * 1e6
    roughest = float(np.max(micrometres))
    if roughest >= _LIMIT:
        why = f"the Benedict-Kelly formula diverges at {_LIMIT:g} um"
        remedy = "Check the unit (m), or choose another friction law"
        raise InputError(f"roughness = {roughest:.4g} um", "argument roughness", why, remedy)
    factor = np.asarray(_LIMIT / (_LIMIT - micrometres))
    if roughest > _TRUSTED:
        warn(
            "friction-roughness",
            f"benedict-kelly: roughness = {roughest:.4g} um is above {_TRUSTED:g} um, where the "
            f"formula multiplies the friction by {np.max(factor):.3g} on its way to infinity at "
            f"{_LIMIT:g} um; it was fitted up to a factor of 3. Choose another friction law.",
            stacklevel=3,
        )
    return factor


def _clipped(coefficient: Array) -> Array:
    """Set negative coefficients to zero and say so."""
    least = float(np.min(coefficient))
    if least < 0.0:
        warn(
            "friction-range",
            f"benedict-kelly: the logarithm is negative (friction coefficient down to "
            f"{least:.3g}) where the load is too small for the viscosity and the speed; the "
            "coefficient is set to 0 there. Choose another friction law.",
            stacklevel=3,
        )
    return np.asarray(np.maximum(coefficient, 0.0))[()]


def _warn_of_range(coefficient: Array, rough: Array, entrainment_speed: ArrayLike) -> None:
    """Say where surfaces creep, or where roughness lifts friction above that of steel."""
    greatest, slowest = float(np.max(coefficient)), float(np.min(entrainment_speed))
    factor = float(np.max(rough))
    observation = f"benedict-kelly: friction coefficient up to {greatest:.3g}"
    steel = f"lubricated steel stays below {_GREATEST:g}"
    if greatest > DRY_STEEL:
        cause = (
            f"is limited to {DRY_STEEL:g}, that of dry steel: the roughness factor "
            f"1.13/(1.13 - S) has grown to {factor:.3g}. Give the rms roughness of run-in flanks, "
            "or choose another friction law."
        )
    elif slowest < _CREEP:
        cause = (
            f"at entrainment speeds from {slowest:.3g} m/s on; the formula was fitted to running "
            f"films, and {steel}. Do not use it below {_CREEP:g} m/s: choose another friction law."
        )
    elif greatest > _GREATEST and factor <= _LIMIT / (_LIMIT - _TRUSTED):
        # A steeper roughness factor has its own warning.
        micrometres = _LIMIT * (1.0 - 1.0 / factor)
        cause = (
            f"where {steel}: the roughness factor 1.13/(1.13 - S) multiplies that of smooth ones, "
            f"{greatest / factor:.3g}, by {factor:.3g} at S = {micrometres:.3g} um. Give the "
            "rms roughness of run-in flanks, or choose another friction law."
        )
    else:
        return
    warn("friction-range", f"{observation} {cause}", stacklevel=3)


_OPTIONS = {
    "variant": choice(
        "benedict-kelly",
        {
            "benedict-kelly": "friction coefficient of the mixed film, fitted to disc tests: falls "
            "with the logarithm of the speeds",
            "he-singh": "variant of the Benedict-Kelly law with the factor 0.0137 in place of "
            "0.0127",
        },
        meaning="published form of the Benedict-Kelly law",
    ),
    "rolling_speed": choice(
        "mean", ("mean", "sum"), meaning="rolling speed of the Benedict-Kelly law: half sum or sum"
    ),
    "minimum_sliding_speed": number(
        MINIMUM_SLIDING_SPEED,
        1e-9,
        10.0,
        "guards against a wrong unit",
        of="sliding_speed",
        meaning="floor that keeps the law finite",
        example='"0.001 m/s"',
    ),
}


LAWS.define(
    "benedict-kelly",
    source="Benedict and Kelley, ASLE Trans. 4 (1961)",
    options=_OPTIONS,
    together=True,
    meaning=_OPTIONS["variant"].meanings["benedict-kelly"],
    papers=("benedict-kelley",),
)(of_columns(benedict_kelly))
