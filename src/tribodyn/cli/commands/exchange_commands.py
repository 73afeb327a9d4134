"""``tribodyn import`` and ``tribodyn export``: models of other gear programs, and tables."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

from tribodyn.cli.console import say, say_json, table, tell
from tribodyn.cli.settings import Flag, Words, changed_case, check_file, read_changes
from tribodyn.errors import InputError
from tribodyn.types import Tree

if TYPE_CHECKING:
    from tribodyn.exchange import GearboxModel, Load, Stage

_TO_RPM, _TO_DEG = 30.0 / math.pi, 180.0 / math.pi


def import_(
    file: Path,
    /,
    *,
    out: Path | None = None,
    stage: int | None = None,
    load_case: int | None = None,
    machine: Flag = False,
    set_: Words = None,
    force: Flag = False,
    json: Flag = False,
) -> None:
    """List the stages and loads of a REXS gearbox model; write a case of one stage or of all.

    Parameters
    ----------
    file : Path
        Model of another gear program: .rexs, .rexsj or .rexsz.
    out : Path
        Case file to write; without it the model is listed.
    stage : int
        Number of the stage, where there are several.
    load_case : int
        Number of the load case; the first by default.
    machine : bool
        Write the machine of all stages, with its shafts, bearings and load cases.
    set_ : list of str
        Values to add or to change in the case, for example "operation.torque=120 N*m".
    force : bool
        Replace an existing file.
    json : bool
        Write one JSON object in SI to stdout.
    """
    from tribodyn.exchange import case_from_rexs, machine_from_rexs, read_rexs
    from tribodyn.study.pipeline.save import write_file

    if machine and (out is None or stage is not None):
        what = "--machine writes the case of all stages"
        remedy = "Add --out FILE, and leave out --stage"
        raise InputError(what, "tribodyn import", "", remedy)
    model = read_rexs(file)
    if out is None:
        if json:
            say_json(_listed(model))
        else:
            say(_tables(model))
            _show_remarks(model)
            if any(not s.planetary and s.gear_1.teeth * s.gear_2.teeth > 0 for s in model.stages):
                tell(f"To compute a stage: tribodyn import {file} --stage NUMBER --out case.toml")
            tell(f"To compute all of them: tribodyn run {file}")
        return
    check_file(out, force)
    changes = read_changes(set_ or [])
    if machine:
        text = machine_from_rexs(model, load_case, changes=changes, by="--set").to_toml()
    else:
        text = case_from_rexs(model, stage, load_case, changes=changes).to_toml()
    write_file(out, text)
    if json:
        say_json({"path": str(out)})
    else:
        say(str(out))
    _show_remarks(model)
    tell(f"Look at what is marked as assumed, then: tribodyn check {out}")


def export(
    case: str,
    /,
    *,
    rexs: Path | None = None,
    tables: Path | None = None,
    set_: Words = None,
    force: Flag = False,
    json: Flag = False,
) -> None:
    """Write a case as a REXS gearbox model, or all tables and figures of a result.

    Parameters
    ----------
    case : str
        Built-in case, path of a case file, or a directory that tribodyn run wrote.
    rexs : Path
        File to write: .rexs (XML), .rexsj (JSON) or .rexsz (zip).
    tables : Path
        Folder to make, with every table and figure of the result as CSV and JSON.
    set_ : list of str
        Values of a case to change, for example "operation.torque=120 N*m".
    force : bool
        Replace an existing REXS file.
    json : bool
        Write one JSON object to stdout.
    """
    if (rexs is None) == (tables is None):
        remedy = "Add --rexs FILE for a case, or --tables FOLDER for a result"
        raise InputError("one thing is exported at a time", "tribodyn export", "", remedy)
    if rexs is not None:
        from tribodyn.exchange import write_rexs

        omitted = write_rexs(changed_case(case, set_ or [], "export"), rexs, force=force)
        if omitted:
            tell(f"note: only tribodyn reads back from the model: {', '.join(omitted)}")
    elif tables is not None:
        from tribodyn.cases.load import load_result
        from tribodyn.exchange import write_tables

        write_tables(load_result(case), tables)
    if json:
        say_json({"path": str(rexs or tables)})
    else:
        say(str(rexs or tables))


def _show_remarks(model: GearboxModel) -> None:
    for remark in model.remarks:
        tell(f"note: {remark}")


def _tables(model: GearboxModel) -> str:
    """Stages and loads as text."""
    parts = [
        f"{model.application or 'REXS'}, REXS {model.version}: "
        f"{sum(model.components.values())} components"
    ]
    head = ["stage", "z", "m_n [mm]", "beta [deg]", "a [mm]", "b [mm]", "x", "alpha_wt [deg]",
            "sum x from a"]  # fmt: skip
    if model.stages:
        parts.append(table([head, *(_stage_row(stage) for stage in model.stages)], indent=""))
    rows = [_load_row(model, load, stage) for load in model.loads for stage in model.stages]
    load_rows = [row for row in rows if any(row[3:])]
    if load_rows:
        head = ["load case", "share", "stage", "n_1 [rpm]", "T_1 [N m]", "mesh [Hz]", "n_2 [rpm]"]
        parts.append(table([head, *load_rows], indent=""))
    return "\n\n".join(parts)


def _stage_row(stage: Stage) -> list[str]:
    gears = (stage.gear_1, stage.gear_2)

    def pair_text(values: list[float], form: str) -> str:
        texts = [format(value, form) for value in values]
        return texts[0] if texts[0] == texts[1] else " / ".join(texts)

    widths = [math.nan if g.face_width is None else g.face_width * 1e3 for g in gears]
    return [
        str(stage.id),
        " / ".join(str(g.teeth) for g in gears),
        pair_text([g.normal_module * 1e3 for g in gears], "g"),
        pair_text([g.helix_angle * _TO_DEG + 0.0 for g in gears], ".6g"),
        f"{stage.center_distance * 1e3:g}",
        pair_text(widths, "g"),
        pair_text([g.profile_shift_coefficient for g in gears], "g"),
        f"{stage.operating_pressure_angle * _TO_DEG:.4f}",
        f"{stage.shift_sum + 0.0:.5f}",
    ]


def _load_row(model: GearboxModel, load: Load, stage: Stage) -> list[str]:
    first_shaft, second_shaft = (model.shaft_of(g.id) for g in (stage.gear_1, stage.gear_2))
    speeds = [load.speeds.get(s) if s is not None else None for s in (first_shaft, second_shaft)]
    torque = load.torques.get(first_shaft) if first_shaft is not None else None
    mesh = (
        None
        if speeds[0] is None or stage.planetary
        else (speeds[0] * abs(stage.gear_1.teeth) / (2.0 * math.pi))
    )
    values = [speeds[0] and speeds[0] * _TO_RPM, torque, mesh, speeds[1] and speeds[1] * _TO_RPM]
    share = "" if load.share is None else f"{load.share * 100:g} %"
    return [str(load.id), share, str(stage.id), *("" if v is None else f"{v:.6g}" for v in values)]


def _listed(model: GearboxModel) -> Tree:
    """All of a model in SI and radians."""
    return {
        "version": model.version,
        "application": model.application,
        "components": model.components,
        "stages": [
            {
                "id": stage.id,
                "center_distance": stage.center_distance,
                "reference_center_distance": stage.reference_center_distance,
                "operating_pressure_angle": stage.operating_pressure_angle,
                "shift_sum": stage.shift_sum,
                "planetary": stage.planetary,
                "gears": [vars(stage.gear_1), vars(stage.gear_2)],
            }
            for stage in model.stages
        ],
        "load_cases": [vars(load) for load in model.loads],
        "remarks": model.remarks,
    }
