"""Teeth that stand on an elastic ring: what a load on one foot does to another foot."""

from __future__ import annotations

import numpy as np

from tribodyn.errors import require_positive
from tribodyn.stiffness.ring_fourier import RingCompliance
from tribodyn.types import Array


def foot_stresses(
    load_angle: Array | float,
    base_radius: float,
    root_radius: float,
    half_angle: float,
) -> Array:
    """Spread a tooth load over the foot of the tooth.

    The load turns the gear counter-clockwise. Over the foot an even tangential stress carries the
    torque, an even radial stress the force along the tooth, and a radial stress that grows
    linearly with the angle from the tooth axis the rest of the force across.

    Parameters
    ----------
    load_angle : float or array (K,) [rad]
        Angle between the load and the normal of the tooth axis.
    base_radius : float [m]
        Base radius, the lever of the load.
    root_radius : float [m]
        Radius on which the foot lies.
    half_angle : float [rad]
        Half of the angle that the foot covers.

    Returns
    -------
    array (3, K) [1/m]
        Per load per width: tangential stress, even radial stress, and radial stress at the
        counter-clockwise end of the foot of the part that grows linearly.

    Raises
    ------
    InputError
        If a radius or the half angle is not positive.

    Notes
    -----
    Force and torque are those of the load exactly. Source: distributions of Sainsot, Velex and
    Duverger (2004), J. Mech. Des. 126, 748-752.

    Examples
    --------
    The tangential stress carries the torque, here 0.03 N m/m per 1 N/m.

    >>> stress = foot_stresses(0.3, 0.03, 0.032, 0.1)
    >>> print(f"{float(stress[0, 0]) * 2 * 0.1 * 0.032**2:.6f}")
    0.030000
    """
    for name, value, unit in (
        ("base_radius", base_radius, "m"),
        ("root_radius", root_radius, "m"),
        ("half_angle", half_angle, "rad"),
    ):
        require_positive(name, value, unit)
    angle = np.atleast_1d(np.asarray(load_angle, dtype=float))
    chord = 2.0 * root_radius * np.sin(half_angle)
    tangential = np.full(angle.shape, base_radius / (2.0 * half_angle * root_radius**2))
    lever = (np.sin(half_angle) - half_angle * np.cos(half_angle)) / half_angle
    linear = (np.cos(angle) - tangential * chord) / (2.0 * root_radius * lever)
    return np.stack([tangential, -np.sin(angle) / chord, linear])


def foot_compliance(ring: RingCompliance, half_angle: float, turn: float) -> Array:
    """Displacement of one foot under the stress on another, in the pattern of the stresses."""
    require_positive("half_angle", half_angle, "rad")
    n = np.arange(1.0, ring.waves.shape[0] + 1.0)
    phase = n * half_angle
    even = 2.0 * np.sin(phase) / (np.pi * n)
    linear = 2.0 * (np.sin(phase) - phase * np.cos(phase)) / (np.pi * n * phase)
    # Stresses about their own tooth axis: tangential even, radial even, radial odd. In waves of
    # p cos + q sin the even radial part is (p, 0); a quarter wave on, the tangential one is
    # (0, -q) and the odd one (p, 0).
    size = np.stack([-even, even, linear])
    kind = np.array([1, 0, 0])
    quarter = np.array([1, 0, 1])
    coupling = ring.waves[:, kind[:, None], kind[None, :]]
    products = size[:, None, :] * size[None, :, :] * np.moveaxis(coupling, 0, 2)
    in_phase = products @ np.cos(n * turn)
    a_quarter_off = products @ np.sin(n * turn)
    step = quarter[None, :] - quarter[:, None]
    work = np.pi * ring.outer_radius * np.where(step == 0, in_phase, step * a_quarter_off)
    share = 2.0 * ring.outer_radius * half_angle**2 / np.pi
    work[0, 0] += share * ring.torsion
    work[1, 1] += share * ring.expansion
    return np.asarray(work)
