"""The linear view of a structure about its static load.

The public names stand on the page of :mod:`tribodyn.dynamics`.

| module | what it answers |
|---|---|
| ``natural_modes`` | natural frequencies, modes and where their energy sits |
| ``forced_response`` | what a harmonic transmission error does |
| ``campbell`` | at which speeds mesh orders meet natural frequencies |
"""
