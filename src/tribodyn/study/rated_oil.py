"""The oil of a case as ratings need it: viscosities at 40 and 100 degC."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from tribodyn.errors import InputError
from tribodyn.lubricant import walther_viscosity
from tribodyn.lubricant.astm import viscosity_from_slope
from tribodyn.lubricant.library import library_base_oil
from tribodyn.rating import GearOil
from tribodyn.study.case.to_models import lubricant
from tribodyn.units import ZERO_CELSIUS

if TYPE_CHECKING:
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.case.sections import LubricantData

#: Base oils of data sheets by their names in ratings; others count as mineral.
_BASE_OILS = {"polyalphaolefin": "pao", "polyalkylene glycol": "polyglycol"}
#: 40 and 100 degC [K], and the fall of the density of oils per kelvin [kg/(m^3 K)].
_REFERENCE, _DENSITY_FALL = (313.15, 373.15), 0.7
#: Temperatures of oils, and how far the line of Walther is taken beyond its points [K].
_OILS, _MARGIN = (233.15, 473.15), 1e4


def _viscosities(data: LubricantData, at_40: float | None) -> tuple[float, float | None]:
    """Kinematic viscosities at 40 and 100 degC; the latter is None where nothing gives it."""
    if data.name is not None or data.density_at_15 is not None:
        oils = [lubricant(data, temperature) for temperature in _REFERENCE]
        return oils[0].kinematic_viscosity, oils[1].kinematic_viscosity
    oil, fall = lubricant(data), data.temperature_viscosity_coefficient
    viscosity = oil.kinematic_viscosity
    if at_40 is not None and data.temperature is not None:
        points = sorted([(_REFERENCE[0], at_40), (data.temperature, viscosity)])
        return at_40, float(walther_viscosity(_REFERENCE[1], (points[0], points[1]), _MARGIN))
    if fall is None or data.temperature is None:  # stated at 40 degC
        return viscosity if at_40 is None else at_40, None
    slope, point = fall - _DENSITY_FALL / oil.density, (data.temperature, viscosity)
    cold, warm = (viscosity_from_slope(temperature, point, slope) for temperature in _REFERENCE)
    return cold, warm


def _at_its_temperature(oil: GearOil, data: LubricantData) -> GearOil:
    """Oil at the temperature of the case, else at that where it has the viscosity of the case."""
    from scipy.optimize import brentq

    if data.temperature is not None:
        return replace(oil, temperature=data.temperature)
    viscosity = lubricant(data).kinematic_viscosity
    if not oil.kinematic_viscosity(_OILS[1]) <= viscosity <= oil.kinematic_viscosity(_OILS[0]):
        low, high = (temperature - ZERO_CELSIUS for temperature in _OILS)
        raise InputError(
            f"kinematic_viscosity_at_40 = {1e6 * oil.kinematic_viscosity_at_40:g} mm2/s",
            where="rating.kinematic_viscosity_at_40",
            why=f"This oil has the {1e6 * viscosity:.4g} mm2/s of the case nowhere from {low:g} to "
            f"{high:g} degC",
            remedy="Correct one of them, or state lubricant.temperature",
        )
    return replace(
        oil, temperature=brentq(lambda t: oil.kinematic_viscosity(t) - viscosity, *_OILS)
    )


def gear_oil(case: PairCase) -> GearOil:
    """Oil of a case as ratings need it, with its viscosities at 40 and 100 degC."""
    data, rating = case.lubricant, case.rating
    assert data is not None
    assert rating is not None
    cold, warm = _viscosities(data, rating.kinematic_viscosity_at_40)
    base_oil = data.base_oil if data.name is None else library_base_oil(data.name)
    oil = GearOil(
        kinematic_viscosity_at_40=cold,
        kinematic_viscosity_at_100=warm,
        base_oil=_BASE_OILS.get(base_oil or "", "mineral"),
        density_at_15=data.density_at_15,
        lubrication=rating.lubrication,
        scuffing_load_stage=rating.scuffing_load_stage,
        micropitting_load_stage=rating.micropitting_load_stage,
    )
    return _at_its_temperature(oil, data)
