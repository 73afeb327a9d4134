"""Array types that every part of the package uses."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Mask = NDArray[np.bool_]
ComplexArray = NDArray[np.complex128]
Texts = NDArray[np.str_]
