"""Figures: each answers one question about a result, as an interactive plotly figure.

Figures are looked up by name in :data:`FIGURES`. Plotly is loaded when the first one is drawn.
"""

from __future__ import annotations

from tribodyn.plot.acceleration import acceleration
from tribodyn.plot.bearing_force import bearing_force
from tribodyn.plot.bearing_spectrum import bearing_spectrum
from tribodyn.plot.film import film
from tribodyn.plot.friction import friction
from tribodyn.plot.gear_pair import gear_pair
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
    "drawing",
    "film",
    "friction",
    "gear_pair",
    "mesh_force",
    "mesh_stiffness",
    "path_of_contact",
    "spectrum",
    "transmission_error",
]
