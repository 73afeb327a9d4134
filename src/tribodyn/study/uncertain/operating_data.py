"""Table of the steady response at operating points, as training data of a surrogate."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.errors import Argument, InputError
from tribodyn.nomenclature import require_whole
from tribodyn.progress import SILENT, Progress
from tribodyn.study.pipeline.summary_figures import figure_of
from tribodyn.study.studies.sweep_result import OF_PARTS, level_keys
from tribodyn.study.uncertain.cycles import steady_cycles
from tribodyn.study.uncertain.data_set import DataSet
from tribodyn.study.uncertain.lanes import draw, lanes_of, points_of_values, successful
from tribodyn.study.uncertain.vibration_data import data_set
from tribodyn.types import Tree

if TYPE_CHECKING:
    from tribodyn.study.machine.case import AnyCase, MachineCase
    from tribodyn.types import Array

#: Response figures of every operating point, with units.
RESPONSE = {
    "mean_mesh_force": "N",
    "rms_mesh_force": "N",
    "peak_mesh_force": "N",
    "peak_to_peak_dynamic_transmission_error": "m",
    "rms_acceleration_loa_pinion": "m/s^2",
    "mean_friction_coefficient": "1",
}
#: Range of an operating point about that of the case, and places of a mesh cycle.
_LOW, _HIGH, _PHASES = 0.7, 1.3, 8


def default_ranges(case: AnyCase) -> dict[str, str]:
    """Ranges of torque and speed about the case, of a pair also of what its teeth depend on."""
    ranges = {
        "operation.torque": _about(case["operation.torque"], "N*m"),
        "operation.speed": _about(case["operation.speed"], "rad/s"),
    }
    if not case.lumped:
        return ranges
    ranges |= dict.fromkeys(("friction_scale", "stiffness_scale"), f"{_LOW} .. {_HIGH}")
    if case.gears.composite_roughness is not None and case.friction.law not in ("none", "constant"):
        ranges["gears.composite_roughness"] = _about(case.gears.composite_roughness, "m")
    return ranges


def _about(value: float, unit: str) -> str:
    return f"{_LOW * value!r} {unit} .. {_HIGH * value!r} {unit}"


#: Part of the largest figure that is rounding.
_ROUNDING = 1e-9


def operating_data(
    case: AnyCase,
    over: Mapping[str, object] | None = None,
    size: int = 256,
    *,
    seed: int,
    progress: Progress = SILENT,
) -> DataSet:
    """Steady response of a case at operating points drawn evenly over ranges.

    Parameters
    ----------
    case : Case
        From :func:`tribodyn.load_case`.
    over : mapping, optional
        Ranges such as ``{"operation.speed": "400 rpm .. 3000 rpm"}``, of keys of the case or of
        the factors of :func:`ensemble`; by default torque, speed, friction, stiffness and, where
        friction depends on it, roughness, from 0.7 to 1.3 times those of the case; torque and speed
        of a machine or a stage, which takes keys but no factors.
    size : int
        Operating points, of a Sobol sequence; a power of two is the most even.
    seed : int
        The same seed gives the same points.
    progress : Progress
        Receives the progress of the computation; silent by default.

    Returns
    -------
    DataSet
        The inputs, and mean, rms and peak of the mesh force [N], the swing of the transmission
        error [m], the rms acceleration of the pinion along the line of action [m/s^2], and the
        friction coefficient. Of a machine or a stage the levels of its parts that a sweep shows, at
        the points that can be computed.

    Raises
    ------
    InputError
        If an input cannot be spread.
    ComputationError
        If a motion grows beyond all bounds.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("time-varying-friction")
    >>> operating_data(case, {"force_scale": "0.5 .. 2"}, 4, seed=1).rows
    4
    """
    ranges = dict(default_ranges(case) if over is None else over)
    count = require_whole("size", size)
    inputs = draw(case, ranges, count, method="sobol", seed=seed)
    settings = {
        "over": {key: str(value) for key, value in ranges.items()},
        "size": count,
        "seed": int(seed),
    }
    if not case.lumped:
        return _of_parts(case, inputs, settings, progress)
    lanes = lanes_of(case, inputs, progress)
    cycles = steady_cycles(lanes, _PHASES, progress)
    mean, rms, _, high = cycles.figures["mesh_force"]
    _, _, least, greatest = cycles.figures["dynamic_transmission_error"]
    middle, shaking, _, _ = cycles.figures["acceleration"]
    response = dict(zip(RESPONSE, (
        mean, rms, high, greatest - least, np.sqrt(np.maximum(shaking**2 - middle**2, 0.0)),
        cycles.figures["friction_coefficient"][0],
    ), strict=True))  # fmt: skip
    data = data_set("operating_data", case, {**inputs, **response}, settings)
    return DataSet(data.columns, {**data.units, **RESPONSE}, data.case, data.settings, data.version)


def _of_parts(
    case: MachineCase, inputs: Mapping[str, Array], settings: Tree, progress: Progress
) -> DataSet:
    """Levels of the parts of a machine or a stage, at the points that can be computed."""
    progress.start("Operating points", settings["size"])
    points = points_of_values(case, inputs, progress)
    progress.finish()
    good = successful(points, "operating points", "ranges", 1)
    figures = [point.figures for point in good]
    names = [name for figure in OF_PARTS for name in level_keys(figures[0], figure)]
    response = {name: np.array([each[name] for each in figures]) for name in names}
    response = _vibrating(response, figures[0])
    if not response:
        what, why = "no level of the parts varies", "Nothing excites a vibration of this case"
        raise InputError(what, Argument("case"), why, "Give its meshes computed teeth")
    columns = dict(zip(inputs, np.array([point.values for point in good]).T, strict=True))
    data = data_set("operating_data", case, columns | response, settings)
    units = {name: figure_of(name).unit or "1" for name in response}
    return DataSet(data.columns, {**data.units, **units}, data.case, data.settings, data.version)


def _vibrating(response: dict[str, Array], figures: Mapping[str, float]) -> dict[str, Array]:
    """Levels that are more than the rounding of the largest figure with their unit."""
    largest: dict[str, float] = {"m/s^2": 1.0}
    for name, value in figures.items():
        unit = figure_of(name).unit
        largest[unit] = max(largest.get(unit, 0.0), abs(value))
    return {
        name: column
        for name, column in response.items()
        if column.max() > _ROUNDING * largest[figure_of(name).unit]
    }
