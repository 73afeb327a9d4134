"""The elastohydrodynamic film of a tooth contact: solved, or by formulas named by author.

| module | what it answers |
|---|---|
| ``models`` | film models by name, as a case file picks them |
| ``formulas`` | films by formula: which groups, which regime, which film |
| ``area`` | pressure and film of points, ellipses and lines of finite length |
| ``solver`` | the equations of a line contact on a grid, and their engines |
| ``steady`` | pressure and film of a contact at rest in its frame, one or many |
| ``transient`` | pressure and film while load, radius and speed change |
| ``thermal`` | the film with its heat: temperatures and shear across it, friction |
| ``film_stiffness`` | stiffness and damping of the film |
| ``traction`` | shear of the oil, and its temperature |
| ``asperities`` | summits of rough flanks from their roughness, and their contact |
| ``mixed_contact`` | how much of its load the film of a rough contact carries, and the regime |
| ``flow_factors`` | mean flow between rough surfaces |
| ``roughness`` | measured heights of a surface |
"""

from __future__ import annotations

from tribodyn.arguments import guard
from tribodyn.ehl.area.finite_line import RollerProfile, solve_finite_line_contact
from tribodyn.ehl.area.point_contact import solve_point_contact
from tribodyn.ehl.area.solution import AreaFriction, FiniteLineSolution, PointContactSolution
from tribodyn.ehl.asperities import Asperities, asperity_integral
from tribodyn.ehl.flow_factors import (
    FlowFactors,
    mean_gap,
    pressure_flow_factor,
    shear_flow_factor,
)
from tribodyn.ehl.formulas.dimensionless_groups import Groups, line_contact_groups
from tribodyn.ehl.formulas.elliptic import (
    hamrock_dowson_central,
    hamrock_dowson_minimum,
    nijenbanning_central,
    nijenbanning_dimensionless_central,
)
from tribodyn.ehl.formulas.line import (
    dowson_1968_minimum,
    dowson_toyoda_central,
    moes_central,
    moes_dimensionless_central,
    pan_hamrock_central,
    pan_hamrock_minimum,
)
from tribodyn.ehl.mixed_contact import (
    MixedLineContact,
    balanced_load_share,
    film_load_share,
    lubrication_regime,
    mixed_line_contact,
)
from tribodyn.ehl.models import FILM_MODELS, FilmModel
from tribodyn.ehl.roughness import RoughnessProfile
from tribodyn.ehl.steady.batch import LineContactBatch, solve_line_contacts
from tribodyn.ehl.steady.line_contact import solve_line_contact, solve_line_contact_moes
from tribodyn.ehl.steady.solution import LineContactSolution, ThermalLineContactSolution
from tribodyn.ehl.thermal.thermal_model import BodyHeat, ThermalModel
from tribodyn.ehl.traction.film_temperature import blok_flash_temperature, inlet_heating_factor
from tribodyn.ehl.traction.shear_models import (
    SHEAR_MODELS,
    bair_winer_shear_stress,
    carreau_shear_stress,
    newtonian_shear_stress,
    ree_eyring_shear_stress,
)
from tribodyn.ehl.traction.traction import FilmState, Traction, film_traction
from tribodyn.ehl.transient.solution import (
    ThermalTransientLineContact,
    TransientLineContact,
)
from tribodyn.ehl.transient.transient import solve_transient_line_contact
from tribodyn.ehl.transient.waviness import (
    AmplitudeReduction,
    amplitude_reduction,
    flattened_roughness,
    solve_amplitude_reduction,
)

__all__ = [
    "FILM_MODELS",
    "SHEAR_MODELS",
    "AmplitudeReduction",
    "AreaFriction",
    "Asperities",
    "BodyHeat",
    "FilmModel",
    "FilmState",
    "FiniteLineSolution",
    "FlowFactors",
    "Groups",
    "LineContactBatch",
    "LineContactSolution",
    "MixedLineContact",
    "PointContactSolution",
    "RollerProfile",
    "RoughnessProfile",
    "ThermalLineContactSolution",
    "ThermalModel",
    "ThermalTransientLineContact",
    "Traction",
    "TransientLineContact",
    "amplitude_reduction",
    "asperity_integral",
    "bair_winer_shear_stress",
    "balanced_load_share",
    "blok_flash_temperature",
    "carreau_shear_stress",
    "dowson_1968_minimum",
    "dowson_toyoda_central",
    "film_load_share",
    "film_traction",
    "flattened_roughness",
    "hamrock_dowson_central",
    "hamrock_dowson_minimum",
    "inlet_heating_factor",
    "line_contact_groups",
    "lubrication_regime",
    "mean_gap",
    "mixed_line_contact",
    "moes_central",
    "moes_dimensionless_central",
    "newtonian_shear_stress",
    "nijenbanning_central",
    "nijenbanning_dimensionless_central",
    "pan_hamrock_central",
    "pan_hamrock_minimum",
    "pressure_flow_factor",
    "ree_eyring_shear_stress",
    "shear_flow_factor",
    "solve_amplitude_reduction",
    "solve_finite_line_contact",
    "solve_line_contact",
    "solve_line_contact_moes",
    "solve_line_contacts",
    "solve_point_contact",
    "solve_transient_line_contact",
]

guard(__name__)
