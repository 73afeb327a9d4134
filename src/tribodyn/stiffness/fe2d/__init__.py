"""Finite elements of a whole gear: what a load on one tooth does there and at the others."""

from tribodyn.stiffness.fe2d.picture import deformed_gear
from tribodyn.stiffness.fe2d.provider import fe2d_influence
from tribodyn.stiffness.fe2d.tooth_mesh import MeshSize

__all__ = ["MeshSize", "deformed_gear", "fe2d_influence"]
