"""Signals: figures and spectra of a motion or of a measured signal.

The public names stand on the page of :mod:`tribodyn.analysis`.

| module | what it answers |
|---|---|
| ``angular_resampling`` | what a signal is over the rotation of a shaft |
| ``envelope`` | how strong a signal is at each moment, how that repeats, what modulates it |
| ``indicators`` | mean, rms, ranges, dynamic factor, direction and harmonics of a motion |
| ``order_map`` | how strong each multiple of the rotation is over the speed |
| ``run_up_orders`` | orders and levels of a run-up, and the natural modes of its peaks |
| ``spectrum`` | how strong each frequency is |
| ``synchronous_average`` | what repeats with the rotation, and what the rest tells of damage |
"""
