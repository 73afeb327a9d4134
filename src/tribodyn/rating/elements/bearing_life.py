"""Life of rolling bearings: ISO 281.

``L_10 = (C/P)^p`` million turns, p 3 for balls and 10/3 for rollers; ``L_nm = a_1 a_ISO L_10`` with
``a_ISO = 0.1 [1 - (k - c/kappa^e)^r s^t]^v``, ``kappa = nu/nu_1``, ``s = e_C C_u/P`` and the
reference viscosity ``nu_1 = 45000 n^-0.83 D_pw^-0.5`` below 1000/min, ``4500 n^-0.5 D_pw^-0.5``
above (mm2/s, 1/min, mm). Factors of bearing makers (a_SKF) are other numbers.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from tribodyn.errors import Argument, InputError, require_between, require_one_of, require_positive
from tribodyn.rating.factor import check_range

#: k; c below kappa 0.4, below 1 and above; r, t, v; divisor of s.
_KINDS: Final = {
    "radial ball": (2.5671, (2.2649, 1.9987, 1.9987), 0.83, 1.0 / 3.0, -9.3, 1.0),
    "radial roller": (1.5859, (1.3993, 1.2348, 1.2348), 1.0, 0.4, -9.185, 1.0),
    "thrust ball": (2.5671, (2.2649, 1.9987, 1.9987), 0.83, 1.0 / 3.0, -9.3, 3.0),
    "thrust roller": (1.5859, (1.3993, 1.2348, 1.2348), 1.0, 0.4, -9.185, 2.5),
}
#: Exponent of kappa below 0.4, below 1 and above.
_EXPONENTS: Final = (0.054381, 0.19087, 0.071739)
#: a_1 by the probability of survival in percent.
RELIABILITY: Final = {
    90.0: 1.0, 95.0: 0.64, 96.0: 0.55, 97.0: 0.47, 98.0: 0.37, 99.0: 0.25, 99.2: 0.22, 99.4: 0.19,
    99.6: 0.16, 99.8: 0.12, 99.9: 0.093, 99.92: 0.087, 99.94: 0.080, 99.95: 0.077,
}  # fmt: skip
#: c1 and c2 of e_C by lubrication and cleanliness (ISO 4406) or state of grease.
CLEANLINESS: Final = {
    "in-line -/13/10": (0.0864, 0.5663), "in-line -/15/12": (0.0432, 0.9987),
    "in-line -/17/14": (0.0288, 1.6329), "in-line -/19/16": (0.0216, 2.3362),
    "bath -/13/10": (0.0864, 0.6796), "bath -/15/12": (0.0288, 1.141),
    "bath -/17/14": (0.0133, 1.670), "bath -/19/16": (0.00864, 2.5164),
    "bath -/21/18": (0.00411, 3.8974), "grease high": (0.0864, 0.6796),
    "grease normal": (0.0432, 1.141), "grease typical": (0.0177, 1.887),
    "grease severe": (0.0115, 2.662), "grease very severe": (0.00617, 4.06),
}  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class RatedBearing:
    """Catalogue values of a rolling bearing.

    Parameters
    ----------
    kind : str
        ``radial ball``, ``radial roller``, ``thrust ball`` or ``thrust roller``.
    dynamic_capacity : float [N]
        C.
    pitch_diameter : float [m]
        D_pw.
    static_capacity : float, optional [N]
        C_0.
    fatigue_load : float, optional [N]
        C_u; without it C_0/22 of balls and C_0/8.2 of rollers.

    Raises
    ------
    InputError
        If a value is out of range.

    Examples
    --------
    >>> RatedBearing(kind="radial ball", dynamic_capacity=55.3e3, pitch_diameter=72.5e-3).exponent
    3.0
    """

    kind: str
    dynamic_capacity: float
    pitch_diameter: float
    static_capacity: float | None = None
    fatigue_load: float | None = None

    def __post_init__(self) -> None:
        require_one_of("kind", self.kind, _KINDS)
        require_positive("dynamic_capacity", self.dynamic_capacity, "N")
        require_between("pitch_diameter", self.pitch_diameter, 1e-3, 10.0, "m")
        for name in ("static_capacity", "fatigue_load"):
            if getattr(self, name) is not None:
                require_positive(name, getattr(self, name), "N")

    @property
    def exponent(self) -> float:
        """Life exponent p."""
        return 3.0 if self.kind.endswith("ball") else 10.0 / 3.0

    @property
    def fatigue_limit(self) -> float | None:
        """C_u [N], estimated from C_0 where it is not stated; None without both."""
        if self.fatigue_load is not None or self.static_capacity is None:
            return self.fatigue_load
        return self.static_capacity / (22.0 if self.kind.endswith("ball") else 8.2)


@dataclass(frozen=True)
class BearingLife:
    """Life of a bearing; made by :func:`bearing_life`.

    Parameters
    ----------
    basic_life : float [s]
        L_10h.
    modified_life : float, optional [s]
        L_nmh; None without a viscosity, C_u or cleanliness.
    basic_turns : float
        L_10, pure number of turns.
    reliability_factor : float
        a_1.
    life_factor : float, optional
        a_ISO.
    viscosity_ratio : float, optional
        kappa.
    contamination_factor : float, optional
        e_C.
    """

    basic_life: float
    modified_life: float | None
    basic_turns: float
    reliability_factor: float
    life_factor: float | None
    viscosity_ratio: float | None
    contamination_factor: float | None


def reference_viscosity(speed: float, pitch_diameter: float) -> float:
    """Viscosity nu_1 that a bearing needs.

    Parameters
    ----------
    speed : float [rad/s]
        Speed of rotation.
    pitch_diameter : float [m]
        D_pw.

    Returns
    -------
    float [m^2/s]

    Raises
    ------
    InputError
        If a value is not positive.

    Notes
    -----
    Source: ISO 281. Values printed by SKF are about 16 % lower.

    Examples
    --------
    >>> round(reference_viscosity(3000.0 * math.pi / 30.0, 72.5e-3) * 1e6, 4)
    9.649
    """
    require_positive("speed", speed, "rad/s")
    require_positive("pitch_diameter", pitch_diameter, "m")
    rpm, diameter = speed * 30.0 / math.pi, 1e3 * pitch_diameter
    scale = 45000.0 * rpm**-0.83 if rpm < 1000.0 else 4500.0 * rpm**-0.5
    return float(1e-6 * scale * diameter**-0.5)


def life_modification_factor(kind: str, viscosity_ratio: float, fatigue_ratio: float) -> float:
    """Life modification factor a_ISO.

    Parameters
    ----------
    kind : str
        As of :class:`RatedBearing`.
    viscosity_ratio : float
        kappa, above 4 taken as 4.
    fatigue_ratio : float
        e_C C_u/P.

    Returns
    -------
    float
        At most 50.

    Raises
    ------
    InputError
        If a value is out of range or the kind is unknown.

    Warns
    -----
    ModelWarning
        ``rating-range`` below kappa 0.1.

    Notes
    -----
    Source: ISO 281:2007.

    Examples
    --------
    >>> round(life_modification_factor("radial ball", 1.0, 0.1), 6)
    2.430518
    """
    require_one_of("kind", kind, _KINDS)
    require_between("viscosity_ratio", viscosity_ratio, 1e-3, 1e6)
    require_between("fatigue_ratio", fatigue_ratio, 0.0, 1e6)
    check_range("kappa", viscosity_ratio, 0.1, math.inf, "a_ISO of ISO 281")
    k, c, r, t, v, divisor = _KINDS[kind]
    kappa = min(viscosity_ratio, 4.0)
    branch = 0 if kappa < 0.4 else 1 if kappa < 1.0 else 2
    film = max(k - c[branch] / kappa ** _EXPONENTS[branch], 0.0)
    base = 1.0 - film**r * (fatigue_ratio / divisor) ** t
    if base <= 0.0:
        return 50.0
    return float(min(0.1 * base**v, 50.0))


def contamination_factor(cleanliness: str, viscosity_ratio: float, pitch_diameter: float) -> float:
    """Contamination factor e_C.

    Parameters
    ----------
    cleanliness : str
        ``in-line`` or ``bath`` with a class of ISO 4406, such as ``bath -/17/14``, or ``grease``
        with ``high``, ``normal``, ``typical``, ``severe`` or ``very severe`` cleanliness.
    viscosity_ratio : float
        kappa.
    pitch_diameter : float [m]
        D_pw.

    Returns
    -------
    float

    Raises
    ------
    InputError
        If a value is out of range or the name is unknown.

    Notes
    -----
    Source: ISO 281:2007; the constants of the oil bath are from memory of its text.

    Examples
    --------
    >>> round(contamination_factor("in-line -/15/12", 1.0, 72.5e-3), 4)
    0.3465
    """
    require_one_of("cleanliness", cleanliness, CLEANLINESS)
    require_between("viscosity_ratio", viscosity_ratio, 1e-3, 1e6)
    require_positive("pitch_diameter", pitch_diameter, "m")
    c_1, c_2 = CLEANLINESS[cleanliness]
    diameter = 1e3 * pitch_diameter
    if cleanliness == "grease typical" and diameter >= 500.0:
        c_2 = 1.677
    film = min(c_1 * min(viscosity_ratio, 4.0) ** 0.68 * diameter**0.55, 1.0)
    return float(max(film * (1.0 - c_2 / diameter ** (1.0 / 3.0)), 0.0))


def deep_groove_load(radial: float, axial: float, axial_share: float) -> float:
    """Equivalent load P of a deep groove ball bearing of normal clearance.

    Parameters
    ----------
    radial, axial : float [N]
        F_r and F_a.
    axial_share : float
        f_0 F_a/C_0, pure number.

    Returns
    -------
    float [N]

    Raises
    ------
    InputError
        If a value is out of range.

    Notes
    -----
    Factors of ISO 281 from memory of its text; straight between the values of the table.

    Examples
    --------
    >>> deep_groove_load(10e3, 0.0, 0.0)
    10000.0
    """
    for name, value in (("radial", radial), ("axial", axial)):
        require_between(name, value, 0.0, 1e12, "N")
    require_between("axial_share", axial_share, 0.0, 1e3)
    shares = (0.172, 0.345, 0.689, 1.03, 1.38, 2.07, 3.45, 5.17, 6.89)
    limits = (0.19, 0.22, 0.26, 0.28, 0.30, 0.34, 0.38, 0.42, 0.44)
    slopes = (2.30, 1.99, 1.71, 1.55, 1.45, 1.31, 1.15, 1.04, 1.00)
    if axial <= np.interp(axial_share, shares, limits) * radial:
        return radial
    return float(0.56 * radial + np.interp(axial_share, shares, slopes) * axial)


def bearing_life(
    bearing: RatedBearing,
    load: float,
    speed: float,
    *,
    viscosity: float | None = None,
    contamination: str | float | None = None,
    reliability: float = 90.0,
) -> BearingLife:
    """Basic and modified life of a bearing under a constant equivalent load.

    Parameters
    ----------
    bearing : RatedBearing
        Catalogue values.
    load : float [N]
        Equivalent dynamic load P.
    speed : float [rad/s]
        Speed of rotation.
    viscosity : float, optional [m^2/s]
        Kinematic viscosity at the operating temperature.
    contamination : str or float, optional
        Cleanliness as of :func:`contamination_factor`, or e_C itself (pure number).
    reliability : float
        Probability of survival in percent, pure number: 90 to 99.95.

    Returns
    -------
    BearingLife

    Raises
    ------
    InputError
        If a value is out of range, or the standard has no a_1 for the reliability.

    Notes
    -----
    Source: ISO 281:2007.

    Examples
    --------
    >>> bearing = RatedBearing(kind="radial ball", dynamic_capacity=55.3e3, pitch_diameter=72.5e-3)
    >>> life = bearing_life(bearing, 10e3, 3000.0 * math.pi / 30.0)
    >>> round(life.basic_turns / 1e6, 1), round(life.basic_life / 3600.0, 1)
    (169.1, 939.5)
    """
    require_positive("load", load, "N")
    require_positive("speed", speed, "rad/s")
    if reliability not in RELIABILITY:
        why = f"ISO 281 has: {', '.join(f'{value:g}' for value in RELIABILITY)}"
        what = f"reliability = {reliability:g} %"
        raise InputError(what, Argument("reliability"), why, "Choose one of these")
    turns = 1e6 * (bearing.dynamic_capacity / load) ** bearing.exponent
    basic, first = turns / speed * 2.0 * math.pi, RELIABILITY[reliability]
    kappa = None
    if viscosity is not None:
        require_positive("viscosity", viscosity, "m^2/s")
        kappa = viscosity / reference_viscosity(speed, bearing.pitch_diameter)
    limit = bearing.fatigue_limit
    if kappa is None or limit is None or contamination is None:
        return BearingLife(basic, None, turns, first, None, kappa, None)
    if isinstance(contamination, str):
        clean = contamination_factor(contamination, kappa, bearing.pitch_diameter)
    else:
        require_between("contamination", contamination, 0.0, 1.0)
        clean = float(contamination)
    factor = life_modification_factor(bearing.kind, kappa, clean * limit / load)
    return BearingLife(basic, first * factor * basic, turns, first, factor, kappa, clean)


def system_life(lives: Sequence[float], weibull_exponent: float = 1.5) -> float:
    """Life of a system that fails with its first part: ``(sum L_i^-e)^(-1/e)``.

    Parameters
    ----------
    lives : sequence of float
        Lives of the parts at one reliability [s].
    weibull_exponent : float
        Slope e of the Weibull distribution: 10/9 balls, 9/8 rollers, 1.5 usual.

    Returns
    -------
    float
        Life of the system [s].

    Raises
    ------
    InputError
        If a life is not positive.

    Examples
    --------
    >>> round(system_life([1000.0, 1000.0], 1.0), 6)
    500.0
    """
    values = np.asarray(lives, dtype=float)
    require_positive("lives", values, "s")
    require_between("weibull_exponent", weibull_exponent, 0.5, 10.0)
    least = float(values.min())
    total = float(((least / values) ** weibull_exponent).sum())
    return float(least * total ** (-1.0 / weibull_exponent))
