"""Friction coefficients of the tooth contact: laws picked by name from ``LAWS``.

| module | what it answers |
| --- | --- |
| `base` | what a law is given and what a law is, and the warning of its range |
| `constant` | no friction, or the same everywhere |
| `benedict_kelly` | friction of discs, by formula |
| `discs` | the same: Misharin, Drozdov and Gavrikov, O'Donoghue and Cameron |
| `xu`, `ehl` | friction of an oil film, by regression or from the solved film |
| `mixed_ehl` | film and asperities share the load, by a fit: Castro and Seabra, Matsumoto |
| `mixed` | film and asperities share the load, by the gap at which both carry it |
| `exponential` | sliding and roughness, with numbers to be fitted |
| `mesh_means`, `iso_14179` | one mean value for a whole mesh: Schlenk, ISO, Niemann |
| `measured` | the same between measured points |
"""

from __future__ import annotations

from tribodyn.arguments import guard
from tribodyn.friction.base import (
    LAWS,
    STEEL_BODIES,
    FrictionLaw,
    FrictionParts,
    TribologicalContact,
)
from tribodyn.friction.benedict_kelly import benedict_kelly
from tribodyn.friction.constant import constant, none
from tribodyn.friction.discs import drozdov, misharin, odonoghue_cameron
from tribodyn.friction.ehl import ehl
from tribodyn.friction.exponential import exponential
from tribodyn.friction.iso_14179 import iso_14179_1, iso_14179_2
from tribodyn.friction.measured import measured
from tribodyn.friction.mesh_means import PitchPoint, iso_6336_22, niemann, pitch_point, schlenk
from tribodyn.friction.mixed import mixed, mixed_solved
from tribodyn.friction.mixed_ehl import matsumoto, mixed_ehl
from tribodyn.friction.xu import xu_2007

__all__ = [
    "LAWS",
    "STEEL_BODIES",
    "FrictionLaw",
    "FrictionParts",
    "PitchPoint",
    "TribologicalContact",
    "benedict_kelly",
    "constant",
    "drozdov",
    "ehl",
    "exponential",
    "iso_6336_22",
    "iso_14179_1",
    "iso_14179_2",
    "matsumoto",
    "measured",
    "misharin",
    "mixed",
    "mixed_ehl",
    "mixed_solved",
    "niemann",
    "none",
    "odonoghue_cameron",
    "pitch_point",
    "schlenk",
    "xu_2007",
]

guard(__name__)
