"""A mesh with a rectangular stiffness: two pairs for a share of the cycle, then one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tribodyn.dynamics.structure.gear_pair import Driver
from tribodyn.types import Array

_MODULE, _TEETH = 4.5e-3, (16, 24)
_COSINE = float(np.cos(np.radians(20.0)))
#: Base radii (pinion, wheel) of the test gears type A [m].
BASE_RADIUS = tuple(0.5 * _MODULE * teeth * _COSINE for teeth in _TEETH)
_PITCH = float(np.pi) * _MODULE * _COSINE
_ANGLE = float(np.arccos(sum(BASE_RADIUS) / 91.5e-3))
_LINE = 91.5e-3 * float(np.sin(_ANGLE))
_PITCH_POINT = BASE_RADIUS[0] * float(np.tan(_ANGLE))
#: Radius of curvature of the pinion where the path of contact begins on its side [m]: the tip
#: circle of the wheel is that of centre distance 91.5 mm with shortened addendum.
_BEGIN = 0.324239 * BASE_RADIUS[0]


@dataclass(frozen=True)
class RectangularMesh:
    """Stiffness of one value while two pairs touch and of another while one does."""

    single: float  #: [N/m]
    double: float  #: [N/m]
    duty: float = 1.0 / 3.0  #: part of the mesh cycle with two pairs [1]
    friction_coefficient: float = 0.0  #: constant friction coefficient [1]
    driver: Driver = "pinion"  #: which gear drives: contacts run away from its base tangent point

    @property
    def event_phases(self) -> tuple[float, ...]:
        """Phases at which a pair enters, leaves or passes the pitch point."""
        return tuple(sorted({0.0, self.duty, self._travelled(_PITCH_POINT) % 1.0}))

    def stiffness(self, phase: Array) -> Array:
        """Mesh stiffness."""
        return np.where(np.asarray(phase) < self.duty, self.double, self.single)

    def friction_sum(self, phase: Array) -> Array:
        """Directed friction coefficient of all pairs, each with its share of the load."""
        return np.asarray(sum(pull for pull, _ in self._pairs(phase)))

    def friction_moment_pinion(self, phase: Array) -> Array:
        """Friction moment on the pinion over the normal force."""
        return np.asarray(sum(pull * lever for pull, lever in self._pairs(phase)))

    def friction_moment_wheel(self, phase: Array) -> Array:
        """Friction moment on the wheel over the normal force."""
        return np.asarray(sum(pull * (_LINE - lever) for pull, lever in self._pairs(phase)))

    def _travelled(self, lever: float) -> float:
        """Base pitches that a contact has travelled when it is at a lever of the pinion."""
        forward = (lever - _BEGIN) / _PITCH
        return forward if self.driver == "pinion" else 1.0 + self.duty - forward

    def _pairs(self, phase: Array) -> list[tuple[Array, Array]]:
        """Pull and lever on the pinion of the pair that came last and of the one before."""
        phases = np.asarray(phase, dtype=float)
        both = phases < self.duty
        found = []
        for age in (0.0, 1.0):
            travelled = phases + age
            path = travelled if self.driver == "pinion" else 1.0 + self.duty - travelled
            lever = _BEGIN + path * _PITCH
            share = np.where(both, 0.5, 1.0 - age)
            sense = np.sign(lever - _PITCH_POINT)
            found.append((self.friction_coefficient * share * sense, lever))
        return found
