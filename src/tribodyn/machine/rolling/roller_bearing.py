"""Roller bearings: line contact between roller and raceways, in laminae; rolling bearings by name.

A lamina at ``xi`` along the roller is compressed by the displacement of the inner ring along
the normal of the raceway, less clearance and profile, and carries
``35948 L^(8/9) delta^(10/9) / laminae`` (N, mm; steel). Forces of the flanges, and the
difference between the contact angles of both raceways of a tapered roller, are left out.
Source: ISO/TS 16281 (2008); Palmgren (1959).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import InputError, require_one_of
from tribodyn.machine.fields import check_number
from tribodyn.machine.rolling.ball_bearing import AngularContactBallBearing, DeepGrooveBallBearing
from tribodyn.machine.rolling.element_ring import ElementLaw, RollingElementBearing
from tribodyn.model import Registry
from tribodyn.types import Array

#: Force of a steel roller over length^(8/9) compression^(10/9), both raceways together; the
#: 35948 N/mm^2 of ISO/TS 16281 in SI.
LINE_CONSTANT = 35948e6
#: Exponent of the compression of a line contact.
EXPONENT = 10.0 / 9.0
#: E' of steel with E = 207 GPa, nu = 0.3, for pressures [Pa].
_STEEL = 207e9 / (1.0 - 0.3**2)


@dataclass(frozen=True, kw_only=True)
class RollerBearing(RollingElementBearing):
    """Single-row roller bearing, in laminae that carry independently of each other."""

    rollers: int | None = None
    roller_diameter: float | None = None
    roller_length: float | None = None
    contact_angle: float = 0.0
    profile: str = "none"
    laminae: int = 30

    def _complete(self) -> None:
        self._estimate(
            "roller_diameter", lambda bore, outer: 0.25 * (outer - bore), "0.25 (outside - bore)"
        )
        self._estimate(
            "rollers",
            lambda bore, outer: int(0.8 * math.pi * self.pitch / self.element_diameter),
            "80 % of the pitch circle filled",
        )
        if self.roller_length is None and self.width is None:
            raise InputError(
                "roller_length is missing",
                self._where("roller_length"),
                "It is estimated only where the width of the bearing is given",
                "Give roller_length or width",
            )
        width = self.width or 0.0
        self._estimate("roller_length", lambda bore, outer: 0.6 * width, "0.6 of the width")
        require_one_of("profile", self.profile, ["none", "logarithmic"])
        self._check_count("laminae", 3)
        limit = 0.05 * self.element_diameter
        check_number(self, "radial_clearance", "m", -limit, limit)

    @property
    def _pressure_limit(self) -> float:
        return 4.0e9

    @property
    def elements(self) -> int:
        """Number of rollers."""
        return int(self.rollers or 0)

    @property
    def element_diameter(self) -> float:
        """Mean diameter of a roller [m]."""
        return float(self.roller_diameter or 0.0)

    @cached_property
    def _lamina_positions(self) -> Array:
        """Positions of the laminae along the roller, from its middle [m]."""
        length = float(self.roller_length or 0.0)
        return length * ((np.arange(self.laminae) + 0.5) / self.laminae - 0.5)

    @cached_property
    def lamina_gaps(self) -> Array:
        """Gap of each lamina without displacement: clearance and profiles of both contacts [m]."""
        gap = np.full(self.laminae, 0.5 * self.radial_clearance * math.cos(self.contact_angle))
        if self.profile == "none":
            return gap
        length, diameter = float(self.roller_length or 0.0), self.element_diameter
        share = 2.0 * np.abs(self._lamina_positions) / length
        depth = 0.00045 if self.contact_angle else 0.00035
        if not self.contact_angle and length > 2.5 * diameter:
            end = 2.5 * diameter / length
            share, depth = np.maximum(share - (1.0 - end), 0.0) / end, 0.0005
        return gap - 2.0 * depth * diameter * np.log1p(-(share**2))

    def _compression(self, axial: Array, radial: Array, tilt: Array) -> tuple[Array, Array]:
        """Compression of each lamina, and its gradient (rollers, laminae, 3)."""
        sine = self.direction * math.sin(self.contact_angle)
        levers = 0.5 * self.pitch * sine - self._lamina_positions
        gradient = np.empty((self.elements, self.laminae, 3))
        gradient[..., 0], gradient[..., 1] = sine, math.cos(self.contact_angle)
        gradient[..., 2] = levers
        local = np.stack([axial, radial, tilt], axis=-1)
        pressed = np.einsum("eki,ei->ek", gradient, local) - self.lamina_gaps
        return np.maximum(pressed, 0.0), gradient

    @cached_property
    def _lamina_constant(self) -> float:
        length = float(self.roller_length or 0.0)
        return float(LINE_CONSTANT * length ** (8.0 / 9.0) / self.laminae)

    def element_law(self, axial: Array, radial: Array, tilt: Array) -> ElementLaw:
        """Response of each roller, see :class:`RollingElementBearing`."""
        compression, gradient = self._compression(axial, radial, tilt)
        force = self._lamina_constant * compression**EXPONENT
        energy = (force * compression).sum(axis=1) / (EXPONENT + 1.0)
        touching = compression > 0.0
        slope = EXPONENT * np.divide(force, compression, out=np.zeros_like(force), where=touching)
        return ElementLaw(
            energy,
            np.einsum("ek,eki->ei", force, gradient),
            np.einsum("ek,eki,ekj->eij", slope, gradient, gradient),
        )

    def lamina_loads(self, displacement: ArrayLike) -> Array:
        """Loads (rollers, laminae) [N] at a displacement (5,) of the inner ring [m, rad]."""
        return self._forces(*self._local(np.asarray(displacement, dtype=float)))

    def _forces(self, axial: Array, radial: Array, tilt: Array) -> Array:
        compression, _ = self._compression(axial, radial, tilt)
        return np.asarray(self._lamina_constant * compression**EXPONENT)

    def _contacts(self, axial: Array, radial: Array, tilt: Array) -> tuple[Array, ...]:
        force = self._forces(axial, radial, tilt)
        per_length = force.max(axis=1) * self.laminae / float(self.roller_length or 0.0)
        slope = self.element_diameter * math.cos(self.contact_angle) / self.pitch
        angle = np.full(self.elements, self.direction * self.contact_angle)
        return (
            force.sum(axis=1),
            angle,
            *(
                np.sqrt(
                    per_length * _STEEL / (math.pi * self.element_diameter * (1.0 + sign * slope))
                )
                for sign in (-1.0, 1.0)
            ),
        )


class CylindricalRollerBearing(RollerBearing):
    """Cylindrical roller bearing without axial guidance (N, NU): takes no axial force.

    Parameters
    ----------
    bore_diameter, outer_diameter, width : float, optional [m]
        Main dimensions, from which missing inner ones are estimated.
    pitch_diameter : float, optional [m]
        Diameter of the circle of the roller axes; default: mean of bore and outer diameter.
    radial_clearance : float [m]
        Radial play at work, of the diameter; negative for an interference.
    preload : float [N]
        Zero: the bearing carries no axial force.
    direction : int
        Without effect.
    first_element_angle : float [rad]
        Position of the first roller, from y towards z.
    rollers : int, optional
        Number of rollers; default: 80 % of the pitch circle filled.
    roller_diameter : float, optional [m]
        Default: a quarter of the difference of outer and bore diameter.
    roller_length : float, optional [m]
        Effective length of the contact; default: 0.6 of the width.
    contact_angle : float [rad]
        Zero.
    profile : str
        "none" (straight) or "logarithmic" (profile of ISO/TS 16281).
    laminae : int
        Laminae of a roller.

    Examples
    --------
    >>> bearing = CylindricalRollerBearing(pitch_diameter=65e-3, rollers=14,
    ...     roller_diameter=10e-3, roller_length=9.6e-3)
    >>> position = bearing.displacement([0.0, 4450.0, 0.0, 0.0, 0.0])
    >>> round(float(bearing.state(position).element_load.max()) * 14 / 4450.0, 2)
    4.09
    """

    def _complete(self) -> None:
        for name in ("contact_angle", "preload"):
            if getattr(self, name):
                raise InputError(
                    f"{name} = {getattr(self, name):.4g}",
                    self._where(name),
                    "A cylindrical roller bearing carries no axial force",
                    'Leave it out, or choose the type "tapered-roller"',
                )
        super()._complete()

    @property
    def takes_axial_force(self) -> bool:
        """Whether it holds the shaft along its axis: never."""
        return False

    def _limits(self) -> str:
        return "A cylindrical roller bearing carries no axial force"


class TaperedRollerBearing(RollerBearing):
    """Tapered roller bearing; takes axial forces of one direction.

    Parameters
    ----------
    bore_diameter, outer_diameter, width : float, optional [m]
        Main dimensions, from which missing inner ones are estimated.
    pitch_diameter : float, optional [m]
        Diameter of the circle of the roller centres; default: mean of bore and outer diameter.
    radial_clearance : float [m]
        Radial play at work, of the diameter; negative for an interference.
    preload : float [N]
        Axial force of the undisplaced bearing.
    direction : int
        1 if the bearing holds the shaft against forces along +x, -1 against those along -x.
    first_element_angle : float [rad]
        Position of the first roller, from y towards z.
    rollers : int, optional
        Number of rollers; default: 80 % of the pitch circle filled.
    roller_diameter : float, optional [m]
        Mean diameter; default: a quarter of the difference of outer and bore diameter.
    roller_length : float, optional [m]
        Effective length of the contact; default: 0.6 of the width.
    contact_angle : float [rad]
        Angle between the normal of the outer raceway and a plane across the shaft.
    profile : str
        "none" (straight) or "logarithmic" (profile of ISO/TS 16281).
    laminae : int
        Laminae of a roller.

    Examples
    --------
    >>> import math
    >>> bearing = TaperedRollerBearing(bore_diameter=45e-3, outer_diameter=85e-3, width=20e-3,
    ...     contact_angle=math.radians(15.0), preload=500.0)
    >>> [round(float(force), 6) for force in bearing.load([0.0] * 5)][0]
    500.0
    """

    def _complete(self) -> None:
        why = "5 to 60 deg; usual are 10 to 17 deg, 25 to 30 deg for steep bearings"
        check_number(self, "contact_angle", "rad", math.radians(5.0), math.radians(60.0), why=why)
        super()._complete()

    def _limits(self) -> str:
        sign = "+" if self.direction > 0 else "-"
        return (
            f"It carries axial forces along {sign}x only, and a radial force needs an axial force "
            f"of about {1.26 * math.tan(self.contact_angle):.2f} of it to load half of the rollers"
        )


#: What arguments of rolling bearings mean, where their name does not say it.
ROLLING_MEANINGS = {
    "direction": "1 if it holds the shaft against forces along +x, -1 if against those along -x",
    "preload": "axial force of the undisplaced bearing",
    "radial_clearance": "radial play at work, of the diameter; negative for an interference",
    "first_element_angle": "position of the first rolling element, from y towards z",
    "pitch_diameter": "diameter of the circle of the element centres",
    "inner_groove": "radius of the inner groove over the ball diameter",
    "outer_groove": "radius of the outer groove over the ball diameter",
    "profile": "crowning of the rollers: none or logarithmic",
    "laminae": "slices along each roller",
    "balls": "number of balls",
    "rollers": "number of rollers",
}

#: Types of rolling bearings: classes by name.
ROLLING_BEARINGS: Registry[type[RollingElementBearing]] = Registry(
    "type of rolling bearing", "tribodyn.rolling_bearing"
)
for _name, _type in (
    ("deep-groove", DeepGrooveBallBearing),
    ("angular-contact", AngularContactBallBearing),
    ("cylindrical-roller", CylindricalRollerBearing),
    ("tapered-roller", TaperedRollerBearing),
):
    ROLLING_BEARINGS.register(_name)(_type)
