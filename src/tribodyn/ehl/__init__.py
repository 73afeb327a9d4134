"""The elastohydrodynamic film of a tooth contact: film formulas by author."""

from __future__ import annotations

from tribodyn.ehl.dowson import dowson_1968_minimum
from tribodyn.ehl.dowson_toyoda import dowson_toyoda_central
from tribodyn.ehl.groups import Groups, line_contact_groups
from tribodyn.ehl.models import FILM_MODELS, FilmModel
from tribodyn.ehl.moes import moes_central, moes_dimensionless_central
from tribodyn.ehl.pan_hamrock import pan_hamrock_central, pan_hamrock_minimum

__all__ = [
    "FILM_MODELS",
    "FilmModel",
    "Groups",
    "dowson_1968_minimum",
    "dowson_toyoda_central",
    "line_contact_groups",
    "moes_central",
    "moes_dimensionless_central",
    "pan_hamrock_central",
    "pan_hamrock_minimum",
]
