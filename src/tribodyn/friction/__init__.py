"""Friction coefficients of the tooth contact: one law per file, picked by name from ``LAWS``."""

from __future__ import annotations

from tribodyn.friction.base import LAWS, FrictionLaw, TribologicalContact
from tribodyn.friction.benedict_kelly import benedict_kelly
from tribodyn.friction.constant import constant, none
from tribodyn.friction.ehl import ehl
from tribodyn.friction.xu import xu_2007

__all__ = [
    "LAWS",
    "FrictionLaw",
    "TribologicalContact",
    "benedict_kelly",
    "constant",
    "ehl",
    "none",
    "xu_2007",
]
