from tribodyn.stiffness.fe3d.bevel import FlankInfluence as FlankInfluence
from tribodyn.stiffness.fe3d.bevel import hypoid_influence as hypoid_influence
from tribodyn.stiffness.fe3d.bevel_sector import BevelSize as BevelSize
from tribodyn.stiffness.fe3d.provider import fe3d_influence as fe3d_influence
from tribodyn.stiffness.fe3d.sector import SolidSize as SolidSize
