"""Recorded signals and run-ups.

============  ===============================================================
module        what it draws
============  ===============================================================
``bands``     any figure of a run with the spread of variants on it
``learned``   spread motions with bands, learned over computed values
``maps``      spectrogram, order map, spectra one behind the other
``recorded``  channels of a recording, its orders, orders through time
``run_up``    level and mesh orders over the speed, amplitudes over frequency
============  ===============================================================
"""
