"""Uncertainty: samples of inputs, confidence bands of outputs, shares of the variance.

| module | content |
|---|---|
| ``sampling`` | distributions of quantities, samples of them, confidence band of a mean curve |
| ``variance`` | Sobol indices of the inputs |
"""

from tribodyn.arguments import guard
from tribodyn.uncertainty.sampling import Band, bootstrap_band, distribution, sample
from tribodyn.uncertainty.variance import SobolIndices, sobol_indices

__all__ = ["Band", "SobolIndices", "bootstrap_band", "distribution", "sample", "sobol_indices"]

guard(__name__)
