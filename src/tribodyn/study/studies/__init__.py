"""Studies of a case: sweeps, bifurcation diagrams, run-ups, tooth contacts at rest."""
