"""Periodic orbits: computed directly, and followed over the speed or any parameter.

The public names are those of :mod:`tribodyn.dynamics`.

| module | content |
|---|---|
| ``batched_orbits`` | orbits without loss of contact of many systems, computed together |
| ``continuation``, ``continuation_path`` | branches of orbits over a parameter, stable or not |
| ``orbit_map`` | the map of a state over one period, and Newton's method for its fixed point |
| ``periods`` | mesh cycles after which a motion repeats; a batch of systems over one of them |
| ``search`` | search for the orbit that a start approaches |
| ``solution_branch`` | result of a continuation |
| ``steady_state`` | the orbit at one speed, with a certified error |
"""
