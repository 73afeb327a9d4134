"""Viscosity over temperature: the two-point line of Walther, as in ASTM D341."""

from __future__ import annotations

import math

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
    temperature: float,
    points: tuple[TemperaturePoint, TemperaturePoint],
    margin: float = MARGIN,
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
