"""What was cut: involute tooth, rack-generated outline, gear, pair, mass and inertia."""

from tribodyn.gear.deviation import hunting_period, pitch_gap, run_out_gap, tooth_positions
from tribodyn.gear.flank_gap import flank_gap, lead_gap, profile_gap
from tribodyn.gear.flank_range import FlankRange, default_relief_length, flank_ranges
from tribodyn.gear.mass_properties import MassProperties, mass_properties, section_moments
from tribodyn.gear.material import Material
from tribodyn.gear.mesh_geometry import MeshGeometry
from tribodyn.gear.modification import FlankModification
from tribodyn.gear.modification_map import ProfileMap
from tribodyn.gear.outline import gear_outline, half_tooth, tooth_outline
from tribodyn.gear.pair_factory import spur_pair
from tribodyn.gear.pair_geometry import (
    operating_pressure_angle,
    tip_shortening_coefficient,
    zero_backlash_center_distance,
)
from tribodyn.gear.rack import BasicRack
from tribodyn.gear.spur_gear import SpurGear
from tribodyn.gear.spur_pair import SpurPair
from tribodyn.gear.tooth_form import ToothForm

__all__ = [
    "BasicRack",
    "FlankModification",
    "FlankRange",
    "MassProperties",
    "Material",
    "MeshGeometry",
    "ProfileMap",
    "SpurGear",
    "SpurPair",
    "ToothForm",
    "default_relief_length",
    "flank_gap",
    "flank_ranges",
    "gear_outline",
    "half_tooth",
    "hunting_period",
    "lead_gap",
    "mass_properties",
    "operating_pressure_angle",
    "pitch_gap",
    "profile_gap",
    "run_out_gap",
    "section_moments",
    "spur_pair",
    "tip_shortening_coefficient",
    "tooth_outline",
    "tooth_positions",
    "zero_backlash_center_distance",
]
