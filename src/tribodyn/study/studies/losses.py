"""Losses and efficiency of a case over torque and speed, and the power flow of a rig with it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.errors import ModelWarning, collected, warn
from tribodyn.progress import SILENT, Progress
from tribodyn.study.case.derive import locate_errors
from tribodyn.study.pipeline.first_look import gearbox_losses_of
from tribodyn.study.pipeline.tooth_contact import mesh_of
from tribodyn.study.studies.axes import pinion_speeds, pinion_torques

if TYPE_CHECKING:
    from tribodyn.losses import GearboxLosses, RigPowerFlow
    from tribodyn.study.case.case import Case

#: Torques and speeds of a map over those of the case, which is one of them.
STEPS = np.linspace(0.25, 2.0, 8)


def loss_map(
    case: Case, *, torque: Any = None, speed: Any = None, progress: Progress = SILENT
) -> GearboxLosses:
    """Find the losses and the efficiency of a case for every torque at every speed.

    Parameters
    ----------
    case : Case
        From :func:`tribodyn.load_case`. Teeth lose by its ``[friction]``, shafts and oil by its
        ``[losses]``; without that table the teeth alone are counted.
    torque, speed : float, str or list, optional
        Torques [N*m] and speeds [rad/s] of the gear named by ``operation.speed_of``, or text with
        a unit. By default 8 of each up to twice those of the case.
    progress : Progress
        Told how many points are computed.

    Returns
    -------
    GearboxLosses
        Torques and speeds in it are those of the pinion. Loads of the teeth are quasi-static.

    Raises
    ------
    InputError
        If a value is out of range, or the case has a mesh table instead of gears.
    ComputationError
        If the tooth contact cannot be computed at a point.

    Warns
    -----
    ModelWarning
        What the models said, each code once, with the number of points that it holds for.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("fzg-roughness").replace({"friction.law": "schlenk"})
    >>> found = loss_map(case, torque=["50 N*m", "300 N*m"], speed="900 rpm")
    >>> found.gear_efficiency.round(4).tolist()
    [[0.9889], [0.9841]]
    """
    torques, speeds = pinion_torques(case, torque), pinion_speeds(case, speed)
    torques = torques if torque is not None else list(STEPS * torques[0])
    speeds = speeds if speed is not None else list(STEPS * speeds[0])
    turns = case.gear_ratio if case.operation.speed_of == "wheel" else 1.0
    heard: list[ModelWarning] = []
    progress.start("Tooth contact", len(torques) * len(speeds))
    lost = np.empty((len(torques), len(speeds)))
    for row, load in enumerate(torques):
        for column, turning in enumerate(speeds):
            point = {"operation.torque": load * turns, "operation.speed": turning / turns}
            with locate_errors(case), collected() as told:
                lost[row, column] = mesh_of(case.replace(point)).mean_friction_power
            heard += {warning.code: warning for warning in told}.values()
            progress.advance()
    progress.finish()
    _tell(heard, lost.size)
    with locate_errors(case):
        return gearbox_losses_of(case, lost, pinion_torque=torques, pinion_speed=speeds)


def _tell(heard: Iterable[ModelWarning], points: int) -> None:
    """Tell each warning once: that of the first point, and of how many others."""
    first: dict[str, list[ModelWarning]] = {}
    for warning in heard:
        first.setdefault(warning.code, []).append(warning)
    for code, told in first.items():
        among = f" This was told at {len(told)} of {points} points." if points > 1 else ""
        warn(code, told[0].message + among, stacklevel=3)


def rig_power_flow(case: Case, slave: Case | None = None) -> RigPowerFlow:
    """Find the power flow of a back-to-back rig that tests the gears of a case.

    Parameters
    ----------
    case : Case
        The test gearbox with its ``[losses]``.
    slave : Case, optional
        The gearbox that closes the loop, at the same torque and speed of the pinion; one like the
        first by default.

    Raises
    ------
    InputError
        If both cases are not at one torque and speed, or one has a mesh table instead of gears.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("fzg-roughness").replace({"friction.law": "schlenk"})
    >>> rig_power_flow(case)
    RigPowerFlow(motor 211.92 W for 8482.3 W in the loop)
    """
    from tribodyn.losses import rig_power_flow as compute

    found = []
    for each in (case, case if slave is None else slave):
        with locate_errors(each), collected() as told:
            found.append(gearbox_losses_of(each, mesh_of(each).mean_friction_power))
        _tell(told, 1)
    return compute(*found)
