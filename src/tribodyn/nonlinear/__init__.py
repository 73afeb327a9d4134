"""Nonlinear motions: which there are, where they change, and whether they are physics.

The public names stand on the page of :mod:`tribodyn.analysis`.

| module | what it answers |
|---|---|
| ``attractors`` | how many motions are marched side by side until they repeat |
| ``basins``, ``basins_attractors``, ``start_plane`` | which motion each start comes to |
| ``bifurcation``, ``bifurcation_sweep`` | how motions change over a parameter, up and down |
| ``lyapunov``, ``lyapunov_tangent``, ``lyapunov_products`` | how fast neighbouring motions part |
| ``parameter_map`` | how motions change over two parameters |
| ``poincare`` | after how many mesh cycles a motion repeats, and its phase plane |
| ``survey`` | how motions are marched, measured and judged by half the step |
"""
