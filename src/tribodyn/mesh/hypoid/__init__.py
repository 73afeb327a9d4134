"""Hypoid pairs under load, and the mesh table that they fill.

| module | what it answers |
| --- | --- |
| `cells` | contact lines in cells, and the forces of their springs |
| `coupled` | the same on the compliance of the teeth by finite elements |
| `loaded_contact` | load of every cell, stiffness, transmission error, pressure |
| `film` | oil film of every cell, in series with the teeth |
| `friction` | film and friction of every cell, and what they sum up to |
| `table` | the same as a mesh table for the dynamics; transmission error over torque |
"""
