"""Where teeth touch and how they move there: path of contact, speeds, Hertz, loss factor."""

from tribodyn.contact.hertz import HertzLine, effective_modulus, hertz_line
from tribodyn.contact.kinematics import Kinematics
from tribodyn.contact.loss_factor import equal_share, gear_loss_factor
from tribodyn.contact.path import PathOfContact, path_of_contact
from tribodyn.contact.separation import ExtendedContact, extended_contact

__all__ = [
    "ExtendedContact",
    "HertzLine",
    "Kinematics",
    "PathOfContact",
    "effective_modulus",
    "equal_share",
    "extended_contact",
    "gear_loss_factor",
    "hertz_line",
    "path_of_contact",
]
