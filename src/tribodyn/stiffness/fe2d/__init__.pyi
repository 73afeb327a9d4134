from tribodyn.stiffness.fe2d.picture import deformed_gear as deformed_gear
from tribodyn.stiffness.fe2d.provider import fe2d_influence as fe2d_influence
from tribodyn.stiffness.fe2d.tooth_mesh import MeshSize as MeshSize
