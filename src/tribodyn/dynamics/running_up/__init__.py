"""Motions whose speed changes: run-ups and run-downs.

The public names stand on the page of :mod:`tribodyn.dynamics`.

| module | what it answers |
|---|---|
| ``run_up`` | the motion while the speed changes as prescribed |
| ``run_up_profile`` | when each mesh phase is reached |
| ``run_up_tables`` | grids and tables that follow the speed |
| ``run_up_march`` | the march over the cycles, and the samples kept of it |
| ``run_up_result`` | samples and figures of every mesh cycle |
"""
