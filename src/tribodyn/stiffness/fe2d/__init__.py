"""Finite elements of a complete gear: influence of a load on its tooth and on the others.

| module | content |
| --- | --- |
| `provider` | influence of one gear, looked up on disk or computed |
| `tooth_mesh` | mesh of the sector of one tooth |
| `ring` | elements of that mesh, and the whole ring from one sector |
| `flank_load` | nodal forces of a load on the flank |
| `picture` | the deformed gear for a figure |
"""

from tribodyn.arguments.pages import public_page

__all__, __getattr__, __dir__ = public_page(__name__, __file__)
