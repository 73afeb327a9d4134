"""Signal analysis: indicators and spectra of a response or of a measured signal.

The page of :mod:`tribodyn.analysis` lists the public names of all modules; the indicators of gears
and the methods of diagnosis can be imported from this page too.

| module | what it answers |
|---|---|
| ``angular_resampling`` | what a signal is over the rotation of a shaft |
| ``cepstrum`` | which families of evenly spaced lines a signal has, and what it is without them |
| ``condition_indicators`` | all indicators of a gear at once |
| ``cyclic_coherence`` | which carriers are modulated at which frequencies |
| ``demodulation`` | amplitude and phase of a mesh harmonic over a revolution |
| ``envelope`` | envelope and its spectrum, sidebands, the most impulsive band |
| ``gear_indicators`` | whether teeth are damaged: FM0, FM4, NA4, NB4, M6A, M8A and others |
| ``indicators`` | mean, rms, ranges, dynamic factor, direction and harmonics of a response |
| ``order_map`` | how strong each multiple of the rotation is over the speed |
| ``run_up_orders`` | orders and levels of a run-up, and the natural modes of its peaks |
| ``spectrum`` | how strong each frequency is |
| ``synchronous_average`` | what repeats with the rotation, and its variance before a damage |
| ``uneven_transform`` | Fourier sums over uneven places |
"""

from tribodyn.arguments.pages import public_page

__all__, __getattr__, __dir__ = public_page(__name__, __file__)
