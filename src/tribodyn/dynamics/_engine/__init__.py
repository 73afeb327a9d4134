"""Compiled time integration; private, used through `tribodyn.dynamics.time`.

A lane is one trajectory of a block of trajectories that are integrated together (SIMD).

| module | content |
|---|---|
| `lanes` | vector type of the compiled code: one number per lane |
| `contact_forces` | equation of motion: contact forces, frictions, accelerations |
| `method` | interface of the fixed-step methods |
| `runge_kutta`, `newmark` | one step of each fixed-step method |
| `dormand_prince` | one adaptive step, its error estimate and its dense output; rows at any phase |
| `crossing` | location of contact loss and contact gain within a step |
| `statistics` | signals whose statistics are accumulated, and their order |
| `running_statistics` | accumulation of the statistics during the integration |
| `midpoint` | state in the middle of a step, needed for the statistics |
| `marching` | integration loop of a block of lanes with fixed steps |
| `adaptive` | integration loop of a block of lanes, each with adaptive steps of its own |
| `blocks` | fixed steps: distribution over blocks and threads, report of failures |
| `adaptive_engine` | adaptive steps: tolerances of each trajectory, report of failures |
| `row_table` | entries of the system as polynomials between the nodes of a grid fine enough |
"""
