"""HTML reports in one self-contained file that opens in a browser without a network."""

from tribodyn.arguments.pages import public_page

__all__, __getattr__, __dir__ = public_page(__name__, __file__)
