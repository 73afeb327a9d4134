"""Nonlinear dynamics: coexisting motions, bifurcations, and whether they are physical or numerical.

The public names are listed on the page of :mod:`tribodyn.analysis`.

| module | what it answers |
|---|---|
| ``attractors`` | how a batch of motions is integrated until each repeats |
| ``basins``, ``basins_attractors``, ``start_plane`` | which motion each start comes to |
| ``bifurcation``, ``bifurcation_sweep`` | how motions change over a parameter, up and down |
| ``lyapunov``, ``lyapunov_tangent``, ``lyapunov_products`` | rate at which nearby motions diverge |
| ``parameter_map`` | how motions change over two parameters |
| ``poincare`` | after how many mesh cycles a motion repeats, and its phase plane |
| ``survey`` | how motions are marched, measured and judged by half the step |
"""
