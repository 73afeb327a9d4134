"""Lumped structures with time-varying contacts: steady states, transients, ensembles."""

from tribodyn.arguments.pages import public_page

__all__, __getattr__, __dir__ = public_page(__name__, __file__)
