"""Loads and speeds at the pitch point."""

from __future__ import annotations

from dataclasses import dataclass

from tribodyn.contact import path_of_contact
from tribodyn.errors import require_positive
from tribodyn.gear import SpurPair


@dataclass(frozen=True)
class PitchPoint:
    """A mesh at its pitch point, the whole normal force on one line of contact.

    Parameters
    ----------
    load_per_width : float [N/m]
        Tangential load at the base circle per face width.
    sum_velocity : float [m/s]
        SUM of the surface speeds.
    equivalent_radius : float [m]
        Reduced radius of curvature.
    pitch_line_velocity : float [m/s]
        Speed of the pitch circles.
    pinion_pitch_diameter : float [m]
        Operating pitch diameter of the pinion.
    load_intensity : float [Pa]
        K-factor: pitch-line load over face width and pitch diameter of the pinion, times (u + 1)/u.
    driving_torque : float [N*m]
        Torque on the driving gear.
    driving_speed : float [rad/s]
        Speed of the driving gear.

    Examples
    --------
    >>> PitchPoint(133022.0, 2.6333, 8.3822e-3, 3.4495, 73.2e-3, 2.8e6, 90.0, 94.2).sum_velocity
    2.6333
    """

    load_per_width: float
    sum_velocity: float
    equivalent_radius: float
    pitch_line_velocity: float
    pinion_pitch_diameter: float
    load_intensity: float
    driving_torque: float
    driving_speed: float


def pitch_point(pair: SpurPair, pinion_speed: float, pinion_torque: float) -> PitchPoint:
    """Loads and speeds of a cylindrical pair at its pitch point.

    Parameters
    ----------
    pair : SpurPair
        The pair.
    pinion_speed : float [rad/s]
        Speed of the pinion.
    pinion_torque : float [N*m]
        Torque on the pinion.

    Raises
    ------
    InputError
        If speed or torque is not positive.

    Source: ISO/TR 14179-1 (load intensity) and ISO/TR 14179-2 (the others).

    Examples
    --------
    >>> import math
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...                  normal_pressure_angle=math.radians(20.0), pinion_face_width=50e-3)
    >>> point = pitch_point(pair, 100.0, 200.0)
    >>> round(point.sum_velocity / point.pitch_line_velocity, 6)  # twice the sine of 20 degrees
    0.68404
    """
    require_positive("pinion_speed", pinion_speed, "rad/s")
    require_positive("pinion_torque", pinion_torque, "N*m")
    contact = path_of_contact(pair)
    motion = contact.kinematics(contact.C, pinion_speed)
    width = pair.common_face_width
    radius = abs(pair.center_distance / (1.0 + pair.ratio))
    turned = 1.0 if pair.driver == "pinion" else abs(pair.ratio)
    return PitchPoint(
        load_per_width=pinion_torque / pair.pinion.base_radius / width,
        sum_velocity=2.0 * float(motion.entrainment_speed),
        equivalent_radius=float(motion.equivalent_radius),
        pitch_line_velocity=pinion_speed * radius,
        pinion_pitch_diameter=2.0 * radius,
        load_intensity=pinion_torque * (1.0 + 1.0 / pair.ratio) / (2.0 * width * radius**2),
        driving_torque=pinion_torque * turned,
        driving_speed=pinion_speed / turned,
    )
