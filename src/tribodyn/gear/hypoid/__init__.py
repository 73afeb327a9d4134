"""Hypoid and spiral bevel pairs: blank, flanks, and where they touch.

| module | what it answers |
| --- | --- |
| `pitch_cones` | the cones that touch in the calculation point |
| `dimensions` | all dimensions of both blanks that follow from them |
| `blank` | a pair of blanks from the figures of a drawing |
| `ease_off` | what a flank has less than its conjugate |
| `wheel_flanks` | flanks of generated and of face-hobbed wheels |
| `envelope` | the conjugate of any flank, its curvature and its undercut |
| `conjugate` | one side of a pair: both surfaces and the ends of the flanks |
| `flank` | both flanks as grids of points, for export |
| `tooth_contact` | path of contact, transmission error, pattern, with axes that are misplaced |
| `misalignment_study` | contact and transmission error with displaced gears |
| `kinematics` | how the flanks roll and slide in every cell |
"""

from tribodyn.gear.hypoid.blank import HypoidBlank, hypoid_blank
from tribodyn.gear.hypoid.ease_off import EaseOff
from tribodyn.gear.hypoid.flank import HypoidFlanks, hypoid_flanks
from tribodyn.gear.hypoid.kinematics import HypoidKinematics, hypoid_kinematics
from tribodyn.gear.hypoid.misalignment_study import MisalignmentStudy, misalignment_study
from tribodyn.gear.hypoid.tooth_contact import Misalignment, ToothContact, tooth_contact

__all__ = [
    "EaseOff",
    "HypoidBlank",
    "HypoidFlanks",
    "HypoidKinematics",
    "Misalignment",
    "MisalignmentStudy",
    "ToothContact",
    "hypoid_blank",
    "hypoid_flanks",
    "hypoid_kinematics",
    "misalignment_study",
    "tooth_contact",
]
