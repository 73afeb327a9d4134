"""Where teeth touch and how they move there: path of contact, speeds, Hertz, loss factor.

| module | what it answers |
| --- | --- |
| `path` | where on the line of action tooth pairs are, and how their flanks move there |
| `separation` | how far teeth are apart before and after the path of contact |
| `hertz` | half width and pressure of a line contact, half axes of an elliptical one |
"""

from tribodyn.arguments import guard
from tribodyn.contact.hertz import (
    HertzEllipse,
    HertzLine,
    effective_modulus,
    hertz_ellipse,
    hertz_line,
)
from tribodyn.contact.path import (
    Kinematics,
    PathOfContact,
    equal_share,
    gear_loss_factor,
    path_of_contact,
)
from tribodyn.contact.separation import ExtendedContact, extended_contact

__all__ = [
    "ExtendedContact",
    "HertzEllipse",
    "HertzLine",
    "Kinematics",
    "PathOfContact",
    "effective_modulus",
    "equal_share",
    "extended_contact",
    "gear_loss_factor",
    "hertz_ellipse",
    "hertz_line",
    "path_of_contact",
]

guard(__name__)
