"""Motions whose speed changes: run-ups and run-downs.

The public names stand on the page of :mod:`tribodyn.dynamics`.

| module | what it answers |
|---|---|
| ``run_up`` | the motion while the speed changes as prescribed, its samples and figures |
| ``run_up_tables`` | a prescribed speed, and the grids and tables that follow it |
| ``run_up_march`` | the march over the cycles, and the samples kept of it |
"""
