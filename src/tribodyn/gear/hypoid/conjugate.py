"""One side of a pair: the wheel flank and the pinion flank that it envelops, eased off."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tribodyn.gear.hypoid.blank import HypoidBlank
from tribodyn.gear.hypoid.ease_off import EaseOff, eased_gap
from tribodyn.gear.hypoid.envelope import (
    Curvature,
    Envelope,
    Surface,
    cross,
    envelope,
    relative_curvature,
    turned_surface,
)
from tribodyn.gear.hypoid.formate import pair_axes
from tribodyn.gear.hypoid.wheel_flanks import wheel_flank
from tribodyn.types import Array


class Touch(NamedTuple):
    """Conjugate contact at places on the wheel, in the fixed frame."""

    places: Array  #: (..., 2) along and across the wheel's pitch cone
    contact: Envelope
    sliding: Array  #: (..., 3) of the pinion over the wheel, for a unit speed of the pinion
    lever: Array  #: of the normal about the wheel's axis, positive

    @property
    def curvature(self) -> Curvature:
        """Curvature of the gap about each contact."""
        return relative_curvature(self.contact)

    def at(self, chosen: tuple[slice, ...]) -> Touch:
        """Contact at some of the positions."""
        contact = self.contact
        wheel, pinion = (
            Surface(*(values[chosen] for values in each))
            for each in (contact.wheel, contact.pinion)
        )
        touch = Envelope(contact.rotation[chosen], wheel, pinion, contact.slope[chosen])
        return Touch(self.places[chosen], touch, self.sliding[chosen], self.lever[chosen])


class ConjugateFlanks:
    """Drive or coast side of a pair; points are counted by the parameters of the wheel flank."""

    def __init__(self, blank: HypoidBlank, side: str, ease_off: EaseOff) -> None:
        self.blank, self.ease_off = blank, ease_off
        self.wheel, self.axes = wheel_flank(blank, side), pair_axes(blank)
        moment = cross(self.wheel.point, self.wheel.normal)
        #: 1 where the rotations grow while the pinion drives, else -1.
        self.sense = -math.copysign(1.0, moment[2])

    def touch(self, places: Array) -> Touch:
        """Touch the wheel at places; NaN where it has no flank or never touches."""
        return self.touch_at(self.wheel.at(self.wheel.parameters(places)))

    def touch_at(self, surface: Surface) -> Touch:
        """Touch the wheel at points of its flank."""
        places, _ = self.wheel.projected(surface)
        contact = envelope(surface, self.axes)
        position, normal = contact.wheel[:2]
        return Touch(
            places,
            contact,
            self.axes.sliding(position),
            -self.sense * cross(position, normal)[..., 2],
        )

    def margins(self, touch: Touch) -> Array:
        """Distances (..., 4) to tip of wheel and pinion, to toe and heel; negative outside."""
        blank = self.blank
        along, across = np.moveaxis(touch.places, -1, 0)
        up = math.tan(blank.face_angle_wheel - blank.pitch_angle_wheel)
        pinion, axis = touch.contact.pinion.position, self.axes.axis
        place, pitch = pinion @ axis, blank.pitch_angle_pinion
        radius = np.linalg.norm(pinion - place[..., None] * axis, axis=-1)
        distance = radius * math.sin(pitch) + (place + blank.pitch_apex_pinion) * math.cos(pitch)
        tip = (place + blank.face_apex_pinion) * math.tan(blank.face_angle_pinion)
        mean = blank.mean_cone_distance_wheel
        toe = along - (blank.inner_cone_distance_wheel - mean)
        heel = blank.outer_cone_distance_wheel - mean - along
        return np.stack(
            [
                blank.mean_addendum_wheel + along * up - across,
                tip - radius,
                np.minimum(toe, distance - blank.inner_cone_distance_pinion),
                np.minimum(heel, blank.outer_cone_distance_pinion - distance),
            ],
            axis=-1,
        )

    def pinion_at(self, parameters: Array) -> tuple[Array, Array]:
        """Position about the pinion's origin and normal of the eased pinion flank at rest."""
        flank = self.wheel.at(parameters)
        contact = envelope(flank, self.axes)
        places, steps = self.wheel.projected(flank)
        gap, slope = eased_gap(self.ease_off, self.blank, places)
        pinion = turned_surface(contact.pinion, self.axes.axis, -contact.rotation / self.axes.ratio)
        gap_slope = np.einsum("...i,...ij->...j", slope, steps)
        tangents = (
            pinion.tangents
            - pinion.normal[..., :, None] * gap_slope[..., None, :]
            - gap[..., None, None] * pinion.turns
        )
        normal = cross(tangents[..., 0], tangents[..., 1])
        # A pinion that is undercut is run through backwards; its normal keeps its sense.
        normal *= np.sign(np.einsum("...i,...i->...", normal, pinion.normal))[..., None]
        normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
        return pinion.position - gap[..., None] * pinion.normal, normal
