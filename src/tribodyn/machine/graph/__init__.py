"""What follows from the graph of a machine before any matrix is built.

| module | what it answers |
|---|---|
| ``mobility`` | which meshes join which shafts, and which speeds the teeth allow |
| ``kinematics`` | speeds, torques and power of shafts and meshes |
| ``clock`` | how many mesh cycles and turns there are in a period |
| ``directions`` | along which direction a mesh pushes its gears |
| ``placement`` | where axes and gears are in space |
| ``bodies`` | mass and inertia of the gears |
| ``part_checks`` | what cannot be built |
"""
