"""Temperature of gears and oil at which the surroundings take up what the gearbox loses."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from tribodyn.errors import ComputationError, collected
from tribodyn.lubricant import temperature_range
from tribodyn.lubricant.data_sheet import SHEET_RANGE
from tribodyn.record import Record, fact, quantity, record
from tribodyn.study.pipeline.first_look import gearbox_losses_of
from tribodyn.types import Array
from tribodyn.units import ZERO_CELSIUS

if TYPE_CHECKING:
    from tribodyn.mesh import MeshTable
    from tribodyn.study.case.case import Case

#: Difference of loss and heat given off, over the loss, that is a balance; and most passes.
_CLOSE, _MOST = 5e-7, 40

_ROOM = 293.15  # surroundings that nobody stated [K]

Answer = TypeVar("Answer")


@record
class HeatBalance(Record):
    """How gears and oil came to the temperature at which they give off what is lost.

    Parameters
    ----------
    iteration : array (passes,)
        Number of each pass.
    temperature : array (passes,) [K]
        Temperature of gears and oil.
    power_loss : array (passes,) [W]
        What teeth, bearings, seals and oil lose at it.
    dissipated : array (passes,) [W]
        Heat that the surroundings take up at it.
    heat_transfer : float [W/K]
        Heat transfer coefficient times area.
    ambient_temperature : float [K]
        Temperature of the surroundings.
    """

    iteration: Array = quantity("iteration", unit="1", axis=True)
    temperature: Array = quantity("iteration", unit="K")
    power_loss: Array = quantity("iteration", unit="W")
    dissipated: Array = quantity("iteration", unit="W")
    heat_transfer: float = fact()
    ambient_temperature: float = fact()


def balanced(
    case: Case, mesh_at: Callable[[Case], tuple[Case, MeshTable, Answer]]
) -> tuple[Case, MeshTable, Answer, HeatBalance]:
    """Case where the losses are given off, ``loss(T) = hA (T - T_amb)``, its mesh, and the way."""
    # Secants within a bracket: the loss is positive at the temperature of the surroundings, and has
    # to be smaller than the heat given off at the highest one at which the oil is known.
    oil = case.lubricant
    assert oil is not None
    assert oil.heat_transfer is not None
    transfer, ambient = oil.heat_transfer, oil.ambient_temperature or _ROOM
    coldest, hottest = temperature_range(oil.name) if oil.name else SHEET_RANGE
    name = oil.name or "the oil of the data sheet"
    if ambient < coldest:
        what = f"ambient_temperature = {ambient - ZERO_CELSIUS:.4g} degC"
        why = f"{name} is known from {coldest - ZERO_CELSIUS:.4g} degC on"
        remedy = "Give warmer surroundings, or another oil"
        raise ComputationError(what, "lubricant.ambient_temperature", why, remedy)
    low, high = 0.0, hottest - ambient
    rise = float(np.clip((oil.temperature or ambient) - ambient, 0.0, high))
    rows: list[tuple[float, float]] = []
    while len(rows) < _MOST:
        point = case.replace({"lubricant.temperature": ambient + rise})
        with collected():
            found, mesh, answer = mesh_at(point)
        loss = float(gearbox_losses_of(found, mesh.mean_friction_power).total[0, 0])
        rows.append((rise, loss))
        excess = loss - transfer * rise
        if abs(excess) <= _CLOSE * loss:
            return found, mesh, answer, _record(rows, transfer, ambient)
        if excess > 0.0 and rise == hottest - ambient:
            raise ComputationError(
                f"no temperature up to {hottest - ZERO_CELSIUS:.4g} degC balances the losses: "
                f"there {loss:.4g} W are lost and {transfer * rise:.4g} W given off",
                where="lubricant.heat_transfer",
                why=f"{name} is known up to {hottest - ZERO_CELSIUS:.4g} degC",
                remedy=f"Give more than {loss / rise:.4g} W/K, or less torque or speed",
            )
        low, high = (rise, high) if excess > 0.0 else (low, rise)
        rise = _next(rows, transfer, low, high, hottest - ambient)
    last, loss = rows[-1]
    raise ComputationError(
        f"temperature and losses do not settle: at {ambient + last - ZERO_CELSIUS:.6g} degC "
        f"{loss:.6g} W are lost and {transfer * last:.6g} W given off after {len(rows)} passes",
        where="lubricant.heat_transfer",
        why="The losses jump with the temperature",
        remedy="Tighten film.tolerance or give more film.positions, or leave heat_transfer out",
    )


def _next(
    rows: list[tuple[float, float]], transfer: float, low: float, high: float, most: float
) -> float:
    """Rise of the next pass: that of the last loss, the secant of two, or the middle."""
    rise, loss = rows[-1]
    if len(rows) == 1:
        step = loss / transfer
    else:
        before, lost = rows[-2]
        slope = (loss - lost) / (rise - before) - transfer
        step = rise - (loss - transfer * rise) / slope if slope < 0.0 else np.inf
    if low < step < high or step == low == 0.0:
        return step
    if step >= most and high == most:
        return most
    return 0.5 * (low + high)


def _record(rows: list[tuple[float, float]], transfer: float, ambient: float) -> HeatBalance:
    rises, losses = np.array(rows).T
    return HeatBalance(
        iteration=np.arange(1.0, len(rows) + 1.0),
        temperature=ambient + rises,
        power_loss=losses,
        dissipated=transfer * rises,
        heat_transfer=transfer,
        ambient_temperature=ambient,
    )
