"""Studies of machines: points of sweeps, motions over the speed, run-ups, ensembles."""
