from tribodyn.uncertainty.sampling import Band as Band
from tribodyn.uncertainty.sampling import bootstrap_band as bootstrap_band
from tribodyn.uncertainty.sampling import distribution as distribution
from tribodyn.uncertainty.sampling import sample as sample
from tribodyn.uncertainty.variance import SobolIndices as SobolIndices
from tribodyn.uncertainty.variance import sobol_indices as sobol_indices
