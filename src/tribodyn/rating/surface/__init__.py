"""Damage of the surface of the flanks: scuffing, micropitting, and criteria point by point.

| module | content |
| --- | --- |
| `path_load` | load factors of scuffing; share of the load along the path |
| `scuffing` | flash and integral temperature: ISO/TS 6336-20 and -21 |
| `micropitting` | specific film thickness: ISO/TS 6336-22, method B; test C-GF/8.3 |
| `subsurface` | stress below a line contact with traction |
"""
