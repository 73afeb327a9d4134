"""The elastohydrodynamic film of a tooth contact: solved, or by formulas named by author.

| module | what it answers |
|---|---|
| ``models`` | film models by name, as a case file picks them |
| ``formulas`` | films by formula: which groups, which regime, which film |
| ``area`` | pressure and film of points, ellipses and lines of finite length |
| ``solver`` | the equations of a line contact on a grid, and their engines |
| ``steady`` | pressure and film of a contact at rest in its frame, one or many |
| ``transient`` | pressure and film while load, radius and speed change |
| ``thermal`` | the film with its heat: temperatures and shear across it, friction |
| ``film_stiffness`` | stiffness and damping of the film |
| ``traction`` | shear of the oil, and its temperature |
| ``asperities`` | summits of rough flanks from their roughness, and their contact |
| ``mixed_contact`` | how much of its load the film of a rough contact carries, and the regime |
| ``flow_factors`` | mean flow between rough surfaces |
| ``roughness`` | measured heights of a surface |
"""

from tribodyn.arguments.pages import public_page

__all__, __getattr__, __dir__ = public_page(__name__, __file__)
