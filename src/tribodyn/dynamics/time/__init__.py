"""Motion over time: single trajectories, ensembles, what is read off them."""
