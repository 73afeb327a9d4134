"""Figures read off a motion: rms, peaks, mesh harmonics, spectra, direction indicator."""

from tribodyn.arguments import guard
from tribodyn.nonlinear.basins import basins
from tribodyn.nonlinear.basins_attractors import Attractor, Basins
from tribodyn.nonlinear.bifurcation import Bifurcation, bifurcation
from tribodyn.nonlinear.lyapunov import LyapunovExponents, lyapunov_exponents
from tribodyn.nonlinear.parameter_map import ParameterMap, parameter_map
from tribodyn.nonlinear.poincare import PhasePortrait, PoincareSection, phase_portrait, poincare
from tribodyn.signals import (
    ConditionIndicators,
    NarrowbandDemodulation,
    SynchronousAverage,
    condition_indicators,
    energy_ratio,
    fm0,
    fm4,
    kurtosis,
    m6a,
    m8a,
    na4,
    na4_star,
    narrowband_demodulation,
    nb4,
    sideband_index,
    sideband_level_factor,
    time_synchronous_average,
)
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

__all__ = [
    "AngularSignal",
    "Attractor",
    "Basins",
    "Bifurcation",
    "ConditionIndicators",
    "LyapunovExponents",
    "NarrowbandDemodulation",
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
    "energy_ratio",
    "envelope",
    "envelope_spectrum",
    "extremes",
    "fm0",
    "fm4",
    "kurtosis",
    "line_of_action_indicator",
    "lyapunov_exponents",
    "m6a",
    "m8a",
    "mean",
    "mesh_harmonics",
    "na4",
    "na4_star",
    "narrowband_demodulation",
    "nb4",
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
    "sideband_index",
    "sideband_level_factor",
    "sidebands",
    "spectrogram",
    "spectrum",
    "time_synchronous_average",
    "zoom_spectrum",
]

guard(__name__)
