"""Linear analysis of a structure about its static load.

The public names are those of :mod:`tribodyn.dynamics`.

| module | content |
|---|---|
| ``linear_system`` | matrices about the static load |
| ``natural_modes`` | natural frequencies, modes and their energy shares |
| ``forced_response`` | response to a harmonic transmission error |
| ``campbell`` | speeds at which mesh orders meet natural frequencies |
"""
