"""Recorded signals and run-ups.

=============  ======================================================================
module         what it draws
=============  ======================================================================
``bands``      spread of case variants in any figure; surrogate against computation
``diagnosis``  mean revolution, demodulation, cepstrum, kurtogram, coherence
``spectra``    signal spectra, sidebands, order cut, level, spectrogram, order map, waterfall
``recorded``   channels of a recording, their analysis, orders, comparison with a run
``run_up``     run-up: level and mesh orders over speed, map over frequency
``uncertain``  variance shares of inputs, band of a mean, columns of computed data
=============  ======================================================================
"""
