"""Friction by an exponential of the sliding and a power of the roughness."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import require_between, require_positive
from tribodyn.friction.base import LAWS, Range, of_columns, warn_outside
from tribodyn.model import number
from tribodyn.types import Array


def exponential(
    slide_to_roll_ratio: ArrayLike,
    hertz_pressure: ArrayLike,
    roughness: ArrayLike,
    reference_coefficient: float = 0.0465,
    slide_coefficient: float = 0.0,
    roughness_exponent: float = 0.5638,
    *,
    reference_roughness: float = 0.8e-6,
    reference_pressure: float = 1e9,
    least_slide_ratio: float = 0.02,
) -> Array:
    """Friction coefficient ``a exp(b |SR|) (S/S_0 sqrt(p_0/p))^c tanh(|SR|/SR_0)``.

    The printed law has ``(S/sqrt(p))^c``, which is no pure number, and claims a coefficient near
    zero at the pitch point that it does not give: hence the reference values and the last factor.

    Parameters
    ----------
    slide_to_roll_ratio : float or array
        Sliding speed over entrainment speed; its sign does not matter.
    hertz_pressure : float or array [Pa]
        Maximum Hertzian pressure.
    roughness : float or array [m]
        Composite roughness.
    reference_coefficient : float
        a, the coefficient at the reference values. Default: mean of the printed table at 0.8 um
        next to its pitch point.
    slide_coefficient : float
        b in the exponential.
    roughness_exponent : float
        c. Default: mean of the four positions of the printed table next to its pitch point.
    reference_roughness : float [m]
        S_0 that makes the power a pure number.
    reference_pressure : float [Pa]
        p_0 that makes the power a pure number.
    least_slide_ratio : float
        SR_0, the slide-to-roll ratio below which friction falls to zero.

    Returns
    -------
    float or array
        Friction coefficient, of the common shape of the arguments; zero in pure rolling.

    Raises
    ------
    InputError
        If a value is not finite, or not positive where it must be.

    Warns
    -----
    ModelWarning
        Code ``friction-range`` outside of the roughness 0.4 to 3.2 um of the printed table, and
        where the coefficient exceeds 0.2.

    Source: the time-varying friction of a study of spur gears, with its two defects mended.

    Examples
    --------
    >>> round(float(exponential(0.5, 1e9, 1.6e-6)), 4)  # printed: 0.062 to 0.078
    0.0687
    """
    require_between("slide_to_roll_ratio", slide_to_roll_ratio, -np.inf, np.inf)
    require_positive("hertz_pressure", hertz_pressure, "Pa")
    require_between("roughness", roughness, 0.0, np.inf, "m")
    require_between("reference_coefficient", reference_coefficient, 0.0, 1.0)
    require_between("slide_coefficient", slide_coefficient, -10.0, 10.0)
    require_between("roughness_exponent", roughness_exponent, 0.0, 5.0)
    require_positive("reference_roughness", reference_roughness, "m")
    require_positive("reference_pressure", reference_pressure, "Pa")
    require_positive("least_slide_ratio", least_slide_ratio)
    slide = np.abs(np.asarray(slide_to_roll_ratio, dtype=float))
    height = np.asarray(roughness, dtype=float) / reference_roughness
    pressure = np.asarray(hertz_pressure, dtype=float) / reference_pressure
    rough = (height / np.sqrt(pressure)) ** roughness_exponent
    with np.errstate(over="ignore"):
        growth = np.exp(slide_coefficient * slide)
    coefficient = reference_coefficient * growth * rough * np.tanh(slide / least_slide_ratio)
    coefficient = np.asarray(coefficient)[()]
    warn_outside(
        "exponential",
        (
            Range("roughness", 1e6 * np.asarray(roughness), 0.4, 3.2, "um"),
            Range("friction coefficient", coefficient, 0.0, 0.2),
        ),
        "Fit its three numbers to a measurement, or choose another friction law.",
    )
    return coefficient


LAWS.define(
    "exponential",
    source="a study of time-varying friction in spur gears, with reference values",
    together=True,
    meaning="exponential of the slide-to-roll ratio times a power of the roughness",
    options={
        "reference_coefficient": number(
            0.0465,
            0.0,
            1.0,
            "lubricated steel lies below 0.2",
            of="friction_coefficient",
            meaning="friction coefficient at the reference roughness and pressure",
        ),
        "slide_coefficient": number(
            0.0,
            -10.0,
            10.0,
            "the exponential means nothing beyond",
            meaning="factor of the slide-to-roll ratio in the exponential",
            example="-0.2",
        ),
        "roughness_exponent": number(
            0.5638,
            0.0,
            5.0,
            "the printed table has 0.55 to 0.58",
            meaning="exponent of roughness over root of pressure",
            example="0.56",
        ),
        "reference_roughness": number(
            0.8e-6,
            1e-9,
            1e-4,
            "guards against a wrong unit",
            of="composite_roughness",
            meaning="roughness of the reference coefficient",
        ),
        "reference_pressure": number(
            1e9,
            1e6,
            1e11,
            "guards against a wrong unit",
            of="hertz_pressure",
            meaning="Hertzian pressure of the reference coefficient",
            example='"1 GPa"',
        ),
        "least_slide_ratio": number(
            0.02,
            1e-6,
            1.0,
            "a tooth pair slides less on a few per cent of its path",
            meaning="slide-to-roll ratio below which friction falls to zero",
            example="0.02",
        ),
    },
    papers=("time-varying-friction",),
)(of_columns(exponential))
