"""Load classes of a recorded torque, for the load capacity of gears."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tribodyn.errors import Argument, InputError, did_you_mean
from tribodyn.measurement.readers.detect_format import read_recording_data
from tribodyn.measurement.readers.recording_data import RecordingData, rate_of
from tribodyn.rating import SpectrumLoad, load_classes
from tribodyn.types import Array
from tribodyn.units import UnitProblemError, convert

#: Part of the greatest speed below which a shaft is at rest and counts no load cycles.
_STANDSTILL = 1e-3


def read_load_classes(
    path: str,
    speed: float,
    *,
    torque_column: str = "torque",
    torque_unit: str | None = None,
    speed_column: str | None = None,
    speed_unit: str | None = None,
    classes: int = 16,
) -> tuple[SpectrumLoad, ...]:
    """Load classes of a recorded torque that carry a load, with durations that are shares."""
    # ``speed`` [rad/s] is that of the whole recording where no column has one, without its sign.
    data = read_recording_data(path)
    torques = _channel(data, path, ("torque", torque_column, torque_unit or "", "N*m"))
    speeds = np.full(torques.size, abs(speed))
    if speed_column is not None:
        speeds = _channel(data, path, ("speed", speed_column, speed_unit or "", "rad/s"))
        speeds = speeds * np.sign(speeds[np.abs(speeds).argmax()])
    if speeds.size != torques.size:
        what = f"{torque_column} has {torques.size} samples and {speed_column} {speeds.size}"
        why, remedy = "Each torque acts at one speed", "Record both at one rate"
        raise InputError(what, Argument("speed_column"), why, remedy)
    slow = _STANDSTILL * speeds.max()
    if speeds.min() < -slow:
        what = f"{speed_column} changes its sign"
        why = "Which flanks carry follows from the torque, in one direction of rotation"
        remedy = "Cut the recording where the direction changes"
        raise InputError(what, Argument("speed_column"), why, remedy)
    turning = speeds > slow
    if not np.any(torques[turning]):
        what = f"{torque_column} of {Path(path).name} is zero while the shaft turns"
        remedy = "Choose another column, or remove torque_history"
        raise InputError(what, Argument("torque_column"), "Nothing loads the gears", remedy)
    listed = load_classes(torques[turning], speeds[turning], float(turning.mean()), classes)
    return tuple(each for each in listed if each.torque != 0.0)


def _channel(data: RecordingData, path: str, wanted: tuple[str, str, str, str]) -> Array:
    """Samples of a column in SI, at evenly spaced times."""
    quantity, name, unit, si = wanted
    if name not in data.channels:
        columns = list(data.channels)
        why = f"{Path(path).name} has {', '.join(columns[:20])}"
        remedy = did_you_mean(name, columns, f"Write {quantity}_column")
        raise InputError(f"there is no column {name}", Argument(f"{quantity}_column"), why, remedy)
    if name in data.times:
        rate_of(data.times[name], path)  # refuses times that are not evenly spaced
    stated, where = data.units.get(name, ""), Argument(f"{quantity}_unit")
    if not (unit or stated):
        why, remedy = f"{Path(path).name} does not state it", f'Write {quantity}_unit = "{si}"'
        raise InputError(f"the unit of {name} is not known", where, why, remedy)
    if unit and stated and _factor(unit, stated, where) != 1.0:
        what, why = f"{quantity}_unit = {unit}", f"{Path(path).name} states {stated} for {name}"
        raise InputError(what, where, why, "Correct one of them, or remove the key")
    return data.channels[name] * _factor(unit or stated, si, where)


def _factor(unit: str, to: str, where: Argument) -> float:
    """Factor between two units; a unit of another kind is refused at its argument."""
    try:
        return convert(1.0, unit, to)
    except (InputError, UnitProblemError) as error:
        why, remedy = "It is the unit of a recorded column", f"Write a unit such as {to}"
        raise InputError(f"unit {unit}: {error}", where, why, remedy) from None
