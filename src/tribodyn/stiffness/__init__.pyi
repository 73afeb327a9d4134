from tribodyn.stiffness.loaded import ContactProblem as ContactProblem
from tribodyn.stiffness.loaded import LoadedContact as LoadedContact
from tribodyn.stiffness.loaded import loaded_contact as loaded_contact
from tribodyn.stiffness.loaded import mesh_problem as mesh_problem
from tribodyn.stiffness.model import MODELS as MODELS
from tribodyn.stiffness.model import StiffnessModel as StiffnessModel
from tribodyn.stiffness.models.iso6336 import iso6336_mesh_stiffness as iso6336_mesh_stiffness
from tribodyn.stiffness.models.iso6336 import iso6336_pair_stiffness as iso6336_pair_stiffness
from tribodyn.stiffness.models.iso6336 import iso6336_single_stiffness as iso6336_single_stiffness
from tribodyn.stiffness.models.potential_energy import (
    potential_energy_influence as potential_energy_influence,
)
from tribodyn.stiffness.models.potential_energy import (
    potential_energy_stiffness as potential_energy_stiffness,
)
from tribodyn.stiffness.models.potential_energy import (
    single_pair_stiffness as single_pair_stiffness,
)
from tribodyn.stiffness.models.prescribed import fourier_mesh_stiffness as fourier_mesh_stiffness
from tribodyn.stiffness.models.prescribed import rectangular_stiffness as rectangular_stiffness
from tribodyn.stiffness.models.prescribed import tabulated_stiffness as tabulated_stiffness
from tribodyn.stiffness.teeth.face_influence import FaceInfluence as FaceInfluence
from tribodyn.stiffness.teeth.face_influence import SlicedInfluence as SlicedInfluence
from tribodyn.stiffness.teeth.influence import GearInfluence as GearInfluence
from tribodyn.stiffness.teeth.influence import (
    weber_banaschek_compression as weber_banaschek_compression,
)
from tribodyn.stiffness.teeth.tooth_bending import LoadPoint as LoadPoint
from tribodyn.stiffness.teeth.tooth_bending import ToothBendingCompliance as ToothBendingCompliance
from tribodyn.stiffness.teeth.tooth_bending import load_point as load_point
from tribodyn.stiffness.teeth.tooth_bending import (
    tooth_bending_compliance as tooth_bending_compliance,
)
from tribodyn.stiffness.teeth.tooth_compliance import ToothCompliance as ToothCompliance
from tribodyn.stiffness.teeth.tooth_compliance import sainsot_coefficients as sainsot_coefficients
from tribodyn.stiffness.teeth.tooth_compliance import sainsot_compliance as sainsot_compliance
from tribodyn.stiffness.teeth.tooth_compliance import tooth_compliance as tooth_compliance
from tribodyn.stiffness.teeth.tooth_compliance import wind_up_compliance as wind_up_compliance
from tribodyn.stiffness.tip_relief.harris import HarrisMap as HarrisMap
from tribodyn.stiffness.tip_relief.harris import (
    transmission_error_over_torque as transmission_error_over_torque,
)
from tribodyn.stiffness.tip_relief.lead import LeadOptimum as LeadOptimum
from tribodyn.stiffness.tip_relief.lead import optimize_lead as optimize_lead
from tribodyn.stiffness.tip_relief.search import TipReliefOptimum as TipReliefOptimum
from tribodyn.stiffness.tip_relief.search import optimize_tip_relief as optimize_tip_relief
from tribodyn.stiffness.tip_relief.search import with_tip_relief as with_tip_relief
