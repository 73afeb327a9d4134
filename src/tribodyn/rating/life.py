"""Life factors Z_NT and Y_NT: ISO 6336-2 and -3, and their inverse, cycles to failure.

Straight lines between points in a plot of log factor over log cycles; constant below the first
point. Above 1e10 cycles the factor stays, and a smaller stress does no damage.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Final

from tribodyn.errors import require_between, require_positive
from tribodyn.rating.materials import GearMaterial

#: Points (cycles, factor) of a curve; the last factor is that of long life.
Curve = tuple[tuple[float, float], ...]
_END: Final = 1e10

_PITTING: Final[dict[str, Curve]] = {
    "steel": ((1e5, 1.6), (5e7, 1.0)),
    "hardened": ((1e5, 1.6), (5e7, 1.0)),
    "brittle": ((1e5, 1.3), (2e6, 1.0)),
    "nitrocarburized": ((1e5, 1.1), (2e6, 1.0)),
}
#: Where some pitting is allowed, of steel and hardened steel.
_SOME_PITTING: Final[Curve] = ((6e5, 1.6), (1e7, 1.3), (1e9, 1.0))
_BENDING: Final[dict[str, Curve]] = {
    "steel": ((1e4, 2.5), (3e6, 1.0)),
    "hardened": ((1e3, 2.5), (3e6, 1.0)),
    "brittle": ((1e3, 1.6), (3e6, 1.0)),
    "nitrocarburized": ((1e3, 1.1), (3e6, 1.0)),
}


def pitting_curve(material: GearMaterial, long_life: float, some_pitting: bool = False) -> Curve:
    """Curve of Z_NT of a material."""
    group = material.life_group
    allowed = some_pitting and group in ("steel", "hardened")
    return (*(_SOME_PITTING if allowed else _PITTING[group]), (_END, long_life))


def bending_curve(material: GearMaterial, long_life: float) -> Curve:
    """Curve of Y_NT of a material."""
    return (*_BENDING[material.life_group], (_END, long_life))


def reference_cycles(curve: Curve) -> float:
    """Cycles at which a curve reaches the endurance value 1."""
    return next(cycles for cycles, factor in curve if factor <= 1.0)


def life_factor(curve: Curve, cycles: float) -> float:
    """Life factor at a number of load cycles.

    Parameters
    ----------
    curve : tuple of (float, float)
        Points of load cycles and factor, pure numbers, rising in cycles.
    cycles : float
        Number of load cycles, pure number.

    Returns
    -------
    float
        Constant below the first and above the last point.

    Raises
    ------
    InputError
        If the number of cycles is not positive.

    Notes
    -----
    Source: ISO 6336-2 (Z_NT) and ISO 6336-3 (Y_NT).

    Examples
    --------
    >>> curve = pitting_curve(GearMaterial(kind="Eh"), 0.85)
    >>> round(life_factor(curve, 1e8), 6)
    0.978963
    """
    require_positive("cycles", cycles)
    if cycles <= curve[0][0]:
        return curve[0][1]
    for (n_1, f_1), (n_2, f_2) in pairwise(curve):
        if cycles <= n_2:
            return float(f_1 * (f_2 / f_1) ** (math.log(cycles / n_1) / math.log(n_2 / n_1)))
    return curve[-1][1]


def cycles_to_failure(curve: Curve, ratio: float) -> float:
    """Load cycles that a stress lasts: the inverse of a life curve.

    Parameters
    ----------
    curve : tuple of (float, float)
        As for :func:`life_factor`.
    ratio : float
        Stress over the endurance strength, pure number.

    Returns
    -------
    float
        Load cycles: zero above the static strength, infinite below the last point.

    Raises
    ------
    InputError
        If the ratio is not a number of at least zero.

    Notes
    -----
    Source: ISO 6336-6, damage by Miner.

    Examples
    --------
    >>> curve = pitting_curve(GearMaterial(kind="Eh"), 0.85)
    >>> round(cycles_to_failure(curve, 1.3) / (1.3 / 1.6) ** -13.2225 / 1e5, 4)
    1.0
    """
    require_between("ratio", ratio, 0.0, 1e30)
    if ratio > curve[0][1]:
        return 0.0
    for (n_1, f_1), (n_2, f_2) in pairwise(curve):
        if ratio >= f_2 and f_2 < f_1:
            return float(n_1 * (n_2 / n_1) ** (math.log(ratio / f_1) / math.log(f_2 / f_1)))
    return math.inf


def between_static_and_endurance(
    static: float, endurance: float, curve: Curve, cycles: float
) -> float:
    """Factor at limited life: straight in log-log between static strength and endurance."""
    first, reference = curve[0][0], reference_cycles(curve)
    share = math.log(max(min(cycles, reference), first) / first) / math.log(reference / first)
    return float(static * (endurance / static) ** share)
