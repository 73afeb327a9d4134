"""Periodic orbits: found directly, and followed over the speed or any parameter.

The public names stand on the page of :mod:`tribodyn.dynamics`.

| module | what it answers |
|---|---|
| ``alike_lanes`` | how systems alike march over one mesh cycle together |
| ``continuation``, ``continuation_path`` | where a branch of orbits goes, stable or not |
| ``coordinates`` | in which coordinates a motion closes |
| ``orbit_map`` | where states are after one period, and which of them close |
| ``periods`` | after how many mesh cycles a motion repeats |
| ``search`` | which orbit a start comes to, and whether it stays in touch on the way |
| ``side_by_side`` | which motions of many systems alike stay in touch, all found together |
| ``solution_branch`` | what a branch of orbits holds |
| ``speed_sweep``, ``speed_sweep_follow`` | what a slow sweep of the speed meets, up and down |
| ``steady_state`` | the orbit at one speed, with a certified error |
"""
