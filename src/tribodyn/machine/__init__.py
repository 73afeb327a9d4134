"""Machines of several shafts: parts, kinematics, clock, directions of the meshes, matrices.

Node coordinates have the order x, y, z, theta_x, theta_y, theta_z, with x along the shafts; a
positive speed turns y towards z.

| module | what it answers |
|---|---|
| ``section``, ``shaft`` | what a shaft consists of |
| ``gear``, ``mesh`` | which teeth mesh where, and with which force law |
| ``bearing``, ``housing`` | what carries the shafts |
| ``machine`` | which parts form a machine |
| ``beam``, ``shaft_matrices`` | how stiff and how heavy a shaft is |
| ``structure``, ``reduction`` | matrices of all parts but the meshes, full and reduced |
| ``assembly`` | equations of motion |
| ``modes`` | natural frequencies, and which parts store the energy |
| ``hypoid`` | hypoid pair between engine and load, with shafts and bearings |
| ``planetary`` | planetary stages: kinematics, phases, plane model, load sharing |
| ``graph`` | speeds, torques, clock, directions, places and masses that follow from it |
"""

from tribodyn import aliases
from tribodyn.arguments import guard
from tribodyn.machine.assembly import system
from tribodyn.machine.bearing import Bearing
from tribodyn.machine.gear import Gear
from tribodyn.machine.graph.bodies import GearBody
from tribodyn.machine.graph.clock import Clock, Phases
from tribodyn.machine.graph.crossed import CrossedAxes
from tribodyn.machine.graph.directions import MeshDirection
from tribodyn.machine.graph.kinematics import MeshLoad, PowerFlow, ShaftLoad
from tribodyn.machine.graph.placement import Placement
from tribodyn.machine.housing import Housing
from tribodyn.machine.hypoid.pair_machine import hypoid_machine
from tribodyn.machine.machine import Machine, Operation
from tribodyn.machine.mesh import Mesh
from tribodyn.machine.modes import MachineModes, machine_modes
from tribodyn.machine.planetary.double_planets import MeshedPlanets, SteppedPlanets
from tribodyn.machine.planetary.kinematics import PlanetaryKinematics, planetary_kinematics
from tribodyn.machine.planetary.load_sharing import LoadShares, load_shares
from tribodyn.machine.planetary.mesh_laws import sun_to_ring_lag
from tribodyn.machine.planetary.modes import PlanetaryModes, planetary_modes
from tribodyn.machine.planetary.phases import HarmonicExcitation, MeshPhases, mesh_phases
from tribodyn.machine.planetary.plane_model import planetary_plane_model
from tribodyn.machine.planetary.positions import PlanetaryPositions, planetary_positions
from tribodyn.machine.planetary.ring_sensor import RingSensorSignal, ring_sensor_signal
from tribodyn.machine.planetary.stage_parts import PlanetaryStage
from tribodyn.machine.reduction import machine_structure, reduce_structure
from tribodyn.machine.rolling.ball_bearing import AngularContactBallBearing, DeepGrooveBallBearing
from tribodyn.machine.rolling.element_ring import BearingState, RollingElementBearing
from tribodyn.machine.rolling.roller_bearing import (
    ROLLING_BEARINGS,
    CylindricalRollerBearing,
    TaperedRollerBearing,
)
from tribodyn.machine.section import STEEL, Section
from tribodyn.machine.shaft import COUPLINGS, Coupling, CouplingModel, Shaft
from tribodyn.machine.shaft_matrices import ShaftMatrices
from tribodyn.machine.static.balance import (
    BearingBalance,
    MeshBalance,
    ShaftDeflection,
    StaticBalance,
    static_balance,
)
from tribodyn.machine.static.face_law import FaceLaw, face_laws
from tribodyn.machine.structure import MachineStructure, Reduction

__all__ = [
    "COUPLINGS",
    "ROLLING_BEARINGS",
    "STEEL",
    "AngularContactBallBearing",
    "Bearing",
    "BearingBalance",
    "BearingState",
    "Clock",
    "Coupling",
    "CouplingModel",
    "CrossedAxes",
    "CylindricalRollerBearing",
    "DeepGrooveBallBearing",
    "FaceLaw",
    "Gear",
    "GearBody",
    "HarmonicExcitation",
    "Housing",
    "LoadShares",
    "Machine",
    "MachineModes",
    "MachineStructure",
    "Mesh",
    "MeshBalance",
    "MeshDirection",
    "MeshLoad",
    "MeshPhases",
    "MeshedPlanets",
    "Operation",
    "Phases",
    "Placement",
    "PlanetaryKinematics",
    "PlanetaryModes",
    "PlanetaryPositions",
    "PlanetaryStage",
    "PowerFlow",
    "Reduction",
    "RingSensorSignal",
    "RollingElementBearing",
    "Section",
    "Shaft",
    "ShaftDeflection",
    "ShaftLoad",
    "ShaftMatrices",
    "StaticBalance",
    "SteppedPlanets",
    "TaperedRollerBearing",
    "face_laws",
    "hypoid_machine",
    "load_shares",
    "machine_modes",
    "machine_structure",
    "mesh_phases",
    "planetary_kinematics",
    "planetary_modes",
    "planetary_plane_model",
    "planetary_positions",
    "reduce_structure",
    "ring_sensor_signal",
    "static_balance",
    "sun_to_ring_lag",
    "system",
]

__getattr__ = aliases.old_module(__name__)
guard(__name__)
