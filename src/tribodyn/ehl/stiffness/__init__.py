"""Stiffness and damping of the oil film.

| module | what it answers |
|---|---|
| ``film_stiffness`` | tangent, secant, and the sum as one source prints it |
| ``frequency`` | stiffness and damping against small vibrations, over the frequency |
"""
