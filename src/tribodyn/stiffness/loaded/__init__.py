"""Loaded tooth contact: load sharing of the tooth pairs and deflection of the mesh.

| module | what it answers |
| --- | --- |
| `contact` | from a gear pair, a torque and a model's name to the loaded contact |
| `problem` | where pairs may touch; loads at an approach, and approach at a load |
| `kernel` | the compiled solver of that problem |
| `ramps` | ramps that add up to the force of a mesh over its deflection |
| `result` | load sharing, transmission error, stiffness, harmonics, loads at the foot |
| `models` | stiffness models whose pairs are solved together |
"""

from tribodyn.stiffness.loaded.contact import contact_problem, loaded_contact, mesh_problem
from tribodyn.stiffness.loaded.models import OPTIONS
from tribodyn.stiffness.loaded.problem import ContactProblem, Equilibrium
from tribodyn.stiffness.loaded.result import LoadedContact, RootLoads

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
