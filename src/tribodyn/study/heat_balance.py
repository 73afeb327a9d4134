"""Heat balance: the temperature at which the gearbox dissipates its power loss."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, TypeVar

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
    """Iteration to the temperature at which gears and oil dissipate the power loss.

    Parameters
    ----------
    iteration : array (passes,)
        Number of each pass.
    temperature : array (passes,) [K]
        Temperature of gears and oil.
    power_loss : array (passes,) [W]
        Power loss of teeth, bearings, seals and oil at this temperature.
    dissipated : array (passes,) [W]
        Heat flow to the surroundings at this temperature.
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
    case: Case, mesh_at: Callable[[Case], tuple[Case, MeshTable, Extra]]
) -> tuple[Case, MeshTable, Extra, HeatBalance]:
    """Solve ``loss(T) = hA (T - T_amb)``; return the case, its mesh, extras and the iteration."""
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
    rise = float(np.clip((oil.temperature or ambient) - ambient, 0.0, high))
    rows: list[tuple[float, float]] = []
    while len(rows) < _MAX_PASSES:
        point = case.replace({"lubricant.temperature": ambient + rise})
        with collected():
            solved, mesh, extra = mesh_at(point)
        loss = float(gearbox_losses_of(solved, mesh.mean_friction_power).total[0, 0])
        rows.append((rise, loss))
        excess = loss - transfer * rise
        if abs(excess) <= _TOLERANCE * loss:
            return solved, mesh, extra, _record(rows, transfer, ambient)
        if excess > 0.0 and rise == hottest - ambient:
            raise ComputationError(
                f"no temperature up to {hottest - ZERO_CELSIUS:.4g} degC balances the losses: "
                f"there the loss is {loss:.4g} W and {transfer * rise:.4g} W are dissipated",
                where="lubricant.heat_transfer",
                why=f"The data of {name} end at {hottest - ZERO_CELSIUS:.4g} degC",
                remedy=f"Set more than {loss / rise:.4g} W/K, or reduce torque or speed",
            )
        low, high = (rise, high) if excess > 0.0 else (low, rise)
        rise = _next(rows, transfer, low, high, hottest - ambient)
    last, loss = rows[-1]
    raise ComputationError(
        f"temperature and losses do not settle: at {ambient + last - ZERO_CELSIUS:.6g} degC "
        f"the loss is {loss:.6g} W and {transfer * last:.6g} W are dissipated (pass {len(rows)})",
        where="lubricant.heat_transfer",
        why="The losses jump with the temperature",
        remedy="Reduce film.tolerance, increase film.positions, or remove heat_transfer",
    )


def _next(
    rows: list[tuple[float, float]], transfer: float, low: float, high: float, highest: float
) -> float:
    """Return the temperature rise of the next pass: fixed point, secant, or bisection."""
    rise, loss = rows[-1]
    if len(rows) == 1:
        step = loss / transfer
    else:
        rise_before, loss_before = rows[-2]
        slope = (loss - loss_before) / (rise - rise_before) - transfer
        step = rise - (loss - transfer * rise) / slope if slope < 0.0 else np.inf
    if low < step < high or step == low == 0.0:
        return step
    if step >= highest and high == highest:
        return highest
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
