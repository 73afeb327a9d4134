"""Finite elements of a complete gear: influence of a load on its tooth and on the others.

| module | content |
| --- | --- |
| `provider` | influence of one gear, looked up on disk or computed |
| `tooth_mesh` | mesh of the sector of one tooth |
| `ring` | elements of that mesh, and the whole ring from one sector |
| `flank_load` | nodal forces of a load on the flank |
| `picture` | the deformed gear for a figure |
"""

from tribodyn.stiffness.fe2d.picture import deformed_gear
from tribodyn.stiffness.fe2d.provider import fe2d_influence
from tribodyn.stiffness.fe2d.tooth_mesh import MeshSize

__all__ = ["MeshSize", "deformed_gear", "fe2d_influence"]
