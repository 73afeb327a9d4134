"""Figures read off a motion: rms, peaks, mesh harmonics, spectra, direction indicator."""

from tribodyn.nonlinear.basins import basins
from tribodyn.nonlinear.basins_attractors import Attractor
from tribodyn.nonlinear.basins_result import Basins
from tribodyn.nonlinear.bifurcation import bifurcation
from tribodyn.nonlinear.bifurcation_result import Bifurcation
from tribodyn.nonlinear.lyapunov import LyapunovExponents, lyapunov_exponents
from tribodyn.nonlinear.parameter_map import parameter_map
from tribodyn.nonlinear.parameter_map_result import ParameterMap
from tribodyn.nonlinear.phase_portrait import PhasePortrait, phase_portrait
from tribodyn.nonlinear.poincare import PoincareSection, poincare
from tribodyn.signals.dynamic_factor import direction_shares, dynamic_factor
from tribodyn.signals.envelope import envelope, envelope_spectrum
from tribodyn.signals.harmonics import Spectrum, amplitude_spectrum, mesh_harmonics
from tribodyn.signals.indicators import (
    alternating_rms,
    crest_factor,
    extremes,
    mean,
    peak_to_peak,
    rms,
)
from tribodyn.signals.line_of_action import line_of_action_indicator
from tribodyn.signals.order_map import order_map
from tribodyn.signals.order_map_resampling import AngularSignal, angular_resampling
from tribodyn.signals.order_map_result import OrderCut, OrderMap
from tribodyn.signals.run_up_orders import (
    OverallLevel,
    order_cut,
    overall_level,
    run_up_order_map,
)
from tribodyn.signals.run_up_resonances import RunUpResonance, resonances
from tribodyn.signals.sidebands import Sidebands, sidebands
from tribodyn.signals.spectrogram import Spectrogram, spectrogram
from tribodyn.signals.spectrum import spectrum
from tribodyn.signals.spectrum_peaks import Peak
from tribodyn.signals.spectrum_result import SignalSpectrum
from tribodyn.signals.spectrum_zoom import zoom_spectrum
from tribodyn.signals.synchronous_average import (
    SynchronousAverage,
    time_synchronous_average,
)
from tribodyn.signals.synchronous_average_condition import (
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
