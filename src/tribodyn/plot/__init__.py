"""Interactive plotly figures of results, one question about a result per figure.

Figures are looked up by name in :data:`FIGURES`. Plotly is loaded when the first one is drawn.
"""

from __future__ import annotations

from tribodyn.arguments import guard
from tribodyn.drawing import FIGURES, Drawing, drawing
from tribodyn.plot.film.animation import film_along_path, film_over_time
from tribodyn.plot.film.area_contact import area_friction, finite_line_contact, point_contact
from tribodyn.plot.film.dynamics import (
    amplitude_reduction,
    film_response,
    film_temperature,
    film_temperature_over_time,
    film_transient,
)
from tribodyn.plot.film.line_contact import compare_line_contacts, line_contact
from tribodyn.plot.film.lubrication import (
    film_over_operation,
    lubrication,
    lubrication_map,
    mixed_line_contact,
)
from tribodyn.plot.film.path import film, film_pressure, film_stiffness, friction, path_of_contact
from tribodyn.plot.gear.flanks import contact_lines, flank_modification
from tribodyn.plot.gear.gear_pair import gear_pair
from tribodyn.plot.gear.hypoid import ease_off, hypoid_blank, hypoid_contact, hypoid_pair
from tribodyn.plot.gear.hypoid_running import (
    hypoid_friction,
    hypoid_kinematics,
    hypoid_load,
    hypoid_misalignment,
    hypoid_pressure,
)
from tribodyn.plot.gear.losses import friction_from_loss, heat_balance, losses, power_flow
from tribodyn.plot.gear.mesh_deformation import mesh_deformation
from tribodyn.plot.machine.levels import (
    machine_comparison,
    machine_ensemble,
    machine_level_lines,
    machine_levels,
    machine_sweep,
)
from tribodyn.plot.machine.modes import machine_campbell, machine_modes
from tribodyn.plot.machine.orders import (
    kinematic_frequencies,
    machine_forces,
    machine_orders,
    machine_power,
)
from tribodyn.plot.machine.planetary import (
    load_share_statistics,
    planetary_forces,
    planetary_modes,
    planetary_stage,
    ring_sensor,
)
from tribodyn.plot.machine.side_view import machine
from tribodyn.plot.machine.space_view import machine_space
from tribodyn.plot.mesh.loaded_contact import face_maps, loaded_contact, loaded_sharing, rating_maps
from tribodyn.plot.mesh.studies import (
    comprehensive_stiffness,
    coupling,
    harris_map,
    lead_optimum,
    tip_relief_map,
)
from tribodyn.plot.mesh.table import (
    force_law,
    load_sharing,
    mesh_stiffness,
    static_stiffness,
    static_transmission_error,
)
from tribodyn.plot.motion.friction import friction_claims, friction_effect, friction_harmonics
from tribodyn.plot.motion.linear import campbell, forced_response, mode_shapes
from tribodyn.plot.motion.motion import (
    adaptive_solution,
    paper_comparison,
    response,
    result_comparison,
)
from tribodyn.plot.motion.spectra import bearing_spectrum, spectrum
from tribodyn.plot.motion.sweeps import speed_sweep, sweep
from tribodyn.plot.motion.time_histories import (
    acceleration,
    bearing_force,
    friction_force,
    mesh_force,
    tooth_force,
    transmission_error,
    turning_mesh,
    turning_motion,
    wear_depth,
)
from tribodyn.plot.nonlinear.branches import bifurcation, continuation
from tribodyn.plot.nonlinear.planes import basins, lyapunov, parameter_map, phase_portrait, poincare
from tribodyn.plot.signals.bands import bands, ensemble, surrogate
from tribodyn.plot.signals.diagnosis import (
    cepstrum,
    cyclic_coherence,
    kurtogram,
    narrowband_demodulation,
    recording_verdict,
    sideband_cursors,
    synchronous_average,
)
from tribodyn.plot.signals.recorded import (
    comparison,
    order_spectrum,
    recording,
    signal_analysis,
    signal_history,
    tracked_orders,
)
from tribodyn.plot.signals.run_up import run_up, run_up_map
from tribodyn.plot.signals.spectra import (
    harmonic_spectrum,
    order_cut,
    order_map,
    overall_level,
    sidebands,
    signal_spectrum,
    spectrogram,
    waterfall,
)
from tribodyn.plot.signals.uncertain import (
    band,
    data_set,
    failure_probability,
    sensitivity,
    sobol_indices,
)

__all__ = [
    "FIGURES",
    "Drawing",
    "acceleration",
    "adaptive_solution",
    "amplitude_reduction",
    "area_friction",
    "band",
    "bands",
    "basins",
    "bearing_force",
    "bearing_spectrum",
    "bifurcation",
    "campbell",
    "cepstrum",
    "compare_line_contacts",
    "comparison",
    "comprehensive_stiffness",
    "contact_lines",
    "continuation",
    "coupling",
    "cyclic_coherence",
    "data_set",
    "drawing",
    "ease_off",
    "ensemble",
    "face_maps",
    "failure_probability",
    "film",
    "film_along_path",
    "film_over_operation",
    "film_over_time",
    "film_pressure",
    "film_response",
    "film_stiffness",
    "film_temperature",
    "film_temperature_over_time",
    "film_transient",
    "finite_line_contact",
    "flank_modification",
    "force_law",
    "forced_response",
    "friction",
    "friction_claims",
    "friction_effect",
    "friction_force",
    "friction_from_loss",
    "friction_harmonics",
    "gear_pair",
    "harmonic_spectrum",
    "harris_map",
    "heat_balance",
    "hypoid_blank",
    "hypoid_contact",
    "hypoid_friction",
    "hypoid_kinematics",
    "hypoid_load",
    "hypoid_misalignment",
    "hypoid_pair",
    "hypoid_pressure",
    "kinematic_frequencies",
    "kurtogram",
    "lead_optimum",
    "line_contact",
    "load_share_statistics",
    "load_sharing",
    "loaded_contact",
    "loaded_sharing",
    "losses",
    "lubrication",
    "lubrication_map",
    "lyapunov",
    "machine",
    "machine_campbell",
    "machine_comparison",
    "machine_ensemble",
    "machine_forces",
    "machine_level_lines",
    "machine_levels",
    "machine_modes",
    "machine_orders",
    "machine_power",
    "machine_space",
    "machine_sweep",
    "mesh_deformation",
    "mesh_force",
    "mesh_stiffness",
    "mixed_line_contact",
    "mode_shapes",
    "narrowband_demodulation",
    "order_cut",
    "order_map",
    "order_spectrum",
    "overall_level",
    "paper_comparison",
    "parameter_map",
    "path_of_contact",
    "phase_portrait",
    "planetary_forces",
    "planetary_modes",
    "planetary_stage",
    "poincare",
    "point_contact",
    "power_flow",
    "rating_maps",
    "recording",
    "recording_verdict",
    "response",
    "result_comparison",
    "ring_sensor",
    "run_up",
    "run_up_map",
    "sensitivity",
    "sideband_cursors",
    "sidebands",
    "signal_analysis",
    "signal_history",
    "signal_spectrum",
    "sobol_indices",
    "spectrogram",
    "spectrum",
    "speed_sweep",
    "static_stiffness",
    "static_transmission_error",
    "surrogate",
    "sweep",
    "synchronous_average",
    "tip_relief_map",
    "tooth_force",
    "tracked_orders",
    "transmission_error",
    "turning_mesh",
    "turning_motion",
    "waterfall",
    "wear_depth",
]

guard(__name__)
