"""The equations of a line contact on a grid, and their engines.

| module | what it answers |
|---|---|
| ``contact_case`` | is what the user gave a contact, and what are its dimensionless numbers |
| ``grid`` | how far the grid reaches, the inlet before it, and how many nodes it has |
| ``contact_problem`` | problem and outcome of an engine |
| ``engines`` | the two engines: Newton and multigrid |
| ``fallbacks`` | verification of solutions, the fallbacks when an engine fails, rough surfaces |
| ``grid_error`` | how far a solution is from that on finer grids |
"""
