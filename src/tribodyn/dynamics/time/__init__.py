"""Time integration: single trajectories, ensembles, and their evaluation.

| module | content |
|---|---|
| `simulate` | motion of a system from a start |
| `ensemble` | many trajectories and their statistics |
| `engines` | registry of the engines that a case can choose |
| `newmark` | parameters and stability limit of Newmark's scheme |
| `adaptive_solution` | motion to a tolerance, with dense output |
| `response` | forces, accelerations and means along a motion |
| `energy` | energy balance of a motion |
"""
