"""How much of the load of a rough contact its oil film carries."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import require_between
from tribodyn.types import Array

_POWERS = (0.64, 1.26)
#: Film ratio at which the fit is greatest, 2.2576; from there on it is held.
_HELD = (_POWERS[0] / (0.37 * (_POWERS[1] - _POWERS[0]))) ** (1.0 / _POWERS[1])


def film_load_share(film_ratio: ArrayLike) -> Array:
    """Part of the load that the oil film carries.

    ``f = 1.21 L^0.64 / (1 + 0.37 L^1.26)``, at most 1 and held from L = 2.2576 on: the fit itself
    exceeds 1 there and then falls.

    Parameters
    ----------
    film_ratio : float or array
        Minimum film over composite roughness; infinity over smooth flanks.

    Returns
    -------
    float or array
        Load share, 0 to 1, of the same shape; what is missing to 1 the asperities carry.

    Raises
    ------
    InputError
        If a film ratio is negative or no number.

    Valid as a fit to measured rough contacts, Source: Zhu and Hu, Tribol. Trans. 44 (2001).

    Examples
    --------
    >>> [round(float(film_load_share(ratio)), 3) for ratio in (0.0, 0.2, 1.0, 10.0)]
    [0.0, 0.412, 0.883, 1.0]
    """
    ratio = np.minimum(np.asarray(film_ratio, dtype=float), 1e50)
    require_between("film_ratio", ratio, 0.0, np.inf)
    ratio = np.minimum(ratio, _HELD)
    share = 1.21 * ratio ** _POWERS[0] / (1.0 + 0.37 * ratio ** _POWERS[1])
    return np.asarray(np.minimum(share, 1.0))[()]
