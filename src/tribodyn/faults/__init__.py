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

from tribodyn.arguments.pages import public_page

__all__, __getattr__, __dir__ = public_page(__name__, __file__)
