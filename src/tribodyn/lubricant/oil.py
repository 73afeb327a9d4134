"""Lubricant at its working temperature, with the properties that a contact needs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass, field

from numpy.typing import ArrayLike

from tribodyn.errors import InputError, require_between, require_positive
from tribodyn.lubricant.astm import TemperaturePoint, walther_slope, walther_viscosity
from tribodyn.lubricant.pressure_laws import (
    DENSITY_FALL,
    agma_925_coefficient,
    barus_viscosity,
    density_at_temperature,
    dowson_higginson_density,
    roelands_index,
    roelands_viscosity,
)
from tribodyn.model import Registry
from tribodyn.nomenclature import QUANTITIES
from tribodyn.types import Array

#: Pressure laws by name, each ``law(pressure, dynamic_viscosity, coefficient)``.
VISCOSITY_LAWS: Registry[Callable[[ArrayLike, float, float], Array]] = Registry(
    "viscosity law", "tribodyn.viscosity"
)
VISCOSITY_LAWS.register("roelands")(roelands_viscosity)
VISCOSITY_LAWS.register("barus")(barus_viscosity)


#: Limits of the properties of liquids, with remedies.
_LIMITS = {
    "dynamic_viscosity": (6.4e-5, 1e3, "82 mPa*s (cP) is 0.082 Pa*s"),
    "density": (100.0, 3000.0, "0.88 g/cm^3 is 880 kg/m^3"),
    "pressure_viscosity_coefficient": (0.0, 1e-7, "21.9 1/GPa is 2.19e-8 1/Pa"),
    "temperature_viscosity_coefficient": (
        0.0,
        0.3,
        "It is positive: gear oils lie between 0.02 and 0.07 1/K",
    ),
    "thermal_conductivity": (0.01, 2.0, "Mineral oil has about 0.13 W/(m*K)"),
}
_MAY_BE_UNKNOWN = ("temperature_viscosity_coefficient", "thermal_conductivity")


@dataclass(frozen=True)
class Lubricant:
    """A lubricating oil at its working temperature and ambient pressure.

    Parameters
    ----------
    dynamic_viscosity : float [Pa*s]
        Absolute viscosity, above the pole of the Roelands law (6.3e-5 Pa*s).
    density : float [kg/m^3]
        Density.
    pressure_viscosity_coefficient : float [1/Pa]
        Slope of ln(viscosity) over pressure at ambient pressure; zero for an isoviscous liquid.
    name : str
        Name of the oil.
    temperature : float, optional [K]
        Temperature that the properties belong to; ``None`` when unknown.
    temperature_viscosity_coefficient : float, optional [1/K]
        Fall of ln(viscosity) per kelvin, positive; ``None`` when unknown.
    thermal_conductivity : float, optional [W/m/K]
        Thermal conductivity; ``None`` when unknown.
    source : str
        Where the properties come from.
    assumptions : tuple of str
        What was assumed because no source states it, each with its reason.

    Raises
    ------
    InputError
        If a property is not positive or out of the range of liquids.

    Examples
    --------
    >>> oil = Lubricant(0.082, 880.0, 2.19e-8)
    >>> round(oil.roelands_index, 3)
    0.599
    """

    dynamic_viscosity: float
    density: float
    pressure_viscosity_coefficient: float
    _: KW_ONLY
    name: str = ""
    temperature: float | None = None
    temperature_viscosity_coefficient: float | None = field(default=None, repr=False)
    thermal_conductivity: float | None = field(default=None, repr=False)
    source: str = field(default="", repr=False)
    assumptions: tuple[str, ...] = field(default=(), repr=False)

    def __post_init__(self) -> None:
        """Check the properties."""
        for name, (low, high, remedy) in _LIMITS.items():
            value = getattr(self, name)
            if value is not None or name not in _MAY_BE_UNKNOWN:
                require_between(name, value, low, high, QUANTITIES[name].unit, remedy=remedy)
        if self.temperature is not None:
            require_positive("temperature", self.temperature, "K")

    @classmethod
    def from_temperature(
        cls,
        temperature: float,
        points: tuple[TemperaturePoint, TemperaturePoint],
        density_at_15_degc: float,
        pressure_viscosity_coefficient: float | None = None,
        *,
        base_oil: str | None = None,
        thermal_conductivity: float | None = None,
        name: str = "",
        source: str = "",
        assumptions: tuple[str, ...] = (),
    ) -> Lubricant:
        """Lubricant at a working temperature, from its viscosity at two temperatures.

        Parameters
        ----------
        temperature : float [K]
            Working temperature, at most 30 K outside the two points.
        points : tuple of two (float [K], float [m^2/s])
            Temperature and kinematic viscosity, the colder point first.
        density_at_15_degc : float [kg/m^3]
            Density at 15 degC.
        pressure_viscosity_coefficient : float, optional [1/Pa]
            Measured at the working temperature. Give this or ``base_oil``.
        base_oil : str, optional
            Base oil from which AGMA 925 estimates the coefficient.
        thermal_conductivity : float, optional [W/m/K]
            Thermal conductivity.
        name, source : str
            Name of the oil and origin of the data.
        assumptions : tuple of str
            What was assumed because no source states it.

        Raises
        ------
        InputError
            If the temperature is too far from the data, or not exactly one of
            ``pressure_viscosity_coefficient`` and ``base_oil`` is given.

        Valid within the span of the points. Source: ASTM D341, ISO/TR 15144-1, AGMA 925-A03.

        Examples
        --------
        >>> points = ((313.15, 100e-6), (373.15, 11.066e-6))
        >>> oil = Lubricant.from_temperature(343.15, points, 892.2, base_oil="mineral")
        >>> round(oil.dynamic_viscosity, 5), round(oil.density, 1)
        (0.02316, 853.7)
        """
        density = density_at_temperature(temperature, density_at_15_degc)
        viscosity = walther_viscosity(temperature, points) * density
        coefficient, estimated = _coefficient(pressure_viscosity_coefficient, base_oil, viscosity)
        return cls(
            viscosity,
            density,
            coefficient,
            name=name,
            temperature=temperature,
            temperature_viscosity_coefficient=walther_slope(temperature, points)
            + DENSITY_FALL / density,
            thermal_conductivity=thermal_conductivity,
            source=source,
            assumptions=assumptions + estimated,
        )

    @property
    def kinematic_viscosity(self) -> float:
        """Kinematic viscosity [m^2/s]."""
        return self.dynamic_viscosity / self.density

    @property
    def roelands_index(self) -> float:
        """Pressure-viscosity index z of the Roelands law."""
        return roelands_index(self.dynamic_viscosity, self.pressure_viscosity_coefficient)

    def viscosity(self, pressure: ArrayLike, law: str = "roelands") -> Array:
        """Viscosity under pressure.

        Parameters
        ----------
        pressure : float or array [Pa]
            Pressure above ambient.
        law : {"roelands", "barus"}
            Name of the pressure law.

        Returns
        -------
        float or array [Pa*s]
            Same shape as ``pressure``.

        Raises
        ------
        InputError
            If the law is unknown, a pressure is negative or the viscosity overflows.

        Source: Roelands (1966) or Barus (1893).

        Examples
        --------
        >>> oil = Lubricant(0.082, 880.0, 2.19e-8)
        >>> round(float(oil.viscosity(100e6, "barus")), 6)
        0.732687
        """
        viscosity_law = VISCOSITY_LAWS[law]
        return viscosity_law(pressure, self.dynamic_viscosity, self.pressure_viscosity_coefficient)

    def density_at(self, pressure: ArrayLike) -> Array:
        """Density under pressure.

        Parameters
        ----------
        pressure : float or array [Pa]
            Pressure above ambient.

        Returns
        -------
        float or array [kg/m^3]
            Same shape as ``pressure``.

        Raises
        ------
        InputError
            If a pressure is negative.

        Source: Dowson and Higginson (1966).

        Examples
        --------
        >>> oil = Lubricant(0.082, 880.0, 2.19e-8)
        >>> round(float(oil.density_at(1e9)), 3)
        1075.556
        """
        return dowson_higginson_density(pressure, self.density)


def _coefficient(
    coefficient: float | None, base_oil: str | None, viscosity: float
) -> tuple[float, tuple[str, ...]]:
    """Return the given pressure-viscosity coefficient, or its estimate with a remark."""
    if coefficient is not None and base_oil is None:
        return coefficient, ()
    if coefficient is None and base_oil is not None:
        estimate = agma_925_coefficient(viscosity, base_oil)
        remark = (
            f"Pressure-viscosity coefficient {estimate:.3g} 1/Pa: estimated by AGMA 925 from the "
            f"viscosity, taking the base oil as {base_oil}; a measured value is better."
        )
        return estimate, (remark,)
    what = f"pressure_viscosity_coefficient = {coefficient} and base_oil = {base_oil}"
    why = "exactly one of the two determines how the viscosity rises with pressure"
    remedy = "Give a measured coefficient, or the base oil for an estimate"
    raise InputError(what, "arguments pressure_viscosity_coefficient and base_oil", why, remedy)
