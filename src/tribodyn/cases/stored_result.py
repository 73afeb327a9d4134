"""Read a saved result from its directory."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.cases.load import load_case
from tribodyn.errors import InputError, ModelWarning, TribodynError, collected
from tribodyn.record import labels_of
from tribodyn.study.case.to_models import locate_errors
from tribodyn.study.pipeline.save import MACHINE_FILES, RESULT_FILES

if TYPE_CHECKING:
    import xarray

    from tribodyn.dynamics import Response, System
    from tribodyn.mesh import MeshFriction, MeshTable
    from tribodyn.study.heat_balance import HeatBalance
    from tribodyn.study.pipeline.computed import Coupling

#: File of a machine or a planetary stage.
_MOTION = "motion.nc"
_REMEDY = "Give the directory that tribodyn run or Result.save wrote"
#: Series without which a motion cannot be built again.
_NEEDED = ("position", "velocity", "end_position", "end_velocity", "phase", "time")
_FACTS = ("mesh_frequency", "periods", "steady_state_error", "warnings", "cycles_used",
          "search_cycles", "period", "converged")  # fmt: skip


def load_result(directory: str | os.PathLike[str]) -> Any:
    """Read a saved result; only the forces along its motion are computed again.

    A planetary stage that an earlier version stored is computed again from its case file.

    Parameters
    ----------
    directory : str or path
        What :meth:`tribodyn.Result.save` or ``tribodyn run`` wrote, of a gear pair or a machine.

    Returns
    -------
    Result or MachineResult
        With the same case, summary, warnings and figures. Of a long transient it has the mesh
        cycles that were stored; the summary is that of the whole run. The motion with nominal
        friction is not stored, only its figures in the summary.

    Raises
    ------
    InputError
        If the directory holds no result, or a file is damaged or was changed.

    Examples
    --------
    >>> import tribodyn
    >>> tribodyn.load_result("no-such-result")
    Traceback (most recent call last):
        ...
    tribodyn.errors.InputError: no-such-result: this is no result. There is no such directory. \
Give the directory that tribodyn run or Result.save wrote.
    """
    from tribodyn.mesh import MeshTable
    from tribodyn.study.machine.stored import read_machine
    from tribodyn.study.pipeline.assembly import damping_of, system_of
    from tribodyn.study.pipeline.result import Result
    from tribodyn.validated_files import read_dataset

    folder = Path(directory)
    if (folder / _MOTION).is_file():
        if "planet" in read_dataset(folder / _MOTION, str(folder)).coords:
            return _recomputed(folder)
        return read_machine(folder, load_case, read_summary)
    summary = read_summary(folder)
    case = load_case(folder / "case.toml")
    mesh = MeshTable.load(folder / "mesh.nc")
    data = read_dataset(folder / "response.nc", str(folder))
    lacking = [name for name in _NEEDED if name not in data.variables]
    lacking += [name for name in _FACTS if name not in data.attrs]
    if lacking:
        why = f"response.nc has no {', '.join(lacking)}: an earlier version wrote it"
        remedy = f"Compute it again: tribodyn run {folder / 'case.toml'}"
        raise InputError("this result cannot be read back", str(folder), why, remedy)
    _compare(folder, summary, data)
    try:
        friction, coupling, heat = _friction(mesh, data), _coupling(mesh, data), _heat(data)
        with locate_errors(case), collected():
            damping = damping_of(case, mesh)
            system = system_of(case, mesh, damping, friction)
        response = _response(folder, system, data)
        warnings = tuple(
            ModelWarning(code, text) for code, text in json.loads(data.attrs["warnings"])
        )
    except TribodynError:
        raise
    # What a damaged file holds makes its readers stumble in many ways.
    except Exception as error:
        why = f"response.nc is damaged: {error or type(error).__name__}"
        raise InputError("this result cannot be read back", str(folder), why, _REMEDY) from None
    parts = case, mesh, system, response, damping, warnings, friction
    result = Result(*parts, coupling=coupling, heat=heat)
    vars(result)["figures"] = summary
    return result


def _recomputed(folder: Path) -> Any:
    """Result of a planetary stage of an earlier version, computed again from its case."""
    from tribodyn.cases.load import run

    summary = read_summary(folder)
    with collected():
        result = run(load_case(folder / "case.toml"))
    vars(result)["_summary"] = summary
    return result


def _compare(folder: Path, summary: Mapping[str, float], data: xarray.Dataset) -> None:
    """Refuse text files that differ from the record of them in response.nc, which has a checksum.

    Results of an earlier version have no record of their case.
    """
    from tribodyn.validated_files import read_bytes

    case = hashlib.sha256(read_bytes(folder / "case.toml", "case")).hexdigest()
    changed = ["case.toml"] if data.attrs.get("case", case) != case else []
    stored = {name: data.attrs.get(name, value) for name, value in summary.items()}
    if stored != summary or data.attrs.get("figures", len(summary)) != len(summary):
        changed.append("summary.json")
    if changed:
        why = f"{changed[0]} is of another, or was damaged or changed after it was written"
        raise InputError("these files are of different results", str(folder), why, _REMEDY)


def read_summary(folder: Path) -> dict[str, float]:
    """Figures of a saved result, from a directory that holds all of its files."""
    files = MACHINE_FILES if (folder / _MOTION).is_file() else RESULT_FILES
    lacking = [name for name in files[:-1] if not (folder / name).is_file()]
    if lacking:
        why = f"It holds no {lacking[0]}" if folder.is_dir() else "There is no such directory"
        raise InputError("this is no result", str(folder), why, _REMEDY)
    from tribodyn.study.pipeline.summary_figures import in_order, is_figure
    from tribodyn.validated_files import read_bytes

    place = folder / "summary.json"
    try:
        entries = json.loads(read_bytes(place, "case"))
        if not isinstance(entries, dict) or not entries:
            raise ValueError("It is no table of figures")
        figures = {name: float(value) for name, value in entries.items()}
        if wrong := [n for n, v in figures.items() if not np.isfinite(v)]:
            raise ValueError(f"It has {wrong[0]} = {figures[wrong[0]]}")
        if unknown := [name for name in figures if not is_figure(name)]:
            raise ValueError(f"It has a figure that this version does not know, {unknown[0]}")
    except (OSError, TypeError, ValueError, RecursionError) as error:
        remedy = "Compute the case again"
        raise InputError("cannot be read", str(place), str(error), remedy) from None
    return {name: figures[name] for name in in_order(figures)}


def _friction(mesh: MeshTable, data: xarray.Dataset) -> MeshFriction | None:
    from tribodyn.mesh import MeshFriction

    if "friction_coefficients" not in data:
        return None
    names = ("load", "limit", "fit_error")
    load, limit, error = (float(data.attrs[f"friction_{name}"]) for name in names)
    couple = data.get("friction_couple_coefficients")
    wrench = data.get("friction_wrench_coefficients")
    further = [None if each is None else each.values for each in (couple, wrench)]
    coefficients = data["friction_coefficients"].values
    return MeshFriction(mesh.grid, coefficients, load, limit, error, *further)


def _coupling(mesh: MeshTable, data: xarray.Dataset) -> Coupling | None:
    """Return how the iteration of a coupled result converged; earlier versions did not store it."""
    from tribodyn.study.pipeline.computed import Coupling

    if "coupling_loading" not in data:
        return None
    columns = {
        name.removeprefix("coupling_"): data[name].values
        for name in map(str, data.data_vars)
        if name.startswith("coupling_")
    }
    order = np.arange(1.0, data.sizes["pass"] + 1.0)
    kind, tolerance = str(data.attrs["coupling_kind"]), float(data.attrs["coupling_tolerance"])
    return Coupling(iteration=order, phase=mesh.phase, kind=kind, tolerance=tolerance, **columns)


def _heat(data: xarray.Dataset) -> HeatBalance | None:
    """Return the passes of the heat balance; earlier versions did not store them."""
    from tribodyn.study.heat_balance import HeatBalance

    if "heat_temperature" not in data:
        return None
    values: dict[str, Any] = {}
    for name, label in labels_of(HeatBalance).items():
        source = data if label.dims else data.attrs
        if (key := f"heat_{name}") in source:
            values[name] = source[key].values if label.dims else float(source[key])
    return HeatBalance(**values)


def _response(folder: Path, system: System, data: xarray.Dataset) -> Response:
    """The motion from its states at the steps, with forces as the structure has them."""
    from tribodyn.dynamics.equations.compiled import compile_for
    from tribodyn.dynamics.time.response import build_response, later

    names, attributes, facts = tuple(data["coordinate"].values), data.attrs, dict[str, Any]()
    rows, periods = data.sizes["time"], int(attributes["periods"])
    if names != tuple(system.names) or rows % periods:
        why = f"Its motion has {', '.join(names)}, its case {', '.join(system.names)}"
        raise InputError("these files are of different results", str(folder), why, _REMEDY)
    frequency = float(attributes["mesh_frequency"])
    ends = [
        np.hstack([data[f"{end}{name}"].values for name in ("position", "velocity")])
        for end in ("", "end_")
    ]
    extra = data["extra_force"].values if "extra_force" in data else np.zeros(system.size)
    if "floquet_multipliers" in data:
        real, imaginary = data["floquet_multipliers"].values
        facts["floquet_multipliers"] = real + 1j * imaginary
    response = build_response(
        compile_for(system, frequency, rows // periods),
        frequency,
        np.vstack(ends),
        extra,
        error=float(attributes["steady_state_error"]),
        step_error=float(attributes.get("step_error", "nan")),
        converged=bool(attributes["converged"]),
        cycles_used=int(attributes["cycles_used"]),
        search_cycles=int(attributes["search_cycles"]),
        period=int(attributes["period"]),
        **facts,
    )
    return later(response, float(data["time"].values[0]))
