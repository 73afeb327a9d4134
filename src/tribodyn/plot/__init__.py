"""Figures: each answers one question about a result, as an interactive plotly figure.

Figures are looked up by name in :data:`FIGURES`. Plotly is loaded when the first one is drawn.
"""

from __future__ import annotations

from tribodyn.drawing import FIGURES, Drawing, drawing
from tribodyn.plot.acceleration import acceleration
from tribodyn.plot.basins import basins
from tribodyn.plot.bearing_force import bearing_force
from tribodyn.plot.bearing_spectrum import bearing_spectrum
from tribodyn.plot.bifurcation import bifurcation
from tribodyn.plot.campbell import campbell
from tribodyn.plot.comprehensive_stiffness import comprehensive_stiffness
from tribodyn.plot.continuation import continuation
from tribodyn.plot.film import film
from tribodyn.plot.film_along_path import film_along_path, film_over_time
from tribodyn.plot.film_comparison import compare_line_contacts
from tribodyn.plot.film_dynamics import film_response, film_transient
from tribodyn.plot.film_pressure import film_pressure
from tribodyn.plot.film_stiffness import film_stiffness
from tribodyn.plot.flank_modification import flank_modification
from tribodyn.plot.force_law import force_law
from tribodyn.plot.forced_response import forced_response
from tribodyn.plot.friction import friction
from tribodyn.plot.gear_pair import gear_pair
from tribodyn.plot.harris_map import harris_map
from tribodyn.plot.line_contact import line_contact
from tribodyn.plot.load_sharing import load_sharing
from tribodyn.plot.loaded_contact import loaded_contact
from tribodyn.plot.loaded_sharing import loaded_sharing
from tribodyn.plot.lyapunov import lyapunov
from tribodyn.plot.mesh_deformation import mesh_deformation
from tribodyn.plot.mesh_force import mesh_force
from tribodyn.plot.mesh_stiffness import mesh_stiffness
from tribodyn.plot.mode_shapes import mode_shapes
from tribodyn.plot.order_map import order_map
from tribodyn.plot.parameter_map import parameter_map
from tribodyn.plot.path_of_contact import path_of_contact
from tribodyn.plot.phase_portrait import phase_portrait
from tribodyn.plot.poincare import poincare
from tribodyn.plot.run_up import run_up
from tribodyn.plot.run_up_map import run_up_map
from tribodyn.plot.spectrogram import spectrogram
from tribodyn.plot.spectrum import spectrum
from tribodyn.plot.speed_sweep import speed_sweep
from tribodyn.plot.static_stiffness import static_stiffness
from tribodyn.plot.static_transmission_error import static_transmission_error
from tribodyn.plot.sweep import sweep
from tribodyn.plot.tip_relief_map import tip_relief_map
from tribodyn.plot.transmission_error import transmission_error
from tribodyn.plot.waterfall import waterfall

__all__ = [
    "FIGURES",
    "Drawing",
    "acceleration",
    "basins",
    "bearing_force",
    "bearing_spectrum",
    "bifurcation",
    "campbell",
    "compare_line_contacts",
    "comprehensive_stiffness",
    "continuation",
    "drawing",
    "film",
    "film_along_path",
    "film_over_time",
    "film_pressure",
    "film_response",
    "film_stiffness",
    "film_transient",
    "flank_modification",
    "force_law",
    "forced_response",
    "friction",
    "gear_pair",
    "harris_map",
    "line_contact",
    "load_sharing",
    "loaded_contact",
    "loaded_sharing",
    "lyapunov",
    "mesh_deformation",
    "mesh_force",
    "mesh_stiffness",
    "mode_shapes",
    "order_map",
    "parameter_map",
    "path_of_contact",
    "phase_portrait",
    "poincare",
    "run_up",
    "run_up_map",
    "spectrogram",
    "spectrum",
    "speed_sweep",
    "static_stiffness",
    "static_transmission_error",
    "sweep",
    "tip_relief_map",
    "transmission_error",
    "waterfall",
]
