"""Lumped structures with time-varying contacts: steady states, transients, ensembles."""

from tribodyn.dynamics.energy import EnergyAudit, energy_audit
from tribodyn.dynamics.ensemble import Ensemble, LaneStatistics, simulate_ensemble
from tribodyn.dynamics.force_law import MeshForce, law_contacts
from tribodyn.dynamics.response import FineSamples, Response
from tribodyn.dynamics.simulate import simulate
from tribodyn.dynamics.spur6 import SPUR6_NAMES, spur6
from tribodyn.dynamics.steady_state import steady_state
from tribodyn.dynamics.step_limit import recommended_steps
from tribodyn.dynamics.system import Contact, Entry, System
from tribodyn.dynamics.torsional import TORSIONAL_NAMES, torsional

__all__ = [
    "SPUR6_NAMES",
    "TORSIONAL_NAMES",
    "Contact",
    "EnergyAudit",
    "Ensemble",
    "Entry",
    "FineSamples",
    "LaneStatistics",
    "MeshForce",
    "Response",
    "System",
    "energy_audit",
    "law_contacts",
    "recommended_steps",
    "simulate",
    "simulate_ensemble",
    "spur6",
    "steady_state",
    "torsional",
]
