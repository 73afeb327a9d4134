from tribodyn.ehl.area.finite_line import RollerProfile as RollerProfile
from tribodyn.ehl.area.finite_line import solve_finite_line_contact as solve_finite_line_contact
from tribodyn.ehl.area.point_contact import solve_point_contact as solve_point_contact
from tribodyn.ehl.area.solution import AreaFriction as AreaFriction
from tribodyn.ehl.area.solution import FiniteLineSolution as FiniteLineSolution
from tribodyn.ehl.area.solution import PointContactSolution as PointContactSolution
from tribodyn.ehl.asperities import Asperities as Asperities
from tribodyn.ehl.asperities import asperity_integral as asperity_integral
from tribodyn.ehl.flow_factors import FlowFactors as FlowFactors
from tribodyn.ehl.flow_factors import mean_gap as mean_gap
from tribodyn.ehl.flow_factors import pressure_flow_factor as pressure_flow_factor
from tribodyn.ehl.flow_factors import shear_flow_factor as shear_flow_factor
from tribodyn.ehl.formulas.dimensionless_groups import Groups as Groups
from tribodyn.ehl.formulas.dimensionless_groups import line_contact_groups as line_contact_groups
from tribodyn.ehl.formulas.elliptic import hamrock_dowson_central as hamrock_dowson_central
from tribodyn.ehl.formulas.elliptic import hamrock_dowson_minimum as hamrock_dowson_minimum
from tribodyn.ehl.formulas.elliptic import nijenbanning_central as nijenbanning_central
from tribodyn.ehl.formulas.elliptic import (
    nijenbanning_dimensionless_central as nijenbanning_dimensionless_central,
)
from tribodyn.ehl.formulas.line import dowson_1968_minimum as dowson_1968_minimum
from tribodyn.ehl.formulas.line import dowson_toyoda_central as dowson_toyoda_central
from tribodyn.ehl.formulas.line import moes_central as moes_central
from tribodyn.ehl.formulas.line import moes_dimensionless_central as moes_dimensionless_central
from tribodyn.ehl.formulas.line import pan_hamrock_central as pan_hamrock_central
from tribodyn.ehl.formulas.line import pan_hamrock_minimum as pan_hamrock_minimum
from tribodyn.ehl.mixed_contact import MixedLineContact as MixedLineContact
from tribodyn.ehl.mixed_contact import balanced_load_share as balanced_load_share
from tribodyn.ehl.mixed_contact import film_load_share as film_load_share
from tribodyn.ehl.mixed_contact import lubrication_regime as lubrication_regime
from tribodyn.ehl.mixed_contact import mixed_line_contact as mixed_line_contact
from tribodyn.ehl.models import FILM_MODELS as FILM_MODELS
from tribodyn.ehl.models import FilmModel as FilmModel
from tribodyn.ehl.roughness import RoughnessProfile as RoughnessProfile
from tribodyn.ehl.steady.batch import LineContactBatch as LineContactBatch
from tribodyn.ehl.steady.batch import solve_line_contacts as solve_line_contacts
from tribodyn.ehl.steady.line_contact import solve_line_contact as solve_line_contact
from tribodyn.ehl.steady.line_contact import solve_line_contact_moes as solve_line_contact_moes
from tribodyn.ehl.steady.solution import LineContactSolution as LineContactSolution
from tribodyn.ehl.steady.solution import ThermalLineContactSolution as ThermalLineContactSolution
from tribodyn.ehl.thermal.thermal_model import BodyHeat as BodyHeat
from tribodyn.ehl.thermal.thermal_model import ThermalModel as ThermalModel
from tribodyn.ehl.traction.film_temperature import blok_flash_temperature as blok_flash_temperature
from tribodyn.ehl.traction.film_temperature import inlet_heating_factor as inlet_heating_factor
from tribodyn.ehl.traction.shear_models import SHEAR_MODELS as SHEAR_MODELS
from tribodyn.ehl.traction.shear_models import bair_winer_shear_stress as bair_winer_shear_stress
from tribodyn.ehl.traction.shear_models import carreau_shear_stress as carreau_shear_stress
from tribodyn.ehl.traction.shear_models import newtonian_shear_stress as newtonian_shear_stress
from tribodyn.ehl.traction.shear_models import ree_eyring_shear_stress as ree_eyring_shear_stress
from tribodyn.ehl.traction.traction import FilmState as FilmState
from tribodyn.ehl.traction.traction import Traction as Traction
from tribodyn.ehl.traction.traction import film_traction as film_traction
from tribodyn.ehl.transient.solution import (
    ThermalTransientLineContact as ThermalTransientLineContact,
)
from tribodyn.ehl.transient.solution import TransientLineContact as TransientLineContact
from tribodyn.ehl.transient.transient import (
    solve_transient_line_contact as solve_transient_line_contact,
)
from tribodyn.ehl.transient.waviness import AmplitudeReduction as AmplitudeReduction
from tribodyn.ehl.transient.waviness import amplitude_reduction as amplitude_reduction
from tribodyn.ehl.transient.waviness import flattened_roughness as flattened_roughness
from tribodyn.ehl.transient.waviness import solve_amplitude_reduction as solve_amplitude_reduction
