"""Faults of gears that repeat with a shaft: deviations, damage, and the mesh over whole turns.

| module | content |
|---|---|
| ``fault`` | what every fault answers: the gear, the gap and the compliance that it adds |
| ``deviations`` | eccentricity and waviness, pitch deviations of an accuracy class |
| ``flanks`` | slopes of profile and helix that differ from tooth to tooth, measured flanks |
| ``damage`` | spalls, broken teeth, root cracks |
| ``cracked_tooth`` | compliance of a cracked tooth by finite elements |
| ``cracked_face`` | the same over path and face, of a crack on a part of the face |
| ``turning`` | force law of a mesh over the turns of its gears |
| ``turning_table`` | the same of hypoid pairs, whose deviations are errors of the mesh |
| ``excitation`` | torque and speed over the turns of a shaft, random loads |
| ``driven`` | a system with them |
| ``bearing_defect`` | frequencies of a damaged rolling bearing and its impacts |
"""

from tribodyn.arguments import guard
from tribodyn.faults.bearing_defect import BearingDefect, BearingForce, BearingImpacts
from tribodyn.faults.cracked_face import crack_influence
from tribodyn.faults.cracked_tooth import crack_compliance
from tribodyn.faults.damage import BrokenTooth, Crack, Spall
from tribodyn.faults.deviations import (
    InclinedFlanks,
    PitchDeviations,
    Waviness,
    eccentricity,
    pitch_tolerances,
)
from tribodyn.faults.driven import DrivenSystem, clock_cycles, drive
from tribodyn.faults.excitation import RandomLoad, ShaftExcitation, SpeedFluctuation, TorqueRipple
from tribodyn.faults.fault import Fault
from tribodyn.faults.flanks import FlankDeviations, FlankTopographies, slope_tolerances
from tribodyn.faults.turning import TurningMesh, turning_mesh, turns_of

__all__ = [
    "BearingDefect",
    "BearingForce",
    "BearingImpacts",
    "BrokenTooth",
    "Crack",
    "DrivenSystem",
    "Fault",
    "FlankDeviations",
    "FlankTopographies",
    "InclinedFlanks",
    "PitchDeviations",
    "RandomLoad",
    "ShaftExcitation",
    "Spall",
    "SpeedFluctuation",
    "TorqueRipple",
    "TurningMesh",
    "Waviness",
    "clock_cycles",
    "crack_compliance",
    "crack_influence",
    "drive",
    "eccentricity",
    "pitch_tolerances",
    "slope_tolerances",
    "turning_mesh",
    "turns_of",
]

guard(__name__)
