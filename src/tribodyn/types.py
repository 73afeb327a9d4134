"""Types that every part of the package uses."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Mask = NDArray[np.bool_]
ComplexArray = NDArray[np.complex128]
Texts = NDArray[np.str_]
#: One number or an array of them.
Numbers = float | Array
#: Values of any kind by name, as in TOML and JSON: a new one, and one that is only read.
Tree = dict[str, Any]
ByName = Mapping[str, Any]
