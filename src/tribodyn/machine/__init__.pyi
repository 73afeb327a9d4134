from tribodyn.machine.assembly import system as system
from tribodyn.machine.bearing import Bearing as Bearing
from tribodyn.machine.gear import Gear as Gear
from tribodyn.machine.graph.bodies import GearBody as GearBody
from tribodyn.machine.graph.clock import Clock as Clock
from tribodyn.machine.graph.clock import Phases as Phases
from tribodyn.machine.graph.crossed import CrossedAxes as CrossedAxes
from tribodyn.machine.graph.directions import MeshDirection as MeshDirection
from tribodyn.machine.graph.kinematics import MeshLoad as MeshLoad
from tribodyn.machine.graph.kinematics import PowerFlow as PowerFlow
from tribodyn.machine.graph.kinematics import ShaftLoad as ShaftLoad
from tribodyn.machine.graph.placement import Placement as Placement
from tribodyn.machine.housing import Housing as Housing
from tribodyn.machine.hypoid.pair_machine import hypoid_machine as hypoid_machine
from tribodyn.machine.machine import Machine as Machine
from tribodyn.machine.machine import Operation as Operation
from tribodyn.machine.mesh import Mesh as Mesh
from tribodyn.machine.modes import MachineModes as MachineModes
from tribodyn.machine.modes import machine_modes as machine_modes
from tribodyn.machine.planetary.double_planets import MeshedPlanets as MeshedPlanets
from tribodyn.machine.planetary.double_planets import SteppedPlanets as SteppedPlanets
from tribodyn.machine.planetary.kinematics import PlanetaryKinematics as PlanetaryKinematics
from tribodyn.machine.planetary.kinematics import planetary_kinematics as planetary_kinematics
from tribodyn.machine.planetary.load_sharing import LoadShares as LoadShares
from tribodyn.machine.planetary.load_sharing import load_shares as load_shares
from tribodyn.machine.planetary.mesh_laws import sun_to_ring_lag as sun_to_ring_lag
from tribodyn.machine.planetary.modes import PlanetaryModes as PlanetaryModes
from tribodyn.machine.planetary.modes import planetary_modes as planetary_modes
from tribodyn.machine.planetary.phases import HarmonicExcitation as HarmonicExcitation
from tribodyn.machine.planetary.phases import MeshPhases as MeshPhases
from tribodyn.machine.planetary.phases import mesh_phases as mesh_phases
from tribodyn.machine.planetary.plane_model import planetary_plane_model as planetary_plane_model
from tribodyn.machine.planetary.positions import PlanetaryPositions as PlanetaryPositions
from tribodyn.machine.planetary.positions import planetary_positions as planetary_positions
from tribodyn.machine.planetary.ring_sensor import RingSensorSignal as RingSensorSignal
from tribodyn.machine.planetary.ring_sensor import ring_sensor_signal as ring_sensor_signal
from tribodyn.machine.planetary.stage_parts import PlanetaryStage as PlanetaryStage
from tribodyn.machine.reduction import machine_structure as machine_structure
from tribodyn.machine.reduction import reduce_structure as reduce_structure
from tribodyn.machine.rolling.ball_bearing import (
    AngularContactBallBearing as AngularContactBallBearing,
)
from tribodyn.machine.rolling.ball_bearing import DeepGrooveBallBearing as DeepGrooveBallBearing
from tribodyn.machine.rolling.element_ring import BearingState as BearingState
from tribodyn.machine.rolling.element_ring import RollingElementBearing as RollingElementBearing
from tribodyn.machine.rolling.roller_bearing import ROLLING_BEARINGS as ROLLING_BEARINGS
from tribodyn.machine.rolling.roller_bearing import (
    CylindricalRollerBearing as CylindricalRollerBearing,
)
from tribodyn.machine.rolling.roller_bearing import TaperedRollerBearing as TaperedRollerBearing
from tribodyn.machine.section import STEEL as STEEL
from tribodyn.machine.section import Section as Section
from tribodyn.machine.shaft import COUPLINGS as COUPLINGS
from tribodyn.machine.shaft import Coupling as Coupling
from tribodyn.machine.shaft import CouplingModel as CouplingModel
from tribodyn.machine.shaft import Shaft as Shaft
from tribodyn.machine.shaft_matrices import ShaftMatrices as ShaftMatrices
from tribodyn.machine.static.balance import BearingBalance as BearingBalance
from tribodyn.machine.static.balance import MeshBalance as MeshBalance
from tribodyn.machine.static.balance import ShaftDeflection as ShaftDeflection
from tribodyn.machine.static.balance import StaticBalance as StaticBalance
from tribodyn.machine.static.balance import static_balance as static_balance
from tribodyn.machine.static.face_law import FaceLaw as FaceLaw
from tribodyn.machine.static.face_law import face_laws as face_laws
from tribodyn.machine.structure import MachineStructure as MachineStructure
from tribodyn.machine.structure import Reduction as Reduction
