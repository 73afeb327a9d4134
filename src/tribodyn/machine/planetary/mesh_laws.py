"""Lag of the meshes of a planet behind each other, from the teeth."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tribodyn.gear import CylindricalPair


def sun_to_ring_lag(
    sun_pair: CylindricalPair, ring_pair: CylindricalPair, *, sun_drives: bool = True
) -> float:
    """Mesh cycles by which the ring mesh of a planet lags behind its sun mesh.

    Parameters
    ----------
    sun_pair, ring_pair : CylindricalPair
        Sun and planet, planet and ring. The mesh phase is 0 where a pair of teeth begins contact.
    sun_drives : bool
        Whether power flows from the sun to the ring relative to the carrier; if not, the
        ring mesh leads by the value.

    Returns
    -------
    float
        From 0 to below 1 [1]; ``sun_to_ring`` of :func:`mesh_phases`.

    Notes
    -----
    Opposite flanks of a planet carry in its two meshes. From the angles of their involutes on the
    base circle, ``lag p_b = r_b (pi - alpha_s - alpha_r) + rho_s + rho_r - s_b`` with the radii of
    curvature of the planet's flanks where contact begins and its base tooth thickness.

    Examples
    --------
    >>> from tribodyn.gear import spur_pair
    >>> rack = {"normal_module": 4e-3, "normal_pressure_angle": math.radians(20.0)}
    >>> sun = spur_pair(pinion_teeth=17, wheel_teeth=22, pinion_face_width=0.05, **rack)
    >>> ring = spur_pair(pinion_teeth=22, wheel_teeth=-61, pinion_face_width=0.05, **rack)
    >>> round(sun_to_ring_lag(sun, ring), 4)
    0.1235
    """
    planet = ring_pair.pinion
    wheel = sun_pair.pinion.teeth != planet.teeth or sun_pair.wheel.teeth == planet.teeth
    return gear_lag(sun_pair, ring_pair, wheel=(wheel, False), drives=sun_drives)


def gear_lag(
    first: CylindricalPair,
    second: CylindricalPair,
    *,
    wheel: tuple[bool, bool],
    turn: float = 0.0,
    drives: bool = True,
) -> float:
    """Mesh cycles by which the second mesh of a gear lags behind the first [1]."""
    # The gear is the wheel or the pinion of each pair; its second mate is opposite to the first
    # one, but for an angle ``turn`` from y towards z while the first one turns this way.
    gear = first.wheel if wheel[0] else first.pinion
    begin, alpha = [], first.operating_pressure_angle + second.operating_pressure_angle
    for pair, is_wheel, at_tip in ((first, wheel[0], drives), (second, wheel[1], not drives)):
        radii = sorted(
            pair.line_of_action_length - limit if is_wheel else limit for limit in pair.path_limits
        )
        begin.append(radii[at_tip])
    arc = math.pi - alpha - turn
    distance = gear.base_radius * (arc - 2.0 * gear.base_half_angle) + sum(begin)
    return float((distance / gear.base_pitch) % 1.0)
