"""The loaded tooth contact: which pairs carry what, and by how much the mesh gives way."""

from tribodyn.stiffness.loaded.contact import loaded_contact
from tribodyn.stiffness.loaded.models import OPTIONS
from tribodyn.stiffness.loaded.prepare import contact_problem, mesh_problem
from tribodyn.stiffness.loaded.problem import ContactProblem, Equilibrium
from tribodyn.stiffness.loaded.result import LoadedContact
from tribodyn.stiffness.loaded.root_loads import RootLoads

__all__ = [
    "OPTIONS",
    "ContactProblem",
    "Equilibrium",
    "LoadedContact",
    "RootLoads",
    "contact_problem",
    "loaded_contact",
    "mesh_problem",
]
