"""Recorded signals and run-ups.

==============  ===============================================================
module          what it draws
==============  ===============================================================
``analysed``    one analysed channel of a recording, its history
``bands``       any figure of a run with the spread of variants on it
``learned``     spread motions with bands, learned over computed values
``lines``       spectra of a signal, sidebands, one order or the level over the speed
``maps``        spectrogram, order map, spectra one behind the other
``recorded``    channels of a recording, its orders, orders through time
``revolution``  the mean revolution of a shaft, its residual and difference
``run_up``      level and mesh orders over the speed, amplitudes over frequency
``sensitivity`` shares of the variance of figures of a case by tolerance
``uncertain``   shares of a variance, the band of a mean, columns of computed data
==============  ===============================================================
"""
