"""Gear geometry: involute tooth, rack-generated outline, gear, pair, mass and inertia.

| module | content |
| --- | --- |
| `curves` | involute and fillet, the curves of a tooth |
| `tooth_form` | the basic rack, and the tooth that it cuts: circles, thickness, flank and fillet |
| `cylindrical_gear` | a gear with a body: values in their range, a tooth that can be made |
| `outline` | the outline of a tooth and of a gear as points |
| `mass_properties` | material, mass and moment of inertia |
| `mesh_geometry` | what follows from two tooth forms and a centre distance |
| `contact_lines` | overlap of two faces, and length of the lines of contact |
| `cylindrical_pair` | two gears that can run together |
| `pair_checks` | why two gears cannot run together |
| `pair_factory` | a pair from the figures of a drawing |
| `modification` | modifications and deviations of the flanks of a gear, also as a map |
| `flank_gap` | the gap that modified flanks, pitch deviations and run-out leave |
| `hypoid` | hypoid and spiral bevel pairs: blank, flanks, contact |
"""

from tribodyn.arguments import guard
from tribodyn.gear.contact_lines import FaceGeometry
from tribodyn.gear.cylindrical_gear import CylindricalGear, SpurGear
from tribodyn.gear.cylindrical_pair import CylindricalPair, SpurPair
from tribodyn.gear.flank_gap import (
    flank_gap,
    hunting_period,
    lead_gap,
    pitch_gap,
    profile_gap,
    run_out_gap,
    tooth_positions,
)
from tribodyn.gear.hypoid import (
    EaseOff,
    HypoidBlank,
    HypoidFlanks,
    HypoidKinematics,
    Misalignment,
    MisalignmentStudy,
    ToothContact,
    hypoid_blank,
    hypoid_flanks,
    hypoid_kinematics,
    misalignment_study,
    tooth_contact,
)
from tribodyn.gear.mass_properties import MassProperties, Material, mass_properties, section_moments
from tribodyn.gear.mesh_geometry import (
    FlankRange,
    MeshGeometry,
    default_relief_length,
    flank_ranges,
    operating_pressure_angle,
    tip_shortening_coefficient,
    zero_backlash_center_distance,
)
from tribodyn.gear.modification import FlankModification, ProfileMap
from tribodyn.gear.outline import gear_outline, half_tooth, tooth_outline
from tribodyn.gear.pair_factory import cylindrical_pair, spur_pair
from tribodyn.gear.tooth_form import BasicRack, ToothForm

__all__ = [
    "BasicRack",
    "CylindricalGear",
    "CylindricalPair",
    "EaseOff",
    "FaceGeometry",
    "FlankModification",
    "FlankRange",
    "HypoidBlank",
    "HypoidFlanks",
    "HypoidKinematics",
    "MassProperties",
    "Material",
    "MeshGeometry",
    "Misalignment",
    "MisalignmentStudy",
    "ProfileMap",
    "SpurGear",
    "SpurPair",
    "ToothContact",
    "ToothForm",
    "cylindrical_pair",
    "default_relief_length",
    "flank_gap",
    "flank_ranges",
    "gear_outline",
    "half_tooth",
    "hunting_period",
    "hypoid_blank",
    "hypoid_flanks",
    "hypoid_kinematics",
    "lead_gap",
    "mass_properties",
    "misalignment_study",
    "operating_pressure_angle",
    "pitch_gap",
    "profile_gap",
    "run_out_gap",
    "section_moments",
    "spur_pair",
    "tip_shortening_coefficient",
    "tooth_contact",
    "tooth_outline",
    "tooth_positions",
    "zero_backlash_center_distance",
]

guard(__name__)
