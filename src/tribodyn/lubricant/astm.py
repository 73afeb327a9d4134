"""Viscosity over temperature (ASTM D341) and the viscosity index (ASTM D2270, ISO 2909)."""

from __future__ import annotations

import math
from collections.abc import Callable

from tribodyn.errors import Argument, InputError, require_between, require_positive
from tribodyn.units import ZERO_CELSIUS

#: One measured point: temperature [K] and kinematic viscosity [m^2/s].
TemperaturePoint = tuple[float, float]

#: How far [K] beyond the two data points the line may be used.
MARGIN = 30.0

_SHIFT = 0.7  # [mm^2/s], the constant of the standard for viscosities above 2 mm^2/s


def _ordinate(kinematic_viscosity: float) -> float:
    """Return the double logarithm that is linear in log10(T)."""
    return math.log10(math.log10(kinematic_viscosity * 1e6 + _SHIFT))


def _require_oil(points: tuple[TemperaturePoint, TemperaturePoint]) -> None:
    """Refuse points from which no falling line of an oil can be drawn."""
    for temperature, viscosity in points:
        require_positive("temperature", temperature, "K")
        require_between(
            "kinematic_viscosity", viscosity, 2e-6, 1.0, "m^2/s", remedy="1 mm^2/s is 1e-6 m^2/s"
        )
    (cold, thick), (warm, thin) = points
    if cold >= warm or thick <= thin:
        raise InputError(
            f"points {cold:g} K, {thick:.4g} m^2/s and {warm:g} K, {thin:.4g} m^2/s",
            where=Argument("points"),
            why="two different temperatures in rising order, with falling viscosity, are "
            "needed for a line over temperature",
            remedy="Give the colder point first",
        )


def _require_inside(temperature: float, cold: float, warm: float, margin: float = MARGIN) -> None:
    """Refuse a temperature that lies too far outside the data."""
    if cold - margin <= temperature <= warm + margin:
        return
    low, high = cold - ZERO_CELSIUS, warm - ZERO_CELSIUS
    raise InputError(
        f"temperature = {temperature - ZERO_CELSIUS:g} degC",
        where=Argument("temperature"),
        why=f"the viscosity is known at {low:g} and {high:g} degC, and the line through "
        f"these points is not trusted more than {margin:g} K beyond them",
        remedy=f"Stay between {low - margin:g} and {high + margin:g} degC, "
        "or give the properties at the working temperature",
    )


def walther_viscosity(
    temperature: float, points: tuple[TemperaturePoint, TemperaturePoint], margin: float = MARGIN
) -> float:
    """Kinematic viscosity at a temperature from two measured points.

    ``log10 log10(nu + 0.7) = A - B log10(T)`` with nu in mm^2/s and T in K.

    Parameters
    ----------
    temperature : float [K]
        Wanted temperature.
    points : tuple of two (float [K], float [m^2/s])
        Temperature and kinematic viscosity, the colder point first.
    margin : float [K]
        How far outside of the points the line may be used.

    Returns
    -------
    float [m^2/s]

    Raises
    ------
    InputError
        If the points make no falling line, or the temperature lies outside them by more than the
        margin.

    Valid for liquid petroleum products above 2 mm^2/s. Source: Walther (1931); ASTM D341.

    Examples
    --------
    >>> points = ((313.15, 100e-6), (373.15, 11.066e-6))
    >>> round(walther_viscosity(343.15, points) * 1e6, 2)
    27.13
    """
    _require_oil(points)
    (cold, thick), (warm, thin) = points
    require_positive("temperature", temperature, "K")
    _require_inside(temperature, cold, warm, margin)
    slope = (_ordinate(thin) - _ordinate(thick)) / math.log10(warm / cold)
    ordinate = _ordinate(thick) + slope * math.log10(temperature / cold)
    return float(10.0 ** (10.0**ordinate) - _SHIFT) * 1e-6


def walther_slope(temperature: float, points: tuple[TemperaturePoint, TemperaturePoint]) -> float:
    """Fall of ln(kinematic viscosity) per kelvin on the line of :func:`walther_viscosity`.

    ``B (nu + 0.7) ln(nu + 0.7) / (nu T)`` with nu in mm^2/s and T in K.

    Parameters
    ----------
    temperature, points
        As for :func:`walther_viscosity`, in [K] and [m^2/s].

    Returns
    -------
    float [1/K]
        Positive.

    Raises
    ------
    InputError
        If the points make no falling line, or the temperature lies more than 30 K outside them.

    Valid for liquid petroleum products above 2 mm^2/s. Source: Walther (1931); ASTM D341.

    Examples
    --------
    >>> points = ((313.15, 100e-6), (373.15, 11.066e-6))
    >>> round(walther_slope(313.15, points), 4)
    0.053
    """
    viscosity = walther_viscosity(temperature, points) * 1e6
    (cold, thick), (warm, thin) = points
    slope = (_ordinate(thick) - _ordinate(thin)) / math.log10(warm / cold)
    shifted = viscosity + _SHIFT
    return slope * shifted * math.log(shifted) / (viscosity * temperature)


def viscosity_from_slope(temperature: float, point: TemperaturePoint, slope: float) -> float:
    """Kinematic viscosity [m^2/s] on the line of Walther through a point with a slope there.

    The slope is the fall of ln(viscosity) per kelvin at the point [1/K].
    """
    reference, viscosity = point[0], 1e6 * point[1]
    shifted = viscosity + _SHIFT
    steepness = slope * viscosity * reference / (shifted * math.log(shifted))
    ordinate = math.log10(math.log10(shifted)) - steepness * math.log10(temperature / reference)
    return float(1e-6 * (10.0**10.0**ordinate - _SHIFT))


#: Least kinematic viscosity at 100 degC [m^2/s] for which the index is defined.
LEAST_AT_100 = 2e-6
#: Greatest kinematic viscosity at 100 degC [m^2/s] that is searched for an index.
GREATEST_AT_100 = 1e-3
#: Indices of liquids: below, an oil would thin more than any, above, hardly at all.
INDEX_RANGE = (-100.0, 400.0)

#: Up to this viscosity at 100 degC Y [mm^2/s] hold L = a Y^2 + b Y + c and H = d Y^2 + e Y + f.
_COEFFICIENTS = (
    (3.8, (1.14673, 1.7576, -0.109), (0.84155, 1.5521, -0.077)),
    (4.4, (3.38095, -15.4952, 33.196), (0.78571, 1.7929, -0.183)),
    (5.0, (2.5000, -7.2143, 13.812), (0.82143, 1.5679, 0.119)),
    (6.4, (0.10100, 16.6350, -45.469), (0.04985, 9.1613, -18.557)),
    (7.0, (3.35714, -23.5643, 78.466), (0.22619, 7.7369, -16.656)),
    (7.7, (0.01191, 21.4750, -72.870), (0.79762, -0.7321, 14.610)),
    (9.0, (0.41858, 16.1558, -56.040), (0.05794, 10.5156, -28.240)),
    (12.0, (0.88779, 7.5527, -16.600), (0.26665, 6.7015, -10.810)),
    (15.0, (0.76720, 10.7972, -38.180), (0.20073, 8.4658, -22.490)),
    (18.0, (0.97305, 5.3135, -2.200), (0.28889, 5.9741, -4.930)),
    (22.0, (0.97256, 5.2500, -0.980), (0.24504, 7.4160, -16.730)),
    (28.0, (0.91413, 7.4759, -21.820), (0.20323, 9.1267, -34.230)),
    (40.0, (0.87031, 9.7157, -50.770), (0.18411, 10.1015, -46.750)),
    (55.0, (0.84703, 12.6752, -133.310), (0.17029, 11.4866, -80.620)),
    (70.0, (0.85921, 11.1009, -83.190), (0.17130, 11.3680, -76.940)),
    (math.inf, (0.83531, 14.6731, -216.246), (0.16841, 11.8493, -96.947)),
)
#: Rise of the index above 100 by procedure B.
_SLOPE = 0.00715
#: Halvings of the range of the viscosity at 100 degC: more than a float has digits.
_HALVINGS = 60


def _references(viscosity: float) -> tuple[float, float]:
    """Viscosities at 40 degC L and H of the oils of index 0 and 100 [mm^2/s]."""
    _, low, high = next(row for row in _COEFFICIENTS if viscosity <= row[0])
    a, b, c = low
    d, e, f = high
    return (a * viscosity + b) * viscosity + c, (d * viscosity + e) * viscosity + f


def viscosity_index(viscosity_at_40: float, viscosity_at_100: float) -> float:
    """Viscosity index of an oil from its kinematic viscosities at 40 and 100 degC.

    Procedure A up to an index of 100, ``VI = 100 (L - U)/(L - H)``; procedure B above,
    ``VI = 100 + (10^N - 1)/0.00715`` with ``N = log(H/U)/log(Y)``, with U at 40 and Y at 100 degC
    in mm^2/s, and L and H at 40 degC of oils of index 0 and 100 that have Y at 100 degC.

    Parameters
    ----------
    viscosity_at_40, viscosity_at_100 : float [m^2/s]
        Kinematic viscosities at 40 and at 100 degC.

    Returns
    -------
    float
        Index, a pure number; reported as the nearest whole one.

    Raises
    ------
    InputError
        If the oil has less than 2 mm^2/s at 100 degC, or does not thin when it warms.

    Valid from 2 mm^2/s at 100 degC on. Source: ASTM D2270-10, eqs. 3 and 6 and the equations of
    its appendix for L and H; ISO 2909.

    Examples
    --------
    >>> round(viscosity_index(73.30e-6, 8.86e-6)), round(viscosity_index(22.83e-6, 5.05e-6))
    (92, 156)
    """
    remedy = "1 mm^2/s is 1e-6 m^2/s"
    require_between("viscosity_at_100", viscosity_at_100, LEAST_AT_100, 1.0, "m^2/s", remedy=remedy)
    require_between("viscosity_at_40", viscosity_at_40, LEAST_AT_100, 1.0, "m^2/s", remedy=remedy)
    u, y = viscosity_at_40 * 1e6, viscosity_at_100 * 1e6
    if u <= y:
        what = f"{u:g} mm^2/s at 40 degC and {y:g} mm^2/s at 100 degC"
        why, remedy = "An oil is thinner when it is warmer", "Exchange the two viscosities"
        raise InputError(what, Argument("viscosity_at_40"), why, remedy)
    low, high = _references(y)
    if u >= high:
        return 100.0 * (low - u) / (low - high)
    return 100.0 + (math.pow(10.0, math.log(high / u) / math.log(y)) - 1.0) / _SLOPE


def viscosity_at_40_degc(viscosity_at_100: float, index: float) -> float:
    """Kinematic viscosity at 40 degC of an oil from that at 100 degC and its viscosity index.

    Parameters
    ----------
    viscosity_at_100 : float [m^2/s]
        Kinematic viscosity at 100 degC.
    index : float
        Viscosity index, a pure number.

    Returns
    -------
    float [m^2/s]

    Raises
    ------
    InputError
        If a value is out of range.

    Valid as :func:`viscosity_index`, which it inverts. Source: ASTM D2270-10, ISO 2909.

    Examples
    --------
    >>> round(viscosity_at_40_degc(11.066e-6, 95.0) * 1e6, 1)
    100.0
    """
    require_between("index", index, *INDEX_RANGE)
    require_between("viscosity_at_100", viscosity_at_100, LEAST_AT_100, 1.0, "m^2/s")
    y = viscosity_at_100 * 1e6
    low, high = _references(y)
    if index <= 100.0:
        return float(low - 0.01 * index * (low - high)) * 1e-6
    return float(high * (1.0 + _SLOPE * (index - 100.0)) ** -math.log10(y)) * 1e-6


def viscosity_at_100_degc(viscosity_at_40: float, index: float) -> float:
    """Kinematic viscosity at 100 degC of an oil from that at 40 degC and its viscosity index.

    Parameters
    ----------
    viscosity_at_40 : float [m^2/s]
        Kinematic viscosity at 40 degC.
    index : float
        Viscosity index, a pure number.

    Returns
    -------
    float [m^2/s]

    Raises
    ------
    InputError
        If a value is out of range, or the oil would have less than 2 mm^2/s at 100 degC.

    Found by bisection of :func:`viscosity_at_40_degc`. Source: ASTM D2270-10, ISO 2909.

    Examples
    --------
    >>> round(viscosity_at_100_degc(100e-6, 95.0) * 1e6, 2)
    11.07
    """
    low, high = LEAST_AT_100, GREATEST_AT_100
    ends = [viscosity_at_40_degc(end, index) for end in (low, high)]
    if not ends[0] <= viscosity_at_40 <= ends[1]:
        what = f"{viscosity_at_40 * 1e6:g} mm^2/s at 40 degC with a viscosity index of {index:g}"
        span = f"{ends[0] * 1e6:.4g} to {ends[1] * 1e6:.4g} mm^2/s"
        why = f"With that index an oil has {span} at 40 degC: 2 to 1000 mm^2/s at 100 degC"
        raise InputError(what, Argument("viscosity_at_40"), why, "Check the value and its unit")
    return halved(lambda at_100: viscosity_at_40_degc(at_100, index), viscosity_at_40, low, high)


def halved(rising: Callable[[float], float], value: float, low: float, high: float) -> float:
    """Argument between two ends at which a rising function has a value, by bisection."""
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if rising(middle) < value else (low, middle)
    return high
