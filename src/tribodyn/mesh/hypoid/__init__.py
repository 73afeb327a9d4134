"""Hypoid pairs under load, and the mesh table that they fill.

| module | what it answers |
| --- | --- |
| `loaded_contact` | load of every cell, stiffness, transmission error, pressure |
| `harris` | transmission error over phase and torque |
| `friction` | film and friction of every cell, and what they sum up to |
| `table` | the same as a mesh table for the dynamics |
"""
