"""Damage of the surface of the flanks: scuffing, micropitting, and criteria point by point.

| module | content |
| --- | --- |
| `path_load` | load factors of scuffing; share of the load along the path |
| `scuffing_flash` | flash temperature: ISO/TS 6336-20 |
| `scuffing_integral` | integral temperature: ISO/TS 6336-21 |
| `micropitting` | specific film thickness: ISO/TS 6336-22, method B |
| `subsurface` | stress below a line contact with traction |
| `micropitting_test` | permissible film from the FZG micropitting test |
"""
