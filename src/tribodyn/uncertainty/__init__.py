"""Uncertainty: samples of inputs, confidence bands of outputs, shares of the variance.

| module | content |
|---|---|
| ``sampling`` | distributions of quantities, samples of them, confidence band of a mean curve |
| ``variance`` | Sobol indices of the inputs |
"""

from tribodyn.arguments.pages import public_page

__all__, __getattr__, __dir__ = public_page(__name__, __file__)
