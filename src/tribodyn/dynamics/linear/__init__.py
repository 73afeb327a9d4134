"""Linear analysis of a structure about its static load.

The public names are those of :mod:`tribodyn.dynamics`.

| module | content |
|---|---|
| ``linear_system`` | matrices about the static load; response to a transmission error |
| ``natural_modes`` | natural frequencies, modes and their energy shares |
| ``campbell`` | speeds at which mesh orders meet natural frequencies |
"""
