"""Lumped structures with time-varying contacts: steady states, transients, ensembles."""

from tribodyn.arguments import guard
from tribodyn.dynamics.equations.entry import Entry
from tribodyn.dynamics.equations.lane_parameters import LaneParameters
from tribodyn.dynamics.equations.step_limit import recommended_steps
from tribodyn.dynamics.equations.system import Contact, LoadFriction, System
from tribodyn.dynamics.harmonic.clearance_motion import clearance_motion
from tribodyn.dynamics.harmonic.harmonic_balance import harmonic_balance
from tribodyn.dynamics.harmonic.phase_response import Lines, PhaseResponse
from tribodyn.dynamics.harmonic.radial_clearance import RadialClearance
from tribodyn.dynamics.linear.campbell import Campbell, Resonance, campbell
from tribodyn.dynamics.linear.linear_system import ForcedResponse, forced_response
from tribodyn.dynamics.linear.natural_modes import NaturalModes, natural_modes
from tribodyn.dynamics.orbits.continuation import continuation
from tribodyn.dynamics.orbits.solution_branch import Branch, SpecialPoint
from tribodyn.dynamics.orbits.steady_state import steady_state
from tribodyn.dynamics.running_up.run_up import run_up
from tribodyn.dynamics.running_up.run_up_result import RunUp, SpeedProfile, speed_ramp
from tribodyn.dynamics.running_up.speed_sweep import Jump, SpeedSweep, speed_sweep
from tribodyn.dynamics.structure.force_law import MeshForce, follow_load, law_contact, law_contacts
from tribodyn.dynamics.structure.fzg12 import FZG12_LIGHT, FZG12_MESH_FREQUENCY, FZG12_NAMES, fzg12
from tribodyn.dynamics.structure.gear_pair import SPUR6_NAMES, TORSIONAL_NAMES, spur6, torsional
from tribodyn.dynamics.structure.helical12 import HELICAL12_NAMES, SpatialSupports, helical12
from tribodyn.dynamics.structure.hypoid14 import HYPOID14_NAMES, HypoidSupports, hypoid14
from tribodyn.dynamics.structure.shafts import (
    Body,
    GearMesh,
    assemble,
    shaft_chain,
    torsional_stiffness,
)
from tribodyn.dynamics.structure.structures import STRUCTURES, Gearing, Structure
from tribodyn.dynamics.time.adaptive_solution import AdaptiveSolution, solve_adaptive
from tribodyn.dynamics.time.energy import EnergyAudit, energy_audit
from tribodyn.dynamics.time.engines import ENGINES, Engine
from tribodyn.dynamics.time.ensemble import Ensemble, LaneStatistics, simulate_ensemble
from tribodyn.dynamics.time.response import FineSamples, Response
from tribodyn.dynamics.time.simulate import simulate

__all__ = [
    "ENGINES",
    "FZG12_LIGHT",
    "FZG12_MESH_FREQUENCY",
    "FZG12_NAMES",
    "HELICAL12_NAMES",
    "HYPOID14_NAMES",
    "SPUR6_NAMES",
    "STRUCTURES",
    "TORSIONAL_NAMES",
    "AdaptiveSolution",
    "Body",
    "Branch",
    "Campbell",
    "Contact",
    "EnergyAudit",
    "Engine",
    "Ensemble",
    "Entry",
    "FineSamples",
    "ForcedResponse",
    "GearMesh",
    "Gearing",
    "HypoidSupports",
    "Jump",
    "LaneParameters",
    "LaneStatistics",
    "Lines",
    "LoadFriction",
    "MeshForce",
    "NaturalModes",
    "PhaseResponse",
    "RadialClearance",
    "Resonance",
    "Response",
    "RunUp",
    "SpatialSupports",
    "SpecialPoint",
    "SpeedProfile",
    "SpeedSweep",
    "Structure",
    "System",
    "assemble",
    "campbell",
    "clearance_motion",
    "continuation",
    "energy_audit",
    "follow_load",
    "forced_response",
    "fzg12",
    "harmonic_balance",
    "helical12",
    "hypoid14",
    "law_contact",
    "law_contacts",
    "natural_modes",
    "recommended_steps",
    "run_up",
    "shaft_chain",
    "simulate",
    "simulate_ensemble",
    "solve_adaptive",
    "speed_ramp",
    "speed_sweep",
    "spur6",
    "steady_state",
    "torsional",
    "torsional_stiffness",
]

guard(__name__)
