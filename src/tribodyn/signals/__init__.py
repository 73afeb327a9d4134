"""Signals: figures and spectra of a motion or of a measured signal.

The public names stand on the page of :mod:`tribodyn.analysis`.

| module | what it answers |
|---|---|
| ``dynamic_factor`` | how much larger the force is than at rest, and in which direction it acts |
| ``envelope`` | how strong a signal is at each moment, and how that repeats |
| ``harmonics`` | how strong each multiple of the mesh frequency is |
| ``indicators`` | mean, rms, ranges |
| ``line_of_action`` | how much of a motion lies along the line of action |
| ``order_map`` | how strong each multiple of the rotation is over the speed |
| ``run_up_orders`` | the same for a run-up, and one order of it |
| ``run_up_resonances`` | which natural mode each peak of a run-up belongs to |
| ``sidebands`` | how a mesh harmonic is modulated |
| ``spectrogram`` | how a spectrum changes over time |
| ``spectrum`` | how strong each frequency is |
| ``synchronous_average`` | what repeats with the rotation, and what the rest tells of damage |
"""
