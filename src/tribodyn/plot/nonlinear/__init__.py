"""Nonlinear responses over parameters and initial states.

===============  =============================================================
module           what it draws
===============  =============================================================
``planes``       basins of attraction and maps over two parameters
``branches``     bifurcation diagrams, branches of periodic orbits
``phase_plane``  phase portrait, Poincare section, Lyapunov exponents
===============  =============================================================
"""
