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

from tribodyn.arguments.pages import public_page

__all__, __getattr__, __dir__ = public_page(__name__, __file__)
