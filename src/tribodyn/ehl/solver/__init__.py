"""The equations of a line contact on a grid, and their engines.

| module | what it answers |
|---|---|
| ``contact_case`` | is what the user gave a contact; its dimensionless numbers and its problem |
| ``grid`` | how far the grid reaches, the inlet before it, and how many nodes it has |
| ``engines`` | the two engines: Newton and multigrid; how far both are from finer grids |
| ``fallbacks`` | verification of solutions, the fallbacks when an engine fails, rough surfaces |
"""
