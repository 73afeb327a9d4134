"""Recorded signals and run-ups.

==============  ===============================================================
module          what it draws
==============  ===============================================================
``analysed``    analysis of a recorded channel, time history of the channel
``bands``       any figure of a run with a band of case variants
``learned``     response of case variants with bands; surrogate against computation
``lines``       signal spectra, sidebands, order cut and overall level over the speed
``maps``        spectrogram, order map, waterfall
``recorded``    channels of a recording, order spectrum, tracked orders
``revolution``  synchronous average of a shaft, residual and difference signal
``run_up``      run-up: level and mesh orders over speed, map over frequency
``sensitivity`` variance shares of summary figures by tolerance
``uncertain``   Sobol indices, band of a mean, columns of computed data
==============  ===============================================================
"""
