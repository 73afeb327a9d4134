"""The right-hand boundary of a tooth by its length: involute, fillet and root land."""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np

from tribodyn.gear.tooth_form import ToothForm
from tribodyn.types import Array

#: Points of the table from length to parameter of the fillet.
_TABLE = 2001
#: Steepness [rad] of the fillet over the circle where the tooth begins and the body ends.
_FOOT_STEEPNESS = math.radians(45.0)


def _cartesian(radius: Array, angle: Array) -> Array:
    return np.stack([radius * np.sin(angle), radius * np.cos(angle)], axis=-1)


class ToothSide:
    """Half of the outline of a tooth with its axis on +y, all lengths in modules."""

    def __init__(self, form: ToothForm) -> None:
        self.form = form
        module = form.normal_module
        self.base_radius = form.base_radius / module
        self.root_radius = form.root_radius / module
        self.tip_radius = form.tip_radius / module
        self.pitch_angle = math.pi / form.teeth
        self.tip_length = self._involute_length(form.tip_radius)
        self.form_length = self._involute_length(form.form_radius)

    def _involute_length(self, radius: float) -> float:
        base = self.form.base_radius
        roll = self.form.roll_angle(max(radius, base))
        return 0.5 * self.base_radius * roll * roll

    @cached_property
    def _fillet(self) -> tuple[Array, Array, int]:
        """Parameter and length of the fillet from the form circle down, and index of the foot."""
        angle = np.linspace(self.form.form_normal_angle, 0.5 * math.pi, _TABLE)
        places = self._fillet_at(angle)
        step = np.hypot(*np.diff(places, axis=0).T)
        length = np.concatenate([[0.0], np.cumsum(step)])
        radius = np.hypot(*places.T)
        middle = 0.5 * (places[1:] + places[:-1])
        outward = middle / np.hypot(*middle.T)[:, None]
        fall = -np.einsum("ix,ix->i", np.diff(places, axis=0), outward)
        along = np.einsum("ix,ix->i", np.diff(places, axis=0), outward[:, ::-1] * [1.0, -1.0])
        flat = (np.arctan2(fall, along) < _FOOT_STEEPNESS) & (np.diff(radius) <= 0.0)
        steep = np.flatnonzero(~flat)
        foot = min(int(steep[-1]) + 1 if steep.size else 0, int(0.9 * _TABLE))
        return angle, length, foot

    def _fillet_at(self, angle: Array) -> Array:
        curve = self.form.trochoid
        radius = curve.radius(angle) / self.form.normal_module
        return _cartesian(radius, curve.half_tooth_angle(angle))

    @property
    def foot_length(self) -> float:
        """Length of the fillet from the form circle to the foot of the tooth."""
        _, length, foot = self._fillet
        return float(length[foot])

    def flank_points(self, length: Array) -> Array:
        """Points from the tip to the foot."""
        angle, fillet_length, _ = self._fillet
        on_fillet = length < self.form_length
        roll = np.sqrt(2.0 * np.where(on_fillet, self.form_length, length) / self.base_radius)
        radius = self.base_radius * np.hypot(1.0, roll)
        flank = _cartesian(radius, self.form.base_half_angle - (roll - np.arctan(roll)))
        below = np.interp(self.form_length - length, fillet_length, angle)
        return np.where(on_fillet[..., None], self._fillet_at(below), flank)

    def root_points(self, share: Array) -> Array:
        """Points of the lower fillet and the root land."""
        angle, length, foot = self._fillet
        begin = float(self.form.trochoid.half_tooth_angle(0.5 * math.pi))
        land = max(self.root_radius * (self.pitch_angle - begin), 0.0)
        rest = length[-1] - length[foot]
        along = share * (land + rest)
        on_fillet = self._fillet_at(np.interp(length[-1] - (along - land), length, angle))
        turn = self.pitch_angle - np.minimum(along, land) / self.root_radius
        on_land = _cartesian(np.full_like(turn, self.root_radius), turn)
        points = np.where((along < land)[..., None], on_land, on_fillet)
        # the cut between two teeth is exactly a radius
        ends = _cartesian(np.hypot(*points.T).T, np.full(points.shape[:-1], self.pitch_angle))
        return np.where((share == 0.0)[..., None], ends, points)
