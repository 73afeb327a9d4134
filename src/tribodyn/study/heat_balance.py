"""Heat balance: the temperature at which the gearbox dissipates its power loss.

One node for gears and oil, or two as in the thermal networks of Changenet, Oviedo-Marlot and Velex
(2006): the teeth heat the gears, these the oil, and the oil, which takes up all other losses as
well, the surroundings.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

import numpy as np

from tribodyn.errors import ComputationError, collected
from tribodyn.lubricant import temperature_range
from tribodyn.lubricant.data_sheet import SHEET_RANGE
from tribodyn.record import Record, fact, quantity, record
from tribodyn.study.pipeline.preview import gearbox_losses_of
from tribodyn.types import Array
from tribodyn.units import ZERO_CELSIUS

if TYPE_CHECKING:
    from tribodyn.mesh import MeshTable
    from tribodyn.study.case.case import Case

#: Tolerance of the balance over the loss, and largest number of passes.
_TOLERANCE, _MAX_PASSES = 5e-7, 40

_DEFAULT_AMBIENT = 293.15  # default temperature of the surroundings [K]

Extra = TypeVar("Extra")


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
    case: Case, mesh_at: Callable[[Case], tuple[Case, MeshTable, Extra]]
) -> tuple[Case, MeshTable, Extra, HeatBalance]:
    """Solve ``loss(T) = hA (T - T_amb)``; return the case, its mesh, extras and the iteration."""
    # Gears with a heat transfer of their own are warmer than the oil by the friction of their teeth
    # over it; the film has their temperature, bearings, seals and bath have that of the oil.
    # Secants within a bracket: the loss is positive at the temperature of the surroundings, and has
    # to be smaller than the dissipated heat at the highest temperature of the oil data.
    oil = case.lubricant
    assert oil is not None
    assert oil.heat_transfer is not None
    transfer, ambient = oil.heat_transfer, oil.ambient_temperature or _DEFAULT_AMBIENT
    coldest, hottest = temperature_range(oil.name) if oil.name else SHEET_RANGE
    name = oil.name or "the oil of the data sheet"
    if ambient < coldest:
        what = f"ambient_temperature = {ambient - ZERO_CELSIUS:.4g} degC"
        why = f"The data of {name} start at {coldest - ZERO_CELSIUS:.4g} degC"
        remedy = "Increase ambient_temperature, or choose another oil"
        raise ComputationError(what, "lubricant.ambient_temperature", why, remedy)
    low, high = 0.0, hottest - ambient
    start = oil.gear_temperature or oil.temperature or ambient
    rise = float(np.clip(start - ambient, 0.0, high))
    rows: list[_Pass] = []
    while len(rows) < _MAX_PASSES:
        with collected():
            solved, mesh, extra = mesh_at(_at(case, ambient, rise, rise))
        solved, last = _heat_flows(solved, mesh, ambient, rise)
        rows.append(last)
        if abs(last.excess) <= _TOLERANCE * last.loss:
            return solved, mesh, extra, _record(rows, solved, ambient)
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


def _at(case: Case, ambient: float, oil_rise: float, rise: float) -> Case:
    """Return a case with oil and gears at temperatures above the surroundings."""
    oil, changes = case.lubricant, {"lubricant.temperature": ambient + oil_rise}
    if oil is not None and oil.gear_heat_transfer is not None:
        changes["lubricant.gear_temperature"] = ambient + rise
    return case.replace(changes)


def _heat_flows(solved: Case, mesh: MeshTable, ambient: float, rise: float) -> tuple[Case, _Pass]:
    """Find the oil temperature and the losses that belong to a temperature of the gears."""
    oil, friction, oil_rise = solved.lubricant, mesh.mean_friction_power, rise
    assert oil is not None
    assert oil.heat_transfer is not None
    if oil.gear_heat_transfer is not None:
        # At the balance no oil is colder than its surroundings: only the data of the oil end there.
        oil_rise = max(rise - friction / oil.gear_heat_transfer, 0.0)
        solved = _at(solved, ambient, oil_rise, rise)
    loss = float(gearbox_losses_of(solved, friction).total[0, 0])
    return solved, _Pass(rise, oil_rise, friction, loss, oil.heat_transfer * oil_rise)


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


def _record(rows: list[_Pass], case: Case, ambient: float) -> HeatBalance:
    rises, oil_rises, friction, losses, dissipated = np.array(rows).T
    oil = case.lubricant
    assert oil is not None
    assert oil.heat_transfer is not None
    gears: dict[str, Any] = {}
    if oil.gear_heat_transfer is not None:
        gears = {
            "gear_temperature": ambient + rises,
            "gear_power_loss": friction,
            "gear_heat_transfer": oil.gear_heat_transfer,
        }
    return HeatBalance(
        iteration=np.arange(1.0, len(rows) + 1.0),
        temperature=ambient + oil_rises,
        power_loss=losses,
        dissipated=dissipated,
        heat_transfer=oil.heat_transfer,
        ambient_temperature=ambient,
        **gears,
    )
