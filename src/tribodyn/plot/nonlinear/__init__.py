"""Nonlinear responses over parameters and initial states.

============  =============================================================
module        what it draws
============  =============================================================
``planes``    phase portrait, Poincare section, exponents, basins, parameter maps
``branches``  bifurcation diagrams, branches of periodic orbits
============  =============================================================
"""
