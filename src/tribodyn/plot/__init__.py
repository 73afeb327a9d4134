"""Figures: each answers one question about a result, as an interactive plotly figure.

Figures are looked up by name in :data:`FIGURES`. Plotly is loaded when the first one is drawn.
"""

from __future__ import annotations

from tribodyn.plot.acceleration import acceleration
from tribodyn.plot.bearing_force import bearing_force
from tribodyn.plot.bearing_spectrum import bearing_spectrum
from tribodyn.plot.film import film
from tribodyn.plot.film_along_path import film_along_path, film_over_time
from tribodyn.plot.film_comparison import compare_line_contacts
from tribodyn.plot.film_dynamics import film_response, film_transient
from tribodyn.plot.film_pressure import film_pressure
from tribodyn.plot.film_stiffness import film_stiffness
from tribodyn.plot.friction import friction
from tribodyn.plot.gear_pair import gear_pair
from tribodyn.plot.line_contact import line_contact
from tribodyn.plot.loaded_contact import loaded_contact
from tribodyn.plot.loaded_sharing import loaded_sharing
from tribodyn.plot.mesh_force import mesh_force
from tribodyn.plot.mesh_stiffness import mesh_stiffness
from tribodyn.plot.path_of_contact import path_of_contact
from tribodyn.plot.registry import FIGURES, Drawing, drawing
from tribodyn.plot.spectrum import spectrum
from tribodyn.plot.transmission_error import transmission_error

__all__ = [
    "FIGURES",
    "Drawing",
    "acceleration",
    "bearing_force",
    "bearing_spectrum",
    "compare_line_contacts",
    "drawing",
    "film",
    "film_along_path",
    "film_over_time",
    "film_pressure",
    "film_response",
    "film_stiffness",
    "film_transient",
    "friction",
    "gear_pair",
    "line_contact",
    "loaded_contact",
    "loaded_sharing",
    "mesh_force",
    "mesh_stiffness",
    "path_of_contact",
    "spectrum",
    "transmission_error",
]
