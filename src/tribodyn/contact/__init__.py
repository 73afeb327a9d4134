"""Kinematics and dry mechanics of the contact: path of contact, speeds, Hertz, loss factor.

| module | content |
| --- | --- |
| `path` | positions of tooth pairs on the line of action, and motion of their flanks |
| `face_contacts` | lines of contact of helical gears in slices of the face width |
| `separation` | separation of the teeth before and after the path of contact |
| `loss_factor` | equal load shares, and the gear loss factor by integration |
| `hertz` | half width and pressure of a line contact, half axes of an elliptical one |
"""

from tribodyn.arguments import guard
from tribodyn.contact.face_contacts import FaceContacts, face_contacts
from tribodyn.contact.hertz import (
    HertzEllipse,
    HertzLine,
    effective_modulus,
    hertz_ellipse,
    hertz_line,
)
from tribodyn.contact.loss_factor import equal_share, gear_loss_factor
from tribodyn.contact.path import Kinematics, PathOfContact, path_of_contact
from tribodyn.contact.separation import ExtendedContact, extended_contact

__all__ = [
    "ExtendedContact",
    "FaceContacts",
    "HertzEllipse",
    "HertzLine",
    "Kinematics",
    "PathOfContact",
    "effective_modulus",
    "equal_share",
    "extended_contact",
    "face_contacts",
    "gear_loss_factor",
    "hertz_ellipse",
    "hertz_line",
    "path_of_contact",
]

guard(__name__)
