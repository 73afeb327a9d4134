"""An oil of a data sheet: viscosities at 40 and 100 degC or an index, density at 15 degC."""

from __future__ import annotations

from tribodyn.errors import Argument, InputError, require_between
from tribodyn.lubricant.astm import (
    GREATEST_AT_100,
    LEAST_AT_100,
    MARGIN,
    TemperaturePoint,
    halved,
    viscosity_at_40_degc,
    viscosity_at_100_degc,
    viscosity_index,
    walther_viscosity,
)
from tribodyn.lubricant.oil import Lubricant
from tribodyn.units import ZERO_CELSIUS

#: Temperatures of the viscosities of a data sheet [K].
AT_40, AT_100 = ZERO_CELSIUS + 40.0, ZERO_CELSIUS + 100.0
#: Temperatures at which an oil of a data sheet is known [K].
SHEET_RANGE = (AT_40 - MARGIN, AT_100 + MARGIN)
#: Difference of a stated viscosity index from that of both viscosities that their rounding allows.
_INDEX_TOLERANCE = 5.0


def sheet_points(
    viscosity_at_40: float | None, viscosity_at_100: float | None, index: float | None
) -> tuple[TemperaturePoint, TemperaturePoint]:
    """Two points of the viscosity from two of the three figures of a data sheet."""
    if viscosity_at_40 is None and viscosity_at_100 is not None and index is not None:
        viscosity_at_40 = viscosity_at_40_degc(viscosity_at_100, index)
    elif viscosity_at_100 is None and viscosity_at_40 is not None and index is not None:
        viscosity_at_100 = viscosity_at_100_degc(viscosity_at_40, index)
    elif viscosity_at_40 is not None and viscosity_at_100 is not None:
        stated, index = index, viscosity_index(viscosity_at_40, viscosity_at_100)
        if stated is not None and abs(stated - index) > _INDEX_TOLERANCE:
            _contradiction(viscosity_at_40, viscosity_at_100, stated, index)
    if viscosity_at_40 is None or viscosity_at_100 is None:
        what = "one figure of the viscosity over temperature is missing"
        why = "Two of them are needed: viscosity at 40 degC, at 100 degC, viscosity index"
        raise InputError(what, Argument("viscosity_at_100"), why, "Add one from the data sheet")
    return (AT_40, viscosity_at_40), (AT_100, viscosity_at_100)


def _contradiction(at_40: float, at_100: float, stated: float, index: float) -> None:
    """Refuse a viscosity index that the viscosities do not have."""
    what = f"viscosity index {stated:g}"
    viscosities = f"{at_40 * 1e6:g} mm^2/s at 40 degC and {at_100 * 1e6:g} mm^2/s at 100 degC"
    why = f"{viscosities} have an index of {index:.0f} by ISO 2909"
    raise InputError(what, Argument("index"), why, "Correct one of the three, or leave one out")


def points_through(
    temperature: float, viscosity: float, index: float
) -> tuple[TemperaturePoint, TemperaturePoint]:
    """Viscosities at 40 and 100 degC of the line of an index through one known point."""

    def points_of(at_100: float) -> tuple[TemperaturePoint, TemperaturePoint]:
        return (AT_40, viscosity_at_40_degc(at_100, index)), (AT_100, at_100)

    def viscosity_of(at_100: float) -> float:
        return walther_viscosity(temperature, points_of(at_100))

    low, high = LEAST_AT_100, GREATEST_AT_100
    ends = [viscosity_of(end) for end in (low, high)]
    require_between("viscosity", viscosity, ends[0], ends[1], "m^2/s")
    return points_of(halved(viscosity_of, viscosity, low, high))


def conductivity_of_petroleum(density_at_15_degc: float, temperature: float) -> float:
    """Conductivity of a petroleum oil: ``0.117/d (1 - 0.00054 t)``, d in t/m^3, Cragoe (1929)."""
    return 117.0 / density_at_15_degc * (1.0 - 0.00054 * (temperature - ZERO_CELSIUS))


def from_data_sheet(
    temperature: float,
    density_at_15_degc: float,
    *,
    viscosity_at_40: float | None = None,
    viscosity_at_100: float | None = None,
    index: float | None = None,
    base_oil: str | None = None,
    pressure_viscosity_coefficient: float | None = None,
    thermal_conductivity: float | None = None,
    name: str = "",
) -> Lubricant:
    """Oil of a data sheet at a working temperature.

    Parameters
    ----------
    temperature : float [K]
        Working temperature, 10 to 130 degC.
    density_at_15_degc : float [kg/m^3]
        Density at 15 degC.
    viscosity_at_40, viscosity_at_100 : float, optional [m^2/s]
        Kinematic viscosities at 40 and at 100 degC: both, or one of them and the index.
    index : float, optional
        Viscosity index.
    base_oil : str, optional
        ``"mineral"``, ``"polyalphaolefin"`` or ``"polyalkylene glycol"``, for the estimate of the
        pressure-viscosity coefficient; mineral, as an assumption, by default.
    pressure_viscosity_coefficient : float, optional [1/Pa]
        Measured at the working temperature; estimated by AGMA 925-A03 by default.
    thermal_conductivity : float, optional [W/m/K]
        That of a petroleum oil by default.
    name : str
        Name of the oil.

    Raises
    ------
    InputError
        If a value is missing or out of range, or the figures contradict each other.

    ``assumptions`` lists estimated values. Source: ASTM D341, ASTM D2270, ISO/TR 15144-1,
    AGMA 925-A03. Conductivity: Cragoe (1929).

    Examples
    --------
    >>> oil = from_data_sheet(333.15, 907.1, viscosity_at_40=220e-6, index=95)
    >>> round(oil.dynamic_viscosity, 4)
    0.0686
    """
    points = sheet_points(viscosity_at_40, viscosity_at_100, index)
    remarks: tuple[str, ...] = ()
    if pressure_viscosity_coefficient is None and base_oil is None:
        base_oil = "mineral"
        remarks += ("Base oil mineral: it is not stated; it sets the pressure-viscosity estimate.",)
    if thermal_conductivity is None:
        thermal_conductivity = conductivity_of_petroleum(density_at_15_degc, temperature)
        remarks += (
            f"Thermal conductivity {thermal_conductivity:.3g} W/(m*K): that of a petroleum oil "
            "after Cragoe (1929); only heated films use it.",
        )
    return Lubricant.from_temperature(
        temperature,
        points,
        density_at_15_degc,
        pressure_viscosity_coefficient,
        base_oil=base_oil if pressure_viscosity_coefficient is None else None,
        thermal_conductivity=thermal_conductivity,
        name=name or f"oil of {points[0][1] * 1e6:.4g} mm^2/s at 40 degC",
        source="data sheet; ASTM D341 between 40 and 100 degC",
        assumptions=remarks,
    )
