"""Equations of motion: data of a structure, its entries over the mesh phase, its accelerations.

| module | content |
|---|---|
| `system` | a structure with its contacts and frictions |
| `phases` | cycles over several independent phases, and errors that turn with shafts |
| `entry` | entries as constants or functions of the mesh phase |
| `grid` | division of the mesh cycle into steps that end at events |
| `nodes` | entries of a system at both ends and in the middle of every step |
| `batched_tables` | the same for a batch of systems with the same structure |
| `motion` | forces and accelerations of a motion, in readable NumPy |
| `program` | the equations in flat arrays for the compiled kernels |
| `lane_parameters` | factors by which the lanes of an ensemble differ |
| `compiled` | one system, or one per lane, evaluated on a grid |
| `orbit_coordinates` | reduced coordinates in which a motion is periodic, static equilibrium |
| `step_limit` | largest stable step, recommended number of steps |
| `divergence` | error messages of failed integrations |
"""
