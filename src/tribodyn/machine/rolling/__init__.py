"""Rolling bearings: load and stiffness from geometry, at the working load.

| module | content |
| --- | --- |
| `element_ring` | sum over a ring of rolling elements, balance of a load |
| `ball_bearing` | deep groove and angular contact ball bearings, Hertzian point contact |
| `roller_bearing` | cylindrical and tapered ones, line contact in laminae; all types by name |
"""
