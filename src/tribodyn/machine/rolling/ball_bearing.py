"""Ball bearings: Hertzian point contact between ball and grooves.

The distance of the centres of curvature of both grooves, ``A = (f_i + f_e - 1) D`` without
load, is stretched by the displacement of the inner ring; a ball carries
``Q = c (distance - A)^(3/2)`` along the line through both centres, so that contact angles
follow the load. Centrifugal forces and gyroscopic moments of the balls are left out.
Source: Harris and Kotzalas (2006); ISO/TS 16281 (2008), with the Hertzian constant ``c`` of
both raceways together.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from tribodyn.contact import hertz_ellipse
from tribodyn.errors import InputError, warn
from tribodyn.machine.fields import check_number
from tribodyn.machine.rolling.element_ring import ElementLaw, RollingElementBearing
from tribodyn.types import Array


class _PointContact(NamedTuple):
    """Ball between both grooves."""

    constant: float  #: force over compression^(3/2) [N/m^(3/2)]
    inner_pressure: float  #: greatest pressure over force^(1/3) [Pa/N^(1/3)]
    outer_pressure: float


@dataclass(frozen=True, kw_only=True)
class BallBearing(RollingElementBearing):
    """Single-row ball bearing whose grooves touch the balls at a contact angle."""

    balls: int | None = None
    ball_diameter: float | None = None
    inner_groove: float = 0.52
    outer_groove: float = 0.53
    contact_angle: float = 0.0
    effective_modulus: float = 207e9 / (1.0 - 0.3**2)

    #: Share of the pitch circle that the balls fill where their number is estimated.
    _FILLING = 0.87

    def _complete(self) -> None:
        self._estimate(
            "ball_diameter", lambda bore, outer: 0.3 * (outer - bore), "0.3 (outside - bore)"
        )
        self._estimate(
            "balls",
            lambda bore, outer: self._usual_count(bore, outer),
            "usual filling of the pitch circle",
        )
        check_number(self, "effective_modulus", "Pa", 1e9, 1e13)
        for name in ("inner_groove", "outer_groove"):
            why = "Groove radius over ball diameter, usually 0.515 to 0.53; from 0.502 to 0.7"
            check_number(self, name, "", 0.502, 0.7, why=why)
        largest = 1.9 * self.centre_distance * math.cos(self.contact_angle)
        check_number(self, "radial_clearance", "m", -0.02 * self.element_diameter, largest)

    def _usual_count(self, bore: float, outer: float) -> int:
        return int(self._FILLING * math.pi * self.pitch / self.element_diameter)

    @property
    def _pressure_limit(self) -> float:
        return 4.2e9

    @property
    def elements(self) -> int:
        """Number of balls."""
        return int(self.balls or 0)

    @property
    def element_diameter(self) -> float:
        """Diameter of a ball [m]."""
        return float(self.ball_diameter or 0.0)

    @property
    def centre_distance(self) -> float:
        """Distance of the centres of curvature of both grooves without load [m]."""
        return (self.inner_groove + self.outer_groove - 1.0) * self.element_diameter

    @cached_property
    def free_contact_angle(self) -> float:
        """Contact angle where an axial displacement just closes the clearance [rad]."""
        radial = self._centres[1] / self.centre_distance
        return math.acos(radial) if radial < 1.0 else 0.0

    @cached_property
    def _centres(self) -> tuple[float, float]:
        """Axial and radial distance of the centres of curvature without displacement."""
        distance, angle = self.centre_distance, self.contact_angle
        axial = self.direction * distance * math.sin(angle)
        return axial, distance * math.cos(angle) - 0.5 * self.radial_clearance

    @cached_property
    def _inner_centre(self) -> tuple[float, float]:
        """Axial position and radius of the centre of curvature of the inner groove."""
        offset = (self.inner_groove - 0.5) * self.element_diameter
        axial = self.direction * offset * math.sin(self.contact_angle)
        return axial, 0.5 * self.pitch + offset * math.cos(self.contact_angle)

    @cached_property
    def _contact(self) -> _PointContact:
        diameter = self.element_diameter
        slope = diameter * math.cos(self.contact_angle) / self.pitch
        along = 0.5 * diameter * np.array([1.0 - slope, 1.0 + slope])
        groove = np.array([self.inner_groove, self.outer_groove])
        across = diameter / (2.0 - 1.0 / groove)
        hertz = hertz_ellipse(1.0, along, across, self.effective_modulus)
        inner, outer = np.asarray(hertz.maximum_pressure)
        return _PointContact(float(np.sum(hertz.approach)) ** -1.5, float(inner), float(outer))

    def _stretched(
        self, axial: Array, radial: Array, tilt: Array
    ) -> tuple[Array, Array, Array, Array]:
        """Distance of both centres, its direction, and the compression of each ball."""
        lever, height = self._inner_centre
        axial_gap = self._centres[0] + axial + height * tilt
        radial_gap = self._centres[1] + radial - lever * tilt
        distance = np.maximum(np.hypot(axial_gap, radial_gap), 1e-12)
        return distance, axial_gap, radial_gap, np.maximum(distance - self.centre_distance, 0.0)

    def element_law(self, axial: Array, radial: Array, tilt: Array) -> ElementLaw:
        """Response of each ball, see :class:`RollingElementBearing`."""
        distance, axial_gap, radial_gap, compression = self._stretched(axial, radial, tilt)
        lever, height = self._inner_centre
        constant = self._contact.constant
        force = constant * compression**1.5
        geometry = np.array([[1.0, 0.0, height], [0.0, 1.0, -lever]])
        gradient = np.stack([axial_gap, radial_gap], axis=-1) / distance[:, None] @ geometry
        turning = force / distance
        stiffness = np.einsum(
            "e,ei,ej->eij", 1.5 * constant * np.sqrt(compression) - turning, gradient, gradient
        )
        stiffness += turning[:, None, None] * (geometry.T @ geometry)
        return ElementLaw(0.4 * force * compression, force[:, None] * gradient, stiffness)

    def _contacts(self, axial: Array, radial: Array, tilt: Array) -> tuple[Array, ...]:
        _, axial_gap, radial_gap, compression = self._stretched(axial, radial, tilt)
        force = self._contact.constant * compression**1.5
        angle = np.arctan2(axial_gap, radial_gap)
        if self.contact_angle and np.any(self.direction * angle[force > 0.0] < 0.0):
            warn(
                "contact-angle",
                "balls of an angular contact bearing run on its low shoulder; the model takes the "
                "groove as complete: give the bearing an axial load in its direction, or a preload",
                stacklevel=3,
            )
        root = np.cbrt(force)
        contact = self._contact
        return force, angle, contact.inner_pressure * root, contact.outer_pressure * root


class DeepGrooveBallBearing(BallBearing):
    """Deep groove ball bearing; takes axial forces of both directions.

    Parameters
    ----------
    bore_diameter, outer_diameter, width : float, optional [m]
        Main dimensions, from which missing inner ones are estimated.
    pitch_diameter : float, optional [m]
        Diameter of the circle of the ball centres; default: mean of bore and outer diameter.
    radial_clearance : float [m]
        Radial play at work, of the diameter; negative for an interference.
    preload : float [N]
        Axial force that presses the bearing along ``direction`` before it is loaded.
    direction : int
        1 or -1: direction of the preload along x.
    first_element_angle : float [rad]
        Position of the first ball, from y towards z.
    balls : int, optional
        Number of balls; default: usual number.
    ball_diameter : float, optional [m]
        Default: 0.3 times the difference of outer and bore diameter.
    inner_groove, outer_groove : float
        Groove radius over ball diameter.
    contact_angle : float [rad]
        Zero; the contact angle of a deep groove bearing follows from clearance and load.
    effective_modulus : float [Pa]
        E' of ball and rings with 2/E' = (1-nu_1^2)/E_1 + (1-nu_2^2)/E_2; default: steel.

    Examples
    --------
    >>> bearing = DeepGrooveBallBearing(bore_diameter=45e-3, outer_diameter=85e-3)
    >>> bearing.assumptions[1]
    'ball_diameter = 12 mm, estimated: 0.3 (outside - bore)'
    >>> position = bearing.displacement([0.0, 5000.0, 0.0, 0.0, 0.0])
    >>> round(float(bearing.stiffness(position)[1, 1]) / 1e6)
    200
    """

    def _complete(self) -> None:
        if self.contact_angle:
            raise InputError(
                f"contact_angle = {math.degrees(self.contact_angle):.4g} deg",
                self._where("contact_angle"),
                "That of a deep groove bearing follows from its radial clearance",
                'Leave it out, or choose the type "angular-contact"',
            )
        super()._complete()

    def _usual_count(self, bore: float, outer: float) -> int:
        return round(2.9 * (outer + bore) / (outer - bore))


class AngularContactBallBearing(BallBearing):
    """Angular contact ball bearing; takes axial forces of one direction.

    Parameters
    ----------
    bore_diameter, outer_diameter, width : float, optional [m]
        Main dimensions, from which missing inner ones are estimated.
    pitch_diameter : float, optional [m]
        Diameter of the circle of the ball centres; default: mean of bore and outer diameter.
    radial_clearance : float [m]
        Play between the rings where their centres have their nominal axial distance, of the
        diameter.
    preload : float [N]
        Axial force of the undisplaced bearing.
    direction : int
        1 if the bearing holds the shaft against forces along +x, -1 against those along -x.
    first_element_angle : float [rad]
        Position of the first ball, from y towards z.
    balls : int, optional
        Number of balls; default: usual number.
    ball_diameter : float, optional [m]
        Default: 0.3 times the difference of outer and bore diameter.
    inner_groove, outer_groove : float
        Groove radius over ball diameter.
    contact_angle : float [rad]
        Nominal contact angle.
    effective_modulus : float [Pa]
        E' of ball and rings with 2/E' = (1-nu_1^2)/E_1 + (1-nu_2^2)/E_2; default: steel.

    Examples
    --------
    >>> import math
    >>> bearing = AngularContactBallBearing(pitch_diameter=125.26e-3, balls=16,
    ...     ball_diameter=22.225e-3, inner_groove=0.5232, outer_groove=0.5232,
    ...     contact_angle=math.radians(40.0))
    >>> position = bearing.displacement([17800.0, 0.0, 0.0, 0.0, 0.0])
    >>> round(math.degrees(bearing.state(position).contact_angle[0]), 2)
    41.5
    """

    def _complete(self) -> None:
        why = "5 to 80 deg; suffix C of a catalogue is 15 deg, E or AC 25 deg, B 40 deg"
        check_number(self, "contact_angle", "rad", math.radians(5.0), math.radians(80.0), why=why)
        super()._complete()
