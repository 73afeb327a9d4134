"""Compiled kernels of the line contact; private: nothing here is called from outside of ``ehl``.

| module | what it holds |
|---|---|
| ``elementary`` | how kernels are compiled; exponential and logarithm as vector instructions |
| ``reynolds`` | oil, fluxes, residual and exact tangent of the discrete equation |
| ``film_sum`` | elastic deflection by Fourier transforms |
| ``factors`` | elimination: of a band, of a dense matrix |
| ``linear_solver`` | GMRES with the tangent, preconditioned by its band and a coarse grid |
| ``newton`` | Newton's method on one grid, with the free outlet and with cavities |
| ``grid_transfer`` | free outlet, and a solution carried to other grids |
| ``inlet`` | flooded inlet before the grid, and the start of Grubin |
| ``steady`` | entries from Python: nested iteration; tangent of the film |
| ``transient`` | entry from Python: the contact over time |
| ``multigrid``, ``multigrid_levels`` | full multigrid; what a cycle does on one grid |
"""
