"""Stiffness of tooth pairs, and load sharing of a mesh under load.

| module | content |
| --- | --- |
| `model` | interface of stiffness models, and their selection by name from :data:`MODELS` |
| `models` | the models of the literature, one in each file |
| `teeth` | compliance of one gear under a load on a tooth, in closed form |
| `fe2d` | the same from finite elements of the whole gear |
| `fe3d` | the same with the face width: slices of the face that are coupled |
| `loaded` | load sharing, transmission error and stiffness of a mesh under load |
| `tip_relief` | transmission error over torque, the best tip relief, crowning and slope |
"""

from importlib import import_module

from tribodyn.arguments.pages import public_page

__all__, __getattr__, __dir__ = public_page(__name__, __file__)
for _models in ("loaded", "models.iso6336", "models.potential_energy", "models.prescribed"):
    import_module(f"{__name__}.{_models}")  # they register
