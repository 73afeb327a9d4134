"""How stiff a tooth pair is: one model per file, picked by name from :data:`MODELS`."""

from tribodyn.stiffness.fourier import fourier_mesh_stiffness
from tribodyn.stiffness.harris import HarrisMap, transmission_error_over_torque
from tribodyn.stiffness.influence import GearInfluence
from tribodyn.stiffness.iso6336 import (
    iso6336_mesh_stiffness,
    iso6336_pair_stiffness,
    iso6336_single_stiffness,
)
from tribodyn.stiffness.load_point import LoadPoint, load_point
from tribodyn.stiffness.loaded import (
    ContactProblem,
    LoadedContact,
    loaded_contact,
    mesh_problem,
)
from tribodyn.stiffness.model import MODELS, StiffnessModel
from tribodyn.stiffness.potential_energy import (
    potential_energy_influence,
    potential_energy_stiffness,
    single_pair_stiffness,
)
from tribodyn.stiffness.rectangular import rectangular_stiffness
from tribodyn.stiffness.sainsot import sainsot_coefficients, sainsot_compliance
from tribodyn.stiffness.table import tabulated_stiffness
from tribodyn.stiffness.tip_relief import optimize_tip_relief
from tribodyn.stiffness.tip_relief_mesh import with_tip_relief
from tribodyn.stiffness.tip_relief_result import TipReliefOptimum
from tribodyn.stiffness.tooth_bending import ToothBendingCompliance, tooth_bending_compliance
from tribodyn.stiffness.tooth_compliance import ToothCompliance, tooth_compliance
from tribodyn.stiffness.weber_banaschek import weber_banaschek_compression
from tribodyn.stiffness.wind_up import wind_up_compliance

__all__ = [
    "MODELS",
    "ContactProblem",
    "GearInfluence",
    "HarrisMap",
    "LoadPoint",
    "LoadedContact",
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
