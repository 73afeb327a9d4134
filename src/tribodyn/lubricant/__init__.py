"""The oil: viscosity and density over pressure and temperature, and a library of named oils."""

from __future__ import annotations

from tribodyn.lubricant.agma_925 import BASE_OILS, agma_925_coefficient
from tribodyn.lubricant.astm_d341 import walther_slope, walther_viscosity
from tribodyn.lubricant.barus import barus_viscosity
from tribodyn.lubricant.dowson_higginson import dowson_higginson_density
from tribodyn.lubricant.iso_15144 import density_at_temperature
from tribodyn.lubricant.library import from_library, library
from tribodyn.lubricant.oil import VISCOSITY_LAWS, Lubricant
from tribodyn.lubricant.roelands import ROELANDS_PRESSURE, roelands_index, roelands_viscosity

__all__ = [
    "BASE_OILS",
    "ROELANDS_PRESSURE",
    "VISCOSITY_LAWS",
    "Lubricant",
    "agma_925_coefficient",
    "barus_viscosity",
    "density_at_temperature",
    "dowson_higginson_density",
    "from_library",
    "library",
    "roelands_index",
    "roelands_viscosity",
    "walther_slope",
    "walther_viscosity",
]
