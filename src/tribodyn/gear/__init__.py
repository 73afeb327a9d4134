"""What was cut: involute tooth, rack-generated outline, gear, pair, mass and inertia."""

from tribodyn.gear.mass_properties import MassProperties, mass_properties, section_moments
from tribodyn.gear.material import Material
from tribodyn.gear.mesh_geometry import MeshGeometry
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
    "MassProperties",
    "Material",
    "MeshGeometry",
    "SpurGear",
    "SpurPair",
    "ToothForm",
    "gear_outline",
    "half_tooth",
    "mass_properties",
    "operating_pressure_angle",
    "section_moments",
    "spur_pair",
    "tip_shortening_coefficient",
    "tooth_outline",
    "zero_backlash_center_distance",
]
