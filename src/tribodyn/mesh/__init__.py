"""Mesh tables: the tooth contact over one mesh cycle, computed, stored and plotted."""

from tribodyn.arguments.pages import public_page

__all__, __getattr__, __dir__ = public_page(__name__, __file__)
