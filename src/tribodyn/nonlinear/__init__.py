"""Nonlinear motions: which there are, where they change, and whether they are physics.

The public names stand on the page of :mod:`tribodyn.analysis`.

| module | what it answers |
|---|---|
| ``attractors`` | how many motions are marched side by side until they repeat |
| ``basins`` | which motion a start comes to |
| ``bifurcation`` | how motions change over a parameter |
| ``lyapunov`` | how fast motions that begin side by side part |
| ``parameter_map`` | how motions change over two parameters |
| ``phase_portrait`` | how a motion looks in its phase plane |
| ``poincare`` | after how many mesh cycles a motion repeats |
| ``verdict`` | whether half the step gives the same motion |
"""
