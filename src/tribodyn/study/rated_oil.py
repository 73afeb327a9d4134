"""The oil of a case as ratings need it: viscosities at 40 and 100 degC."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribodyn.lubricant.astm_d341 import viscosity_from_slope
from tribodyn.rating import GearOil
from tribodyn.study.case.to_models import lubricant

if TYPE_CHECKING:
    from tribodyn.study.case.case import Case
    from tribodyn.study.case.sections import LubricantData

#: Base oils of data sheets by their names in ratings; others count as mineral.
_BASE_OILS = {"polyalphaolefin": "pao", "polyalkylene glycol": "polyglycol"}
#: Where the oil of a case has no temperature, as of the viscosity that it states.
_WITHOUT_TEMPERATURE = 353.15
#: 40 and 100 degC [K], and the fall of the density of oils per kelvin [kg/(m^3 K)].
_REFERENCE, _DENSITY_FALL = (313.15, 373.15), 0.7


def _viscosities(data: LubricantData) -> tuple[float, float | None]:
    """Kinematic viscosities at 40 and 100 degC; the latter is None where nothing gives it."""
    oils = [lubricant(data, temperature) for temperature in _REFERENCE]
    if data.name is not None or data.density_at_15 is not None:
        return oils[0].kinematic_viscosity, oils[1].kinematic_viscosity
    fall, reference = data.temperature_viscosity_coefficient, data.temperature
    if fall is None or reference is None:  # stated at 40 degC
        return oils[0].kinematic_viscosity, None
    slope = fall - _DENSITY_FALL / oils[0].density
    point = reference, oils[0].kinematic_viscosity
    cold, warm = (viscosity_from_slope(temperature, point, slope) for temperature in _REFERENCE)
    return cold, warm


def gear_oil(case: Case) -> GearOil:
    """Oil of a case as ratings need it, with its viscosities at 40 and 100 degC."""
    data, rating = case.lubricant, case.rating
    assert data is not None
    assert rating is not None
    cold, warm = _viscosities(data)
    return GearOil(
        kinematic_viscosity_at_40=cold,
        kinematic_viscosity_at_100=warm,
        temperature=data.temperature or _WITHOUT_TEMPERATURE,
        base_oil=_BASE_OILS.get(data.base_oil or "", "mineral"),
        density_at_15=data.density_at_15,
        lubrication=rating.lubrication,
        scuffing_load_stage=rating.scuffing_load_stage,
        micropitting_load_stage=rating.micropitting_load_stage,
    )
