"""Motions with varying speed: run-ups, run-downs, steady motions over the speed.

The public names are those of :mod:`tribodyn.dynamics`.

| module | content |
|---|---|
| ``run_up`` | the motion while the speed changes as prescribed |
| ``run_up_tables`` | grids and row tables that follow the speed |
| ``run_up_march`` | integration cycle by cycle, and the recorded samples |
| ``run_up_result`` | prescribed speed, samples and figures of every mesh cycle |
| ``speed_sweep``, ``speed_sweep_follow`` | steady motions over the speed, upwards and downwards |
"""
