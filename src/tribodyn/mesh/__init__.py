"""Mesh tables: the tooth contact over one mesh cycle, computed, stored and plotted."""

from tribodyn.arguments import guard
from tribodyn.mesh.build import build
from tribodyn.mesh.columns import MeshColumns
from tribodyn.mesh.film.film_columns import film_columns, moving_film
from tribodyn.mesh.force_law import MeshForceLaw
from tribodyn.mesh.functions import LOADS, MeshFriction, MeshFunctions, mesh_friction
from tribodyn.mesh.grid import MonotonePhaseFunction, PhaseFunction, PhaseGrid, phase_grid
from tribodyn.mesh.hypoid.friction import HypoidFriction, hypoid_friction
from tribodyn.mesh.hypoid.loaded_contact import HypoidLoadedContact, hypoid_loaded_contact
from tribodyn.mesh.hypoid.table import hypoid_transmission_error_over_torque
from tribodyn.mesh.operation import (
    ComprehensiveStiffness,
    FilmOverOperation,
    comprehensive_stiffness,
    film_over_operation,
)
from tribodyn.mesh.table import MeshTable

__all__ = [
    "LOADS",
    "ComprehensiveStiffness",
    "FilmOverOperation",
    "HypoidFriction",
    "HypoidLoadedContact",
    "MeshColumns",
    "MeshForceLaw",
    "MeshFriction",
    "MeshFunctions",
    "MeshTable",
    "MonotonePhaseFunction",
    "PhaseFunction",
    "PhaseGrid",
    "build",
    "comprehensive_stiffness",
    "film_columns",
    "film_over_operation",
    "hypoid_friction",
    "hypoid_loaded_contact",
    "hypoid_transmission_error_over_torque",
    "mesh_friction",
    "moving_film",
    "phase_grid",
]

guard(__name__)
