"""Natural modes of a case of any kind: the table of a report, and the report of their study."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn import plot
from tribodyn.errors import InputError
from tribodyn.interrupt import single_blas_thread
from tribodyn.machine import machine_modes
from tribodyn.model import Option
from tribodyn.progress import SILENT, Progress
from tribodyn.report.numbers import HEAD, cells
from tribodyn.report.study_report_data import StudyReportData, figure_with_caption
from tribodyn.study.case.values import FaultError, read_value
from tribodyn.study.machine.modes import (
    MODES_HEAD,
    axial_notes,
    campbell_of,
    mode_rows,
    modes_facts,
)
from tribodyn.study.machine.run import structure_at_rest
from tribodyn.study.machine.tables import OperationTable
from tribodyn.study.studies.needs import PAIRS, kind_of

if TYPE_CHECKING:
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.machine.case import AnyCase, MachineCase


def any_modes_report_data(
    case: AnyCase, ends: object, progress: Progress = SILENT
) -> StudyReportData:
    """Natural modes of a pair or a machine; ``ends`` limits the speeds."""
    if kind_of(case) in PAIRS:
        return _pair_modes_report_data(case, ends, progress)  # type: ignore[arg-type]
    return _parts_modes_report_data(case, ends, progress)  # type: ignore[arg-type]


def _parts_modes_report_data(
    case: MachineCase, ends: object, progress: Progress = SILENT
) -> StudyReportData:
    """Natural modes of a machine and what excites them; ``ends`` limits the speeds."""
    with single_blas_thread():
        structure = structure_at_rest(case, progress)
        progress.start("Natural modes")
        modes = machine_modes(structure)
        campbell = campbell_of(structure, _diagram_speeds(ends), modes)
    pictures = ((plot.machine_modes, modes), (plot.machine_campbell, campbell))
    figures = [figure_with_caption(*each) for each in pictures if not each[0].missing(each[1])]
    progress.finish()
    statements = [f"{figures[-1][1].layout.title.text}.", *axial_notes(modes)]
    facts = modes_facts(modes, campbell)
    rows = mode_rows(modes)
    return StudyReportData(campbell, figures, statements, MODES_HEAD, rows, facts)


def _diagram_speeds(ends: Any) -> Any:
    """Speeds of a diagram between two ends, given as text or in rad/s."""
    if ends is None:
        return None
    spec = OperationTable.fields["speed"]
    assert isinstance(spec, Option)
    try:
        first, last = (read_value(spec, "speed", end) for end in ends)
    except FaultError as fault:
        raise InputError(replace(fault.problem, where="operation.speed")) from None
    return np.linspace(max(first, 0.0), last, 8)


def _pair_modes_report_data(
    case: PairCase, ends: object, progress: Progress = SILENT
) -> StudyReportData:
    """Natural frequencies and critical speeds; ``ends`` limits the speeds [rad/s]."""
    from tribodyn.dynamics import natural_modes
    from tribodyn.study.pipeline.assembly import ORDERS, diagram_of
    from tribodyn.study.pipeline.tooth_contact import operation_values
    from tribodyn.study.studies.case_grid import build_system
    from tribodyn.study.studies.modes import mode_rows

    speeds = None if ends is None else operation_values("speed", ends, case)
    system, mesh_frequency = build_system(case, progress=progress)
    modes = natural_modes(system)
    diagram = diagram_of(system, case, mesh_frequency, speeds)
    rows = mode_rows(modes, case, mesh_frequency)
    figures = [
        figure_with_caption(plot.mode_shapes, modes),
        figure_with_caption(plot.campbell, diagram),
    ]
    statements = [
        f"{figures[1][1].layout.title.text}; speeds are those of the {case.operation.speed_of}."
    ]
    facts = {
        "mesh_frequency": mesh_frequency,
        "orders": list(ORDERS),
        "modes": [vars(row) for row in rows],
    }
    return StudyReportData(modes, figures, statements, HEAD, [cells(row) for row in rows], facts)
