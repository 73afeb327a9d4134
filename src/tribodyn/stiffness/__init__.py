"""Stiffness of tooth pairs, and load sharing of a mesh under load.

| module | content |
| --- | --- |
| `model` | interface of stiffness models, and their selection by name from :data:`MODELS` |
| `models` | the models of the literature, one in each file |
| `teeth` | compliance of one gear under a load on a tooth, in closed form |
| `fe2d` | the same from finite elements of the whole gear |
| `fe3d` | the same with the face width: slices of the face that are coupled |
| `loaded` | load sharing, transmission error and stiffness of a mesh under load |
| `tip_relief` | transmission error over torque, the best tip relief, crowning and slope |
"""

from tribodyn.arguments import guard
from tribodyn.stiffness.loaded import ContactProblem, LoadedContact, loaded_contact, mesh_problem
from tribodyn.stiffness.model import MODELS, StiffnessModel
from tribodyn.stiffness.models.iso6336 import (
    iso6336_mesh_stiffness,
    iso6336_pair_stiffness,
    iso6336_single_stiffness,
)
from tribodyn.stiffness.models.potential_energy import (
    potential_energy_influence,
    potential_energy_stiffness,
    single_pair_stiffness,
)
from tribodyn.stiffness.models.prescribed import (
    fourier_mesh_stiffness,
    rectangular_stiffness,
    tabulated_stiffness,
)
from tribodyn.stiffness.teeth.face_influence import FaceInfluence, SlicedInfluence
from tribodyn.stiffness.teeth.influence import GearInfluence, weber_banaschek_compression
from tribodyn.stiffness.teeth.tooth_bending import (
    LoadPoint,
    ToothBendingCompliance,
    load_point,
    tooth_bending_compliance,
)
from tribodyn.stiffness.teeth.tooth_compliance import (
    ToothCompliance,
    sainsot_coefficients,
    sainsot_compliance,
    tooth_compliance,
    wind_up_compliance,
)
from tribodyn.stiffness.tip_relief.harris import HarrisMap, transmission_error_over_torque
from tribodyn.stiffness.tip_relief.lead import LeadOptimum, optimize_lead
from tribodyn.stiffness.tip_relief.search import (
    TipReliefOptimum,
    optimize_tip_relief,
    with_tip_relief,
)

__all__ = [
    "MODELS",
    "ContactProblem",
    "FaceInfluence",
    "GearInfluence",
    "HarrisMap",
    "LeadOptimum",
    "LoadPoint",
    "LoadedContact",
    "SlicedInfluence",
    "StiffnessModel",
    "TipReliefOptimum",
    "ToothBendingCompliance",
    "ToothCompliance",
    "fourier_mesh_stiffness",
    "iso6336_mesh_stiffness",
    "iso6336_pair_stiffness",
    "iso6336_single_stiffness",
    "load_point",
    "loaded_contact",
    "mesh_problem",
    "optimize_lead",
    "optimize_tip_relief",
    "potential_energy_influence",
    "potential_energy_stiffness",
    "rectangular_stiffness",
    "sainsot_coefficients",
    "sainsot_compliance",
    "single_pair_stiffness",
    "tabulated_stiffness",
    "tooth_bending_compliance",
    "tooth_compliance",
    "transmission_error_over_torque",
    "weber_banaschek_compression",
    "wind_up_compliance",
    "with_tip_relief",
]

guard(__name__)
