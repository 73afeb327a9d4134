"""The oil: viscosity and density over pressure and temperature, and a library of named oils.

| module | content |
| --- | --- |
| `oil` | a lubricating oil at its working temperature |
| `library` | named oils, each number with its source |
| `data_sheet` | an oil of a data sheet: two viscosities, or one and a viscosity index |
| `astm` | viscosity over temperature from two points (D341); viscosity index, and back (D2270) |
| `pressure_laws` | viscosity (Barus, Roelands) and density under pressure and temperature |
"""

from __future__ import annotations

from tribodyn.arguments import guard
from tribodyn.lubricant.astm import (
    viscosity_at_40_degc,
    viscosity_at_100_degc,
    viscosity_index,
    walther_slope,
    walther_viscosity,
)
from tribodyn.lubricant.data_sheet import from_data_sheet
from tribodyn.lubricant.library import from_library, library, temperature_range
from tribodyn.lubricant.oil import VISCOSITY_LAWS, Lubricant
from tribodyn.lubricant.pressure_laws import (
    BASE_OILS,
    ROELANDS_PRESSURE,
    agma_925_coefficient,
    barus_viscosity,
    density_at_temperature,
    dowson_higginson_density,
    roelands_index,
    roelands_viscosity,
)

__all__ = [
    "BASE_OILS",
    "ROELANDS_PRESSURE",
    "VISCOSITY_LAWS",
    "Lubricant",
    "agma_925_coefficient",
    "barus_viscosity",
    "density_at_temperature",
    "dowson_higginson_density",
    "from_data_sheet",
    "from_library",
    "library",
    "roelands_index",
    "roelands_viscosity",
    "temperature_range",
    "viscosity_at_40_degc",
    "viscosity_at_100_degc",
    "viscosity_index",
    "walther_slope",
    "walther_viscosity",
]

guard(__name__)
