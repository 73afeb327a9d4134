from tribodyn.mesh.build import build as build
from tribodyn.mesh.columns import MeshColumns as MeshColumns
from tribodyn.mesh.film.film_columns import film_columns as film_columns
from tribodyn.mesh.film.film_columns import moving_film as moving_film
from tribodyn.mesh.force_law import MeshForceLaw as MeshForceLaw
from tribodyn.mesh.functions import LOADS as LOADS
from tribodyn.mesh.functions import MeshFriction as MeshFriction
from tribodyn.mesh.functions import MeshFunctions as MeshFunctions
from tribodyn.mesh.functions import mesh_friction as mesh_friction
from tribodyn.mesh.grid import MonotonePhaseFunction as MonotonePhaseFunction
from tribodyn.mesh.grid import PhaseFunction as PhaseFunction
from tribodyn.mesh.grid import PhaseGrid as PhaseGrid
from tribodyn.mesh.grid import phase_grid as phase_grid
from tribodyn.mesh.hypoid.friction import HypoidFriction as HypoidFriction
from tribodyn.mesh.hypoid.friction import hypoid_friction as hypoid_friction
from tribodyn.mesh.hypoid.loaded_contact import HypoidLoadedContact as HypoidLoadedContact
from tribodyn.mesh.hypoid.loaded_contact import hypoid_loaded_contact as hypoid_loaded_contact
from tribodyn.mesh.hypoid.table import (
    hypoid_transmission_error_over_torque as hypoid_transmission_error_over_torque,
)
from tribodyn.mesh.operation import ComprehensiveStiffness as ComprehensiveStiffness
from tribodyn.mesh.operation import FilmOverOperation as FilmOverOperation
from tribodyn.mesh.operation import comprehensive_stiffness as comprehensive_stiffness
from tribodyn.mesh.operation import film_over_operation as film_over_operation
from tribodyn.mesh.table import MeshTable as MeshTable
