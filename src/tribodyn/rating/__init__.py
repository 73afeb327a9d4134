"""Load capacity of gears by ISO 6336: pitting, bending, scuffing, micropitting.

| module | content |
| --- | --- |
| `pair_rating` | pitting and bending of a cylindrical gear pair under one load |
| `spectrum` | the same under a load spectrum, damage by Miner: ISO 6336-6 |
| `factor` | a factor with unit, source and branch |
| `conditions` | application factor, life, edition, design of the leads, required safeties |
| `rated_gear` | material, accuracy, roughness and load cycles of a gear; its cutter and shaft |
| `materials` | strength by type, grade and hardness: ISO 6336-5 |
| `oil` | the oil as ratings need it |
| `tolerances` | deviations by accuracy grade: ISO 1328-1 |
| `mesh_load` | forces, speeds and running-in of one mesh |
| `influence` | K_v, K_Hbeta, K_Halpha: ISO 6336-1 |
| `pitting` | contact stress and its limit: ISO 6336-2 |
| `root_section`, `bending` | root stress and its limit: ISO 6336-3 |
| `root_elements` | root stress by finite elements, compared with it |
| `surface` | scuffing, micropitting: ISO/TS 6336-20, -21, -22; stress below the surface |
| `elements` | life of rolling bearings, shafts, load cycles: ISO 281, ISO/TS 16281, DIN 743 |
| `life` | Z_NT, Y_NT and cycles to failure |
"""

from tribodyn.arguments import guard
from tribodyn.rating.conditions import RatingConditions
from tribodyn.rating.elements.bearing_life import (
    BearingLife,
    RatedBearing,
    bearing_life,
    contamination_factor,
    deep_groove_load,
    life_modification_factor,
    reference_viscosity,
    system_life,
)
from tribodyn.rating.elements.element_life import ball_bearing_life, roller_bearing_life
from tribodyn.rating.elements.rainflow import LoadCycles, rainflow_cycles
from tribodyn.rating.elements.shaft_fatigue import (
    ShaftMaterial,
    ShaftNotch,
    ShaftRating,
    ShaftStress,
    rate_shaft,
)
from tribodyn.rating.factor import Factor
from tribodyn.rating.influence.dynamic_factor import DynamicFactor, dynamic_factor
from tribodyn.rating.influence.face_load import face_load_factor
from tribodyn.rating.life import cycles_to_failure, life_factor
from tribodyn.rating.materials import GearMaterial
from tribodyn.rating.oil import GearOil
from tribodyn.rating.pair_rating import GearRating, PairRating, rate_pair
from tribodyn.rating.rated_gear import PinionShaft, RatedGear, ShaperCutter
from tribodyn.rating.root_elements import RootStress, root_stress_by_elements
from tribodyn.rating.spectrum import (
    GearDamage,
    SpectrumLoad,
    SpectrumRating,
    load_classes,
    rate_spectrum,
)
from tribodyn.rating.surface.subsurface import (
    LineContactStress,
    SubsurfaceExposure,
    line_contact_stress,
    subsurface_exposure,
)
from tribodyn.rating.tolerances import Deviations, gear_tolerances

__all__ = [
    "BearingLife",
    "Deviations",
    "DynamicFactor",
    "Factor",
    "GearDamage",
    "GearMaterial",
    "GearOil",
    "GearRating",
    "LineContactStress",
    "LoadCycles",
    "PairRating",
    "PinionShaft",
    "RatedBearing",
    "RatedGear",
    "RatingConditions",
    "RootStress",
    "ShaftMaterial",
    "ShaftNotch",
    "ShaftRating",
    "ShaftStress",
    "ShaperCutter",
    "SpectrumLoad",
    "SpectrumRating",
    "SubsurfaceExposure",
    "ball_bearing_life",
    "bearing_life",
    "contamination_factor",
    "cycles_to_failure",
    "deep_groove_load",
    "dynamic_factor",
    "face_load_factor",
    "gear_tolerances",
    "life_factor",
    "life_modification_factor",
    "line_contact_stress",
    "load_classes",
    "rainflow_cycles",
    "rate_pair",
    "rate_shaft",
    "rate_spectrum",
    "reference_viscosity",
    "roller_bearing_life",
    "root_stress_by_elements",
    "subsurface_exposure",
    "system_life",
]

guard(__name__)
