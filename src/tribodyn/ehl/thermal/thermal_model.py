"""How the oil of a heated film shears, and the thermal data of the bodies of a contact."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from tribodyn.ehl.traction.film_temperature import (
    STEEL_THERMAL_CONTACT_COEFFICIENT,
    ThermalOil,
    require_known,
)
from tribodyn.ehl.traction.shear_models import EYRING_STRESS, SHEAR_MODELS
from tribodyn.errors import (
    InputError,
    require_between,
    require_one_of,
    require_positive,
)
from tribodyn.lubricant import Lubricant
from tribodyn.lubricant.pressure_laws import DENSITY_FALL
from tribodyn.model import NO_OPTIONS
from tribodyn.nomenclature import require_whole

#: Thermal conductivity of gear steel [W/m/K], in the middle of ISO/TR 13989-1.
STEEL_CONDUCTIVITY = 47.0
#: The shear models that a heated film can have, by the number that the kernel has for them.
MODELS = {"newtonian": 0, "ree-eyring": 1, "carreau": 2, "carreau-eyring": 3, "bair-winer": 4}


class BodyHeat(NamedTuple):
    """How a body takes up heat."""

    #: ``sqrt(k rho c)`` [J/(m^2 K s^0.5)]
    thermal_contact_coefficient: float = STEEL_THERMAL_CONTACT_COEFFICIENT
    thermal_conductivity: float = STEEL_CONDUCTIVITY  #: [W/m/K]
    #: Temperature far from the contact [K]; that of the oil at the inlet if None.
    temperature: float | None = None

    @property
    def diffusivity(self) -> float:
        """``k/(rho c)`` [m^2/s]."""
        return (self.thermal_conductivity / self.thermal_contact_coefficient) ** 2


class OilHeat(NamedTuple):
    """Thermal properties of an oil, complete."""

    temperature: float  #: [K]
    temperature_viscosity_coefficient: float  #: [1/K]
    thermal_conductivity: float  #: [W/m/K]
    specific_heat: float  #: [J/kg/K]
    expansion: float  #: thermal expansion [1/K]


@dataclass(frozen=True)
class ThermalModel:
    """How a heated film is computed; see :func:`tribodyn.ehl.solve_line_contact`.

    Parameters
    ----------
    shear_model : str
        How the oil shears: ``"newtonian"``, ``"ree-eyring"``, ``"carreau"``, ``"carreau-eyring"``
        or ``"bair-winer"``.
    shear_numbers : mapping of str to float
        Numbers of the shear model, such as ``eyring_stress`` [Pa]; its defaults otherwise. A
        ``limiting_stress`` [Pa] and a ``limiting_stress_slope`` bound the stress of any model.
    bodies : two of BodyHeat
        How bodies 1 and 2 take up heat; gear steel by default.
    specific_heat : float, optional [J/kg/K]
        Of the oil; by default ``(1630 + 3.4 t)/sqrt(s)`` with t in degC and s the density over
        that of water, Gambill (1957).
    thermal_conductivity : float, optional [W/m/K]
        Of the oil; that of the lubricant by default.
    nodes_across : int
        Nodes across the film, both surfaces included, 5 to 129.
    tolerance : float
        Greatest relative change of film and friction in the last pass.
    passes : int
        Passes at most between film and temperatures.

    Raises
    ------
    InputError
        If a value is out of range, or a number does not belong to the shear model.

    Examples
    --------
    >>> ThermalModel("ree-eyring", {"eyring_stress": 4e6}).numbers
    {'eyring_stress': 4000000.0}
    """

    shear_model: str = "newtonian"
    shear_numbers: Mapping[str, float | None] = field(default_factory=lambda: NO_OPTIONS)
    bodies: tuple[BodyHeat, BodyHeat] = (BodyHeat(), BodyHeat())
    specific_heat: float | None = None
    thermal_conductivity: float | None = None
    nodes_across: int = 17
    tolerance: float = 5e-4
    passes: int = 60

    def __post_init__(self) -> None:
        """Check the values."""
        require_one_of("shear_model", self.shear_model, MODELS)
        _ = self.numbers
        for body in self.bodies:
            name = "thermal_contact_coefficient"
            require_positive(name, body.thermal_contact_coefficient, "J/(m^2 K s^0.5)")
            require_positive("thermal_conductivity", body.thermal_conductivity, "W/m/K")
            if body.temperature is not None:
                require_between("temperature", body.temperature, 200.0, 700.0, "K")
        for name, unit in (("specific_heat", "J/kg/K"), ("thermal_conductivity", "W/m/K")):
            if getattr(self, name) is not None:
                require_positive(name, getattr(self, name), unit)
        require_between("nodes_across", require_whole("nodes_across", self.nodes_across, 5), 5, 129)
        require_between("tolerance", self.tolerance, 1e-9, 1e-2)
        require_whole("passes", self.passes, 1)

    @property
    def numbers(self) -> dict[str, float]:
        """All numbers of the shear model."""
        numbers = dict(self.shear_numbers)
        stress = numbers.pop("eyring_stress", None)
        model = SHEAR_MODELS[self.shear_model]
        return model.complete(EYRING_STRESS if stress is None else stress, numbers)

    def oil(self, lubricant: Lubricant, compressible: bool = True) -> OilHeat:
        """Thermal properties of an oil that must have them all.

        Parameters
        ----------
        lubricant : Lubricant
            Oil at the temperature of the inlet.
        compressible : bool
            Whether its density follows pressure and temperature.

        Returns
        -------
        OilHeat

        Raises
        ------
        InputError
            If a property of the oil is not known.
        """
        usual = list(ThermalOil._fields)
        if self.thermal_conductivity is not None:
            usual.remove("thermal_conductivity")
        require_known(lubricant, usual, "solve the film without thermal")
        temperature, density = float(lubricant.temperature or 0.0), lubricant.density
        capacity = self.specific_heat
        if capacity is None:
            capacity = (1630.0 + 3.4 * (temperature - 273.15)) / math.sqrt(density / 1000.0)
        return OilHeat(
            temperature,
            float(lubricant.temperature_viscosity_coefficient or 0.0),
            float(self.thermal_conductivity or lubricant.thermal_conductivity or 0.0),
            capacity,
            DENSITY_FALL / density if compressible else 0.0,
        )


def read_thermal(thermal: object) -> ThermalModel | None:
    """The argument ``thermal`` of a solver, checked; None for a film at one temperature."""
    model = ThermalModel() if thermal is True else thermal or None
    if model is not None and not isinstance(model, ThermalModel):
        what = f"thermal is of the type {type(model).__name__}"
        remedy = "Give True, or ThermalModel(shear_model, ...)"
        raise InputError(what, "argument thermal", "It says how the film is heated", remedy)
    return model
