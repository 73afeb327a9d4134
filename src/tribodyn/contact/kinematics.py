"""Curvature and speed of two flanks at a point of the line of action."""

from __future__ import annotations

from dataclasses import dataclass

from tribodyn.types import Array


@dataclass(frozen=True)
class Kinematics:
    """Motion of the flanks at positions on the line of action; all arrays have one shape.

    Parameters
    ----------
    pinion_curvature_radius : array
        Radius of curvature of the pinion's flank [m].
    wheel_curvature_radius : array
        Radius of curvature of the wheel's flank [m].
    equivalent_radius : array
        Product over sum of the two radii [m].
    pinion_surface_speed : array
        Speed of the contact point along the pinion's flank, omega_pinion rho_pinion [m/s].
    wheel_surface_speed : array
        The same of the wheel, omega_wheel rho_wheel [m/s].
    sliding_speed : array
        Pinion less wheel surface speed [m/s]; exactly zero at the pitch point.
    entrainment_speed : array
        Half the sum of the surface speeds [m/s].
    slide_to_roll_ratio : array
        Sliding speed over entrainment speed.
    sliding_direction : array
        Sign of the sliding speed: -1, 0 or 1.
    """

    pinion_curvature_radius: Array
    wheel_curvature_radius: Array
    equivalent_radius: Array
    pinion_surface_speed: Array
    wheel_surface_speed: Array
    sliding_speed: Array
    entrainment_speed: Array
    slide_to_roll_ratio: Array
    sliding_direction: Array
