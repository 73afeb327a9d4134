"""The elastohydrodynamic film of a tooth contact: solved, or by formulas named by author."""

from __future__ import annotations

from tribodyn.ehl.batch import LineContactBatch, solve_line_contacts
from tribodyn.ehl.dowson import dowson_1968_minimum
from tribodyn.ehl.dowson_toyoda import dowson_toyoda_central
from tribodyn.ehl.film_state import FilmState
from tribodyn.ehl.flash_temperature import blok_flash_temperature
from tribodyn.ehl.groups import Groups, line_contact_groups
from tribodyn.ehl.inlet_heating import inlet_heating_factor
from tribodyn.ehl.line_contact import solve_line_contact, solve_line_contact_moes
from tribodyn.ehl.models import FILM_MODELS, FilmModel
from tribodyn.ehl.moes import moes_central, moes_dimensionless_central
from tribodyn.ehl.newtonian import newtonian_shear_stress
from tribodyn.ehl.pan_hamrock import pan_hamrock_central, pan_hamrock_minimum
from tribodyn.ehl.ree_eyring import ree_eyring_shear_stress
from tribodyn.ehl.roughness import RoughnessProfile
from tribodyn.ehl.shear_models import SHEAR_MODELS
from tribodyn.ehl.solution import LineContactSolution
from tribodyn.ehl.traction import Traction, film_traction
from tribodyn.ehl.transient import solve_transient_line_contact
from tribodyn.ehl.transient_result import TransientLineContact

__all__ = [
    "FILM_MODELS",
    "SHEAR_MODELS",
    "FilmModel",
    "FilmState",
    "Groups",
    "LineContactBatch",
    "LineContactSolution",
    "RoughnessProfile",
    "Traction",
    "TransientLineContact",
    "blok_flash_temperature",
    "dowson_1968_minimum",
    "dowson_toyoda_central",
    "film_traction",
    "inlet_heating_factor",
    "line_contact_groups",
    "moes_central",
    "moes_dimensionless_central",
    "newtonian_shear_stress",
    "pan_hamrock_central",
    "pan_hamrock_minimum",
    "ree_eyring_shear_stress",
    "solve_line_contact",
    "solve_line_contact_moes",
    "solve_line_contacts",
    "solve_transient_line_contact",
]
