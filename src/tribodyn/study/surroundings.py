"""The sections ``[material]``, ``[lubricant]``, ``[operation]`` and ``[film]`` of the case file."""

from __future__ import annotations

from tribodyn.study.fields import choice, integer, number, numbers
from tribodyn.study.section import Section

_GUARD = "guards against a wrong unit"
_RPM = 0.10471975511965977


def _film_models() -> list[str]:
    from tribodyn.ehl import FILM_MODELS

    return FILM_MODELS.names()


def _lubricants() -> list[str]:
    from tribodyn.lubricant import library

    return list(library())


class MaterialData(Section):
    """The ``[material]`` table: both gears are made of it."""

    youngs_modulus: float = number(
        206e9, 1e8, 1e12, "from polymers to tungsten carbide", of="youngs_modulus"
    )
    poissons_ratio: float = number(
        0.3, 0.0, 0.49, "0.5 is incompressible, negative is no gear material", of="poissons_ratio"
    )
    density: float = number(7800.0, 500.0, 25000.0, "from polymers to tungsten", of="density")


class LubricantData(Section):
    """The ``[lubricant]`` table: a name from the library, or the properties themselves."""

    name: str | None = choice(None, _lubricants, meaning="name of an oil of the library")
    dynamic_viscosity: float | None = number(None, 1e-5, 100.0, _GUARD, of="dynamic_viscosity")
    density: float | None = number(None, 500.0, 2000.0, "liquids; " + _GUARD, of="density")
    pressure_viscosity_coefficient: float | None = number(
        None, 1e-10, 1e-7, "oils lie between 5 and 40 1/GPa", of="pressure_viscosity_coefficient"
    )
    temperature_viscosity_coefficient: float | None = number(
        None, 0.001, 0.3, "gear oils lie between 0.02 and 0.07 1/K",
        of="temperature_viscosity_coefficient",
    )  # fmt: skip
    thermal_conductivity: float | None = number(
        None, 0.01, 2.0, "mineral oil has about 0.13 W/m/K", of="thermal_conductivity"
    )
    temperature: float | None = number(
        None, 233.15, 473.15, "gear oils work between -40 and 200 degC", of="temperature"
    )


class Operation(Section):
    """The ``[operation]`` table."""

    speed: float = number(..., 0.01 * _RPM, 2e5 * _RPM, _GUARD, of="speed")
    torque: float = number(..., 1e-6, 1e8, _GUARD, of="torque")
    speed_of: str = choice(
        "pinion", ("pinion", "wheel"), meaning="the gear whose speed and torque are given"
    )
    torque_balance: str = choice(
        "drive",
        ("drive", "load", "both"),
        meaning="which nominal torque is held when friction acts",
    )


class Film(Section):
    """The ``[film]`` table: how the oil film is found; None where the model does not use a key."""

    model: str = choice("none", _film_models, meaning="how the oil film is found")
    stiffness: str = choice(
        "none", ("none", "tangent", "secant", "seed"),
        meaning="stiffness of the oil film; tangent and secant are in series with the teeth",
    )  # fmt: skip
    nodes: int | None = integer(
        None, 65, 16385, "a power of two plus one", example="513",
        meaning="nodes of each solved contact",
    )  # fmt: skip
    positions: int | None = integer(
        None, 8, 200, "fewer miss how the film changes, more only cost time", example="30",
        meaning="positions on the path of contact at which the film is solved",
    )  # fmt: skip
    inlet: str | None = choice(
        None, ("flooded", "zero"), meaning="oil supply: plenty, or none before the domain begins"
    )
    domain: tuple[float, ...] | None = numbers(
        -100.0, 10.0, "a contact is wetted over 1.5 to 20 half widths", example="-2.5, 1.5",
        meaning="first and last position of each solved contact in Hertzian half widths",
    )  # fmt: skip
