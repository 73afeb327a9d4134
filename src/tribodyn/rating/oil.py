"""Oil of a gear drive as ratings need it: viscosities, temperature, results of tests."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from tribodyn.errors import Argument, InputError, require_between, require_one_of, require_positive
from tribodyn.lubricant import viscosity_at_100_degc, walther_viscosity

#: Lubricant factor X_L of ISO/TS 6336-20 and -22 by base oil.
LUBRICANT_FACTORS: Final = {
    "mineral": 1.0, "water-soluble polyglycol": 0.6, "polyglycol": 0.7, "pao": 0.8,
    "phosphate ester": 1.3, "traction fluid": 1.5,
}  # fmt: skip
#: Factor X_S of the lubrication.
LUBRICATION_FACTORS: Final = {"spray": 1.2, "dip": 1.0, "submerged": 0.2}


@dataclass(frozen=True, kw_only=True)
class GearOil:
    """Oil of a gear drive.

    Parameters
    ----------
    kinematic_viscosity_at_40 : float
        nu_40 at 40 degC [m^2/s].
    kinematic_viscosity_at_100 : float, optional
        nu_100 at 100 degC [m^2/s]; by default from a viscosity index of 95.
    temperature : float
        theta_oil in the tank or at the spray nozzle [K].
    base_oil : str
        ``mineral``, ``pao``, ``polyglycol``, ``water-soluble polyglycol``, ``phosphate ester`` or
        ``traction fluid``.
    density_at_15 : float, optional
        Density at 15 degC [kg/m^3]; by default 43.37 lg nu_40 + 805.5.
    lubrication : str
        ``spray``, ``dip`` or ``submerged``.
    scuffing_load_stage : int, optional
        Failure load stage of the FZG test A/8.3/90, 1 to 14.
    micropitting_load_stage : int, optional
        Failure load stage of the FZG micropitting test C-GF/8.3, 5 to 10.
    micropitting_test_temperature : float
        Oil temperature of that test [K].
    micropitting_test_lubrication : str
        Lubrication of that test, ``spray``, ``dip`` or ``submerged``.

    Raises
    ------
    InputError
        If a value is out of range or a name is unknown.

    Examples
    --------
    >>> oil = GearOil(kinematic_viscosity_at_40=220e-6, temperature=353.15)
    >>> round(oil.kinematic_viscosity(313.15) * 1e6, 6)
    220.0
    """

    kinematic_viscosity_at_40: float
    kinematic_viscosity_at_100: float | None = None
    temperature: float = 353.15
    base_oil: str = "mineral"
    density_at_15: float | None = None
    lubrication: str = "dip"
    scuffing_load_stage: int | None = None
    micropitting_load_stage: int | None = None
    micropitting_test_temperature: float = 363.15
    micropitting_test_lubrication: str = "spray"

    def __post_init__(self) -> None:
        require_between(
            "kinematic_viscosity_at_40", self.kinematic_viscosity_at_40, 1e-6, 0.1, "m^2/s"
        )
        require_between("temperature", self.temperature, 233.15, 473.15, "K")
        require_one_of("base_oil", self.base_oil, LUBRICANT_FACTORS)
        for name in ("lubrication", "micropitting_test_lubrication"):
            require_one_of(name, getattr(self, name), LUBRICATION_FACTORS)
        if self.density_at_15 is not None:
            require_positive("density_at_15", self.density_at_15, "kg/m^3")
        for name, low, high in (("scuffing_load_stage", 1, 14), ("micropitting_load_stage", 5, 10)):
            if getattr(self, name) is not None:
                require_between(name, getattr(self, name), low, high)
        at_100 = self.kinematic_viscosity_at_100
        if at_100 is not None and not 0.0 < at_100 < self.kinematic_viscosity_at_40:
            raise InputError(
                f"kinematic_viscosity_at_100 = {at_100 * 1e6:g} mm2/s",
                Argument("kinematic_viscosity_at_100"),
                f"It is positive and below nu_40 = {self.kinematic_viscosity_at_40 * 1e6:g} mm2/s",
                "Check the unit: 24 mm2/s is 24e-6 m^2/s",
            )

    def kinematic_viscosity(self, temperature: float) -> float:
        """Kinematic viscosity on the line of Walther through 40 and 100 degC.

        Parameters
        ----------
        temperature : float [K]
            Of the oil.

        Returns
        -------
        float [m^2/s]
        """
        at_40, at_100 = self.kinematic_viscosity_at_40, self.kinematic_viscosity_at_100
        if at_100 is None:
            at_100 = viscosity_at_100_degc(at_40, 95.0)
        points = (313.15, at_40), (373.15, at_100)
        return float(walther_viscosity(temperature, points, margin=1e4))

    def density(self, temperature: float) -> float:
        """Density, falling by 0.7 kg/m3 per kelvin.

        Parameters
        ----------
        temperature : float [K]
            Of the oil.

        Returns
        -------
        float [kg/m^3]
        """
        at_15 = self.density_at_15
        if at_15 is None:
            at_15 = 43.37 * math.log10(1e6 * self.kinematic_viscosity_at_40) + 805.5
        return at_15 - 0.7 * (temperature - 289.0)

    def dynamic_viscosity(self, temperature: float) -> float:
        """Dynamic viscosity at ambient pressure.

        Parameters
        ----------
        temperature : float [K]
            Of the oil.

        Returns
        -------
        float [Pa*s]
        """
        return self.kinematic_viscosity(temperature) * self.density(temperature)

    @property
    def lubricant_factor(self) -> float:
        """X_L of the friction and the scuffing temperature."""
        return LUBRICANT_FACTORS[self.base_oil]

    @property
    def lubrication_factor(self) -> float:
        """X_S of the heat that the oil takes up."""
        return LUBRICATION_FACTORS[self.lubrication]
