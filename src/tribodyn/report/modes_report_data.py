"""Report data on the natural modes of a case of any kind."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tribodyn.progress import SILENT, Progress
from tribodyn.report.machine_report import diagram_speeds, machine_modes_report_data
from tribodyn.report.planetary_report import stage_modes_report_data
from tribodyn.report.study_report_data import StudyReportData, modes_report_data
from tribodyn.study.machine.case import MachineCase
from tribodyn.study.planetary.case import PlanetaryCase

if TYPE_CHECKING:
    from tribodyn.study.case.case import Case
    from tribodyn.study.machine.user_tables import PartsCase


def any_modes_report_data(
    case: Case | PartsCase, ends: Any, progress: Progress = SILENT
) -> StudyReportData:
    """Natural modes of a pair, a machine or a planetary stage; ``ends`` limits the speeds."""
    if isinstance(case, PlanetaryCase):
        return stage_modes_report_data(case, diagram_speeds(ends), progress)
    if isinstance(case, MachineCase):
        return machine_modes_report_data(case, ends, progress)
    return modes_report_data(case, ends, progress)  # type: ignore[arg-type]
