"""HTML reports in one self-contained file that opens in a browser without a network."""

from __future__ import annotations

from tribodyn.arguments import guard
from tribodyn.report.html import render_report, write_report
from tribodyn.report.signal_report import write_signal_report
from tribodyn.report.study import write_bifurcation_report, write_study_report, write_sweep_report

__all__ = [
    "render_machine_report",
    "render_planetary_report",
    "render_report",
    "write_bifurcation_report",
    "write_machine_report",
    "write_planetary_report",
    "write_report",
    "write_signal_report",
    "write_study_report",
    "write_sweep_report",
]

#: Names of an earlier version: all kinds of cases have one report.
render_machine_report = render_planetary_report = render_report
write_machine_report = write_planetary_report = write_report

guard(__name__)
