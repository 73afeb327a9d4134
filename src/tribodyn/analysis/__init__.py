"""Figures read off a motion: rms, peaks, mesh harmonics, spectra, direction indicator."""

from tribodyn.analysis.basins import basins
from tribodyn.analysis.basins_attractors import Attractor
from tribodyn.analysis.basins_result import Basins
from tribodyn.analysis.bifurcation import bifurcation
from tribodyn.analysis.bifurcation_result import Bifurcation
from tribodyn.analysis.dynamic_factor import direction_shares, dynamic_factor
from tribodyn.analysis.envelope import envelope, envelope_spectrum
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
from tribodyn.analysis.lyapunov import LyapunovExponents, lyapunov_exponents
from tribodyn.analysis.order_map import order_map
from tribodyn.analysis.order_map_resampling import AngularSignal, angular_resampling
from tribodyn.analysis.order_map_result import OrderCut, OrderMap
from tribodyn.analysis.parameter_map import parameter_map
from tribodyn.analysis.parameter_map_result import ParameterMap
from tribodyn.analysis.phase_portrait import PhasePortrait, phase_portrait
from tribodyn.analysis.poincare import PoincareSection, poincare
from tribodyn.analysis.run_up_orders import (
    OverallLevel,
    order_cut,
    overall_level,
    run_up_order_map,
)
from tribodyn.analysis.run_up_resonances import RunUpResonance, resonances
from tribodyn.analysis.sidebands import Sidebands, sidebands
from tribodyn.analysis.spectrogram import Spectrogram, spectrogram
from tribodyn.analysis.spectrum import spectrum
from tribodyn.analysis.spectrum_peaks import Peak
from tribodyn.analysis.spectrum_result import SignalSpectrum
from tribodyn.analysis.spectrum_zoom import zoom_spectrum
from tribodyn.analysis.synchronous_average import SynchronousAverage, time_synchronous_average
from tribodyn.analysis.synchronous_average_condition import (
    ConditionIndicators,
    condition_indicators,
    kurtosis,
)

__all__ = [
    "AngularSignal",
    "Attractor",
    "Basins",
    "Bifurcation",
    "ConditionIndicators",
    "LyapunovExponents",
    "OrderCut",
    "OrderMap",
    "OverallLevel",
    "ParameterMap",
    "Peak",
    "PhasePortrait",
    "PoincareSection",
    "RunUpResonance",
    "Sidebands",
    "SignalSpectrum",
    "Spectrogram",
    "Spectrum",
    "SynchronousAverage",
    "alternating_rms",
    "amplitude_spectrum",
    "angular_resampling",
    "basins",
    "bifurcation",
    "condition_indicators",
    "crest_factor",
    "direction_shares",
    "dynamic_factor",
    "envelope",
    "envelope_spectrum",
    "extremes",
    "kurtosis",
    "line_of_action_indicator",
    "lyapunov_exponents",
    "mean",
    "mesh_harmonics",
    "order_cut",
    "order_map",
    "overall_level",
    "parameter_map",
    "peak_to_peak",
    "phase_portrait",
    "poincare",
    "resonances",
    "rms",
    "run_up_order_map",
    "sidebands",
    "spectrogram",
    "spectrum",
    "time_synchronous_average",
    "zoom_spectrum",
]
