"""Losses that do not depend on the load: seals, churning in an oil bath, windage."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import require_between, require_positive, warn
from tribodyn.types import Array
from tribodyn.units import RPM

_GRAVITY = 9.80665  # [m/s^2]


def seal_loss(shaft_diameter: ArrayLike, speed: ArrayLike) -> Array:
    """Power lost in a radial shaft seal.

    ``P = 7.69e-6 d^2 n`` with d in mm and n in rpm.

    Parameters
    ----------
    shaft_diameter : float or array [m]
        Diameter of the shaft under the lip.
    speed : float or array [rad/s]
        Speed of the shaft.

    Returns
    -------
    float or array
        Power [W].

    Raises
    ------
    InputError
        If a value is not finite, or the diameter not positive.

    Valid for lips of nitrile or fluorinated rubber in gear oil; an open program that quotes the
    standard has the same. Source: Freudenberg, in ISO/TR 14179-2.

    Examples
    --------
    >>> round(float(seal_loss(30e-3, 1400 * math.pi / 30)), 2)
    9.69
    """
    require_positive("shaft_diameter", shaft_diameter, "m", remedy="30 mm is 0.030 m")
    require_between("speed", speed, 0.0, np.inf, "rad/s")
    millimetres = 1e3 * np.asarray(shaft_diameter, dtype=float)
    return np.asarray(7.69e-6 * millimetres**2 * np.asarray(speed, dtype=float) / RPM)[()]


def churning_loss(
    pitch_radius: float,
    face_width: float,
    module: float,
    immersion: float,
    speed: float,
    oil_volume: float,
    oil_density: float,
    kinematic_viscosity: float,
) -> float:
    """Power lost by a spur gear that churns in an oil bath.

    ``P = rho/2 omega^3 S_m R^3 C_m``, slow with
    ``C_m = 1.366 (h/D)^0.45 (V/D^3)^0.1 Fr^-0.6 Re^-0.21``, fast with
    ``C_m = 3.644 (h/D)^0.1 (V/D^3)^-0.35 Fr^-0.88 (b/D)^0.85``. The acceleration
    ``omega^2 sqrt(R m)`` decides: slow below 750 m/s^2, fast above 1250 m/s^2, with a
    linear transition.

    Parameters
    ----------
    pitch_radius : float [m]
        R.
    face_width : float [m]
        b.
    module : float [m]
        m, for the heights of the wetted teeth.
    immersion : float [m]
        Depth h of the lowest point of the pitch circle under the oil, at most its radius.
    speed : float [rad/s]
        Speed of the gear.
    oil_volume : float [m^3]
        V in the sump.
    oil_density : float [kg/m^3]
        Density of the oil.
    kinematic_viscosity : float [m^2/s]
        Viscosity over density at the temperature of the sump.

    Returns
    -------
    float
        Power [W].

    Raises
    ------
    InputError
        If a value is not positive (immersion and speed may be zero), or the gear immersed to more
        than its radius.

    Valid for one gear without flanges near it. No second source of the constants was found. Source:
    Changenet and Velex, J. Mech. Des. 129 (2007) and 130 (2008).

    Examples
    --------
    >>> round(churning_loss(54.9e-3, 20e-3, 4.5e-3, 54.9e-3, 100.0, 1.2e-3, 880.0, 60e-6), 1)
    19.2
    """
    for name, value, unit in (
        ("pitch_radius", pitch_radius, "m"),
        ("face_width", face_width, "m"),
        ("module", module, "m"),
        ("oil_volume", oil_volume, "m^3"),
        ("oil_density", oil_density, "kg/m^3"),
        ("kinematic_viscosity", kinematic_viscosity, "m^2/s"),
    ):
        require_positive(name, value, unit)
    require_between("immersion", immersion, 0.0, pitch_radius, "m")
    require_between("speed", speed, 0.0, math.inf, "rad/s")
    if immersion == 0.0 or speed == 0.0:
        return 0.0
    diameter = 2.0 * pitch_radius
    depth, volume = immersion / diameter, oil_volume / diameter**3
    froude = speed**2 * pitch_radius / _GRAVITY
    reynolds = speed * pitch_radius**2 / kinematic_viscosity
    slow = 1.366 * depth**0.45 * volume**0.1 * froude**-0.6 * reynolds**-0.21
    wide = (face_width / diameter) ** 0.85
    fast = 3.644 * depth**0.1 * volume**-0.35 * froude**-0.88 * wide
    acceleration = speed**2 * math.sqrt(pitch_radius * module)
    part = float(np.clip((acceleration - 750.0) / 500.0, 0.0, 1.0))
    coefficient = (1.0 - part) * slow + part * fast
    surface = wetted_surface(pitch_radius, face_width, module, immersion)
    return float(0.5 * oil_density * speed**3 * surface * pitch_radius**3 * coefficient)


def wetted_surface(radius: float, width: float, module: float, immersion: float) -> float:
    """Surface of a spur gear under the oil [m^2]: both sides, the rim, and the sides of teeth."""
    angle = math.acos(1.0 - immersion / radius)
    sides = radius**2 * (2.0 * angle - math.sin(2.0 * angle))
    # Teeth of a height of 2.25 modules: each flank adds to the rim, two flanks a pitch.
    teeth = 2.0 * angle * radius / (math.pi * module)
    return sides + 2.0 * angle * radius * width + 2.0 * teeth * 2.25 * module * width


def windage_loss(
    pitch_radius: float, face_width: float, speed: float, oil_viscosity: float = 0.0
) -> float:
    """Power lost by a gear in air with oil mist.

    ``P = 2.82e-7 (1 + 2.3 b/R) n^2.8 R^4.6 (0.028 eta + 0.019)^0.2`` in kW with m, rpm and cP.

    Parameters
    ----------
    pitch_radius : float [m]
        R.
    face_width : float [m]
        b.
    speed : float [rad/s]
        Speed of the gear.
    oil_viscosity : float [Pa*s]
        Dynamic viscosity of the oil in the mist; zero for air alone.

    Returns
    -------
    float
        Power [W].

    Raises
    ------
    InputError
        If a size is not positive, or speed or viscosity negative.

    Warns
    -----
    ModelWarning
        Code ``windage-range`` beyond 200 m/s at the pitch circle.

    No second source of the constants was found. Source: Anderson and Loewenthal, NASA TP-1622
    (1980).

    Examples
    --------
    >>> round(windage_loss(0.1, 0.05, 1000.0, 0.01), 1)
    1666.3
    """
    require_positive("pitch_radius", pitch_radius, "m")
    require_positive("face_width", face_width, "m")
    require_between("speed", speed, 0.0, math.inf, "rad/s")
    require_between("oil_viscosity", oil_viscosity, 0.0, 100.0, "Pa*s")
    if speed * pitch_radius > 200.0:
        warn(
            "windage-range",
            f"windage: {speed * pitch_radius:.4g} m/s at the pitch circle is beyond the 200 m/s "
            "of the tests. Measure it.",
        )
    shape = (1.0 + 2.3 * face_width / pitch_radius) * pitch_radius**4.6
    mist = (0.028 * 1e3 * oil_viscosity + 0.019) ** 0.2
    return float(1e3 * 2.82e-7 * shape * (speed / RPM) ** 2.8 * mist)
