"""Kinematics and dry mechanics of the contact: path of contact, speeds, Hertz, loss factor.

| module | content |
| --- | --- |
| `path` | positions of tooth pairs on the line of action, and motion of their flanks |
| `face_contacts` | lines of contact of helical gears in slices of the face width |
| `separation` | separation of the teeth before and after the path of contact |
| `loss_factor` | equal load shares, and the gear loss factor by integration |
| `hertz` | half width and pressure of a line contact, half axes of an elliptical one |
"""

from tribodyn.arguments.pages import public_page

__all__, __getattr__, __dir__ = public_page(__name__, __file__)
