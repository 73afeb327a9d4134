"""Signal analysis: indicators and spectra of a response or of a measured signal.

The public names are listed on the page of :mod:`tribodyn.analysis`.

| module | what it answers |
|---|---|
| ``angular_resampling`` | what a signal is over the rotation of a shaft |
| ``envelope`` | how strong a signal is at each moment, how that repeats, what modulates it |
| ``indicators`` | mean, rms, ranges, dynamic factor, direction and harmonics of a response |
| ``order_map`` | how strong each multiple of the rotation is over the speed |
| ``run_up_orders`` | orders and levels of a run-up, and the natural modes of its peaks |
| ``spectrum`` | how strong each frequency is |
| ``synchronous_average`` | what repeats with the rotation, and damage indicators from it |
"""
