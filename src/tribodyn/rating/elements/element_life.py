"""Life of rolling bearings from the loads of their rolling elements: ISO/TS 16281.

Balls, with ``g = D cos(alpha)/D_pw`` and groove radii over the ball diameter f_i, f_e:
``r = 1.044 ((1 - g)/(1 + g))^1.72 [f_i (2 f_e - 1)/(f_e (2 f_i - 1))]^0.41``,
``Q_ci = C/(0.407 Z cos(alpha)) (1 + r^(10/3))^0.3``, ``Q_ce = C/(0.389 ...) (1 + r^(-10/3))^0.3``;
the rotating ring counts the mean of Q^3, the standing ring that of Q^(10/3), and
``L_10r = [(Q_ci/Q_ei)^(-10/3) + (Q_ce/Q_ee)^(-10/3)]^-0.9`` million turns. Rollers by laminae with
0.378, 0.364, ``r = 1.038 ((1 - g)/(1 + g))^(143/108)``, exponents 9/2, 2/9 and -8/9, and both
capacities divided by 0.83: their life falls with the fourth power of the load, not with 10/3.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import Argument, InputError, require_between, require_positive
from tribodyn.types import Array

#: Reduction of the capacity of rollers for uneven load along them.
_ROLLER_REDUCTION = 0.83


def _loads(element_load: ArrayLike) -> Array:
    loads = np.asarray(element_load, dtype=float)
    require_between("element_load", loads, 0.0, 1e12, "N")
    if not np.any(loads > 0.0):
        why = "A bearing without load has no fatigue life"
        raise InputError("no element is loaded", Argument("element_load"), why, "Give the loads")
    return loads


def ball_bearing_life(
    element_load: ArrayLike,
    dynamic_capacity: float,
    geometry: tuple[float, float],
    *,
    grooves: tuple[float, float] = (0.52, 0.53),
    inner_rotates: bool = True,
) -> float:
    """Life of a ball bearing from the loads of its balls.

    Parameters
    ----------
    element_load : array [N]
        Load of each ball, (balls,).
    dynamic_capacity : float [N]
        C of the bearing, one row.
    geometry : tuple of float
        D/D_pw and the nominal contact angle [rad].
    grooves : tuple of float
        Groove radius over ball diameter, inner and outer; pure numbers.
    inner_rotates : bool
        Whether the inner ring rotates against the load; else the outer ring.

    Returns
    -------
    float
        L_10r, pure number of turns.

    Raises
    ------
    InputError
        If a value is out of range or no ball is loaded.

    Notes
    -----
    Source: ISO/TS 16281:2008. With rigid rings, no clearance, radial load and many balls it is
    (C/F_r)^3 million turns.

    Examples
    --------
    >>> angle = np.linspace(0.0, 2.0 * math.pi, 1000, endpoint=False)
    >>> load = 4.37 * 10e3 / 1000 * np.maximum(np.cos(angle), 0.0) ** 1.5
    >>> round(ball_bearing_life(load, 50e3, (0.2, 0.0)) / 125e6, 2)
    1.0
    """
    loads = _loads(element_load)
    require_positive("dynamic_capacity", dynamic_capacity, "N")
    size, angle = geometry
    inner, outer = grooves
    require_between("grooves", np.array(grooves), 0.5 + 1e-6, 1.0)
    cosine = math.cos(angle)
    g = size * cosine
    require_between("geometry", g, 1e-3, 0.9)
    groove = inner * (2.0 * outer - 1.0) / (outer * (2.0 * inner - 1.0))
    r = 1.044 * ((1.0 - g) / (1.0 + g)) ** 1.72 * groove**0.41
    scale = dynamic_capacity / (loads.size * cosine)
    capacity_i = scale / 0.407 * (1.0 + r ** (10.0 / 3.0)) ** 0.3
    capacity_e = scale / 0.389 * (1.0 + r ** (-10.0 / 3.0)) ** 0.3
    rotating = float((loads**3).mean() ** (1.0 / 3.0))
    standing = float((loads ** (10.0 / 3.0)).mean() ** 0.3)
    load_i, load_e = (rotating, standing) if inner_rotates else (standing, rotating)
    damage = (capacity_i / load_i) ** (-10.0 / 3.0) + (capacity_e / load_e) ** (-10.0 / 3.0)
    return float(1e6 * damage**-0.9)


def roller_bearing_life(
    element_load: ArrayLike,
    dynamic_capacity: float,
    geometry: tuple[float, float],
    *,
    inner_rotates: bool = True,
) -> float:
    """Life of a roller bearing from the loads of its rollers or their laminae.

    Parameters
    ----------
    element_load : array [N]
        Load of each roller, (rollers,), or of each lamina, (rollers, laminae).
    dynamic_capacity : float [N]
        C of the bearing, one row.
    geometry : tuple of float
        D/D_pw and the contact angle [rad].
    inner_rotates : bool
        Whether the inner ring rotates against the load; else the outer ring.

    Returns
    -------
    float
        L_10r, pure number of turns.

    Raises
    ------
    InputError
        If a value is out of range or no roller is loaded.

    Notes
    -----
    Source: ISO/TS 16281:2008; the sum over the laminae is from memory of its text.

    Examples
    --------
    >>> load = np.full(20, 1000.0)
    >>> ratio = roller_bearing_life(load, 50e3, (0.2, 0.0))
    >>> round(ratio / roller_bearing_life(2.0 * load, 50e3, (0.2, 0.0)), 6)
    16.0
    """
    loads = _loads(element_load)
    loads = loads[:, None] if loads.ndim == 1 else loads
    require_positive("dynamic_capacity", dynamic_capacity, "N")
    size, angle = geometry
    cosine = math.cos(angle)
    g = size * cosine
    require_between("geometry", g, 1e-3, 0.9)
    rollers, laminae = loads.shape
    r = 1.038 * ((1.0 - g) / (1.0 + g)) ** (143.0 / 108.0)
    scale = dynamic_capacity / (_ROLLER_REDUCTION * rollers * cosine)
    scale *= (1.0 / laminae) ** (7.0 / 9.0)
    capacity_i = scale / 0.378 * (1.0 + r**4.5) ** (2.0 / 9.0)
    capacity_e = scale / 0.364 * (1.0 + r**-4.5) ** (2.0 / 9.0)
    rotating = (loads**4).mean(axis=0) ** 0.25
    standing = (loads**4.5).mean(axis=0) ** (2.0 / 9.0)
    load_i, load_e = (rotating, standing) if inner_rotates else (standing, rotating)
    damage = (load_i / capacity_i) ** 4.5 + (load_e / capacity_e) ** 4.5
    return float(1e6 * damage.sum() ** (-8.0 / 9.0))
