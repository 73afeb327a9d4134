"""The case and its result: user input, computation and results."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from tribodyn.arguments import guarded

if TYPE_CHECKING:
    from tribodyn.cases.papers.friction_experiment import friction_experiment
    from tribodyn.study.case.case import Case
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.faults.clock import TurningClock, turning_clock
    from tribodyn.study.faults.recording_set import RecordingSet, record_set
    from tribodyn.study.faults.recording_verdict import Finding, RecordingVerdict, judge_recordings
    from tribodyn.study.faults.wear import Wear, wear
    from tribodyn.study.frequencies import KinematicFrequencies, kinematic_frequencies
    from tribodyn.study.machine.case import MachineCase, PartsCase, PlanetaryCase
    from tribodyn.study.machine.modes import MachineCampbell
    from tribodyn.study.machine.motion import MachineMotion, PeriodicSamples
    from tribodyn.study.machine.read import read_case
    from tribodyn.study.machine.read_parts import LoadCase
    from tribodyn.study.machine.result import (
        LoadResult,
        MachineResult,
        PlanetaryLoadResult,
        PlanetaryResult,
    )
    from tribodyn.study.pipeline.result import PairResult
    from tribodyn.study.pipeline.result_of_case import Result, ResultOfCase
    from tribodyn.study.pipeline.run import run
    from tribodyn.study.pipeline.summary import SUMMARY, summary_figure
    from tribodyn.study.pipeline.tooth_contact import loaded_contact
    from tribodyn.study.planetary.stage_result import PlanetaryMotion, StageResult
    from tribodyn.study.planetary.tolerances import LoadShareStatistics, load_share_statistics
    from tribodyn.study.rated_parts import BearingRating, NotchRating, Verdict
    from tribodyn.study.rating import CaseRating, MeshRating, MeshSpectrum
    from tribodyn.study.result_comparison import ResultComparison, compare_results
    from tribodyn.study.studies.bifurcation import bifurcation
    from tribodyn.study.studies.case_grid import build_system
    from tribodyn.study.studies.levels import MachineLevels
    from tribodyn.study.studies.losses import loss_map, rig_power_flow
    from tribodyn.study.studies.modes import campbell, natural_modes
    from tribodyn.study.studies.nonlinear import basins, continuation, lyapunov_exponents
    from tribodyn.study.studies.run_up import run_up, speed_sweep
    from tribodyn.study.studies.static import (
        comprehensive_stiffness,
        film_over_operation,
        harris_map,
        optimize_lead,
        optimize_tip_relief,
    )
    from tribodyn.study.studies.sweep import sweep
    from tribodyn.study.studies.sweep_result import Sweep
    from tribodyn.study.uncertain.data_set import DataSet, load_data
    from tribodyn.study.uncertain.ensemble import CaseEnsemble, MachineEnsemble, ensemble
    from tribodyn.study.uncertain.failure_probability import (
        FailureProbability,
        failure_probability,
    )
    from tribodyn.study.uncertain.operating_data import operating_data
    from tribodyn.study.uncertain.sensitivity import CaseSensitivity, sobol_indices
    from tribodyn.study.uncertain.vibration_data import vibration_data

__all__ = [
    "SUMMARY",
    "BearingRating",
    "Case",
    "CaseEnsemble",
    "CaseRating",
    "CaseSensitivity",
    "DataSet",
    "FailureProbability",
    "Finding",
    "KinematicFrequencies",
    "LoadCase",
    "LoadResult",
    "LoadShareStatistics",
    "MachineCampbell",
    "MachineCase",
    "MachineEnsemble",
    "MachineLevels",
    "MachineMotion",
    "MachineResult",
    "MeshRating",
    "MeshSpectrum",
    "NotchRating",
    "PairCase",
    "PairResult",
    "PartsCase",
    "PeriodicSamples",
    "PlanetaryCase",
    "PlanetaryLoadResult",
    "PlanetaryMotion",
    "PlanetaryResult",
    "RecordingSet",
    "RecordingVerdict",
    "Result",
    "ResultComparison",
    "ResultOfCase",
    "StageResult",
    "Sweep",
    "TurningClock",
    "Verdict",
    "Wear",
    "basins",
    "bifurcation",
    "build_system",
    "campbell",
    "compare_results",
    "comprehensive_stiffness",
    "continuation",
    "ensemble",
    "failure_probability",
    "film_over_operation",
    "friction_experiment",
    "harris_map",
    "judge_recordings",
    "kinematic_frequencies",
    "load_data",
    "load_share_statistics",
    "loaded_contact",
    "loss_map",
    "lyapunov_exponents",
    "natural_modes",
    "operating_data",
    "optimize_lead",
    "optimize_tip_relief",
    "read_case",
    "record_set",
    "rig_power_flow",
    "run",
    "run_up",
    "sobol_indices",
    "speed_sweep",
    "summary_figure",
    "sweep",
    "turning_clock",
    "vibration_data",
    "wear",
]

#: Public names by the module that they are taken from.
_NAMES = {
    "machine.read": "read_case",
    "machine.case": "Case MachineCase PairCase PartsCase PlanetaryCase",
    "machine.read_parts": "LoadCase",
    "faults.clock": "TurningClock turning_clock",
    "faults.recording_set": "RecordingSet record_set",
    "faults.wear": "Wear wear",
    "machine.modes": "MachineCampbell",
    "machine.motion": "MachineMotion PeriodicSamples",
    "rated_parts": "BearingRating NotchRating Verdict",
    "rating": "CaseRating MeshRating MeshSpectrum",
    "machine.result": "LoadResult MachineResult PlanetaryLoadResult PlanetaryResult",
    "uncertain.failure_probability": "FailureProbability failure_probability",
    "studies.levels": "MachineLevels",
    "pipeline.result": "PairResult Result",
    "pipeline.result_of_case": "ResultOfCase",
    "pipeline.run": "run",
    "pipeline.summary": "SUMMARY summary_figure",
    "pipeline.tooth_contact": "loaded_contact",
    "planetary.stage_result": "PlanetaryMotion StageResult",
    "planetary.tolerances": "LoadShareStatistics load_share_statistics",
    "faults.recording_verdict": "Finding RecordingVerdict judge_recordings",
    "result_comparison": "ResultComparison compare_results",
    "studies.bifurcation": "bifurcation",
    ".cases.papers.friction_experiment": "friction_experiment",
    "studies.losses": "loss_map rig_power_flow",
    "studies.modes": "campbell natural_modes",
    "studies.nonlinear": "basins continuation lyapunov_exponents",
    "studies.run_up": "run_up speed_sweep",
    "frequencies": "KinematicFrequencies kinematic_frequencies",
    "studies.static": "comprehensive_stiffness film_over_operation harris_map optimize_lead "
    "optimize_tip_relief",
    "studies.case_grid": "build_system",
    "studies.sweep": "sweep",
    "studies.sweep_result": "Sweep",
    "uncertain.data_set": "DataSet load_data",
    "uncertain.ensemble": "CaseEnsemble MachineEnsemble ensemble",
    "uncertain.operating_data": "operating_data",
    "uncertain.sensitivity": "CaseSensitivity sobol_indices",
    "uncertain.vibration_data": "vibration_data",
}
_HOMES = {name: home for home, names in _NAMES.items() for name in names.split()}


def __getattr__(name: str) -> Any:
    """Load a public name when it is first used."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(f".{_HOMES[name]}", __name__), name)
    return globals().setdefault(name, guarded(value, __name__))
