"""Loads at the foot of the teeth: what bends them, shears them and presses them down."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tribodyn.gear import SpurGear, half_tooth
from tribodyn.stiffness.load_point import load_point
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.stiffness.loaded.result import LoadedContact


class RootLoads(NamedTuple):
    """Loads at the feet of the teeth of both gears, (..., p, n) each.

    Parameters
    ----------
    pinion_bending_moment, wheel_bending_moment : array [N*m]
        About the middle of the foot, positive where the loaded flank is in tension.
    pinion_shear_force, wheel_shear_force : array [N]
        Across the axis of the tooth.
    pinion_compressive_force, wheel_compressive_force : array [N]
        Along the axis of the tooth, towards the gear centre.
    """

    pinion_bending_moment: Array
    wheel_bending_moment: Array
    pinion_shear_force: Array
    wheel_shear_force: Array
    pinion_compressive_force: Array
    wheel_compressive_force: Array


def root_loads(result: LoadedContact) -> RootLoads:
    """Carry the normal force of every pair to the feet of its two teeth.

    Parameters
    ----------
    result : LoadedContact
        Loaded tooth contact.

    Returns
    -------
    RootLoads

    Notes
    -----
    The foot is the height at which the fillet meets the root circle, the lowest section of the
    tooth; the force crosses the axis of the tooth at the height ``h``:
    ``M = F cos(a) (h - h_foot)``, ``Q = F cos(a)``, ``N = F sin(a)``. Without friction. Source:
    statics; the lever of ISO 6336-3 is that of the 30 degree tangent, a little higher.
    """
    pair = result.gear_pair
    found = [
        _foot(gear, radius, result.normal_force)
        for gear, radius in (
            (pair.pinion, result.pinion_curvature_radius),
            (pair.wheel, result.wheel_curvature_radius),
        )
    ]
    return RootLoads(*(part for both in zip(*found, strict=True) for part in both))


def _foot(gear: SpurGear, curvature_radius: Array, force: Array) -> tuple[Array, Array, Array]:
    load = load_point(gear, curvature_radius)
    lever = load.axis_height - half_tooth(gear)[0][0]
    across = force * np.cos(load.load_angle)
    return across * lever, across, force * np.sin(load.load_angle)
