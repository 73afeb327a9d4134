"""Friction of rolling and sliding discs: the formula of Misharin."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import require_between, require_positive
from tribodyn.friction.base import LAWS, TribologicalContact
from tribodyn.friction.validity import Range, warn_outside
from tribodyn.types import Array

#: Range of the coefficients measured, in which the formula is held: it has a pole where sliding
#: stops, and no end at high speed.
LIMITS = (0.02, 0.08)


def misharin(
    sliding_speed: ArrayLike,
    entrainment_speed: ArrayLike,
    kinematic_viscosity: ArrayLike,
    hertz_pressure: ArrayLike | None = None,
) -> Array:
    """Friction coefficient by Misharin, held within 0.02 and 0.08.

    ``mu = 0.325 (v_s v_r nu)^-0.25`` with speeds in m/s and nu in mm^2/s; v_r is the SUM of the
    surface speeds.

    Parameters
    ----------
    sliding_speed : float or array [m/s]
        Difference of the surface speeds; its sign does not matter.
    entrainment_speed : float or array [m/s]
        HALF the sum of the surface speeds; the formula itself takes the sum.
    kinematic_viscosity : float or array [m^2/s]
        Viscosity over density at the inlet.
    hertz_pressure : float or array [Pa], optional
        Maximum Hertzian pressure, for the range only.

    Returns
    -------
    float or array
        Friction coefficient, of the common shape of speeds and viscosity.

    Raises
    ------
    InputError
        If a value is not finite, or not positive where it must be.

    Warns
    -----
    ModelWarning
        Code ``friction-range`` below 245 MPa (2500 kgf/cm^2), and where the formula leaves 0.02
        to 0.08, as it does where sliding stops.

    Fitted to disc tests. No second source of the constants was found. Source: Misharin, Proc. Int.
    Conf. Gearing, IMechE (1958), as listed by Xu et al. (2007).

    Examples
    --------
    >>> round(float(misharin(1.0, 2.0, 93e-6)), 4)
    0.074
    """
    require_between("sliding_speed", sliding_speed, -np.inf, np.inf, "m/s")
    require_positive("entrainment_speed", entrainment_speed, "m/s")
    require_positive("kinematic_viscosity", kinematic_viscosity, "m^2/s")
    sliding = np.abs(np.asarray(sliding_speed, dtype=float))
    rolling = 2.0 * np.asarray(entrainment_speed, dtype=float)
    viscosity = 1e6 * np.asarray(kinematic_viscosity, dtype=float)
    with np.errstate(divide="ignore"):
        formula = np.asarray(0.325 / np.sqrt(np.sqrt(sliding * rolling * viscosity)))
    ranges = [Range("friction coefficient", formula, *LIMITS)]
    if hertz_pressure is not None:
        require_positive("hertz_pressure", hertz_pressure, "Pa")
        ranges.append(
            Range("hertz_pressure", 1e-6 * np.asarray(hertz_pressure), 245, np.inf, "MPa")
        )
    warn_outside("misharin", ranges, "The coefficient is held within 0.02 and 0.08.")
    return np.asarray(np.clip(formula, *LIMITS))[()]


@LAWS.define(
    "misharin",
    source="Misharin, Int. Conf. Gearing, IMechE (1958)",
    meaning="friction coefficient of discs: falls with speeds and viscosity, whatever the load",
    papers=("misharin", "xu"),
)
def _law(contact: TribologicalContact) -> Array:
    return misharin(
        contact.sliding_speed,
        contact.entrainment_speed,
        contact.kinematic_viscosity,
        contact.hertz_pressure,
    )
