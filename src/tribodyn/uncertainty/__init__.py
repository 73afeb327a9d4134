"""What is known within bounds only: samples of inputs, bands of outputs, shares of the variance.

| module | what it answers |
|---|---|
| ``sampling`` | how a quantity is spread, and which values to compute with |
| ``bands`` | how well a mean curve is known |
| ``variance`` | which input the spread of an output comes from |
"""

from tribodyn.arguments import guard
from tribodyn.uncertainty.bands import Band, bootstrap_band
from tribodyn.uncertainty.sampling import distribution, sample
from tribodyn.uncertainty.variance import SobolIndices, sobol_indices

__all__ = ["Band", "SobolIndices", "bootstrap_band", "distribution", "sample", "sobol_indices"]

guard(__name__)
