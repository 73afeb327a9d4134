"""Faults of gears that repeat with a shaft: deviations, damage, and the mesh over whole turns.

| module | content |
|---|---|
| ``fault`` | what every fault answers: the gear, the gap and the compliance that it adds |
| ``deviations`` | eccentricity and waviness, pitch deviations of an accuracy class |
| ``damage`` | spalls, broken teeth, root cracks |
| ``cracked_tooth`` | compliance of a cracked tooth by finite elements |
| ``turning`` | force law of a mesh over the turns of its gears |
| ``bearing_defect`` | frequencies of a damaged rolling bearing and its impacts |
"""

from tribodyn.arguments import guard
from tribodyn.faults.bearing_defect import BearingDefect
from tribodyn.faults.cracked_tooth import crack_compliance
from tribodyn.faults.damage import BrokenTooth, Crack, Spall
from tribodyn.faults.deviations import PitchDeviations, Waviness, eccentricity, pitch_tolerances
from tribodyn.faults.fault import Fault
from tribodyn.faults.turning import TurningMesh, turning_mesh, turns_of

__all__ = [
    "BearingDefect",
    "BrokenTooth",
    "Crack",
    "Fault",
    "PitchDeviations",
    "Spall",
    "TurningMesh",
    "Waviness",
    "crack_compliance",
    "eccentricity",
    "pitch_tolerances",
    "turning_mesh",
    "turns_of",
]

guard(__name__)
