"""The oil: viscosity and density over pressure and temperature, and a library of named oils.

| module | content |
| --- | --- |
| `oil` | a lubricating oil at its working temperature |
| `library` | named oils, each number with its source |
| `data_sheet` | an oil of a data sheet: two viscosities, or one and a viscosity index |
| `astm_d341` | viscosity over temperature from two measured points |
| `astm_d2270` | viscosity index: from two viscosities, and back |
| `pressure_viscosity` | viscosity under pressure: Barus, Roelands; the coefficient of an oil |
| `density` | density over temperature and under pressure |
"""

from __future__ import annotations

from tribodyn.arguments import guard
from tribodyn.lubricant.astm_d341 import walther_slope, walther_viscosity
from tribodyn.lubricant.astm_d2270 import (
    viscosity_at_40_degc,
    viscosity_at_100_degc,
    viscosity_index,
)
from tribodyn.lubricant.data_sheet import from_data_sheet
from tribodyn.lubricant.density import density_at_temperature, dowson_higginson_density
from tribodyn.lubricant.library import from_library, library, temperature_range
from tribodyn.lubricant.oil import VISCOSITY_LAWS, Lubricant
from tribodyn.lubricant.pressure_viscosity import (
    BASE_OILS,
    ROELANDS_PRESSURE,
    agma_925_coefficient,
    barus_viscosity,
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
