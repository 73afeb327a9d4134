"""Figures read off a motion: rms, peaks, mesh harmonics, spectra, direction indicator."""

from tribodyn.arguments.pages import public_page

__all__, __getattr__, __dir__ = public_page(__name__, __file__)
