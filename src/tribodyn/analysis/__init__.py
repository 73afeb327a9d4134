"""Figures read off a motion: rms, peaks, mesh harmonics, spectra, direction indicator."""

from tribodyn.analysis.harmonics import Spectrum, amplitude_spectrum, mesh_harmonics
from tribodyn.analysis.indicators import (
    alternating_rms,
    crest_factor,
    extremes,
    mean,
    peak_to_peak,
    rms,
)
from tribodyn.analysis.line_of_action import line_of_action_indicator

__all__ = [
    "Spectrum",
    "alternating_rms",
    "amplitude_spectrum",
    "crest_factor",
    "extremes",
    "line_of_action_indicator",
    "mean",
    "mesh_harmonics",
    "peak_to_peak",
    "rms",
]
