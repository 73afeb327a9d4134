"""Heat balance: the temperature at which the gearbox dissipates its power loss.

One node for gears and oil, or two as in the thermal networks of Changenet, Oviedo-Marlot and Velex
(2006): the teeth heat the gears, these the oil, and the oil, which takes up all other losses as
well, the surroundings.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, NamedTuple, TypeVar

import numpy as np

from tribodyn.errors import ComputationError, collected
from tribodyn.lubricant import temperature_range
from tribodyn.lubricant.data_sheet import SHEET_RANGE
from tribodyn.record import Record, fact, quantity, record
from tribodyn.study.pipeline.tooth_contact import repeat
from tribodyn.types import Array
from tribodyn.units import ZERO_CELSIUS

if TYPE_CHECKING:
    from tribodyn.study.case.sections import LubricantData

#: Tolerance of the balance over the loss, and largest number of passes.
_TOLERANCE, _MAX_PASSES = 5e-7, 40

_DEFAULT_AMBIENT = 293.15  # default temperature of the surroundings [K]

Solved = TypeVar("Solved")


@record
class HeatBalance(Record):
    """Iteration to the temperatures at which gears and oil dissipate the power loss.

    Parameters
    ----------
    iteration : array (passes,)
        Number of each pass.
    temperature : array (passes,) [K]
        Temperature of the oil, and of the gears where they have none of their own.
    power_loss : array (passes,) [W]
        Power loss of teeth, bearings, seals and oil at this temperature.
    dissipated : array (passes,) [W]
        Heat flow to the surroundings at this temperature.
    heat_transfer : float [W/K]
        Heat transfer coefficient times area.
    ambient_temperature : float [K]
        Temperature of the surroundings.
    gear_temperature : array (passes,) [K], optional
        Bulk temperature of the gears, where it is not that of the oil.
    gear_power_loss : array (passes,) [W], optional
        Part of the loss that heats the gears: the friction of their teeth.
    gear_heat_transfer : float, optional [W/K]
        Heat transfer coefficient times area between gears and oil.
    """

    iteration: Array = quantity("iteration", unit="1", axis=True)
    temperature: Array = quantity("iteration", unit="K")
    power_loss: Array = quantity("iteration", unit="W")
    dissipated: Array = quantity("iteration", unit="W")
    heat_transfer: float = fact()
    ambient_temperature: float = fact()
    gear_temperature: Array | None = quantity("iteration", unit="K", default=None)
    gear_power_loss: Array | None = quantity("iteration", unit="W", default=None)
    gear_heat_transfer: float | None = fact(default=None)


class Temperatures(NamedTuple):
    """Temperatures of a gearbox [K]."""

    oil: float
    gears: float | None = None  #: None where the gears have that of the oil

    def changes(self) -> dict[str, float]:
        """Values of the table ``[lubricant]``."""
        temperatures = {"temperature": self.oil, "gear_temperature": self.gears}
        return {name: value for name, value in temperatures.items() if value is not None}


class _Pass(NamedTuple):
    """Temperatures above the surroundings and heat flows of one pass."""

    rise: float  #: of the gears, which is iterated [K]
    oil_rise: float  #: of the oil [K]
    friction: float  #: loss of the teeth [W]
    loss: float  #: loss of the gearbox [W]
    dissipated: float  #: heat flow to the surroundings [W]

    @property
    def excess(self) -> float:
        """Heat that the surroundings do not take up [W]."""
        return self.loss - self.dissipated


def balanced(
    heat: LubricantData,
    oils: Sequence[LubricantData],
    solve: Callable[[Temperatures], tuple[Solved, float]],
    loss: Callable[[Solved, Temperatures], float] | None = None,
) -> tuple[Solved, Temperatures, HeatBalance]:
    """Solve ``loss(T) = hA (T - T_amb)``; return what is solved there, and the iteration."""
    # solve: computes the teeth and the friction of all meshes [W]. loss: of the gearbox with these
    # teeth [W], by default their friction. oils: those whose data have to reach the temperature.
    # Gears with a heat transfer of their own are warmer than the oil by the friction of their teeth
    # over it; the film has their temperature, bearings, seals and bath have that of the oil.
    # Secants within a bracket: the loss is positive at the temperature of the surroundings, and has
    # to be smaller than the dissipated heat at the highest temperature of the oil data.
    assert heat.heat_transfer is not None
    transfer, ambient = heat.heat_transfer, heat.ambient_temperature or _DEFAULT_AMBIENT
    to_oil = heat.gear_heat_transfer
    hottest, name = _range_of(oils, ambient)
    low, high = 0.0, hottest - ambient
    start = heat.gear_temperature or heat.temperature or ambient
    rise = float(np.clip(start - ambient, 0.0, high))
    rows: list[_Pass] = []
    while len(rows) < _MAX_PASSES:
        gears = None if to_oil is None else ambient + rise
        with collected() as of_models:
            solved, friction = solve(Temperatures(ambient + rise, gears))
        # At the balance no oil is colder than its surroundings: only its data end there.
        oil_rise = rise if to_oil is None else max(rise - friction / to_oil, 0.0)
        at = Temperatures(ambient + oil_rise, gears)
        lost = friction if loss is None else loss(solved, at)
        last = _Pass(rise, oil_rise, friction, lost, transfer * oil_rise)
        rows.append(last)
        if abs(last.excess) <= _TOLERANCE * last.loss:
            repeat(of_models)
            return solved, at, _record(rows, heat, ambient)
        if last.excess > 0.0 and rise == hottest - ambient:
            raise ComputationError(
                f"no temperature up to {hottest - ZERO_CELSIUS:.4g} degC balances the losses: "
                f"there the loss is {last.loss:.4g} W and {last.dissipated:.4g} W are dissipated",
                where="lubricant.heat_transfer",
                why=f"The data of {name} end at {hottest - ZERO_CELSIUS:.4g} degC",
                remedy=_enough(last),
            )
        low, high = (rise, high) if last.excess > 0.0 else (low, rise)
        rise = _next(rows, transfer, low, high, hottest - ambient)
    last = rows[-1]
    raise ComputationError(
        "temperature and losses do not settle: at "
        f"{ambient + last.oil_rise - ZERO_CELSIUS:.6g} degC the loss is {last.loss:.6g} W and "
        f"{last.dissipated:.6g} W are dissipated (pass {len(rows)})",
        where="lubricant.heat_transfer",
        why="The losses jump with the temperature",
        remedy="Reduce film.tolerance, increase film.positions, or remove heat_transfer",
    )


def _range_of(oils: Sequence[LubricantData], ambient: float) -> tuple[float, str]:
    """Highest temperature of the data of all oils [K], and the oil that has it."""
    names = [oil.name or "the oil of the data sheet" for oil in oils]
    ranges = [temperature_range(oil.name) if oil.name else SHEET_RANGE for oil in oils]
    coldest, name = max((low, name) for (low, _), name in zip(ranges, names, strict=True))
    if ambient < coldest:
        what = f"ambient_temperature = {ambient - ZERO_CELSIUS:.4g} degC"
        why = f"The data of {name} start at {coldest - ZERO_CELSIUS:.4g} degC"
        remedy = "Increase ambient_temperature, or choose another oil"
        raise ComputationError(what, "lubricant.ambient_temperature", why, remedy)
    return min((high, name) for (_, high), name in zip(ranges, names, strict=True))


def _enough(last: _Pass) -> str:
    """Return the remedy for a loss that is too great at the highest temperature of the gears."""
    if not last.oil_rise > 0.0:
        return "Set a greater gear_heat_transfer, or reduce torque or speed"
    return f"Set more than {last.loss / last.oil_rise:.4g} W/K, or reduce torque or speed"


def _next(rows: list[_Pass], transfer: float, low: float, high: float, highest: float) -> float:
    """Return the temperature rise of the next pass: fixed point, secant, or bisection."""
    last = rows[-1]
    if len(rows) == 1:
        step = last.rise - last.oil_rise + last.loss / transfer
    else:
        before = rows[-2]
        slope = (last.excess - before.excess) / (last.rise - before.rise)
        step = last.rise - last.excess / slope if slope < 0.0 else np.inf
    if low < step < high or step == low == 0.0:
        return step
    if step >= highest and high == highest:
        return highest
    return 0.5 * (low + high)


def _record(rows: list[_Pass], oil: LubricantData, ambient: float) -> HeatBalance:
    rises, oil_rises, friction, losses, dissipated = np.array(rows).T
    assert oil.heat_transfer is not None
    two = oil.gear_heat_transfer is not None
    return HeatBalance(
        iteration=np.arange(1.0, len(rows) + 1.0),
        temperature=ambient + oil_rises,
        power_loss=losses,
        dissipated=dissipated,
        heat_transfer=oil.heat_transfer,
        ambient_temperature=ambient,
        gear_temperature=ambient + rises if two else None,
        gear_power_loss=friction if two else None,
        gear_heat_transfer=oil.gear_heat_transfer,
    )
