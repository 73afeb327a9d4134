"""Report data on the natural modes of a case of any kind."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tribodyn.progress import SILENT, Progress
from tribodyn.report.machine_report import machine_modes_report_data
from tribodyn.report.study_report_data import StudyReportData, modes_report_data
from tribodyn.study.machine.case import MachineCase

if TYPE_CHECKING:
    from tribodyn.study.case.case import Case
    from tribodyn.study.machine.case import MachineCase


def any_modes_report_data(
    case: Case | MachineCase, ends: Any, progress: Progress = SILENT
) -> StudyReportData:
    """Natural modes of a pair or a machine; ``ends`` limits the speeds."""
    if isinstance(case, MachineCase):
        return machine_modes_report_data(case, ends, progress)
    return modes_report_data(case, ends, progress)  # type: ignore[arg-type]
