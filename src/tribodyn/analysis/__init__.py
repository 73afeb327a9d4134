"""Figures read off a motion: rms, peaks, mesh harmonics, spectra, direction indicator."""

from tribodyn.arguments import guard
from tribodyn.nonlinear.basins import basins
from tribodyn.nonlinear.basins_attractors import Attractor, Basins
from tribodyn.nonlinear.bifurcation import Bifurcation, bifurcation
from tribodyn.nonlinear.lyapunov import LyapunovExponents, lyapunov_exponents
from tribodyn.nonlinear.parameter_map import ParameterMap, parameter_map
from tribodyn.nonlinear.poincare import PhasePortrait, PoincareSection, phase_portrait, poincare
from tribodyn.signals.angular_resampling import AngularSignal, angular_resampling
from tribodyn.signals.envelope import Sidebands, envelope, envelope_spectrum, sidebands
from tribodyn.signals.indicators import (
    Spectrum,
    alternating_rms,
    amplitude_spectrum,
    crest_factor,
    direction_shares,
    dynamic_factor,
    extremes,
    line_of_action_indicator,
    mean,
    mesh_harmonics,
    peak_to_peak,
    rms,
)
from tribodyn.signals.order_map import OrderCut, OrderMap, Spectrogram, order_map, spectrogram
from tribodyn.signals.run_up_orders import (
    OverallLevel,
    RunUpResonance,
    order_cut,
    overall_level,
    resonances,
    run_up_order_map,
)
from tribodyn.signals.spectrum import Peak, SignalSpectrum, spectrum, zoom_spectrum
from tribodyn.signals.synchronous_average import (
    ConditionIndicators,
    SynchronousAverage,
    condition_indicators,
    kurtosis,
    time_synchronous_average,
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

guard(__name__)
