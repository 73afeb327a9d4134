"""Rolling and sliding of the flanks of a hypoid pair along their contact lines."""

from __future__ import annotations

from dataclasses import field
from typing import NamedTuple

import numpy as np

from tribodyn.errors import require_between, require_one_of, require_positive
from tribodyn.gear.hypoid.conjugate import ConjugateFlanks, Touch
from tribodyn.gear.hypoid.envelope import Curvature, cross
from tribodyn.gear.hypoid.tooth_contact import ToothContact
from tribodyn.nomenclature import require_number
from tribodyn.record import Record, fact, quantity, record
from tribodyn.types import Array

ENTRAINMENTS = ("contact", "fixed_frame")
_CELLS = ("rotation", "cell")


@record
class HypoidKinematics(Record):
    """Motion of the flanks in the cells of their contact lines; made by :func:`hypoid_kinematics`.

    Parameters
    ----------
    rotation : array (rotation,) [rad]
        Rotation of the wheel in its running sense from the calculation point on.
    sliding_velocity : array (rotation, cell, 3) [m/s]
        Velocity of the pinion's surface less that of the wheel, in the fixed frame.
    sliding_speed : array (rotation, cell) [m/s]
        Its amount.
    pinion_rolling_speed, wheel_rolling_speed : array (rotation, cell) [m/s]
        Speeds of both surfaces through the contact, across its line; both have one sign where they
        draw oil in together.
    entrainment_speed : array (rotation, cell) [m/s]
        HALF the sum of the two, as an amount; or the amount of half the sum of both velocities in
        the tangent plane and the fixed frame, if that was chosen.
    slide_to_roll_ratio : array (rotation, cell)
        Sliding speed over entrainment speed.
    equivalent_radius : array (rotation, cell) [m]
        Radius of the gap across the line.
    pinion_lever, wheel_lever : array (rotation, cell, 3) [m]
        Directional rotation radii: moment of a unit normal force about the point of each axis
        where the common perpendicular meets it.
    friction_direction : array (rotation, cell, 3)
        Unit vector of the friction force on the pinion, against its sliding; zero without any.
    pinion_speed : float [rad/s]
        Speed of the pinion.
    entrainment : str
        ``"contact"`` or ``"fixed_frame"``.
    contact : ToothContact
        The contact.
    """

    rotation: Array = quantity("rotation", unit="rad", axis=True)
    sliding_velocity: Array = quantity(*_CELLS, "component", unit="m/s")
    sliding_speed: Array = quantity(*_CELLS, unit="m/s")
    pinion_rolling_speed: Array = quantity(*_CELLS, unit="m/s")
    wheel_rolling_speed: Array = quantity(*_CELLS, unit="m/s")
    entrainment_speed: Array = quantity(*_CELLS, unit="m/s")
    slide_to_roll_ratio: Array = quantity(*_CELLS, unit="1")
    equivalent_radius: Array = quantity(*_CELLS, unit="m")
    pinion_lever: Array = quantity(*_CELLS, "component", unit="m")
    wheel_lever: Array = quantity(*_CELLS, "component", unit="m")
    friction_direction: Array = quantity(*_CELLS, "component", unit="1")
    pinion_speed: float = fact()
    entrainment: str = fact()
    contact: ToothContact = field()


def hypoid_kinematics(
    contact: ToothContact, pinion_speed: float, *, entrainment: str = "contact"
) -> HypoidKinematics:
    """Sliding, entrainment and levers in every cell of the contact lines.

    Parameters
    ----------
    contact : ToothContact
        Contact with its lines.
    pinion_speed : float
        Speed of the pinion [rad/s].
    entrainment : str
        ``"contact"`` takes the velocities of both surfaces relative to the contact line, which
        moves over them; ``"fixed_frame"`` is the shortcut of the literature, which leaves that out.

    Raises
    ------
    InputError
        If an argument is wrong.

    Notes
    -----
    A contact line moves over the wheel with the speed at which the rotation of contact changes from
    place to place. The entrainment of the fixed frame differs from it by tens of per cent.

    Examples
    --------
    >>> import math
    >>> from tribodyn.gear import hypoid_blank, hypoid_flanks, tooth_contact
    >>> blank = hypoid_blank(10, 43, 31.7e-3, 0.336, 47.7e-3, math.radians(46.0), 0.1143)
    >>> motion = hypoid_kinematics(tooth_contact(hypoid_flanks(blank)), 314.16)
    >>> bool(motion.sliding_speed.min() > 2.0)
    True
    """
    speed = require_number("pinion_speed", pinion_speed)
    require_positive("pinion_speed", speed, "rad/s", remedy="3000 rpm is 314.16 rad/s")
    require_between("pinion_speed", speed, 0.0, 1e5, "rad/s", remedy="3000 rpm is 314.16 rad/s")
    chosen = require_one_of("entrainment", entrainment, ENTRAINMENTS)
    flanks = contact.flanks.conjugate
    touch = flanks.touch(np.stack([contact.cell_along, contact.cell_across], axis=-1))
    position, normal = touch.contact.wheel[:2]
    motion = cell_motion(flanks, touch, touch.curvature, speed, chosen)
    return HypoidKinematics(
        rotation=contact.rotation,
        **motion._asdict(),
        pinion_lever=cross(position - flanks.axes.origin, normal),
        wheel_lever=cross(position, normal),
        pinion_speed=speed,
        entrainment=chosen,
        contact=contact,
    )


class CellMotion(NamedTuple):
    """Motion in cells of any shape, as :class:`HypoidKinematics` names it."""

    sliding_velocity: Array
    sliding_speed: Array
    pinion_rolling_speed: Array
    wheel_rolling_speed: Array
    entrainment_speed: Array
    slide_to_roll_ratio: Array
    equivalent_radius: Array
    friction_direction: Array


def cell_motion(
    flanks: ConjugateFlanks, touch: Touch, curvature: Curvature, speed: float, entrainment: str
) -> CellMotion:
    """Motion where flanks touch, at a speed of the pinion."""
    position, normal = touch.contact.wheel[:2]
    spin = flanks.sense * speed
    sliding = spin * touch.sliding
    amount = np.linalg.norm(sliding, axis=-1)
    wheel = -spin * flanks.axes.ratio / curvature.gradient
    pinion = wheel + np.einsum("...i,...i->...", sliding, curvature.across)
    velocity = -spin * flanks.axes.ratio * cross(np.array([0.0, 0.0, 1.0]), position)
    mean = velocity + 0.5 * sliding
    mean = mean - np.einsum("...i,...i->...", mean, normal)[..., None] * normal
    fixed = entrainment == "fixed_frame"
    entrainment_speed = np.linalg.norm(mean, axis=-1) if fixed else 0.5 * np.abs(pinion + wheel)
    moving = amount[..., None] > 1e-12 * speed * flanks.blank.mean_pitch_diameter_pinion
    safe = np.where(moving, amount[..., None], 1.0)
    with np.errstate(divide="ignore"):
        radius = 1.0 / curvature.tensor[..., 1, 1]
        ratio = amount / entrainment_speed
    against = np.where(moving, -sliding / safe, 0.0)
    return CellMotion(sliding, amount, pinion, wheel, entrainment_speed, ratio, radius, against)
