"""Fast models learned from computed data: networks, their training, their errors.

| module | content |
|---|---|
| ``network`` | network of one output, and its training by Levenberg and Marquardt |
| ``preparation`` | gaps, outliers, scaling and split of a table |
| ``training`` | a model from a table, and the size of its networks |
| ``model`` | predictions with bands, stored and read |
| ``baselines`` | errors of predictions; what simpler models make of the same table |
"""

from tribodyn.arguments import guard
from tribodyn.surrogate.baselines import BASELINES, ErrorMeasures, baselines
from tribodyn.surrogate.model import Surrogate, load
from tribodyn.surrogate.network import Fit, Network, Squares, levenberg_marquardt
from tribodyn.surrogate.preparation import prepare, split_rows
from tribodyn.surrogate.training import BPNN_PL, Training, bpnn_pl, train

__all__ = [
    "BASELINES",
    "BPNN_PL",
    "ErrorMeasures",
    "Fit",
    "Network",
    "Squares",
    "Surrogate",
    "Training",
    "baselines",
    "bpnn_pl",
    "levenberg_marquardt",
    "load",
    "prepare",
    "split_rows",
    "train",
]

guard(__name__)
