"""Motions over parameters and starts.

===============  =============================================================
module           what it draws
===============  =============================================================
``planes``       planes of starts or of two parameters, coloured by the motion
``branches``     bifurcation diagrams, branches of periodic motions
``phase_plane``  phase portrait, Poincare section, Lyapunov exponents
===============  =============================================================
"""
